"""heat.py: the emission of a Principled Volume by its temperature, as in Cycles (kernel/svm/closure.h), and grids that emit."""
from typing import Any, NamedTuple

import numpy

from . import color_nodes

#: Stefan and Boltzmann's constant, in megawatts, over the directions.
_SIGMA = 5.670373e-8 * 1e-6 / numpy.pi
_KELVIN = numpy.linspace(800.0, 12000.0, 561)  # of the table of colours

FITS = 12  # steps towards the factors of emission
BRIGHTEST = 1e9  # radiance per unit of length; velo drops samples from about 1e12 on


class Heat(NamedTuple):
    """intensity: 0 to 1, the share of the fourth power of the temperature; kelvin: the node's temperature, by which those of a grid are
    multiplied; tint: three numbers."""
    intensity: float
    kelvin: float
    tint: Any


def of_node(node, groups, inputs):
    """The Heat of a Principled Volume; None: it has none, or one that varies (noted)."""
    intensity, kelvin, tint = (inputs.constant(node.inputs[name], groups) for name in ("Blackbody Intensity", "Temperature", "Blackbody Tint"))
    if intensity == 0.0:
        return None
    if not isinstance(intensity, float) or not isinstance(kelvin, float) or not isinstance(tint, tuple):
        inputs.notes.add(inputs.owner, node.name, "the emission of its temperature varies and is left out")
        return None
    return Heat(intensity, kelvin, numpy.maximum(numpy.array(tint), 0)) if intensity > 0 else None


def emission(heat, factors):
    """The radiance per unit of length for the node's temperature times factors, an array of any shape: that shape x 3, at most BRIGHTEST."""
    kelvin = numpy.maximum(heat.kelvin * numpy.asarray(factors, dtype=float), 0)
    total = numpy.minimum(numpy.maximum(_SIGMA * (1 + heat.intensity * (kelvin**4 - 1)), 0), BRIGHTEST)
    table = color_nodes.black_body_color(_KELVIN)
    colors = numpy.stack([numpy.interp(kelvin, _KELVIN, table[:, channel]) for channel in range(3)], axis=-1)
    return numpy.minimum(total[..., None] * colors * heat.tint, BRIGHTEST)


def _moved(values, axis, step):
    """The values one cell further along an axis, step 1 or -1; 0 comes in."""
    moved = numpy.roll(values, step, axis=axis)
    moved[(slice(None),) * axis + ((0 if step > 0 else -1),)] = 0
    return moved


def finer(values):
    """A grid of cells of half the size, linear between the centres of the cells, to 0 beyond: z x y x x, more axes stay."""
    for axis in range(3):
        parts = [0.75 * values + 0.25 * _moved(values, axis, step) for step in (1, -1)]
        shape = list(values.shape)
        shape[axis] *= 2
        values = numpy.stack(parts, axis=axis + 1).reshape(shape)
    return values


def coarser(values):
    """Sums of a finer grid with the weights that finer gives each cell."""
    for axis in range(3):
        first, second = (values[(slice(None),) * axis + (slice(k, None, 2),)] for k in (0, 1))
        values = 0.75 * (first + second) + 0.25 * (_moved(first, axis, -1) + _moved(second, axis, 1))
    return values


def by_absorption(absorption, wanted, least):
    """(absorption, factors) of cells, z x y x x x 3, whose product, each interpolated linearly, has the same sums about each cell as what is
    wanted of the finer grid. least: absorption of what emits."""
    sums = coarser(wanted)
    absorption = numpy.where(sums > 0, numpy.maximum(absorption, least), absorption)
    fine = finer(absorption)
    factors = numpy.where(sums > 0, sums / numpy.maximum(8 * absorption, 1e-30), 0)
    for _ in range(FITS):
        factors = factors * sums / numpy.maximum(coarser(fine * finer(factors)), 1e-30)
    return absorption, numpy.minimum(factors, 1e33)
