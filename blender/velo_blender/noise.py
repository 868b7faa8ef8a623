"""noise.py: Cycles' Perlin noise, with the same numbers (kernel/svm/noise.h, util/hash.h; Jenkins, lookup3.c)."""
import numpy


def _rotate(x, k):
    return (x << numpy.uint32(k)) | (x >> numpy.uint32(32 - k))


def _final(a, b, c):
    for x, k in (("c", 14), ("a", 11), ("b", 25), ("c", 16), ("a", 4), ("b", 14), ("c", 24)):
        if x == "c":
            c = (c ^ b) - _rotate(b, k)
        elif x == "a":
            a = (a ^ c) - _rotate(c, k)
        else:
            b = (b ^ a) - _rotate(a, k)
    return c


def hash_words(*words):
    """The hash of 2 or 3 arrays of uint32."""
    with numpy.errstate(over="ignore"):
        start = numpy.uint32((0xdeadbeef + (len(words) << 2) + 13) & 0xffffffff)
        parts = [start + word for word in words] + [numpy.full_like(words[0], start)] * (3 - len(words))
        return _final(*parts)


def offset(seed):
    """The three numbers that separate the channels of a noise."""
    def number(axis):
        words = [numpy.array([value], dtype=numpy.float32).view(numpy.uint32) for value in (seed, axis)]
        return 100 + 100 * float(hash_words(*words)[0]) / 0xffffffff
    return numpy.array([number(0.0), number(1.0), number(2.0)])


def _gradient(corner, x, y, z):
    h = hash_words(*(part.astype(numpy.int64).astype(numpy.uint32) for part in corner)) & numpy.uint32(15)
    u = numpy.where(h < 8, x, y)
    v = numpy.where(h < 4, y, numpy.where((h == 12) | (h == 14), x, z))
    return numpy.where(h & 1, -u, u) + numpy.where(h & 2, -v, v)


def perlin(points):
    """Signed noise, n, at points n x 3."""
    low = numpy.floor(points)
    f = points - low
    fade = f * f * f * (f * (f * 6 - 15) + 10)
    total = numpy.zeros(len(points))
    for i in range(8):
        step = numpy.array([i & 1, i >> 1 & 1, i >> 2 & 1])
        weight = numpy.prod(numpy.where(step, fade, 1 - fade), axis=1)
        total += weight * _gradient((low + step).T, *(f - step).T)
    return 0.982 * total


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


def noise(points, detail, roughness, distortion):
    """(factor n, colour n x 3) of a noise texture in 3 dimensions."""
    if distortion != 0:
        moved = [perlin(points + offset(axis)) * distortion for axis in (0.0, 1.0, 2.0)]
        points = points + numpy.stack(moved, axis=1)
    factor = fractal(points, detail, roughness)
    others = [fractal(points + offset(axis), detail, roughness) for axis in (3.0, 4.0)]
    return factor, numpy.stack([factor] + others, axis=1)
