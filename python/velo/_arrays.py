"""Arrays of numbers: numpy's where numpy is installed, else memoryviews."""
from __future__ import annotations

from typing import Any, Sequence

_TYPES = {"d": "float64", "f": "float32", "I": "uint32", "B": "uint8"}


def numpy_or_none() -> Any:
    """The module numpy, imported at the first use; None: it is not installed."""
    try:
        import numpy
    except ImportError:
        return None
    return numpy


def from_bytes(data: bytearray, code: str, shape: Sequence[int]) -> Any:
    """The numbers of a bytearray as an array of this shape, without a copy."""
    numpy = numpy_or_none()
    if numpy is not None:
        return numpy.frombuffer(data, dtype=_TYPES[code]).reshape(shape)
    if 0 in shape:
        return memoryview(b"").cast(code)
    return memoryview(data).cast("B").cast(code, list(shape))


def from_rows(numbers: Sequence[float], rows: int, columns: int) -> Any:
    """A matrix of doubles from its rows."""
    numpy = numpy_or_none()
    if numpy is not None:
        return numpy.array(numbers, dtype="float64").reshape(rows, columns)
    import array
    return memoryview(array.array("d", numbers)).cast("B").cast("d", [rows, columns])


def from_buffer(buffer: Any) -> Any:
    """A view of a buffer, without a copy."""
    numpy = numpy_or_none()
    return numpy.asarray(buffer) if numpy is not None else memoryview(buffer)
