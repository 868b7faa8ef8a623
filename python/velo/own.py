"""Code of one's own in a render (docs/own-code.md): a camera and a sampler given by Python functions over numpy arrays.

The library's threads call the functions, each call with up to 1024 elements and the GIL. Functions must be pure: what they
give for an element depends on that element alone."""
from __future__ import annotations

from typing import Any, Callable, NamedTuple, Optional

from velo import _arrays, _velo
from velo._errors import UsageError


def _numpy() -> Any:
    numpy = _arrays.numpy_or_none()
    if numpy is None:
        raise UsageError("code of one's own needs numpy")
    return numpy


def _rows(value: Any, what: str, shape: tuple[int, ...], dtype: str) -> Any:
    array = _numpy().asarray(value, dtype=dtype)
    if array.shape != shape:
        raise UsageError(f"{what}: the function must return {' x '.join(map(str, shape))} numbers, not {' x '.join(map(str, array.shape))}")
    return array


def _callable(function: Any, what: str) -> Any:
    if not callable(function):
        raise UsageError(f"{what} must be callable, it is {function!r}")
    return function


class FilmPoints(NamedTuple):
    """Film points that need rays. Arrays have n elements and are valid during the call."""
    x: Any  #: n: pixels from the left edge; the first pixel's centre is 0.5. Up to 16 pixels outside the image
    y: Any  #: n: pixels from the upper edge
    lens: Any  #: n x 2: numbers in [0, 1) for a point of the lens; 0.5 for cameras without lens=True
    time: Any  #: n: seconds
    width: int  #: of the image for which the camera was made, pixels
    height: int


class OwnCamera:
    """A camera of one's own, for Scene.render(camera=...) or Camera(..., own=...).

    rays(points: FilmPoints): returns directions, n x 3 (any length; 0 0 0: no ray), or (directions, origins), or (directions,
    origins, weights): in camera space, x right, y down, z forward. The camera's pose is applied to them. NaN: the sample is
    left out and counted.
    pixels(points, width, height): the inverse, optional: of points (n x 3, camera space) the film points, n x 2; NaN: not seen.
    name: stands in receipts and films. lens: rays uses points.lens."""

    def __init__(self, rays: Callable[[FilmPoints], Any], *, name: str,
                 pixels: Optional[Callable[[Any, int, int], Any]] = None, lens: bool = False) -> None:
        numpy = _numpy()
        _callable(rays, "rays")

        def call_rays(width: int, height: int, *columns: Any) -> None:
            x, y, u, v, time, ox, oy, oz, dx, dy, dz, weight = (numpy.frombuffer(column, "f8") for column in columns)
            result = rays(FilmPoints(x, y, numpy.stack((u, v), axis=1), time, width, height))
            parts = result if isinstance(result, tuple) else (result,)
            if not 1 <= len(parts) <= 3:
                raise UsageError(f"rays: the function must return directions, origins and weights, not {len(parts)} things")
            dx[:], dy[:], dz[:] = _rows(parts[0], "directions", (len(x), 3), "f8").T
            if len(parts) > 1:
                ox[:], oy[:], oz[:] = _rows(parts[1], "origins", (len(x), 3), "f8").T
            if len(parts) > 2:
                weight[:] = _rows(parts[2], "weights", (len(x),), "f8")

        def call_pixels(width: int, height: int, *columns: Any) -> None:
            assert pixels is not None
            x, y, z, film_x, film_y = (numpy.frombuffer(column, "f8") for column in columns)
            result = _rows(pixels(numpy.stack((x, y, z), axis=1), width, height), "film points", (len(x), 2), "f8")
            film_x[:], film_y[:] = result.T

        if pixels is not None:
            _callable(pixels, "pixels")
        self.name = name
        self._own = _velo.own_new("camera", name, call_rays, None if pixels is None else call_pixels, lens)

    def __repr__(self) -> str:
        return f"<velo.OwnCamera {self.name}>"


class Samples(NamedTuple):
    """Samples that need numbers. Arrays have n elements and are valid during the call."""
    x: Any  #: n: column of the pixel; up to 2 outside the image
    y: Any  #: n: row
    index: Any  #: n: index of the sample in its pixel
    dimension: int  #: what the numbers are for; docs/own-code.md lists them
    dimensions: int  #: 1, or 2: a pair of dimension and dimension + 1
    seed: int  #: of the render


class OwnSampler:
    """A sampler of one's own, for Scene.render(sampler=...).

    numbers(samples: Samples): numbers in [0, 1), n or n x 1, and n x 2 for pairs. Each must depend on its pixel, its index, the
    dimension and the seed alone. Others are replaced and counted. name: stands in receipts and films."""

    def __init__(self, numbers: Callable[[Samples], Any], *, name: str) -> None:
        numpy = _numpy()
        _callable(numbers, "numbers")

        def call(dimension: int, seed: int, *columns: Any) -> None:
            x, y = (numpy.frombuffer(column, "i4") for column in columns[:2])
            index = numpy.frombuffer(columns[2], "u4")
            outputs = [numpy.frombuffer(column, "f4") for column in columns[3:] if column is not None]
            result = numbers(Samples(x, y, index, dimension, len(outputs), seed))
            array = numpy.asarray(result, dtype="f8")
            if len(outputs) == 1:
                array = array.reshape(-1, 1) if array.ndim == 1 else array
            array = _rows(array, "numbers", (len(x), len(outputs)), "f8").astype("f4")
            array[array == 1] = numpy.float32(1 - 2.0**-24)  # doubles just below 1
            for k, output in enumerate(outputs):
                output[:] = array[:, k]

        self.name = name
        self._own = _velo.own_new("sampler", name, call, None, False)

    def __repr__(self) -> str:
        return f"<velo.OwnSampler {self.name}>"


def bare(value: Any) -> Any:
    """The extension's object behind code of one's own; other values as they are."""
    return value._own if isinstance(value, (OwnCamera, OwnSampler)) else value
