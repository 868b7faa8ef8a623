"""math_nodes.py: nodes of numbers and vectors: math, vector math, clamp, map range, separate and combine."""
import math

import numpy


def column(values):
    """n as n x 1."""
    return values[:, None] if values.ndim == 1 else values


def smooth(t):
    return t * t * (3 - 2 * t)


def _divide(a, b):
    return numpy.where(b == 0, 0.0, a / numpy.where(b == 0, 1.0, b))


def _power(a, b):
    with numpy.errstate(all="ignore"):
        return numpy.where((a < 0) & (b != numpy.floor(b)), 0.0, numpy.power(a, b))


def _fmod(a, b):
    return numpy.where(b == 0, 0.0, numpy.fmod(a, numpy.where(b == 0, 1.0, b)))


def _wrap(a, high, low):
    size = high - low
    return numpy.where(size == 0, low, a - size * numpy.floor(_divide(a - low, size)))


def _ping_pong(a, b):
    safe = numpy.where(b == 0, 1.0, b)
    return numpy.where(b == 0, 0.0, numpy.abs((a - b) / (2 * safe) - numpy.floor((a - b) / (2 * safe)) - 0.5) * 2 * b)


def _smooth_min(a, b, c):
    safe = numpy.where(c == 0, 1.0, c)
    h = numpy.maximum(c - numpy.abs(a - b), 0) / safe
    return numpy.where(c == 0, numpy.minimum(a, b), numpy.minimum(a, b) - h * h * h * c / 6)


MATH = {
    "ADD": lambda a, b, c: a + b, "SUBTRACT": lambda a, b, c: a - b, "MULTIPLY": lambda a, b, c: a * b,
    "DIVIDE": lambda a, b, c: _divide(a, b), "MULTIPLY_ADD": lambda a, b, c: a * b + c, "POWER": lambda a, b, c: _power(a, b),
    "LOGARITHM": lambda a, b, c: numpy.where((a > 0) & (b > 0) & (b != 1),
                                             _divide(numpy.log(numpy.maximum(a, 1e-300)), numpy.log(numpy.maximum(b, 1e-300))), 0.0),
    "SQRT": lambda a, b, c: numpy.sqrt(numpy.maximum(a, 0)),
    "INVERSE_SQRT": lambda a, b, c: numpy.where(a > 0, 1 / numpy.sqrt(numpy.maximum(a, 1e-300)), 0.0),
    "ABSOLUTE": lambda a, b, c: numpy.abs(a), "EXPONENT": lambda a, b, c: numpy.exp(numpy.clip(a, -700, 700)),
    "MINIMUM": lambda a, b, c: numpy.minimum(a, b), "MAXIMUM": lambda a, b, c: numpy.maximum(a, b),
    "LESS_THAN": lambda a, b, c: (a < b) * 1.0, "GREATER_THAN": lambda a, b, c: (a > b) * 1.0, "SIGN": lambda a, b, c: numpy.sign(a),
    "COMPARE": lambda a, b, c: (numpy.abs(a - b) <= numpy.maximum(c, 1e-5)) * 1.0, "SMOOTH_MIN": _smooth_min,
    "SMOOTH_MAX": lambda a, b, c: -_smooth_min(-a, -b, c), "ROUND": lambda a, b, c: numpy.floor(a + 0.5),
    "FLOOR": lambda a, b, c: numpy.floor(a), "CEIL": lambda a, b, c: numpy.ceil(a), "TRUNC": lambda a, b, c: numpy.trunc(a),
    "FRACT": lambda a, b, c: a - numpy.floor(a), "MODULO": lambda a, b, c: _fmod(a, b), "WRAP": _wrap,
    "SNAP": lambda a, b, c: numpy.floor(_divide(a, b)) * b, "PINGPONG": lambda a, b, c: _ping_pong(a, b),
    "SINE": lambda a, b, c: numpy.sin(a), "COSINE": lambda a, b, c: numpy.cos(a), "TANGENT": lambda a, b, c: numpy.tan(a),
    "ARCSINE": lambda a, b, c: numpy.arcsin(numpy.clip(a, -1, 1)), "ARCCOSINE": lambda a, b, c: numpy.arccos(numpy.clip(a, -1, 1)),
    "ARCTANGENT": lambda a, b, c: numpy.arctan(a), "ARCTAN2": lambda a, b, c: numpy.arctan2(a, b), "SINH": lambda a, b, c: numpy.sinh(a),
    "COSH": lambda a, b, c: numpy.cosh(a), "TANH": lambda a, b, c: numpy.tanh(a), "RADIANS": lambda a, b, c: a * math.pi / 180,
    "DEGREES": lambda a, b, c: a * 180 / math.pi,
}


def _unsupported(node, text):
    from .evaluate import Unsupported
    return Unsupported(node, text)


def math_node(e, node, output, groups):
    inputs = [e.input(socket, groups) for socket in node.inputs]
    a, b, c = (inputs + [numpy.zeros(1)] * 3)[:3]
    with numpy.errstate(all="ignore"):
        result = MATH[node.operation](a, b, c)
    return numpy.clip(result, 0, 1) if node.use_clamp else result


def _dot(a, b):
    return (a * b).sum(axis=1)


def _cross(a, b):
    return numpy.cross(*numpy.broadcast_arrays(a, b))


def unit(a):
    length = numpy.linalg.norm(a, axis=1, keepdims=True)
    return numpy.where(length == 0, 0.0, a / numpy.maximum(length, 1e-300))


def _refract(a, b, ratio):
    """A direction a that enters a surface of the normal b; 0 where all is reflected. ratio: of the indices of refraction."""
    n, eta = unit(b), column(ratio)
    cosine = column(_dot(a, n))
    k = 1 - eta * eta * (1 - cosine * cosine)
    return numpy.where(k < 0, 0.0, eta * a - (eta * cosine + numpy.sqrt(numpy.maximum(k, 0))) * n)


VECTOR_MATH = {
    "CROSS_PRODUCT": lambda a, b, c, s: _cross(a, b), "DOT_PRODUCT": lambda a, b, c, s: _dot(a, b),
    "PROJECT": lambda a, b, c, s: column(_divide(_dot(a, b), _dot(b, b))) * b,
    "REFLECT": lambda a, b, c, s: a - 2 * column(_dot(a, unit(b))) * unit(b),
    "DISTANCE": lambda a, b, c, s: numpy.linalg.norm(a - b, axis=1), "LENGTH": lambda a, b, c, s: numpy.linalg.norm(a, axis=1),
    "SCALE": lambda a, b, c, s: a * column(s), "NORMALIZE": lambda a, b, c, s: unit(a),
    "REFRACT": lambda a, b, c, s: _refract(a, b, s), "FACEFORWARD": lambda a, b, c, s: numpy.where(column(_dot(c, b)) < 0, a, -a),
}
SAME_AS_MATH = ("ADD", "SUBTRACT", "MULTIPLY", "DIVIDE", "MULTIPLY_ADD", "ABSOLUTE", "MINIMUM", "MAXIMUM", "FLOOR", "CEIL", "MODULO",
                "WRAP", "SNAP", "SINE", "COSINE", "TANGENT")


def vector_math(e, node, output, groups):
    vectors = [e.input(socket, groups) for socket in node.inputs if socket.type == "VECTOR"]
    a, b, c = (vectors + [numpy.zeros((1, 3))] * 3)[:3]
    scale = e.named(node, "Scale", groups)
    with numpy.errstate(all="ignore"):
        if node.operation == "FRACTION":
            return a - numpy.floor(a)
        if node.operation in SAME_AS_MATH:
            return MATH[node.operation](a, b, c)
        if node.operation not in VECTOR_MATH:
            raise _unsupported(node, "vector math %s" % node.operation)
        return VECTOR_MATH[node.operation](a, b, c, scale)


def clamp(e, node, output, groups):
    value, low, high = (e.named(node, name, groups) for name in ("Value", "Min", "Max"))
    if node.clamp_type == "RANGE":
        low, high = numpy.minimum(low, high), numpy.maximum(low, high)
    return numpy.minimum(numpy.maximum(value, low), high)


def map_range(e, node, output, groups):
    is_vector = getattr(node, "data_type", "FLOAT") != "FLOAT"
    value, from_low, from_high, to_low, to_high = (
        e.named(node, name, groups) for name in ("Vector" if is_vector else "Value", "From Min", "From Max", "To Min", "To Max"))
    t = _divide(value - from_low, from_high - from_low)
    kind = node.interpolation_type
    if kind == "STEPPED":
        steps = e.named(node, "Steps", groups)
        t = _divide(numpy.floor(t * (steps + 1)), steps)
    elif kind == "SMOOTHSTEP":
        t = smooth(numpy.clip(t, 0, 1))
    elif kind == "SMOOTHERSTEP":
        t = numpy.clip(t, 0, 1)
        t = t * t * t * (t * (t * 6 - 15) + 10)
    result = to_low + t * (to_high - to_low)
    if node.clamp and kind in ("LINEAR", "STEPPED"):
        return numpy.clip(result, numpy.minimum(to_low, to_high), numpy.maximum(to_low, to_high))
    return result


def separate(e, node, output, groups):
    index = [socket.identifier for socket in node.outputs].index(output.identifier)
    return e.input(node.inputs[0], groups)[:, index]


def combine(e, node, output, groups):
    return numpy.stack(numpy.broadcast_arrays(*(e.input(socket, groups) for socket in list(node.inputs)[:3])), axis=1)


def value(e, node, output, groups):
    return numpy.array([float(node.outputs[0].default_value)])


NODES = {"MATH": math_node, "VECT_MATH": vector_math, "CLAMP": clamp, "MAP_RANGE": map_range, "VALUE": value, "SEPRGB": separate,
         "SEPXYZ": separate, "COMBRGB": combine, "COMBXYZ": combine}
