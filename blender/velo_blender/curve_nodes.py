"""curve_nodes.py: RGB curves, vector curves and float curves, as tables of 256 entries as in Cycles (blender/util.h, svm/ramp.h)."""
import numpy

from .math_nodes import column

ENTRIES = 256


def _range(curves):
    """From the first point of all curves to the last."""
    low = min(curve.points[0].location[0] for curve in curves)
    high = max(curve.points[-1].location[0] for curve in curves)
    return (low, high) if high > low else (low, low + 1.0)


def _look_up(table, place, is_extrapolated):
    """Values of a table at places, 0 to 1 in it; beyond, those of its ends, or of the lines through its last two entries."""
    last = ENTRIES - 1
    values = numpy.interp(numpy.clip(place, 0, 1), numpy.linspace(0, 1, ENTRIES), table)
    if not is_extrapolated:
        return values
    values = numpy.where(place < 0, table[0] + (table[1] - table[0]) * place * last, values)
    return numpy.where(place > 1, table[last] + (table[last] - table[last - 1]) * (place - 1) * last, values)


def _curved(node, value, curve, low, high, before=None):
    """A curve at values, n. before: a curve that is applied first, in the table."""
    mapping = node.mapping
    places = numpy.linspace(low, high, ENTRIES)
    if before is not None:
        places = [mapping.evaluate(before, float(x)) for x in places]
    table = numpy.array([mapping.evaluate(curve, float(x)) for x in places])
    return _look_up(table, (value - low) / (high - low), mapping.extend == "EXTRAPOLATED")


def rgb_curves(e, node, output, groups):
    factor, color = e.named(node, "Fac", groups), e.named(node, "Color", groups)
    node.mapping.initialize()
    curves = list(node.mapping.curves)
    low, high = _range(curves)
    result = numpy.stack([_curved(node, color[:, i], curves[i], low, high, curves[3]) for i in range(3)], axis=1)
    return color + column(factor) * (result - color)


def vector_curves(e, node, output, groups):
    factor, vector = e.named(node, "Fac", groups), e.named(node, "Vector", groups)
    node.mapping.initialize()
    curves = list(node.mapping.curves)[:3]
    low, high = _range(curves)
    result = numpy.stack([_curved(node, vector[:, i], curves[i], low, high) for i in range(3)], axis=1)
    return vector + column(factor) * (result - vector)


def float_curve(e, node, output, groups):
    factor, value = e.named(node, "Factor", groups), e.named(node, "Value", groups)
    node.mapping.initialize()
    curve = node.mapping.curves[0]
    return value + factor * (_curved(node, value, curve, *_range([curve])) - value)


NODES = {"CURVE_RGB": rgb_curves, "CURVE_VEC": vector_curves, "CURVE_FLOAT": float_curve}
