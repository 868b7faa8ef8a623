"""noise.py: Cycles' hashes and Perlin noise in 1 to 4 dimensions, with the same numbers (kernel/svm/noise.h, util/hash.h; Jenkins, lookup3.c).

Points are n x dimensions."""
import numpy

PIECE = 8192  # points that are computed at once: their arrays stay in the processor's cache
SCALES = {1: 0.25, 2: 0.6616, 3: 0.982, 4: 0.8344}


def _rotate(x, k):
    return (x << numpy.uint32(k)) | (x >> numpy.uint32(32 - k))


def _mix(a, b, c):
    a = (a - c) ^ _rotate(c, 4)
    c = c + b
    b = (b - a) ^ _rotate(a, 6)
    a = a + c
    c = (c - b) ^ _rotate(b, 8)
    b = b + a
    a = (a - c) ^ _rotate(c, 16)
    c = c + b
    b = (b - a) ^ _rotate(a, 19)
    a = a + c
    c = (c - b) ^ _rotate(b, 4)
    b = b + a
    return a, b, c


def _final(a, b, c):
    c = (c ^ b) - _rotate(b, 14)
    a = (a ^ c) - _rotate(c, 11)
    b = (b ^ a) - _rotate(a, 25)
    c = (c ^ b) - _rotate(b, 16)
    a = (a ^ c) - _rotate(c, 4)
    b = (b ^ a) - _rotate(a, 14)
    return (c ^ b) - _rotate(b, 24)


def hash_words(*words):
    """The hash of 1 to 4 arrays of uint32."""
    with numpy.errstate(over="ignore"):
        start = numpy.uint32((0xdeadbeef + (len(words) << 2) + 13) & 0xffffffff)
        parts = [start + word for word in words[:3]] + [numpy.full_like(words[0], start)] * (3 - len(words))
        if len(words) == 4:
            parts = list(_mix(*parts))
            parts[0] = parts[0] + words[3]
        return _final(*parts)


def hash_numbers(*numbers):
    """0 to 1 from the bits of 1 to 4 arrays of numbers."""
    words = [numpy.ascontiguousarray(part, dtype=numpy.float32).view(numpy.uint32) for part in numpy.broadcast_arrays(*numbers)]
    return hash_words(*words) / float(0xffffffff)


def hash_vectors(points, count):
    """n x count numbers from 0 to 1 for n points: Cycles' hashes of vectors to vectors."""
    axes = list(points.T)
    if len(axes) == 4:
        turns = {4: ((0, 1, 2, 3), (3, 0, 1, 2), (2, 3, 0, 1), (1, 2, 3, 0)), 3: ((0, 1, 2, 3), (2, 0, 3, 1), (3, 2, 1, 0))}[count]
        return numpy.stack([hash_numbers(*(axes[i] for i in turn)) for turn in turns], axis=1)
    more = [hash_numbers(*axes, numpy.array([float(k)])) for k in range(1, count)]
    return numpy.stack([hash_numbers(*axes)] + more, axis=1)


def offset(seed, dimensions=3):
    """The numbers that separate the channels of a noise."""
    if dimensions == 1:
        return 100 + 100 * hash_numbers(numpy.array([seed]))
    return numpy.array([100 + 100 * float(hash_numbers(numpy.array([seed]), numpy.array([float(axis)]))[0]) for axis in range(dimensions)])


def _signed(values, is_negative):
    return numpy.where(is_negative, -values, values)


def _gradient(corner, f):
    """The slope of a corner, chosen by its hash, times the way from it, f."""
    h = hash_words(*(part.astype(numpy.int64).astype(numpy.uint32) for part in corner))
    if len(f) == 1:
        return _signed(1.0 + (h & 7), h & 8) * f[0]
    if len(f) == 2:
        first = (h & 7) < 4
        return _signed(numpy.where(first, f[0], f[1]), h & 1) + 2 * _signed(numpy.where(first, f[1], f[0]), h & 2)
    if len(f) == 3:
        h = h & 15
        v = numpy.where(h < 4, f[1], numpy.where((h == 12) | (h == 14), f[0], f[2]))
        return _signed(numpy.where(h < 8, f[0], f[1]), h & 1) + _signed(v, h & 2)
    h = h & 31
    u, v, s = numpy.where(h < 24, f[0], f[1]), numpy.where(h < 16, f[1], f[2]), numpy.where(h < 8, f[2], f[3])
    return _signed(u, h & 1) + _signed(v, h & 2) + _signed(s, h & 4)


def in_pieces(function):
    """A function of points, called for some thousand of them at once."""
    def whole(points, *rest):
        with numpy.errstate(all="ignore"):
            if len(points) <= PIECE:
                return function(points, *rest)
            return numpy.concatenate([function(points[i:i + PIECE], *rest) for i in range(0, len(points), PIECE)])
    return whole


@in_pieces
def perlin(points):
    """Signed noise, n."""
    points = points.T
    low = numpy.floor(points)
    f = points - low
    fade = f * f * f * (f * (f * 6 - 15) + 10)
    total = numpy.zeros(points.shape[1])
    for i in range(2**len(points)):
        step = numpy.array([[i >> k & 1] for k in range(len(points))])
        weight = numpy.prod(numpy.where(step, fade, 1 - fade), axis=0)
        total += weight * _gradient(low + step, f - step)
    return SCALES[len(points)] * total


def fractal(points, detail, roughness):
    """Noise of several octaves, 0 to 1."""
    octaves = min(max(float(detail), 0.0), 15.0)
    keep = min(max(float(roughness), 0.0), 1.0)
    scale = amplitude = 1.0
    most, total = 0.0, numpy.zeros(len(points))
    for _ in range(int(octaves) + 1):
        total += amplitude * (0.5 * perlin(scale * points) + 0.5)
        most += amplitude
        amplitude *= keep
        scale *= 2
    rest = octaves - int(octaves)
    if rest == 0:
        return total / most
    more = total + amplitude * (0.5 * perlin(scale * points) + 0.5)
    return (1 - rest) * total / most + rest * more / (most + amplitude)


def noise(points, detail, roughness, distortion, with_color=True):
    """(factor n, colour n x 3 or None) of a noise texture."""
    count = points.shape[1]
    if distortion != 0:
        moved = [perlin(points + offset(float(axis), count)) * distortion for axis in range(count)]
        points = points + numpy.stack(moved, axis=1)
    factor = fractal(points, detail, roughness)
    if not with_color:
        return factor, None
    others = [fractal(points + offset(float(count + k), count), detail, roughness) for k in (0, 1)]
    return factor, numpy.stack([factor] + others, axis=1)
