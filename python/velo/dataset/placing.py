"""Where the objects of a frame are."""
from __future__ import annotations

from typing import Any, Callable, NamedTuple, Optional

from velo._errors import UsageError
from velo.dataset.geometry import Box, Matrix, basis, dot, place, rotation_about, transform
from velo.dataset.random import Random
from velo.dataset.recipe import InVolume, OnScene, OnSurface, Poses
from velo.dataset.surfaces import Surfaces


class Thing(NamedTuple):
    """What is placed, with the bounding box in its own space."""
    number: int  #: from 0; below 0: a distractor
    name: str
    low: Any
    high: Any
    scale: float


def _try_surface(rule: OnSurface, thing: Thing, random: Random) -> Matrix:
    x, y, z = basis(rule.up)
    rotation = random.rotation() if rule.tumble else rotation_about(rule.up, random)
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


def place_things(rule: Any, things: list[Thing], frame: int, random: Random,
                 world: Any = None) -> list[tuple[Thing, Optional[Matrix]]]:
    """A pose (world from model's file, with its scale) for each thing; None: there was no room. world: what things stand on, for
    the rule OnScene."""
    if isinstance(rule, Poses):
        raise UsageError("given poses are not placed")
    attempt: Callable[[Any, Thing, Random], Optional[Matrix]] = _try_volume
    if isinstance(rule, OnSurface):
        attempt = _try_surface
    if isinstance(rule, OnScene):
        surfaces = Surfaces(world, rule)

        def attempt(_: Any, thing: Thing, draw: Random) -> Optional[Matrix]:
            return surfaces.attempt(thing.low, thing.high, thing.scale, draw)
    boxes: list[Box] = []
    result: list[tuple[Thing, Optional[Matrix]]] = []
    for thing in things:
        found = None
        for _ in range(rule.tries):
            pose = attempt(rule, thing, random)
            if pose is None:
                continue
            box = Box(thing.low, thing.high, pose)
            if not any(box.meets(other, rule.gap) for other in boxes):
                boxes.append(box)
                found = pose
                break
        result.append((thing, found))
    return result
