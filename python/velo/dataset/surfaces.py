"""Poses on the surfaces of a scene, found by rays."""
from __future__ import annotations

import math
from typing import Any, Optional, Sequence

import numpy

from velo.dataset.geometry import Box, Matrix, basis, dot, place, rotation_about, subtract
from velo.dataset.random import Random
from velo.dataset.recipe import OnScene

_GRID = [(2 * i + 1) / 7 - 1 for i in range(7)]  # places of rays across a box, from -1 to 1
_SUPPORT = 0.75  # the share of a footprint's rays that must find the surface
_INSET = 0.98  # rays through a box end so much before its faces: it touches what it stands on


class Surfaces:
    """What things can stand on."""

    def __init__(self, world: Any, rule: OnScene) -> None:
        self._world = world
        self._rule = rule
        self._across, self._along, self._up = basis(rule.up)
        angle = math.radians(rule.slope)
        self._cosine, self._slope = math.cos(angle), math.tan(angle)

    def attempt(self, low: Sequence[float], high: Sequence[float], scale: float, random: Random) -> Optional[Matrix]:
        """A random pose (world from model's file, with its scale) of a thing with this bounding box; None: it does not fit there."""
        rule = self._rule
        point = random.point(rule.low, rule.high)
        rotation = random.rotation() if rule.tumble else rotation_about(rule.up, random)
        below = self._below([point], math.inf)
        if not below.valid[0]:
            return None
        foot = [float(value) for value in below.position[0]]
        normal = [float(value) for value in below.normal[0]]
        in_box = all(rule.low[i] - 1e-9 <= foot[i] <= rule.high[i] + 1e-9 for i in range(3))
        if not in_box or abs(dot(normal, self._up)) < self._cosine:
            return None
        pose = place(rotation, [0, 0, 0], scale)
        box = Box(low, high, pose)
        lift = box.extent(self._up)
        self._shift(pose, [foot[i] + lift * self._up[i] - box.center[i] for i in range(3)])
        higher = self._rise(Box(low, high, pose), dot(foot, self._up))
        if higher is None:
            return None
        self._shift(pose, [higher * self._up[i] for i in range(3)])
        return None if self._is_pierced(Box(low, high, pose)) else pose

    @staticmethod
    def _shift(pose: Matrix, by: Sequence[float]) -> None:
        for i in range(3):
            pose[i][3] += by[i]

    def _below(self, points: Any, reach: float) -> Any:
        """What is straight below points, up to a distance."""
        down = [-value for value in self._up]
        return self._world.trace(numpy.array(points, dtype="float64"), numpy.array([down]), t_max=reach,
                                 fields=["valid", "t", "position", "normal"])

    def _rise(self, box: Box, height: float) -> Optional[float]:
        """By how much a box that stands at a height must rise to stand on the highest point below it. None: there is something in
        the box, or nothing below much of it."""
        half = box.extent(self._up)
        a, b = self._footprint(box)
        top = [[box.center[k] + half * self._up[k] + i * a[k] + j * b[k] for k in range(3)] for i in _GRID for j in _GRID]
        width = math.sqrt(dot(a, a) + dot(b, b))
        margin = self._slope * width + 1e-3 * (width + half)
        below = self._below(top, 2 * half + margin)
        heights = [dot(position, self._up) for position, valid in zip(below.position.tolist(), below.valid.tolist()) if valid]
        if len(heights) < _SUPPORT * len(top) or max(heights) > height + margin:
            return None
        return max(0.0, max(heights) - height)

    def _footprint(self, box: Box) -> tuple[list[float], list[float]]:
        """Half axes of a rectangle across `up` that the box covers: its own axes where it is upright."""
        upright = [axis for axis in box.axes if abs(dot(axis, self._up)) < 1e-9 * box.radius]
        if len(upright) == 2:
            return upright[0], upright[1]
        return ([box.extent(self._across) * value for value in self._across], [box.extent(self._along) * value for value in self._along])

    def _is_pierced(self, box: Box) -> bool:
        """Whether a surface of the scene crosses one of the rays through the box, along each of its axes."""
        origins, ways = [], []
        for k in range(3):
            along, a, b = box.axes[k], box.axes[(k + 1) % 3], box.axes[(k + 2) % 3]
            for i in _GRID:
                for j in _GRID:
                    middle = [box.center[n] + _INSET * (i * a[n] + j * b[n]) for n in range(3)]
                    origins.append(subtract(middle, [_INSET * value for value in along]))
                    ways.append([2 * _INSET * value for value in along])
        return bool(self._world.occluded(numpy.array(origins), numpy.array(ways), t_max=1.0).any())
