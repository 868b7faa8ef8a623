"""The context that objects are made from, unless another is given."""
from __future__ import annotations

import atexit
import os
from typing import Any, Optional

from velo import _check, _velo

Context = _velo.Context

_default: Optional[Any] = None


def default_context() -> Any:
    """The context of this process: made at the first call, with a worker for each processor."""
    global _default
    if _default is None:
        _default = _velo.Context()
    return _default


def protecting_context() -> Any:
    """A context that overwrites no file which it has read, with as many workers as the default context."""
    return _velo.Context(keep_inputs=True, **({"threads": _default.threads} if _default else {}))


def context_or_default(context: Any) -> Any:
    """A given context; None: that of this process."""
    return default_context() if context is None else _check.instance(context, Context, "context")


def set_threads(threads: int) -> None:
    """Gives the default context this many workers, from 1 to 1024; at most four for each processor are used. Objects that exist keep the context that they were made from."""
    global _default
    _default = _velo.Context(threads=threads)


def _forget() -> None:
    # The threads of a context do not survive fork(): the child makes a context of its own.
    global _default
    _default = None


os.register_at_fork(after_in_child=_forget)
# Threads that still render when the interpreter ends.
atexit.register(_velo.shut_down)
