"""Simple bodies: meshes of boxes and rectangles, and the places of spheres, disks and cylinders."""
from __future__ import annotations

import math
from typing import Any, Sequence

from velo import _check
from velo._errors import UsageError, wrong_value

Vector = tuple[float, float, float]
Matrix = list[float]  # 16 numbers, by rows


def vector(value: Any, what: str) -> Vector:
    """Three finite numbers."""
    x, y, z = (_check.number(item, what) for item in _check.tuple_of(value, 3, what, "three numbers"))
    return x, y, z


def _flat(value: Any, what: str, depth: int) -> list[Any]:
    if depth == 0 or isinstance(value, (str, bytes)) or not hasattr(value, "__iter__"):
        return [value]
    return [number for item in _check.items(value, what, "rows") for number in _flat(item, what, depth - 1)]


def _matrix(value: Any, what: str) -> Matrix:
    numbers = _flat(value, what, 2)
    if len(numbers) != 16:
        raise wrong_value(what, "4 x 4 numbers", value)
    return [_check.number(number, what) for number in numbers]


def place(keywords: dict[str, Any], matrix: Matrix) -> None:
    """Puts a body's own place before the pose that the keywords give it."""
    names = [name for name in ("pose", "transform", "group_from_shape") if name in keywords]
    if len(names) > 1:
        raise UsageError(f"{names[0]} and {names[1]} are the same: give one of them")
    if names:
        given = _matrix(keywords.pop(names[0]), names[0])
        matrix = [sum(given[4 * i + k] * matrix[4 * k + j] for k in range(4)) for i in range(4) for j in range(4)]
    keywords["transform"] = matrix


def shift(center: Vector) -> Matrix:
    """Moves the origin to a point."""
    x, y, z = center
    return [1, 0, 0, x, 0, 1, 0, y, 0, 0, 1, z, 0, 0, 0, 1]


def _cross(a: Vector, b: Vector) -> Vector:
    return a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]


def _unit(v: Vector, what: str) -> Vector:
    length = math.hypot(*v)
    if not length > 0:
        raise wrong_value(what, "a direction: not all 0", v)
    return v[0] / length, v[1] / length, v[2] / length


def axes(normal: Vector, what: str) -> tuple[Vector, Vector, Vector]:
    """Unit vectors u, v, n, right-handed. u lies in the plane of z = 0 unless the normal is along z: then it is x."""
    n = _unit(normal, what)
    u = _unit((-n[1], n[0], 0.0), what) if n[0] or n[1] else (1.0, 0.0, 0.0)
    return u, _cross(n, u), n


def frame(center: Vector, normal: Vector, what: str) -> Matrix:
    """Moves the origin to a point, and z into a direction."""
    u, v, n = axes(normal, what)
    return [u[0], v[0], n[0], center[0], u[1], v[1], n[1], center[1], u[2], v[2], n[2], center[2], 0, 0, 0, 1]


def box(low: Vector, high: Vector) -> dict[str, Any]:
    """Arrays of a box: 24 vertices, 12 triangles, their normals outwards, uvs from 0 to 1 on each side."""
    if not all(a < b for a, b in zip(low, high)):
        raise wrong_value("high", "above low in x, y and z", high)
    positions: list[Sequence[float]] = []
    indices: list[Sequence[int]] = []
    ends = (low, high)
    for axis in range(3):
        for side in range(2):
            first = len(positions)
            for t in range(2):
                for s in range(2):
                    corner = [0.0, 0.0, 0.0]
                    corner[axis] = ends[side][axis]
                    corner[(axis + 1) % 3] = ends[s][(axis + 1) % 3]
                    corner[(axis + 2) % 3] = ends[t][(axis + 2) % 3]
                    positions.append(corner)
            order = (0, 1, 3, 2) if side else (0, 2, 3, 1)
            a, b, c, d = (first + k for k in order)
            indices += [(a, b, c), (a, c, d)]
    return {"positions": positions, "indices": indices, "uvs": [(0, 0), (1, 0), (0, 1), (1, 1)] * 6}


def plane(center: Vector, normal: Vector, width: float, height: float) -> dict[str, Any]:
    """Arrays of a rectangle: its sides along the axes of its normal, uvs from 0 to 1."""
    u, v, _ = axes(normal, "normal")
    positions = [[center[i] + s * width / 2 * u[i] + t * height / 2 * v[i] for i in range(3)] for t in (-1, 1) for s in (-1, 1)]
    return {"positions": positions, "indices": [(0, 1, 3), (0, 3, 2)], "uvs": [(0, 0), (1, 0), (0, 1), (1, 1)]}
