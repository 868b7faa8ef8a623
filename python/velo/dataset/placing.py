"""Where the objects of a frame are."""
from __future__ import annotations

from typing import Any, Callable, NamedTuple, Optional

from velo._errors import UsageError
from velo.dataset.geometry import Box, Matrix, basis, dot, place, transform
from velo.dataset.random import Random
from velo.dataset.recipe import InVolume, OnSurface, Poses


class Thing(NamedTuple):
    """What is placed, with the bounding box in its own space."""
    number: int  #: from 0; below 0: a distractor
    name: str
    low: Any
    high: Any
    scale: float


def _rotation_about(up: Any, random: Random) -> list[list[float]]:
    """A rotation that maps y to `up` and turns about it."""
    x, y, z = basis(up)
    cosine, sine = random.on_circle()
    first = [x[i] * cosine + y[i] * sine for i in range(3)]
    third = [x[i] * -sine + y[i] * cosine for i in range(3)]
    # Columns: the images of x, y, z. cross(first, third) = up; y maps to up, so z maps to -third.
    return [[first[i], z[i], -third[i]] for i in range(3)]


def _try_surface(rule: OnSurface, thing: Thing, random: Random) -> Matrix:
    x, y, z = basis(rule.up)
    rotation = random.rotation() if rule.tumble else _rotation_about(rule.up, random)
    across, along = rule.size[0] / 2, rule.size[1] / 2
    a, b = random.number(-across, across), random.number(-along, along)
    pose = place(rotation, [rule.center[i] + a * x[i] + b * y[i] for i in range(3)], thing.scale)
    # The lowest corner of its box touches the surface.
    box = Box(thing.low, thing.high, pose)
    lift = dot(rule.center, z) - (dot(box.center, z) - box.extent(z))
    for i in range(3):
        pose[i][3] += lift * z[i]
    return pose


def _try_volume(rule: InVolume, thing: Thing, random: Random) -> Matrix:
    pose = place(random.rotation(), [0, 0, 0], thing.scale)
    center = transform(pose, [(a + b) / 2 for a, b in zip(thing.low, thing.high)])
    point = random.point(rule.low, rule.high)
    for i in range(3):
        pose[i][3] = point[i] - center[i]
    return pose


def place_things(rule: Any, things: list[Thing], frame: int, random: Random) -> list[tuple[Thing, Optional[Matrix]]]:
    """A pose (world from model's file, with its scale) for each thing; None: there was no room."""
    if isinstance(rule, Poses):
        raise UsageError("given poses are not placed")
    attempt: Callable[[Any, Thing, Random], Matrix] = _try_volume
    if isinstance(rule, OnSurface):
        attempt = _try_surface
    boxes: list[Box] = []
    result: list[tuple[Thing, Optional[Matrix]]] = []
    for thing in things:
        found = None
        for _ in range(rule.tries):
            pose = attempt(rule, thing, random)
            box = Box(thing.low, thing.high, pose)
            if not any(box.meets(other, rule.gap) for other in boxes):
                boxes.append(box)
                found = pose
                break
        result.append((thing, found))
    return result
