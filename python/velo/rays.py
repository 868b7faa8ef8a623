"""Rays of one's own: what they hit in a world (docs/rays.md)."""
from __future__ import annotations

import warnings
from typing import Any, NamedTuple, Optional, Sequence

from velo import _arrays, _check, _velo
from velo._errors import UsageError


class RayHits(NamedTuple):
    """What rays hit. n: the shape of the rays' arrays without their last axis, followed by `hits` where that is above 1; hits
    are sorted by t. Rows without a hit are 0, t and distance there infinity. Fields that were not asked for are None."""
    valid: Any  #: n, bool: there is such a hit
    t: Any  #: n: in lengths of the ray's direction
    distance: Any  #: n: along the ray, scene units
    position: Any  #: n x 3: origin + t * direction
    normal: Any  #: n x 3: geometric, unit, on the surface's outside
    shading_normal: Any  #: n x 3: interpolated, with bump and normal maps; unit
    uv: Any  #: n x 2: texture coordinates
    velocity: Any  #: n x 3: of the surface's point, scene units per second
    object_id: Any  #: n: as World.ids("object"), from 1; 0: nothing
    instance_id: Any  #: n: as World.ids("instance"), from 1; 0: in no instance
    primitive_id: Any  #: n: the face in its object, from 1; 0: nothing
    material_id: Any  #: n: as World.ids("material"), from 1; 0: nothing
    met: int  #: number of rays with a hit
    not_finite: int  #: number of rays with NaN or infinity, which were not traced
    zero_directions: int  #: number of rays with direction 0 0 0, which were not traced
    too_far: int  #: number of rays that start beyond 1.8e18, which were not traced


# In the order of RayHits: type and number of each field's items.
_ITEMS = (("B", 1), ("d", 1), ("d", 1), ("d", 3), ("f", 3), ("f", 3), ("f", 2), ("d", 3), ("I", 1), ("I", 1), ("I", 1), ("I", 1))
_FIELDS = RayHits._fields[:len(_ITEMS)]


def _bits(fields: Optional[Sequence[str]]) -> int:
    names = _FIELDS if fields is None else _check.names(fields, "fields")
    bits = 0
    for name in names:
        if name not in _FIELDS:
            raise UsageError(_velo.unknown_name("field of velo.RayHits", name, list(_FIELDS)))
        bits |= 1 << _FIELDS.index(name)
    return bits


def _leading(origins: Any, directions: Any, count: int) -> tuple[int, ...]:
    """The shape of the rays: that of the array that has them all, without its last axis."""
    for array in (origins, directions):
        shape = tuple(getattr(array, "shape", ()))[:-1]
        size = 1
        for length in shape:
            size *= length
        if len(shape) > 1 and size == count:
            return shape
    return (count,)


def _note(count: int, stats: tuple[int, int, int, int]) -> None:
    """A warning about rays that were not traced."""
    reasons = ((stats[1], "have a number that is not finite"), (stats[2], "have the direction 0 0 0"),
               (stats[3], "start beyond 1.8e18"))
    texts = [f"{number} {text}" for number, text in reasons if number]
    if texts:
        warnings.warn(f"of {count} rays, {', '.join(texts)}: they hit nothing", RuntimeWarning, stacklevel=4)


def _flags(data: bytearray, shape: tuple[int, ...]) -> Any:
    flags = _arrays.from_bytes(data, "B", shape)
    return flags.view(bool) if _arrays.numpy_or_none() is not None else flags


def trace(world: Any, origins: Any, directions: Any, t_max: Any, times: Any, t_min: Any, hits: int,
          fields: Optional[Sequence[str]]) -> RayHits:
    """World.trace."""
    count, data, stats = world._trace(origins, directions, t_min, t_max, times, hits, _bits(fields))
    rows = _leading(origins, directions, count) + ((hits,) if hits > 1 else ())
    arrays: list[Any] = []
    for (code, items), block in zip(_ITEMS, data):
        shape = rows + ((items,) if items > 1 else ())
        arrays.append(None if block is None else _arrays.from_bytes(block, code, shape))
    if data[0] is not None:
        arrays[0] = _flags(data[0], rows)
    _note(count, stats)
    return RayHits(*arrays, *stats)


def occluded(world: Any, origins: Any, directions: Any, t_max: Any, times: Any, t_min: Any) -> Any:
    """World.occluded."""
    count, data, stats = world._occluded(origins, directions, t_min, t_max, times)
    _note(count, stats)
    return _flags(data, _leading(origins, directions, count))
