"""Files of a dataset, each written whole or not at all."""
from __future__ import annotations

import json
import os
import tempfile
from typing import Any


def write_bytes(path: str, data: bytes, context: Any = None) -> None:
    """Writes a file, and the folders above it. Failures are velo.OutputErrors; velo.UsageError where the context has read
    that file and keeps its inputs."""
    from velo._errors import OutputError
    try:
        folder = os.path.dirname(path)
        os.makedirs(folder, exist_ok=True)
        if context:
            context.check_output(path)
        handle, temporary = tempfile.mkstemp(prefix=".velo-", suffix=".tmp", dir=folder)
        try:
            with os.fdopen(handle, "wb") as file:
                file.write(data)
            os.chmod(temporary, 0o644)
            os.replace(temporary, path)
        except BaseException:
            os.unlink(temporary)
            raise
    except OSError as problem:
        error = OutputError(f"cannot write: {problem.strerror or problem}")
        error.file = path
        raise error from problem


def read_json(path: str, default: Any) -> Any:
    """Reads JSON; the default where there is no such file."""
    try:
        with open(path, encoding="utf-8") as file:
            return json.load(file)
    except FileNotFoundError:
        return default
