"""Arrays as the images of textures: what their numbers mean, by their type and a range."""
from __future__ import annotations

import math
from typing import Any, Optional

from velo import _arrays, _check
from velo._errors import UsageError, shown, wrong_value
from velo.image import Image

_WHOLE = {"B": "uint8", "H": "uint16"}  # they are scaled by their greatest number
_FLOATS = "efdg"


def _native(value: Any) -> Any:
    """The array in this machine's order of bytes, without types that only numpy has."""
    numpy = _arrays.numpy_or_none()
    if numpy is None or isinstance(value, memoryview):
        return value
    array = numpy.asarray(value)
    if array.dtype.kind == "f" and array.dtype.itemsize > 8:
        return array.astype("float64")
    return array if array.dtype.isnative else array.astype(array.dtype.newbyteorder("="))


def _format(value: Any) -> str:
    try:
        return memoryview(value).format.lstrip("@=<")
    except (TypeError, ValueError, NotImplementedError):
        raise wrong_value("image", "an array of rows x columns x channels", value) from None


def _ends(image: Image) -> tuple[float, float]:
    """The least and the greatest number of an image of floats; NaN where one of them is NaN."""
    numpy = _arrays.numpy_or_none()
    if numpy is not None:
        array = numpy.asarray(image)
        return float(array.min()), float(array.max())
    view: memoryview = _arrays.from_buffer(image)
    numbers = view.cast("B").cast("e" if view.itemsize == 2 else "f").tolist()
    return (math.nan, math.nan) if any(map(math.isnan, numbers)) else (min(numbers), max(numbers))


def _scaled(value: Any, limits: Any) -> Image:
    """The array as linear floats, of which limits are 0 and 1."""
    low, high = (_check.number(end, "range") for end in _check.tuple_of(limits, 2, "range", "(low, high), two numbers"))
    if not low < high:
        raise wrong_value("range", "(low, high), low below high", limits)
    numpy = _arrays.numpy_or_none()
    if numpy is None:
        raise UsageError("range: it needs numpy")
    array = numpy.asarray(value)
    if array.dtype.kind not in "fiub":
        raise wrong_value("image", "an array of numbers", value)
    return Image(((array.astype("float64") - low) / (high - low)).astype("float32"), encoding="linear")


def texels(value: Any, limits: Any, color: bool, factor: Any = None) -> Image:
    """The image of a texture. limits: the keyword range. color: of a colour texture, which holds 0 to 1. factor: the keyword
    scale, by which its numbers are multiplied."""
    if isinstance(value, Image):
        if limits is not None:
            raise UsageError("range: it is of arrays; a velo.Image has its own numbers")
        return value
    _format(value)  # it is an array
    value = _native(value)
    kind = _format(value)
    if limits is not None:
        image = _scaled(value, limits)
    elif kind in _WHOLE or kind == "?" or kind in _FLOATS:
        image = Image(value)
    else:
        raise UsageError("image: only uint8 and uint16 have a range of their own; give range=(low, high), the numbers that are 0 and 1")
    if kind not in _WHOLE or limits is not None:
        _check_ends(image, limits, color, factor)
    return image


def _check_ends(image: Image, limits: Optional[Any], color: bool, factor: Any) -> None:
    low, high = _ends(image)
    if not (math.isfinite(low) and math.isfinite(high)):
        raise UsageError("image: its numbers must be finite")
    times = factor if isinstance(factor, float) else 1.0  # others are checked later
    if color and limits is None and not (low * times >= 0 and high * times <= 1):
        raise UsageError(f"image: its numbers go from {shown(low)} to {shown(high)}, a colour texture holds 0 to 1: give range=(0, 255) "
                         "where 255 is white, for example; range=(0, 1) takes them as they are")
