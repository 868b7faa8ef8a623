"""color_nodes.py: nodes of colours: mix, ramp, invert, gamma, brightness, hue and saturation."""
import numpy

from .math_nodes import column

#: Linear Rec. 709 from CIE XYZ (IEC 61966-2-1).
RGB_FROM_XYZ = numpy.array([[3.2406, -1.5372, -0.4986], [-0.9689, 1.8758, 0.0415], [0.0557, -0.2040, 1.0570]])
LUMINANCE = numpy.array([0.2126, 0.7152, 0.0722])


def _unsupported(node, text):
    from .evaluate import Unsupported
    return Unsupported(node, text)


def rgb(e, node, output, groups):
    return numpy.array([[float(x) for x in node.outputs[0].default_value][:3]])


def _soft_light(a, b):
    screen = 1 - (1 - a) * (1 - b)
    return (1 - a) * a * b + a * screen


def _overlay(a, b):
    return numpy.where(a < 0.5, 2 * a * b, 1 - 2 * (1 - a) * (1 - b))


#: The blended colour, which the factor mixes with the first one.
BLEND = {
    "MIX": lambda a, b: b, "ADD": lambda a, b: a + b, "MULTIPLY": lambda a, b: a * b, "SUBTRACT": lambda a, b: a - b,
    "SCREEN": lambda a, b: 1 - (1 - a) * (1 - b), "OVERLAY": _overlay, "DIFFERENCE": lambda a, b: numpy.abs(a - b),
    "DIVIDE": lambda a, b: numpy.where(b == 0, a, a / numpy.where(b == 0, 1, b)), "SOFT_LIGHT": _soft_light,
    "LINEAR_LIGHT": lambda a, b: a + 2 * b - 1, "EXCLUSION": lambda a, b: numpy.maximum(a + b - 2 * a * b, 0),
    "DARKEN": numpy.minimum, "LIGHTEN": numpy.maximum,
}


def _dodge(t, a, b):
    rest = 1 - t * b
    return numpy.where(a == 0, 0.0, numpy.where(rest <= 0, 1.0, numpy.minimum(a / numpy.where(rest <= 0, 1.0, rest), 1)))


def _burn(t, a, b):
    part = 1 - t + t * b
    return numpy.where(part <= 0, 0.0, numpy.clip(1 - (1 - a) / numpy.where(part <= 0, 1.0, part), 0, 1))


def _hsv_of(t, a, b):
    """a, and both as HSV, as many as there are factors or colours."""
    _, a, b = numpy.broadcast_arrays(t, a, b)
    return a, to_hsv(a), to_hsv(b)


def _mix_hue(t, a, b):
    a, own, other = _hsv_of(t, a, b)
    mixed = a + t * (from_hsv(numpy.stack((other[:, 0], own[:, 1], own[:, 2]), axis=1)) - a)
    return numpy.where(other[:, 1:2] == 0, a, mixed)


def _mix_color(t, a, b):
    a, own, other = _hsv_of(t, a, b)
    mixed = a + t * (from_hsv(numpy.stack((other[:, 0], other[:, 1], own[:, 2]), axis=1)) - a)
    return numpy.where(other[:, 1:2] == 0, a, mixed)


def _mix_saturation(t, a, b):
    a, own, other = _hsv_of(t, a, b)
    saturation = own[:, 1] + t[:, 0] * (other[:, 1] - own[:, 1])
    return numpy.where(own[:, 1:2] == 0, a, from_hsv(numpy.stack((own[:, 0], saturation, own[:, 2]), axis=1)))


def _mix_value(t, a, b):
    a, own, other = _hsv_of(t, a, b)
    return from_hsv(numpy.stack((own[:, 0], own[:, 1], own[:, 2] + t[:, 0] * (other[:, 2] - own[:, 2])), axis=1))


#: Blends with a factor of their own, n x 1.
MIXED = {"DODGE": _dodge, "BURN": _burn, "HUE": _mix_hue, "COLOR": _mix_color, "SATURATION": _mix_saturation, "VALUE": _mix_value}


def _blend(node, kind, factor, a, b, clamp_result):
    factor = column(factor)
    if kind in MIXED:
        result = MIXED[kind](factor, a, b)
    elif kind in BLEND:
        result = a + factor * (BLEND[kind](a, b) - a)
    else:
        raise _unsupported(node, "mixing by %s" % kind)
    return numpy.clip(result, 0, 1) if clamp_result else result


def mix_rgb(e, node, output, groups):
    factor, a, b = (e.input(socket, groups) for socket in list(node.inputs)[:3])
    return _blend(node, node.blend_type, numpy.clip(factor, 0, 1), a, b, node.use_clamp)


def _by_identifier(e, node, identifier, groups):
    return e.input(next(socket for socket in node.inputs if socket.identifier == identifier), groups)


def mix(e, node, output, groups):
    kind = {"FLOAT": "Float", "VECTOR": "Vector", "RGBA": "Color"}.get(node.data_type)
    if kind is None:
        raise _unsupported(node, "a mix of %s" % node.data_type)
    several = kind == "Vector" and node.factor_mode == "NON_UNIFORM"
    factor = _by_identifier(e, node, "Factor_Vector" if several else "Factor_Float", groups)
    if node.clamp_factor:
        factor = numpy.clip(factor, 0, 1)
    a, b = (_by_identifier(e, node, "%s_%s" % (side, kind), groups) for side in "AB")
    if kind == "Color":
        return _blend(node, node.blend_type, factor, a, b, node.clamp_result)
    return a + (column(factor) if kind == "Vector" else factor) * (b - a)


def ramp(e, node, output, groups):
    factor = numpy.clip(e.input(node.inputs[0], groups), 0, 1)
    # As Cycles: a table of 256 entries, linear between them unless the ramp is constant.
    table = numpy.array([list(node.color_ramp.evaluate(i / 255)) for i in range(256)])
    place = factor * 255
    low = numpy.minimum(place.astype(int), 255)
    if node.color_ramp.interpolation == "CONSTANT":
        colors = table[low]
    else:
        t = column(place - low)
        colors = table[low] * (1 - t) + table[numpy.minimum(low + 1, 255)] * t
    return colors[:, 3] if output.name == "Alpha" else colors[:, :3]


def invert(e, node, output, groups):
    factor, color = e.named(node, "Fac", groups), e.named(node, "Color", groups)
    return color + column(factor) * (1 - 2 * color)


def gamma(e, node, output, groups):
    color, power = e.named(node, "Color", groups), e.named(node, "Gamma", groups)
    return numpy.where(color > 0, numpy.power(numpy.maximum(color, 1e-30), column(power)), color)


def bright_contrast(e, node, output, groups):
    color, bright, contrast = (e.named(node, name, groups) for name in ("Color", "Bright", "Contrast"))
    return numpy.maximum((1 + column(contrast)) * color + column(bright - 0.5 * contrast), 0)


def to_hsv(color):
    """n x 3: hue, saturation, value, 0 to 1."""
    high, low = color.max(axis=1), color.min(axis=1)
    size = high - low
    safe = numpy.where(size == 0, 1, size)
    r, g, b = ((high - color[:, i]) / safe for i in range(3))
    hue = numpy.where(color[:, 0] == high, b - g, numpy.where(color[:, 1] == high, 2 + r - b, 4 + g - r)) / 6
    return numpy.stack((numpy.where(size == 0, 0, hue % 1), numpy.where(high == 0, 0, size / numpy.where(high == 0, 1, high)), high), axis=1)


def from_hsv(hsv):
    h, s, v = hsv.T
    sector = numpy.stack([numpy.clip(numpy.abs((h * 6 - c) % 6 - 3) - 1, 0, 1) for c in (0, 2, 4)], axis=1)
    return column(v) * ((sector - 1) * column(s) + 1)


def to_hsl(color):
    """n x 3: hue, saturation, lightness, 0 to 1."""
    high, low = color.max(axis=1), color.min(axis=1)
    size, lightness = high - low, (high + low) / 2
    most = numpy.where(lightness > 0.5, 2 - high - low, high + low)
    saturation = numpy.where(size == 0, 0, size / numpy.where(most == 0, 1, most))
    return numpy.stack((to_hsv(color)[:, 0], saturation, lightness), axis=1)


def from_hsl(hsl):
    h, s, lightness = hsl.T
    sector = numpy.stack([numpy.clip(numpy.abs((h * 6 - c) % 6 - 3) - 1, 0, 1) for c in (0, 2, 4)], axis=1)
    chroma = (1 - numpy.abs(2 * lightness - 1)) * s
    return column(chroma) * (sector - 0.5) + column(lightness)


def hue_saturation(e, node, output, groups):
    hue, saturation, value, factor, color = (e.named(node, name, groups) for name in ("Hue", "Saturation", "Value", "Fac", "Color"))
    hsv = to_hsv(color)
    hsv = numpy.stack(numpy.broadcast_arrays((hsv[:, 0] + hue + 0.5) % 1, numpy.clip(hsv[:, 1] * saturation, 0, 1), hsv[:, 2] * value),
                      axis=1)
    return numpy.maximum(color + column(factor) * (from_hsv(hsv) - color), 0)


def _bell(wavelength, middle, below, above):
    """A Gaussian with a width on each side."""
    t = (wavelength - middle) / numpy.where(wavelength < middle, below, above)
    return numpy.exp(-0.5 * t * t)


def _xyz(nm):
    """The fits of Wyman, Sloan and Shirley 2013 to the CIE 1931 observer, ... x 3."""
    x = 1.056 * _bell(nm, 599.8, 37.9, 31.0) + 0.362 * _bell(nm, 442.0, 16.0, 26.7) - 0.065 * _bell(nm, 501.1, 20.4, 26.2)
    y = 0.821 * _bell(nm, 568.8, 46.9, 40.5) + 0.286 * _bell(nm, 530.9, 16.3, 31.1)
    z = 1.217 * _bell(nm, 437.0, 11.8, 36.0) + 0.681 * _bell(nm, 459.0, 26.0, 13.8)
    return numpy.stack((x, y, z), axis=-1)


def black_body(e, node, output, groups):
    return black_body_color(e.input(node.inputs[0], groups))


def black_body_color(kelvin):
    """n x 3 for n temperatures: Planck's law through the fits of Wyman, Sloan and Shirley 2013 to the CIE 1931 observer, linear Rec. 709
    of luminance 1, as Cycles' to 1 %."""
    kelvin = numpy.clip(kelvin, 800.0, 12000.0)[:, None]
    nm = numpy.arange(380.0, 781.0, 5.0)[None, :]
    with numpy.errstate(all="ignore"):
        power = nm**-5.0 / numpy.expm1(1.4387769e7 / (nm * kelvin))
    xyz = numpy.einsum("ij,ijk->ik", power, numpy.broadcast_to(_xyz(nm), power.shape + (3,)))
    xyz = xyz / numpy.maximum(xyz[:, 1:2], 1e-30)
    return numpy.maximum(xyz @ RGB_FROM_XYZ.T, 0)


def wavelength(e, node, output, groups):
    """The colour of light of a wavelength in nm, by the fits above, as Cycles scales it (svm/wavelength.h)."""
    nm = e.input(node.inputs[0], groups)
    return numpy.where(((nm >= 380) & (nm <= 780))[:, None], numpy.maximum(_xyz(nm) @ RGB_FROM_XYZ.T / 2.52, 0), 0.0)


def separate_color(e, node, output, groups):
    index = [socket.identifier for socket in node.outputs].index(output.identifier)
    color = e.input(node.inputs[0], groups)
    return {"RGB": lambda: color, "HSV": lambda: to_hsv(color), "HSL": lambda: to_hsl(color)}[_mode(node)]()[:, index]


def combine_color(e, node, output, groups):
    parts = numpy.stack(numpy.broadcast_arrays(*(e.input(socket, groups) for socket in list(node.inputs)[:3])), axis=1)
    return {"RGB": lambda: parts, "HSV": lambda: from_hsv(parts), "HSL": lambda: from_hsl(parts)}[_mode(node)]()


def _mode(node):
    """RGB, HSV or HSL; the older nodes have it in their kind."""
    return "HSV" if node.type in ("SEPHSV", "COMBHSV") else getattr(node, "mode", "RGB")


def to_gray(e, node, output, groups):
    return e.input(node.inputs[0], groups) @ LUMINANCE


NODES = {"RGB": rgb, "MIX_RGB": mix_rgb, "MIX": mix, "VALTORGB": ramp, "INVERT": invert, "GAMMA": gamma,
         "BRIGHTCONTRAST": bright_contrast, "HUE_SAT": hue_saturation, "RGBTOBW": to_gray, "BLACKBODY": black_body, "WAVELENGTH": wavelength,
         "SEPARATE_COLOR": separate_color, "COMBINE_COLOR": combine_color, "SEPHSV": separate_color, "COMBHSV": combine_color}
