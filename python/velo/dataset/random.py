"""Random numbers that depend on the recipe's seed, the frame and a purpose only.

Draws for one purpose do not shift those of another: a further light does not move the objects. Only random.Random.random()
is used, whose numbers Python guarantees for all versions, and +, -, *, / and square roots, which every machine rounds alike."""
from __future__ import annotations

import math
import random
from typing import Any, Sequence, Tuple, TypeVar, Union

T = TypeVar("T")
Range = Union[float, Sequence[float]]
Vector = Tuple[float, float, float]


class Random:
    """A sequence of random numbers for a purpose in a frame."""

    def __init__(self, seed: int, frame: int, purpose: str) -> None:
        self._random = random.Random(f"velo {seed} {frame} {purpose}").random

    def number(self, low: float, high: float) -> float:
        """A number from low to high, uniformly."""
        return low + (high - low) * self._random()

    def within(self, bounds: Range) -> float:
        """A number within a pair of bounds; a single number is itself."""
        if isinstance(bounds, (int, float)):
            return float(bounds)
        return self.number(float(bounds[0]), float(bounds[1]))

    def count(self, bounds: Any) -> int:
        """A whole number within a pair of bounds, both included."""
        if isinstance(bounds, int):
            return bounds
        low, high = int(bounds[0]), int(bounds[1])
        return min(high, low + int((high - low + 1) * self._random()))

    def choice(self, items: Sequence[T]) -> T:
        """One of the items."""
        return items[min(len(items) - 1, int(len(items) * self._random()))]

    def point(self, low: Sequence[float], high: Sequence[float]) -> Vector:
        """A point in a box."""
        x, y, z = (self.number(a, b) for a, b in zip(low, high))
        return x, y, z

    def in_ball(self) -> Vector:
        """A point in the unit ball."""
        while True:
            x, y, z = (self.number(-1, 1) for _ in range(3))
            if 1e-4 < x * x + y * y + z * z <= 1:
                return x, y, z

    def direction(self) -> Vector:
        """A unit vector, uniformly."""
        x, y, z = self.in_ball()
        length = math.sqrt(x * x + y * y + z * z)
        return x / length, y / length, z / length

    def on_circle(self) -> Tuple[float, float]:
        """The cosine and the sine of a uniform angle."""
        while True:
            x, y = self.number(-1, 1), self.number(-1, 1)
            if 1e-4 < x * x + y * y <= 1:
                length = math.sqrt(x * x + y * y)
                return x / length, y / length

    def rotation(self) -> list[list[float]]:
        """A uniform rotation (Marsaglia 1972: a uniform quaternion), 3 x 3."""
        while True:
            a, b, c, d = (self.number(-1, 1) for _ in range(4))
            p, q = a * a + b * b, c * c + d * d
            if p <= 1 and 1e-4 < q <= 1:
                break
        s = math.sqrt((1 - p) / q)
        x, y, z, w = a, b, c * s, d * s
        return [[1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
                [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
                [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)]]

    def seed32(self) -> int:
        """A seed for a render."""
        return int(self._random() * 4294967296.0)
