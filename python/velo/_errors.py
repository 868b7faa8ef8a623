"""Exceptions, the state of a render, messages of the library."""
from __future__ import annotations

import contextlib
import logging
from typing import Any, Iterator, NamedTuple, Optional, Sequence


class Error(Exception):
    """What velo reports. `message` is one line; `file`, `line` and `column` (from 1) name the place, None: not known.
    `code` is the exit code that the program velo has for such errors."""

    code = 1
    file: Optional[str] = None
    line: Optional[int] = None
    column: Optional[int] = None
    message: str = ""

    def __init__(self, message: str = "") -> None:
        super().__init__(message)
        self.message = message

    def __str__(self) -> str:
        place = ":".join(str(part) for part in (self.file, self.line, self.column) if part)
        return f"{place}: {self.message}" if place else self.message


class UsageError(Error, ValueError):
    """A call is wrong: an unknown keyword, a value out of range, an object that is closed or in use."""
    code = 2


class SceneError(Error):
    """The contents of a file or of a scene are wrong."""
    code = 3


class UnsupportedError(SceneError):
    """Valid, but not supported."""


class MissingFileError(Error, FileNotFoundError):
    """A file does not exist."""
    code = 4


class OutputError(Error, OSError):
    """Reading or writing failed: no such folder, disk full, permission."""
    code = 5


class OutOfMemoryError(Error, MemoryError):
    """The memory does not suffice."""


class CancelledError(Error):
    """A callback returned False, so that a load or a build has no result."""


class ForkError(Error, RuntimeError):
    """An object made before fork() was used after it."""


# By vlResult.
_CLASSES = {1: UsageError, 2: OutOfMemoryError, 3: SceneError, 4: MissingFileError, 5: OutputError, 6: UnsupportedError,
            7: CancelledError}


def make(result: int, message: str, line: int, column: int) -> Error:
    """The exception of a vlResult. The extension module calls it."""
    error = _CLASSES.get(result, Error)(message)
    error.line = line or None
    error.column = column or None
    return error


def fork_error() -> ForkError:
    """The error of an object of the parent process."""
    return ForkError("this object was made before fork(), which does not copy its threads: make it again in this process")


#: What other programs call keywords.
_OTHER_NAMES = {"base_color": "reflectance", "basecolor": "reflectance", "albedo": "reflectance", "diffuse": "reflectance", "ior": "eta",
                "vertices": "positions", "points": "positions", "faces": "indices", "triangles": "indices", "uv": "uvs", "texcoords": "uvs",
                "location": "position", "energy": "power", "intensity": "scale", "direction": "to", "matrix": "pose",
                "world_from_object": "pose", "samples": "spp", "width": "resolution", "height": "resolution",
                "focal_length": "focal_mm", "aperture": "lens_radius", "transparency": "transmission", "opacity": "alpha", "emissive": "emission"}


def unknown(thing: str, name: str, names: Sequence[str]) -> UsageError:
    """There is no `thing` of that name: the message has the nearest name."""
    from velo import _velo
    other = _OTHER_NAMES.get(name.lower()) if isinstance(name, str) else None
    if other is not None and other in names and name not in names:
        return UsageError(f"unknown {thing} {shown(name)}; it is called {other}")
    if not names:
        return UsageError(f"unknown {thing} {shown(name)}; none is known")
    plain = name.encode(errors="backslashreplace").decode().replace("\0", "?")  # as C can hold it
    return UsageError(_velo.unknown_name(thing, plain, sorted(set(names))))


_MAX_SHOWN = 200  # characters of a value in a message


def _brief(value: Any, depth: int) -> str:
    if isinstance(value, (str, bytes)):
        return repr(value[:_MAX_SHOWN])
    if isinstance(value, int) and value.bit_length() > 2 * _MAX_SHOWN:
        return f"{'-' if value < 0 else ''}2**{value.bit_length() - 1} or more"
    if isinstance(value, (list, tuple, dict)):
        if len(value) > 8 or depth > 2:
            return f"a {type(value).__name__} of {len(value)} items"
        if isinstance(value, dict):
            return "{" + ", ".join(f"{_brief(k, depth + 1)}: {_brief(v, depth + 1)}" for k, v in value.items()) + "}"
        text = ", ".join(_brief(item, depth + 1) for item in value)
        return f"[{text}]" if isinstance(value, list) else f"({text}{',' if len(value) == 1 else ''})"
    return repr(value)


def shown(value: Any) -> str:
    """A value as messages show it: at most 200 characters."""
    try:
        text = _brief(value, 0)
    except Exception:  # its own __repr__ fails
        text = f"<{type(value).__name__}>"
    text = " ".join(text.split()).encode(errors="backslashreplace").decode()
    return text if len(text) <= _MAX_SHOWN else text[:_MAX_SHOWN - 3] + "..."


def wrong_value(what: str, rule: str, value: Any) -> UsageError:
    """A value that `what` must not have. rule: what it may be."""
    return UsageError(f"{what} must be {rule}; it is {shown(value)}")


@contextlib.contextmanager
def at_place(where: str) -> Iterator[None]:
    """Errors inside of it begin with a place, such as recipe.models[0]."""
    try:
        yield
    except Error as error:
        error.message = f"{where}: {error.message}"
        raise


class Progress(NamedTuple):
    """The state of a render."""
    spp: int  #: samples per pixel of finished passes
    spp_total: int  #: samples per pixel that were asked for
    elapsed: float  #: seconds
    remaining: float  #: seconds, an estimate; infinity before there is one
    fraction: float  #: share of the work that is done, 0 to 1
    paths: int  #: paths traced
    rays: int  #: rays traced
    pass_done: bool  #: a pass is finished: the film may be read


class Step(NamedTuple):
    """The state of a load or a build."""
    name: str  #: what is done now: reading, images, shapes, lights, accelerator
    fraction: float  #: estimated share of the work that is done, 0 to 1
    elapsed: float  #: seconds


_LEVELS = (logging.ERROR, logging.WARNING, logging.INFO, logging.DEBUG)


def log(level: int, message: str, file: str, line: int, column: int) -> None:
    """Passes a message of the library to logging's logger "velo"."""
    place = ":".join(str(part) for part in (file, line, column) if part)
    logging.getLogger("velo").log(_LEVELS[level], "%s", f"{place}: {message}" if place else message)
