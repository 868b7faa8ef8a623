"""The values of a recipe: what each may be. A copy has numbers as int and float, and lists as lists."""
from __future__ import annotations

import dataclasses
import math
from typing import Any, Callable, Sequence

import numpy

import velo
from velo import _check
from velo._errors import UsageError, unknown, wrong_value
from velo.dataset import recipe as kinds

MAX_FRAMES = 1000000  # numbers of six digits
Check = Callable[[Any, str], Any]


def whole(low: int, high: int) -> Check:
    """A whole number."""
    return lambda value, where: _check.whole(value, where, low, high)


def number(low: float = -math.inf, high: float = math.inf) -> Check:
    """A finite number."""
    return lambda value, where: _check.number(value, where, low, high)


def setting(group: str, name: str) -> Check:
    """A setting of velo's, by its row."""
    return lambda value, where: _check.setting(value, where, group, name)


def either(one: Check, what: str) -> Check:
    """One value, or a pair of bounds for a random one: the first is not above the second."""
    def check(value: Any, where: str) -> Any:
        if not isinstance(value, (list, tuple, numpy.ndarray)):
            return one(value, where)
        pair = _check.tuple_of(value, 2, where, f"{what}, or a pair of bounds")
        low, high = one(pair[0], f"{where}[0]"), one(pair[1], f"{where}[1]")
        if low > high:
            raise wrong_value(where, "a pair of bounds, the lower one first", value)
        return low, high
    return check


def count(high: int) -> Check:
    """A number of things, or bounds of a random one."""
    return either(whole(0, high), f"a whole number from 0 to {high}")


def range_(low: float = -math.inf, high: float = math.inf) -> Check:
    """A number, or bounds of a random one."""
    return either(number(low, high), "a number")


def vector(size: int, low: float = -math.inf, high: float = math.inf) -> Check:
    """A list of numbers."""
    def check(value: Any, where: str) -> Any:
        found = _check.tuple_of(value, size, where, f"a list of {size} numbers")
        return tuple(_check.number(item, f"{where}[{i}]", low, high) for i, item in enumerate(found))
    return check


def bounds(one: Check) -> Check:
    """A pair of values, the lower one first."""
    def check(value: Any, where: str) -> Any:
        pair = _check.tuple_of(value, 2, where, "a pair of bounds")
        low, high = (one(item, f"{where}[{i}]") for i, item in enumerate(pair))
        ordered = low <= high if not isinstance(low, tuple) else all(a <= b for a, b in zip(low, high))
        if not ordered:
            raise wrong_value(where, "a pair of bounds, the lower one first", value)
        return low, high
    return check


def direction(value: Any, where: str) -> Any:
    """A vector with a length."""
    found = vector(3, -1e6, 1e6)(value, where)
    if sum(item * item for item in found) < 1e-12:
        raise wrong_value(where, "a vector that is not 0", value)
    return found


def text(value: Any, where: str) -> str:
    """A text without control characters."""
    if not isinstance(value, str) or len(value) > 4096 or any(ord(c) < 32 or 0xd800 <= ord(c) < 0xe000 for c in value):
        raise wrong_value(where, "a text of at most 4096 characters", value)
    return value


def file_name(value: Any, where: str) -> str:
    """A part of the names of files."""
    name = text(value, where)
    if not name or len(name.encode()) > 100 or "/" in name or name.startswith("."):
        raise wrong_value(where, "a name for files: 1 to 100 letters, without / and not beginning with a dot", value)
    return name


def flag(value: Any, where: str) -> bool:
    """True or False."""
    return _check.flag(value, where)


def choice(*words: str) -> Check:
    """One of some words."""
    return lambda value, where: _check.choice(value, where, words)


def optional(one: Check) -> Check:
    """None, or a value."""
    return lambda value, where: None if value is None else one(value, where)


def items(one: Check, low: int, high: int) -> Check:
    """A list."""
    def check(value: Any, where: str) -> list[Any]:
        if isinstance(value, (str, bytes, dict)) or not isinstance(value, (list, tuple)) or not low <= len(value) <= high:
            raise wrong_value(where, f"a list of {low} to {high} items", value)
        return [one(item, f"{where}[{i}]") for i, item in enumerate(value)]
    return check


def names(one: Check) -> Check:
    """Names and values."""
    def check(value: Any, where: str) -> dict[str, Any]:
        if not isinstance(value, dict) or len(value) > 1000:
            raise wrong_value(where, "names and values", value)
        for name in value:
            text(name, f"a name of {where}")
        return {name: one(item, f"{where}.{name}") for name, item in value.items()}
    return check


def anything(value: Any, where: str) -> Any:
    """What the function that takes it checks."""
    return value


def pose(value: Any, where: str) -> list[list[float]]:
    """A rotation and a translation, 4 x 4."""
    rows = [vector(4)(row, f"{where}[{i}]") for i, row in enumerate(_check.tuple_of(value, 4, where, "a matrix of 4 x 4 numbers"))]
    r = numpy.array([row[:3] for row in rows[:3]])
    with numpy.errstate(all="ignore"):
        rigid = bool(numpy.abs(r.T @ r - numpy.eye(3)).max() < 1e-3) and numpy.linalg.det(r) > 0
    if not rigid or rows[3] != (0.0, 0.0, 0.0, 1.0):
        raise wrong_value(where, "a rotation and a translation, the last row 0 0 0 1", value)
    return [list(row) for row in rows]


def member(*classes: type) -> Check:
    """An object of one of these classes, with its values checked."""
    def check(value: Any, where: str) -> Any:
        if not isinstance(value, classes):
            raise wrong_value(where, f"one of {', '.join(kind.__name__ for kind in classes)}", value)
        rules = _RULES[type(value)]
        made = dataclasses.replace(value, **{name: rule(getattr(value, name), f"{where}.{name}") for name, rule in rules.items()})
        more = _MORE.get(type(value))
        if more:
            more(made, where)
        return made
    return check


def _array(value: Any, where: str, low: float, high: float, rule: str) -> Any:
    lists = isinstance(value, (list, tuple)) and all(
        isinstance(row, (list, tuple, numpy.ndarray)) and len(row) == 3 and all(isinstance(item, (int, float, numpy.number)) for item in row)
        for row in value)
    try:
        array = numpy.asarray(value) if lists or isinstance(value, numpy.ndarray) else numpy.zeros(0)
        fine = array.ndim == 2 and array.shape[1] == 3 and len(array) > 0 and array.dtype.kind in "iuf"
        fine = fine and bool((array >= low).all() and (array <= high).all())
    except (ValueError, TypeError, OverflowError):
        fine = False
    if not fine:
        raise wrong_value(where, rule, value)
    return array


def _model(value: Any, where: str) -> None:
    if value.path and value.positions is not None:
        raise UsageError(f"{where}: path and positions exclude each other")
    if not value.path:
        if value.positions is None or value.indices is None or not value.name:
            raise UsageError(f"{where}: a model needs a path, or a name, positions and indices")
        value.positions = _array(value.positions, f"{where}.positions", -1e30, 1e30, "rows of three finite numbers")
        value.indices = _array(value.indices, f"{where}.indices", 0, len(value.positions) - 1,
                               f"rows of three numbers from 0 to {len(value.positions) - 1}")
        if value.indices.dtype.kind == "f":
            raise wrong_value(f"{where}.indices", "whole numbers", value.indices)
    for i, pair in enumerate(value.skeleton):
        for k, end in enumerate(pair):
            _check.whole(end, f"{where}.skeleton[{i}][{k}]", 1, max(1, len(value.keypoints)))
    if value.skeleton and not value.keypoints:
        raise UsageError(f"{where}.skeleton: the model has no keypoints")


# What the pose of a camera is given by, where a rule chooses it; and the size, which is the recipe's.
_POSE = ("eye", "lookat", "up", "world_from_camera", "camera_from_world", "roll")
_SIZE = ("width", "height")


def _no_keywords(value: Any, where: str, taken: Sequence[str], by: str) -> None:
    for name in value.keywords:
        if name in taken:
            raise UsageError(f"{where}.keywords.{name}: {by} says it already")


def _check_fov(value: Any, where: str) -> None:
    if value.fov is not None:
        _no_keywords(value, where, ("fov", "fov_axis", "K", "fx", "fy", "focal_mm", "view_distance", "colmap"), "fov")


def _fixed(value: Any, where: str) -> None:
    _no_keywords(value, where, _SIZE, "the recipe's resolution")
    if value.file and value.keywords:
        raise UsageError(f"{where}: file and keywords exclude each other")
    if value.file and value.fov is not None:
        raise UsageError(f"{where}: file and fov exclude each other")
    _check_fov(value, where)


def _around(value: Any, where: str) -> None:
    _no_keywords(value, where, _SIZE, "the recipe's resolution")
    _no_keywords(value, where, _POSE, "the kind around")
    _check_fov(value, where)


def _trajectory(value: Any, where: str) -> None:
    _no_keywords(value, where, _SIZE, "the recipe's resolution")
    _no_keywords(value, where, _POSE, "the file")
    if not value.file:
        raise UsageError(f"{where}: needs a file of poses")
    _check_fov(value, where)


def _volume(value: Any, where: str) -> None:
    for i, (low, high) in enumerate(zip(value.low, value.high)):
        if low > high:
            raise UsageError(f"{where}: low[{i}] is {low:g}, above high[{i}], {high:g}")


# Keywords of Scene.render that the recipe has members for, or that change which pixels there are.
_OWN = {"spp": "recipe.spp", "seed": "recipe.seed", "channels": "recipe.channels", "resolution": "recipe.resolution", "camera": "recipe.cameras",
        "film": None, "progress": None, "crop": None, "first_sample": None}


def _recipe(value: Any, where: str) -> None:
    for name in value.render:
        if name in _OWN:
            own = _OWN[name]
            raise UsageError(f"{where}.render.{name}: " + (f"give {own}" if own else "a dataset cannot have it"))
    known = velo.channel_names()
    for i, name in enumerate(value.channels):
        if name not in known:
            raise unknown(f"channel in {where}.channels[{i}]:", name, known)


def _sensor(value: Any, where: str) -> None:
    for name in value.numbers:
        if name in ("sensor", "context", "self"):
            raise UsageError(f"{where}.numbers.{name}: give {where}.name")
    for name in value.exposure:
        if name in ("seed", "frame", "image", "self"):
            raise UsageError(f"{where}.exposure.{name}: each image has its own")


def _part(value: Any, where: str) -> dict[str, Any]:
    found = names(anything)(value, where)
    for name in found:
        if name not in ("name", "pose"):
            raise unknown(f"name in {where}:", name, ("name", "pose"))
    if "pose" not in found:
        raise UsageError(f"{where}: needs a pose, 4 x 4")
    made: dict[str, Any] = {"pose": pose(found["pose"], f"{where}.pose")}
    if "name" in found:
        made["name"] = file_name(found["name"], f"{where}.name")
    return made


def _posed(value: Any, where: str) -> Any:
    name, matrix = _check.tuple_of(value, 2, where, "a model's name and a pose, 4 x 4")
    return text(name, f"{where}[0]"), pose(matrix, f"{where}[1]")


def _pair(value: Any, where: str) -> Any:
    return _check.tuple_of(value, 2, where, "a pair of numbers of keypoints")


_MOVED = (kinds.Fixed, kinds.Around, kinds.Trajectory)
_KEYWORDS = names(anything)
_FOV = optional(number(1e-3, 360))  # degrees
# The rule of each member. A test compares the names with those of the classes.
_RULES: dict[type, dict[str, Check]] = {
    kinds.Model: {"path": text, "name": text, "count": count(10000), "scale": number(1e-12, 1e12), "positions": anything, "indices": anything,
                  "material": _KEYWORDS, "keypoints": names(vector(3)), "skeleton": items(_pair, 0, 10000),
                  "keypoint_depth": optional(number(0, 1e12))},
    kinds.Poses: {"frames": items(items(_posed, 0, 10000), 1, MAX_FRAMES)},
    kinds.OnSurface: {"center": vector(3), "size": vector(2, 0, 1e12), "up": direction, "gap": number(0, 1e12), "tumble": flag,
                      "tries": whole(1, 100000)},
    kinds.OnScene: {"low": vector(3, -1e12, 1e12), "high": vector(3, -1e12, 1e12), "up": direction, "slope": number(0, 89), "gap": number(0, 1e12), "tumble": flag,
                    "tries": whole(1, 100000)},
    kinds.InVolume: {"low": vector(3), "high": vector(3), "gap": number(0, 1e12), "tries": whole(1, 100000)},
    kinds.Fixed: {"keywords": _KEYWORDS, "file": text, "fov": _FOV, "name": file_name},
    kinds.Around: {"target": vector(3), "distance": range_(1e-12, 1e12), "elevation": bounds(number(-90, 90)), "up": direction,
                   "jitter": number(0, 1e12), "fov": _FOV, "keywords": _KEYWORDS, "name": file_name},
    kinds.Trajectory: {"file": text, "fov": _FOV, "keywords": _KEYWORDS, "name": file_name},
    kinds.Rig: {"base": lambda value, where: member(*_MOVED)(value, where), "parts": items(_part, 1, 1000)},
    kinds.Lights: {"count": count(10000), "low": vector(3), "high": vector(3), "power": range_(0, 1e12), "kelvin": range_(1, 1e6)},
    kinds.Environment: {"kind": choice("studio", "window", "evening", "sky", "white", "auto", "none"), "files": items(text, 0, 100000), "strength": either(setting("complete", "strength"), "a number"),
                        "rotation": optional(setting("complete", "rotation"))},
    kinds.Materials: {"color": bounds(vector(3, 0, 1)), "roughness": range_(0, 1), "metallic": range_(0, 1), "textures": items(text, 0, 100000)},
    kinds.Ground: {"size": number(1e-12, 1e12), "height": number(), "up": direction, "materials": lambda v, w: member(kinds.Materials)(v, w)},
    kinds.Distractors: {"count": count(10000), "size": range_(1e-12, 1e12), "materials": lambda v, w: member(kinds.Materials)(v, w)},
    kinds.Sensor: {"name": text, "numbers": _KEYWORDS, "exposure": _KEYWORDS, "buckets": whole(2, 1000), "dng": flag},
    kinds.Recipe: {
        "seed": whole(0, 2**53), "frames": whole(1, MAX_FRAMES), "spp": setting("render", "spp"), "scene": text,
        "resolution": lambda v, w: tuple(_check.setting(side, f"{w}[{i}]", "program", ("width", "height")[i]) for i, side in
                                         enumerate(_check.tuple_of(v, 2, w, "width and height"))),
        "models": lambda v, w: items(member(kinds.Model), 1, 10000)(v, w),
        "placing": lambda v, w: member(kinds.OnSurface, kinds.OnScene, kinds.InVolume, kinds.Poses)(v, w),
        "cameras": lambda v, w: items(member(*_MOVED, kinds.Rig), 1, 1000)(v, w),
        "lights": lambda v, w: optional(member(kinds.Lights))(v, w), "environment": lambda v, w: optional(member(kinds.Environment))(v, w),
        "ground": lambda v, w: optional(member(kinds.Ground))(v, w), "distractors": lambda v, w: optional(member(kinds.Distractors))(v, w),
        "sensor": lambda v, w: optional(member(kinds.Sensor))(v, w),
        "render": _KEYWORDS, "channels": items(text, 0, 100), "depth_scale": number(1e-6, 1e6),
        "occluded": flag, "folder": text, "path": text},
}
_MORE: dict[type, Callable[[Any, str], None]] = {
    kinds.Model: _model, kinds.Fixed: _fixed, kinds.Around: _around, kinds.Trajectory: _trajectory, kinds.InVolume: _volume, kinds.OnScene: _volume,
    kinds.Lights: _volume, kinds.Sensor: _sensor, kinds.Recipe: _recipe}


def checked(recipe: Any) -> Any:
    """A recipe whose values are right: a copy. The first wrong one is a UsageError with its place: recipe.models[0].count."""
    made: Any = member(kinds.Recipe)(recipe, "recipe")
    return made
