"""square.py: the octahedral equal-area square of images of all directions (Clarberg 2008; pbrt book 3.8.3)."""
import math

import numpy


def directions(side):
    """The unit directions of the pixels of an equal-area octahedral square (Clarberg 2008; pbrt book 3.8.3), side * side x 3, rows
    from the top."""
    place = 2 * (numpy.arange(side) + 0.5) / side - 1
    v, u = numpy.meshgrid(place, place, indexing="ij")
    up, vp = numpy.abs(u), numpy.abs(v)
    distance = 1 - (up + vp)
    r = 1 - numpy.abs(distance)
    safe = numpy.where(r == 0, 1, r)
    phi = numpy.where(r == 0, 1, (vp - up) / safe + 1) * math.pi / 4
    z = numpy.copysign(1 - r * r, distance)
    around = r * numpy.sqrt(numpy.maximum(0, 2 - r * r))
    x, y = numpy.copysign(numpy.cos(phi), u) * around, numpy.copysign(numpy.sin(phi), v) * around
    return numpy.stack((x.ravel(), y.ravel(), z.ravel()), axis=1)


def cosines(u, v):
    """z of the directions at places of an octahedral square, -1 to 1 along each side."""
    distance = 1 - (numpy.abs(u) + numpy.abs(v))
    r = 1 - numpy.abs(distance)
    return numpy.copysign(1 - r * r, distance)
