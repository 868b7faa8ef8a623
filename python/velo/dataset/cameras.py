"""The cameras of a frame."""
from __future__ import annotations

import math
import os
from typing import Any, NamedTuple

import velo
from velo._errors import UsageError, at_place
from velo.dataset.geometry import Matrix, basis, look_at, multiply
from velo.dataset.random import Random
from velo.dataset.recipe import Around, Fixed, Recipe, Rig, Trajectory


class View(NamedTuple):
    """A camera of a frame."""
    name: str
    camera: Any  #: velo.Camera


def _keywords(rule: Any) -> dict[str, Any]:
    """Those of a rule's camera. The rule's fov is in degrees, velo.Camera's in radians."""
    return {**rule.keywords, **({} if rule.fov is None else {"fov": math.radians(rule.fov), "fov_axis": "smaller"})}


class Cameras:
    """Makes the cameras of frames. Files are read once."""

    def __init__(self, recipe: Recipe) -> None:
        self._recipe = recipe
        self._files: dict[str, Any] = {}

    def _path(self, path: str) -> str:
        return os.path.join(self._recipe.folder, path)

    def _trajectory(self, path: str) -> Any:
        if path not in self._files:
            width, height = self._recipe.resolution
            self._files[path] = velo.read_trajectory(self._path(path), width=width, height=height)
        return self._files[path]

    def _fixed(self, rule: Fixed) -> Any:
        width, height = self._recipe.resolution
        if not rule.file:
            return velo.Camera(width, height, **_keywords(rule))
        if rule.file not in self._files:
            self._files[rule.file] = velo.read_camera(self._path(rule.file), width=width, height=height)
        return self._files[rule.file].resize(width, height)

    def _around(self, rule: Around, random: Random) -> Any:
        width, height = self._recipe.resolution
        low, high = (math.sin(math.radians(angle)) for angle in rule.elevation)
        x, y, z = basis(rule.up)
        # Uniform over the zone of the sphere between the two elevations.
        sine = random.number(low, high)
        cosine = math.sqrt(max(0.0, 1 - sine * sine))
        a, b = random.on_circle()
        distance = random.within(rule.distance)
        target = [t + rule.jitter * j for t, j in zip(rule.target, random.in_ball())]
        eye = [rule.target[i] + distance * (cosine * (a * x[i] + b * y[i]) + sine * z[i]) for i in range(3)]
        return velo.Camera(width, height, world_from_camera=look_at(eye, target, rule.up), **_keywords(rule))

    def _one(self, rule: Any, frame: int, random: Random) -> Any:
        if isinstance(rule, Fixed):
            return self._fixed(rule)
        if isinstance(rule, Around):
            return self._around(rule, random)
        if isinstance(rule, Trajectory):
            poses = self._trajectory(rule.file)
            if not poses:
                raise UsageError(f"{rule.file}: the file has no poses")
            pose = poses[frame % len(poses)]
            width, height = self._recipe.resolution
            keywords = _keywords(rule)
            if pose.camera is not None and not keywords:
                return pose.camera.resize(width, height)
            return velo.Camera(width, height, world_from_camera=pose.world_from_camera, **keywords)
        raise UsageError(f"unknown kind of camera: {type(rule).__name__}")

    def _views(self, rule: Any, frame: int, random: Random) -> list[View]:
        if not isinstance(rule, Rig):
            return [View(rule.name, self._one(rule, frame, random))]
        base = self._one(rule.base, frame, random)
        pose: Matrix = [[float(value) for value in row] for row in base.world_from_camera]
        return [View(part.get("name", f"camera{k}"), base.move(multiply(pose, part["pose"])))
                for k, part in enumerate(rule.parts)]

    def views(self, frame: int) -> list[View]:
        """The cameras of a frame, in the recipe's order."""
        views: list[View] = []
        for number, rule in enumerate(self._recipe.cameras):
            with at_place(f"recipe.cameras[{number}]"):
                views += self._views(rule, frame, Random(self._recipe.seed, frame, f"camera {number}"))
        names = [view.name for view in views]
        if len(set(names)) < len(names):
            views = [View(f"{view.name}{i}", view.camera) for i, view in enumerate(views)]
        return views
