"""Code of one's own in a render (docs/own-code.md): a camera, a sampler and a tracer given by Python functions over numpy arrays.

The library's threads call the functions, each call with up to 1024 elements and the GIL. Functions must be pure: what they
give for an element depends on that element alone."""
from __future__ import annotations

from typing import Any, Callable, NamedTuple, Optional

from velo import _arrays, _check, _velo
from velo._errors import UsageError, wrong_value


def _numpy() -> Any:
    numpy = _arrays.numpy_or_none()
    if numpy is None:
        raise UsageError("code of one's own needs numpy")
    return numpy


def _array(value: Any, what: str, dtype: str) -> Any:
    numpy = _numpy()
    rule = "an array of real numbers"
    if isinstance(value, range):  # it may be too long for any memory
        raise wrong_value(what, rule, value)
    try:
        if not numpy.iscomplexobj(value):
            return numpy.asarray(value, dtype=dtype)
    except (TypeError, ValueError, OverflowError):
        pass
    raise wrong_value(what, rule, value)


def _numbers(value: Any, what: str, shape: tuple[int, ...], dtype: str) -> Any:
    """An array of a shape."""
    array = _array(value, what, dtype)
    if array.shape != shape:
        raise UsageError(f"{what} must be {' x '.join(map(str, shape))} numbers, not {' x '.join(map(str, array.shape))}")
    return array


def _function(function: Any, what: str) -> Any:
    if not callable(function):
        raise wrong_value(what, "callable", function)
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
        _function(rays, "rays")
        _check.flag(lens, "lens")

        def call_rays(width: int, height: int, *columns: Any) -> None:
            x, y, u, v, time, ox, oy, oz, dx, dy, dz, weight = (numpy.frombuffer(column, "f8") for column in columns)
            result = rays(FilmPoints(x, y, numpy.stack((u, v), axis=1), time, width, height))
            parts = result if isinstance(result, tuple) else (result,)
            if not 1 <= len(parts) <= 3:
                raise UsageError(f"rays: the function must return directions, origins and weights, not {len(parts)} things")
            dx[:], dy[:], dz[:] = _numbers(parts[0], "directions", (len(x), 3), "f8").T
            if len(parts) > 1:
                ox[:], oy[:], oz[:] = _numbers(parts[1], "origins", (len(x), 3), "f8").T
            if len(parts) > 2:
                weight[:] = _numbers(parts[2], "weights", (len(x),), "f8")

        def call_pixels(width: int, height: int, *columns: Any) -> None:
            assert pixels is not None
            x, y, z, film_x, film_y = (numpy.frombuffer(column, "f8") for column in columns)
            result = _numbers(pixels(numpy.stack((x, y, z), axis=1), width, height), "film points", (len(x), 2), "f8")
            film_x[:], film_y[:] = result.T

        if pixels is not None:
            _function(pixels, "pixels")
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
        _function(numbers, "numbers")

        def call(dimension: int, seed: int, *columns: Any) -> None:
            x, y = (numpy.frombuffer(column, "i4") for column in columns[:2])
            index = numpy.frombuffer(columns[2], "u4")
            outputs = [numpy.frombuffer(column, "f4") for column in columns[3:] if column is not None]
            result = numbers(Samples(x, y, index, dimension, len(outputs), seed))
            array = _array(result, "numbers", "f8")
            if len(outputs) == 1:
                array = array.reshape(-1, 1) if array.ndim == 1 else array
            array = _numbers(array, "numbers", (len(x), len(outputs)), "f8").astype("f4")
            array[array == 1] = numpy.float32(1 - 2.0**-24)  # doubles just below 1
            for k, output in enumerate(outputs):
                output[:] = array[:, k]

        self.name = name
        self._own = _velo.own_new("sampler", name, call, None, False)

    def __repr__(self) -> str:
        return f"<velo.OwnSampler {self.name}>"


# ---- tracers ------------------------------------------------------------------------------------------------------------

_BATCH = 1024
_MAX_INDEX = 4096  #: of a bounce, and of a purpose of numbers


def _layout(*members: tuple[str, str, int]) -> list[Any]:
    """Members (name, type, rows) of a struct of velo/trace.h, each row with an element for each lane."""
    return [(name, kind, (rows, _BATCH) if rows else (_BATCH,)) for name, kind, rows in members]


_RAYS: list[Any] = [("count", "u4")] + _layout(("origin", "f4", 3), ("direction", "f4", 3), ("t_min", "f4", 0), ("t_max", "f4", 0),
                                               ("width", "f4", 0))
_HITS: list[Any] = [("count", "u4")] + _layout(("t", "f4", 0), ("position", "f4", 3), ("normal", "f4", 3), ("shading", "f4", 3),
                                               ("uv", "f4", 2), ("object", "u4", 0), ("material", "u4", 0),
                                               ("reflectance", "f4", 4), ("emission", "f4", 4))
_LIGHTS: list[Any] = _layout(("direction", "f4", 3), ("radiance", "f4", 4), ("pdf", "f4", 0), ("delta", "u1", 0)) + [("rays", _RAYS)]
_BOUNCE: list[Any] = _layout(("weight", "f4", 4), ("pdf", "f4", 0), ("specular", "u1", 0)) + [("rays", _RAYS)]


def _view(data: Any, name: str, count: int) -> Any:
    array = data[name]
    return array[:, :count].T if array.ndim == 2 else array[:count]


class TraceRays:
    """Rays of n lanes, in world space. The arrays share their memory with the struct that velo reads: they may be written."""

    def __init__(self, data: Any, count: int) -> None:
        self._data = data
        self.origin = _view(data, "origin", count)  #: n x 3, scene units
        self.direction = _view(data, "direction", count)  #: n x 3, unit; of rays to lights: any length
        self.t_min = _view(data, "t_min", count)  #: n: where the ray begins to count, in lengths of its direction
        self.t_max = _view(data, "t_max", count)  #: n: where it ends; below 0: no ray
        self.width = _view(data, "width", count)  #: n: width of the footprint at the origin, scene units


def _rays_of(rays: Any) -> Any:
    """The struct of rays that velo made."""
    if not isinstance(rays, TraceRays):
        raise wrong_value("rays", "a velo.TraceRays", rays)
    return rays._data


class TraceHits:
    """The nearest hits of n rays."""

    def __init__(self, data: Any, count: int) -> None:
        self.t = _view(data, "t", count)  #: n: distance, scene units; inf: nothing was hit, and all but emission is 0
        self.position = _view(data, "position", count)  #: n x 3, world space
        self.normal = _view(data, "normal", count)  #: n x 3: of the surface, on the side of the ray's origin
        self.shading = _view(data, "shading", count)  #: n x 3: the material's normal, on the surface's outside
        self.uv = _view(data, "uv", count)  #: n x 2: texture coordinates
        self.object = _view(data, "object", count)  #: n: id as in ground truth; 0: nothing
        self.material = _view(data, "material", count)  #: n: id; 0: nothing
        self.reflectance = _view(data, "reflectance", count)  #: n x 4 channels; 1 for materials that have none
        self.emission = _view(data, "emission", count)  #: n x 4: radiance of the light that was hit, or of the sky


class TraceLights:
    """Samples of the direct light at n hits."""

    def __init__(self, data: Any, count: int) -> None:
        self.direction = _view(data, "direction", count)  #: n x 3: towards the light, unit
        self.radiance = _view(data, "radiance", count)  #: n x 4: what arrives if nothing is in between, divided by pdf
        self.pdf = _view(data, "pdf", count)  #: n: per steradian; 0: no sample
        self.delta = _view(data, "delta", count)  #: n: 1: light from a single point or direction
        self.rays = TraceRays(data["rays"], count)  #: the way to the light, for Trace.occluded


class TraceBounce:
    """Directions in which n paths go on."""

    def __init__(self, data: Any, count: int) -> None:
        self.weight = _view(data, "weight", count)  #: n x 4: BSDF times cosine, divided by pdf; 0: the path ends
        self.pdf = _view(data, "pdf", count)  #: n: per steradian
        self.specular = _view(data, "specular", count)  #: n: 1: a mirror or smooth glass
        self.rays = TraceRays(data["rays"], count)  #: for Trace.hits


class Trace:
    """A batch of n paths that is being traced. It lives during the call of the tracer. Lane i is path i in all arrays."""

    def __init__(self, trace: Any, count: int) -> None:
        self._trace = trace
        self._count = count

    def _ask(self, question: str, number: int, given: Any, layout: Any) -> Any:
        data = _numpy().zeros((), dtype=layout)
        _velo.trace_ask(self._trace, question, number, given, data)
        return data

    def _padded(self, direction: Any) -> Any:
        rows = _numpy().zeros((3, _BATCH), dtype="f4")
        rows[:, :self._count] = _numbers(direction, "direction", (self._count, 3), "f4").T
        return rows

    def hits(self, rays: TraceRays) -> TraceHits:
        """The nearest hits of rays. The other methods then ask about these hits."""
        return TraceHits(self._ask("hits", 0, _rays_of(rays), _HITS), self._count)

    def occluded(self, rays: TraceRays) -> Any:
        """n flags, for n rays (n x 3): True where a surface lies on the ray."""
        return self._ask("occluded", 0, _rays_of(rays), ("u1", _BATCH))[:self._count].astype(bool)

    def leave(self, direction: Any) -> TraceRays:
        """Rays that leave the last hits in these directions (n x 3, unit, world space), without meeting the surface that they
        leave."""
        return TraceRays(self._ask("leave", 0, self._padded(direction), _RAYS), self._count)

    def lights(self, bounce: int = 0) -> TraceLights:
        """A sample of a light for each of the last hits. bounce: 0 for hits of the camera's rays; selects the numbers."""
        return TraceLights(self._ask("lights", _check.whole(bounce, "bounce", 0, _MAX_INDEX), None, _LIGHTS), self._count)

    def bsdf(self, direction: Any) -> tuple[Any, Any]:
        """The BSDF of the last hits for light from these directions (n x 3, unit, world space), times the cosine: n x 4; and the
        density with which bounce samples them: n."""
        data = self._ask("bsdf", 0, self._padded(direction), ("f4", (5, _BATCH)))
        return data[:4, :self._count].T, data[4, :self._count]

    def bounce(self, bounce: int = 0) -> TraceBounce:
        """Samples the BSDFs of the last hits. bounce: as lights."""
        return TraceBounce(self._ask("bounce", _check.whole(bounce, "bounce", 0, _MAX_INDEX), None, _BOUNCE), self._count)

    def numbers(self, purpose: int = 0) -> Any:
        """n x 2: numbers in [0, 1) of the render's sampler. Those of different purposes are independent."""
        return self._ask("numbers", _check.whole(purpose, "purpose", 0, _MAX_INDEX), None, ("f4", (2, _BATCH)))[:, :self._count].T


class Paths(NamedTuple):
    """The paths that a tracer computes: n lanes."""
    rays: TraceRays  #: the camera's
    x: Any  #: n: column of the pixel
    y: Any  #: n: row
    index: Any  #: n: index of the sample in its pixel
    time: Optional[Any]  #: n: time in the world's motion, 0 to 1; None: nothing moves
    wavelengths: Optional[Any]  #: n x 4, nm; None in an RGB world
    white: Any  #: n x 4: the channels of white light of luminance 1
    max_depth: int  #: the keyword of render


class OwnTracer:
    """A tracer of one's own, for Scene.render(tracer=...).

    radiance(trace: Trace, paths: Paths): radiance of each path: n x 4 channels (wavelengths, or R, G, B and one that is not
    used), or n numbers, which stand for white light. NaN: the sample is left out and counted. name: stands in receipts and
    films."""

    def __init__(self, radiance: Callable[[Trace, Paths], Any], *, name: str) -> None:
        numpy = _numpy()
        _function(radiance, "radiance")

        def call(trace: Any, count: int, max_depth: int, rays: Any, x: Any, y: Any, index: Any, time: Any, wavelengths: Any,
                 white: Any, result: Any, alpha: Any) -> None:
            def channels(column: Any) -> Any:
                return numpy.frombuffer(column, "f4").reshape(4, _BATCH)[:, :count].T
            data = numpy.frombuffer(rays, dtype=_RAYS)[0]
            paths = Paths(TraceRays(data, count), numpy.frombuffer(x, "i4"), numpy.frombuffer(y, "i4"),
                          numpy.frombuffer(index, "u4"), None if time is None else numpy.frombuffer(time, "f4"),
                          None if wavelengths is None else channels(wavelengths), channels(white), max_depth)
            value = _array(radiance(Trace(trace, count), paths), "radiance", "f4")
            if value.ndim == 1:
                value = _numbers(value, "radiance", (count,), "f4")[:, None] * paths.white
            channels(result)[:] = _numbers(value, "radiance", (count, 4), "f4")

        self.name = name
        self._own = _velo.own_new("tracer", name, call, None, False)

    def __repr__(self) -> str:
        return f"<velo.OwnTracer {self.name}>"


def bare(value: Any) -> Any:
    """The extension's object behind code of one's own; other values as they are."""
    return value._own if isinstance(value, (OwnCamera, OwnSampler, OwnTracer)) else value
