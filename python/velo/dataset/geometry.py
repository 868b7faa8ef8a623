"""Small matrices and boxes in plain Python: sums in a fixed order, so that every machine gives the same bits."""
from __future__ import annotations

import math
from typing import Sequence

from velo.dataset.random import Random

Matrix = list[list[float]]  # 4 x 4, by rows
Vector3 = Sequence[float]


def identity() -> Matrix:
    return [[1.0 if i == j else 0.0 for j in range(4)] for i in range(4)]


def multiply(a: Matrix, b: Matrix) -> Matrix:
    return [[sum(a[i][k] * b[k][j] for k in range(4)) for j in range(4)] for i in range(4)]


def place(rotation: Sequence[Sequence[float]], translation: Vector3, scale: float = 1.0) -> Matrix:
    """A matrix from a rotation, a translation and a scale, which acts first."""
    return [[float(rotation[i][j]) * scale for j in range(3)] + [float(translation[i])] for i in range(3)] + [[0.0, 0.0, 0.0, 1.0]]


def rigid_inverse(m: Matrix) -> Matrix:
    """The inverse of a rotation, uniform scale and translation."""
    s = sum(m[i][0] * m[i][0] for i in range(3))
    r = [[m[j][i] / s for j in range(3)] for i in range(3)]
    t = [-sum(r[i][j] * m[j][3] for j in range(3)) for i in range(3)]
    return [r[i] + [t[i]] for i in range(3)] + [[0.0, 0.0, 0.0, 1.0]]


def transform(m: Matrix, p: Vector3) -> list[float]:
    return [m[i][0] * p[0] + m[i][1] * p[1] + m[i][2] * p[2] + m[i][3] for i in range(3)]


def subtract(a: Vector3, b: Vector3) -> list[float]:
    return [a[i] - b[i] for i in range(3)]


def dot(a: Vector3, b: Vector3) -> float:
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


def cross(a: Vector3, b: Vector3) -> list[float]:
    return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]


def unit(a: Vector3) -> list[float]:
    length = math.sqrt(dot(a, a))
    return [x / length for x in a]


def basis(up: Vector3) -> tuple[list[float], list[float], list[float]]:
    """Two unit vectors across `up`, and `up` as a unit vector; right-handed: cross(first, second) = up."""
    z = unit(up)
    helper = [1.0, 0.0, 0.0] if abs(z[0]) < 0.9 else [0.0, 1.0, 0.0]
    x = unit(cross(helper, z))
    return x, cross(z, x), z


def rotation_about(up: Vector3, random: Random) -> list[list[float]]:
    """A rotation that maps y to `up` and turns about it."""
    x, y, z = basis(up)
    cosine, sine = random.on_circle()
    first = [x[i] * cosine + y[i] * sine for i in range(3)]
    third = [x[i] * -sine + y[i] * cosine for i in range(3)]
    # Columns: the images of x, y, z. cross(first, third) = up; y maps to up, so z maps to -third.
    return [[first[i], z[i], -third[i]] for i in range(3)]


def look_at(eye: Vector3, target: Vector3, up: Vector3) -> Matrix:
    """World from camera: x right, y down, z forward."""
    z = unit(subtract(target, eye))
    x = cross(z, up)
    if dot(x, x) < 1e-12:
        x = basis(z)[0]
    x = unit(x)
    y = cross(z, x)
    return [[x[i], y[i], z[i], float(eye[i])] for i in range(3)] + [[0.0, 0.0, 0.0, 1.0]]


class Box:
    """An oriented box: a centre, three half axes."""

    def __init__(self, low: Vector3, high: Vector3, pose: Matrix) -> None:
        self.center = transform(pose, [(a + b) / 2 for a, b in zip(low, high)])
        self.axes = [[pose[i][k] * (high[k] - low[k]) / 2 for i in range(3)] for k in range(3)]
        self.radius = math.sqrt(sum(dot(axis, axis) for axis in self.axes))

    def extent(self, direction: Vector3) -> float:
        """Half of the box's extent along a direction."""
        return sum(abs(dot(axis, direction)) for axis in self.axes)

    def meets(self, other: "Box", gap: float = 0.0) -> bool:
        """Whether two boxes overlap or are closer than the gap along every axis of separation (Gottschalk 1996)."""
        offset = subtract(other.center, self.center)
        if dot(offset, offset) > (self.radius + other.radius + gap) ** 2:
            return False
        axes = self.axes + other.axes + [cross(a, b) for a in self.axes for b in other.axes]
        for axis in axes:
            length = dot(axis, axis)
            if length < 1e-24:
                continue
            direction = [x / math.sqrt(length) for x in axis]
            if abs(dot(offset, direction)) > self.extent(direction) + other.extent(direction) + gap:
                return False
        return True
