"""Files of a dataset, each written whole or not at all."""
from __future__ import annotations

import json
import os
import tempfile
from typing import Any, Sequence

from velo._errors import UsageError

#: Of images that velo reads.
_IMAGES = (".bmp", ".exr", ".gif", ".hdr", ".jpeg", ".jpg", ".pfm", ".png", ".pnm", ".ppm", ".qoi", ".tga", ".webp")


def images_of(names: Sequence[str], folder: str) -> list[str]:
    """The names of image files, relative to a folder: a name that is a folder's stands for the images in it, in the order of
    their names. UsageError: it has none."""
    found: list[str] = []
    for name in names:
        path = os.path.join(folder, name)
        if not os.path.isdir(path):
            found.append(name)
            continue
        inside = sorted(item for item in os.listdir(path) if item.lower().endswith(_IMAGES) and os.path.isfile(os.path.join(path, item)))
        if not inside:
            raise UsageError(f"the folder {path} has no images")
        found += [os.path.join(name, item) for item in inside]
    return found


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
