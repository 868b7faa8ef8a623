"""voronoi.py: Cycles' Voronoi texture in 1 to 4 dimensions (kernel/svm/voronoi.h of 3.4). Points are n x dimensions."""
import itertools

import numpy

from . import noise


def _distance(a, b, metric, exponent):
    if a.shape[1] == 1 or metric == "EUCLIDEAN":
        return numpy.sqrt(((a - b)**2).sum(axis=1))
    if metric == "MANHATTAN":
        return abs(a - b).sum(axis=1)
    if metric == "CHEBYCHEV":
        return abs(a - b).max(axis=1)
    power = numpy.float64(exponent)
    with numpy.errstate(all="ignore"):
        return (abs(a - b)**power).sum(axis=1)**(1 / power)


def _offsets(reach, dimensions):
    """Cells around one, in Cycles' order: the first axis runs fastest."""
    steps = itertools.product(range(-reach, reach + 1), repeat=dimensions)
    return [numpy.array(step[::-1], dtype=float) for step in steps]


class _Cells:
    """The feature points of the cells around points."""

    def __init__(self, points, randomness):
        self.base = numpy.floor(points)
        self.local = points - self.base
        self.randomness = randomness

    def point(self, step):
        return step + noise.hash_vectors(self.base + step, self.base.shape[1]) * self.randomness

    def color(self, step):
        return noise.hash_vectors(self.base + step, 3)


def _nearest(cells, metric, exponent, second):
    """(distance, colour, place) of the nearest feature point, or of the second one."""
    count, dimensions = cells.local.shape
    best = [numpy.full(count, 8.0), numpy.full(count, 8.0)]
    steps, places = [numpy.zeros((count, dimensions)) for _ in "ab"], [numpy.zeros((count, dimensions)) for _ in "ab"]
    for step in _offsets(1, dimensions):
        place = cells.point(step)
        distance = _distance(place, cells.local, metric, exponent)
        closer = distance < best[0]
        next_one = ~closer & (distance < best[1])
        for chosen, value in ((best, distance), (steps, numpy.broadcast_to(step, place.shape)), (places, place)):
            wide = (lambda mask: mask) if value.ndim == 1 else (lambda mask: mask[:, None])
            chosen[1] = numpy.where(wide(closer), chosen[0], numpy.where(wide(next_one), value, chosen[1]))
            chosen[0] = numpy.where(wide(closer), value, chosen[0])
    k = 1 if second else 0
    return best[k], cells.color(steps[k]), places[k] + cells.base


def _smooth(cells, metric, exponent, smoothness):
    count, dimensions = cells.local.shape
    smoothness = max(smoothness, 1e-5)
    total, color, place = numpy.full(count, 8.0), numpy.zeros((count, 3)), numpy.zeros((count, dimensions))
    for step in _offsets(2, dimensions):
        other = cells.point(step)
        distance = _distance(other, cells.local, metric, exponent)
        t = numpy.clip(0.5 + 0.5 * (total - distance) / smoothness, 0, 1)
        h = t * t * (3 - 2 * t)
        correction = smoothness * h * (1 - h)
        total = total + h * (distance - total) - correction
        correction = (correction / (1 + 3 * smoothness))[:, None]
        color = color + h[:, None] * (cells.color(step) - color) - correction
        place = place + h[:, None] * (other - place) - correction
    return total, color, place + cells.base


def _edge(cells):
    """The distance to the edge of the cell."""
    dimensions = cells.local.shape[1]
    nearest, best = numpy.zeros_like(cells.local), numpy.full(len(cells.local), 8.0)
    for step in _offsets(1, dimensions):
        way = cells.point(step) - cells.local
        length = (way * way).sum(axis=1)
        nearest = numpy.where((length < best)[:, None], way, nearest)
        best = numpy.minimum(best, length)
    distance = numpy.full(len(best), 8.0)
    for step in _offsets(2, dimensions):
        way = cells.point(step) - cells.local
        across = way - nearest
        length = (across * across).sum(axis=1)
        unit = across / numpy.sqrt(numpy.maximum(length, 1e-30))[:, None]
        value = (0.5 * (nearest + way) * unit).sum(axis=1)
        distance = numpy.where(length > 1e-4, numpy.minimum(distance, value), distance)
    return distance


def _radius(cells, metric, exponent):
    """Half the distance between the nearest feature point and its own nearest one."""
    dimensions = cells.local.shape[1]
    best, middle, step_of = numpy.full(len(cells.local), 8.0), numpy.zeros_like(cells.local), numpy.zeros_like(cells.local)
    for step in _offsets(1, dimensions):
        place = cells.point(step)
        distance = _distance(place, cells.local, "EUCLIDEAN", exponent)
        closer = (distance < best)[:, None]
        middle, step_of = numpy.where(closer, place, middle), numpy.where(closer, step, step_of)
        best = numpy.minimum(best, distance)
    other = numpy.full(len(best), 8.0)
    for step in _offsets(1, dimensions):
        if step.any():
            other = numpy.minimum(other, _distance(cells.point(step_of + step), middle, "EUCLIDEAN", exponent))
    return 0.5 * other


@noise.in_pieces
def voronoi(points, feature, metric, randomness, smoothness, exponent):
    """n x (4 + dimensions): distance, colour, place of a feature; of an edge or a radius the distance alone."""
    cells = _Cells(points, min(max(randomness, 0.0), 1.0))
    if feature in ("DISTANCE_TO_EDGE", "N_SPHERE_RADIUS"):
        distance = _edge(cells) if feature == "DISTANCE_TO_EDGE" else _radius(cells, metric, exponent)
        return numpy.concatenate([distance[:, None], numpy.zeros((len(points), 3 + points.shape[1]))], axis=1)
    if feature == "SMOOTH_F1" and smoothness > 0:
        distance, color, place = _smooth(cells, metric, exponent, 0.5 * min(smoothness, 1.0))
    else:
        distance, color, place = _nearest(cells, metric, exponent, feature == "F2")
    return numpy.concatenate([distance[:, None], color, place], axis=1)
