"""procedural.py: Cycles' noise, Voronoi, Musgrave, wave, brick, magic and white noise textures (kernel/svm of 3.4); NODES as in
node_values.py."""
import math

import numpy

from . import noise, voronoi
from .math_nodes import column


def _unsupported(node, text):
    from .evaluate import Unsupported
    return Unsupported(node, text)


def _vector(e, node, groups):
    from .node_values import vector_of
    return vector_of(e, node, groups, "generated")


def _points(e, node, groups, dimensions):
    """The place at which a texture of 1 to 4 dimensions is looked up, times its scale, n x dimensions."""
    w = e.named(node, "W", groups) if dimensions in ("1D", "4D") else None
    if dimensions == "1D":
        points = w[:, None]
    else:
        points = _vector(e, node, groups)[:, :2 if dimensions == "2D" else 3]
    if dimensions == "4D":
        count = max(len(points), len(w))
        points = numpy.concatenate([numpy.broadcast_to(points, (count, 3)), numpy.broadcast_to(w[:, None], (count, 1))], axis=1)
    if node.inputs.get("Scale") is None:
        return points
    return points * column(e.named(node, "Scale", groups))


def _numbers(e, node, groups, *names):
    """Inputs that must be the same everywhere."""
    parts = [e.named(node, name, groups) for name in names]
    for name, part in zip(names, parts):
        if len(part) != 1:
            raise _unsupported(node, "its %s varies" % name.lower())
    return [float(part[0]) for part in parts]


def noise_texture(e, node, output, groups):
    if getattr(node, "noise_type", "FBM") != "FBM":
        raise _unsupported(node, "noise of type %s" % node.noise_type)
    points = _points(e, node, groups, node.noise_dimensions)
    numbers = _numbers(e, node, groups, "Detail", "Roughness", "Distortion")
    factor, color = noise.noise(points, *numbers, with_color=output.name != "Fac")
    return factor if output.name == "Fac" else color


def voronoi_texture(e, node, output, groups):
    dimensions = node.voronoi_dimensions
    points = _points(e, node, groups, dimensions)
    randomness, smoothness, exponent = _numbers(e, node, groups, "Randomness", "Smoothness", "Exponent")
    if node.inputs.get("Detail") is not None and e.named(node, "Detail", groups).max() > 0:
        raise _unsupported(node, "detail")
    table = voronoi.voronoi(points, node.feature, node.distance, randomness, smoothness, exponent)
    if output.name in ("Distance", "Radius"):
        return table[:, 0]
    if output.name == "Color":
        return table[:, 1:4]
    scale = e.named(node, "Scale", groups)
    places = table[:, 4:] / column(numpy.where(scale == 0, 1, scale))
    if output.name == "W":
        return places[:, -1]
    result = numpy.zeros((len(places), 3))
    width = min(3, places.shape[1])
    result[:, :width] = places[:, :width]
    return result


def white_noise(e, node, output, groups):
    points = _points(e, node, groups, node.noise_dimensions)
    hashed = noise.hash_vectors(points, 1 if points.shape[1] < 4 and output.name == "Value" else 3)
    return hashed[:, 0] if output.name == "Value" else hashed


def _octaves(points, lacunarity, whole, first):
    """(points of each octave from first on), and those of the rest."""
    return [points * lacunarity**k for k in range(first, max(whole, first))], points * lacunarity**max(whole, first)


def _fall(lacunarity, dimension):
    """What an octave has of the one before it."""
    return numpy.minimum(numpy.float64(lacunarity)**-dimension, 1e15)


def _fbm(points, dimension, lacunarity, octaves, offset, gain):
    fall, whole = _fall(lacunarity, dimension), int(octaves)
    steps, rest = _octaves(points, lacunarity, whole, 0)
    total = sum((noise.perlin(p) * fall**k for k, p in enumerate(steps)), numpy.zeros(len(points)))
    return total + (octaves - whole) * noise.perlin(rest) * fall**whole if octaves > whole else total


def _multifractal(points, dimension, lacunarity, octaves, offset, gain):
    fall, whole = _fall(lacunarity, dimension), int(octaves)
    steps, rest = _octaves(points, lacunarity, whole, 0)
    total = numpy.ones(len(points))
    for k, p in enumerate(steps):
        total = total * (fall**k * noise.perlin(p) + 1)
    return total * ((octaves - whole) * fall**whole * noise.perlin(rest) + 1) if octaves > whole else total


def _hetero(points, dimension, lacunarity, octaves, offset, gain):
    fall, whole = _fall(lacunarity, dimension), int(octaves)
    total = offset + noise.perlin(points)
    steps, rest = _octaves(points, lacunarity, whole, 1)
    for k, p in enumerate(steps, 1):
        total = total + (noise.perlin(p) + offset) * fall**k * total
    if octaves > whole:
        total = total + (octaves - whole) * (noise.perlin(rest) + offset) * fall**max(whole, 1) * total
    return total


def _hybrid(points, dimension, lacunarity, octaves, offset, gain):
    fall, whole = _fall(lacunarity, dimension), int(octaves)
    total = noise.perlin(points) + offset
    weight = gain * total
    steps, rest = _octaves(points, lacunarity, whole, 1)
    for k, p in enumerate(steps, 1):
        goes_on = weight > 0.001
        signal = (noise.perlin(p) + offset) * fall**k
        capped = numpy.minimum(weight, 1.0)
        total = numpy.where(goes_on, total + capped * signal, total)
        weight = numpy.where(goes_on, capped * gain * signal, weight)
    return total + (octaves - whole) * (noise.perlin(rest) + offset) * fall**max(whole, 1) if octaves > whole else total


def _ridged(points, dimension, lacunarity, octaves, offset, gain):
    fall = _fall(lacunarity, dimension)
    signal = (offset - abs(noise.perlin(points)))**2
    total = signal
    for k in range(1, int(octaves)):
        weight = numpy.clip(signal * gain, 0, 1)
        signal = (offset - abs(noise.perlin(points * lacunarity**k)))**2 * weight
        total = total + signal * fall**k
    return total


MUSGRAVE = {"FBM": _fbm, "MULTIFRACTAL": _multifractal, "HETERO_TERRAIN": _hetero, "HYBRID_MULTIFRACTAL": _hybrid,
            "RIDGED_MULTIFRACTAL": _ridged}


def musgrave(e, node, output, groups):
    points = _points(e, node, groups, node.musgrave_dimensions)
    detail, dimension, lacunarity, offset, gain = _numbers(e, node, groups, "Detail", "Dimension", "Lacunarity", "Offset", "Gain")
    octaves = min(max(detail, 0.0), 15.0)
    with numpy.errstate(all="ignore"):
        return MUSGRAVE[node.musgrave_type](points, max(dimension, 1e-5), numpy.float64(max(lacunarity, 1e-5)), octaves, offset, gain)


def wave(e, node, output, groups):
    p = (_points(e, node, groups, "3D") + 0.000001) * 0.999999
    if node.wave_type == "BANDS":
        n = p.sum(axis=1) * 10 if node.bands_direction == "DIAGONAL" else p[:, "XYZ".index(node.bands_direction)] * 20
    else:
        keep = [axis for axis in range(3) if node.rings_direction == "SPHERICAL" or axis != "XYZ".index(node.rings_direction)]
        n = numpy.linalg.norm(p[:, keep], axis=1) * 20
    n = n + e.named(node, "Phase Offset", groups)
    distortion, detail, scale, roughness = _numbers(e, node, groups, "Distortion", "Detail", "Detail Scale", "Detail Roughness")
    if distortion != 0:
        n = n + distortion * (noise.fractal(p * scale, detail, roughness) * 2 - 1)
    turns = n / (2 * math.pi)
    kind = node.wave_profile
    values = 0.5 + 0.5 * numpy.sin(n - 0.5 * math.pi) if kind == "SIN" else turns - numpy.floor(turns) if kind == "SAW" else \
        abs(turns - numpy.floor(turns + 0.5)) * 2
    return values if output.name == "Fac" else numpy.repeat(values[:, None], 3, axis=1)


def _brick_noise(n):
    with numpy.errstate(over="ignore"):
        n = (n.astype(numpy.uint32) + numpy.uint32(1013)) & numpy.uint32(0x7fffffff)
        n = (n >> numpy.uint32(13)) ^ n
        nn = (n * (n * n * numpy.uint32(60493) + numpy.uint32(19990303)) + numpy.uint32(1376312589)) & numpy.uint32(0x7fffffff)
    return 0.5 * nn / 1073741824.0


def brick(e, node, output, groups):
    p = _points(e, node, groups, "3D")
    size, smooth, bias, width, height = (e.named(node, name, groups) for name in
                                         ("Mortar Size", "Mortar Smooth", "Bias", "Brick Width", "Row Height"))
    width, height = numpy.where(width == 0, 1e-30, width), numpy.where(height == 0, 1e-30, height)
    row = numpy.clip(numpy.floor(p[:, 1] / height), -2**31, 2**31 - 1).astype(numpy.int64)
    shift = numpy.zeros(len(p))
    if node.offset_frequency and node.squash_frequency:
        width = width * numpy.where(row % node.squash_frequency, 1.0, node.squash)
        width = numpy.where(width == 0, 1e-30, width)
        shift = numpy.where(row % node.offset_frequency, 0.0, width * node.offset)
    number = numpy.clip(numpy.floor((p[:, 0] + shift) / width), -2**31, 2**31 - 1).astype(numpy.int64)
    x, y = p[:, 0] + shift - width * number, p[:, 1] - height * row
    tint = numpy.clip(_brick_noise((row << 16) + (number & 0xffff)) + bias, 0, 1)
    near = numpy.minimum(numpy.minimum(x, y), numpy.minimum(width - x, height - y))
    inner = 1 - near / numpy.maximum(size, 1e-30)
    t = numpy.clip(inner / numpy.maximum(smooth, 1e-30), 0, 1)
    mortar = numpy.where(near >= size, 0.0, numpy.where(smooth == 0, 1.0, t * t * (3 - 2 * t)))
    if output.name == "Fac":
        return mortar
    first, second, between = (e.named(node, name, groups) for name in ("Color1", "Color2", "Mortar"))
    color = first * column(1 - tint) + second * column(tint)
    return color * column(1 - mortar) + between * column(mortar)


#: What each further turn of the magic texture changes: the axis and its function of x, y, z.
TURNS = [(1, lambda x, y, z: -numpy.cos(x - y + z)), (0, lambda x, y, z: numpy.cos(x - y - z)), (2, lambda x, y, z: numpy.sin(-x - y - z)),
         (0, lambda x, y, z: -numpy.cos(-x + y - z)), (1, lambda x, y, z: -numpy.sin(-x + y + z)), (1, lambda x, y, z: -numpy.cos(-x + y + z)),
         (0, lambda x, y, z: numpy.cos(x + y + z)), (2, lambda x, y, z: numpy.sin(x + y - z)), (0, lambda x, y, z: -numpy.cos(-x - y + z)),
         (1, lambda x, y, z: -numpy.sin(x - y + z))]


def magic(e, node, output, groups):
    p = _points(e, node, groups, "3D")
    strength = e.named(node, "Distortion", groups)
    a, b, c = p.T
    parts = [numpy.sin((a + b + c) * 5), numpy.cos((-a + b - c) * 5), -numpy.cos((-a - b + c) * 5)]
    for k, (axis, function) in enumerate(TURNS[:max(node.turbulence_depth, 0)]):
        if k == 0:
            parts = [part * strength for part in parts]
        parts[axis] = function(*parts) * strength
    divisor = numpy.where(strength == 0, 1.0, 2 * strength)
    color = 0.5 - numpy.stack(numpy.broadcast_arrays(*(part / divisor for part in parts)), axis=1)
    return color.mean(axis=1) if output.name == "Fac" else color


NODES = {"TEX_NOISE": noise_texture, "TEX_VORONOI": voronoi_texture, "TEX_WHITE_NOISE": white_noise, "TEX_MUSGRAVE": musgrave,
         "TEX_WAVE": wave, "TEX_BRICK": brick, "TEX_MAGIC": magic}
