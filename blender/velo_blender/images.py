"""images.py: Blender's images as arrays: packed, generated, tiled, from files."""
import os

import bpy
import numpy

ENCODED = {"sRGB", "Filmic sRGB"}  # Blender's pixels of these 8-bit images are encoded; those of float images are linear
PLAIN = {"Linear", "Linear Rec.709", "Non-Color", "Raw", "Linear BT.709", "Non-Colour Data"}


def linear_of_srgb(values):
    """sRGB's curve (IEC 61966-2-1), decoded."""
    values = numpy.asarray(values, dtype=numpy.float32)
    return numpy.where(values <= 0.04045, values / 12.92, numpy.power(numpy.maximum(values + 0.055, 0) / 1.055, 2.4)).astype(numpy.float32)


def problem(image):
    """Why an image has no pixels, one line; None: it has."""
    if image is None:
        return "no image is chosen"
    if image.source in ("FILE", "SEQUENCE", "MOVIE") and not image.packed_file:
        path = bpy.path.abspath(image.filepath, library=image.library)
        if not image.has_data and not os.path.exists(path):
            return "the file %s is missing" % path
    if image.source == "TILED":
        return None if len(image.tiles) > 0 else "it has no tiles"
    if len(image.pixels) == 0 or image.size[0] == 0 or image.size[1] == 0:
        return "it has no pixels (%s)" % (image.filepath or image.source)
    return None


def pixels(image, notes=None):
    """height x width x 4, float32, linear, rows from the top, alpha not multiplied in. The image has no problem()."""
    width, height = image.size
    values = numpy.empty(len(image.pixels), dtype=numpy.float32)
    image.pixels.foreach_get(values)
    values = values.reshape(height, width, image.channels)[::-1]
    values = _four(values)
    space = image.colorspace_settings.name
    if space in ENCODED and not image.is_float:
        values[..., :3] = linear_of_srgb(values[..., :3])
    elif space not in PLAIN and not image.is_float and notes is not None:
        notes.add(image.name, "colour space", "%s is taken as linear" % space)
    if not numpy.isfinite(values).all():
        values = numpy.nan_to_num(values, nan=0.0, posinf=0.0, neginf=0.0)
        if notes is not None:
            notes.add(image.name, "", "numbers that are not finite became 0")
    return values


def _four(values):
    """R G B A from 1 to 4 channels."""
    count = values.shape[2]
    if count == 4:
        return values.copy()
    result = numpy.ones(values.shape[:2] + (4,), dtype=numpy.float32)
    result[..., :3] = values[..., :3] if count == 3 else values[..., :1]
    if count == 2:
        result[..., 3] = values[..., 1]
    return result


def is_encoded(image):
    """Whether the pixels are 8-bit sRGB, which velo may keep as they are."""
    return image.colorspace_settings.name == "sRGB" and not image.is_float


class Texels:
    """Bilinear or nearest look-ups in an array of height x width x channels, rows from the top, u to the right, v up. matrix: the
    place in the array, (s, t), from (u, v), 2 x 3."""

    def __init__(self, values, extension="REPEAT", closest=False, matrix=None):
        self.values, self.extension, self.closest, self.matrix = values, extension, closest, matrix

    def _index(self, i, count):
        """(indices in range, whether they are inside)."""
        inside = (i >= 0) & (i < count)
        if self.extension == "REPEAT":
            return numpy.mod(i, count), numpy.ones_like(inside)
        if self.extension == "MIRROR":
            period = numpy.mod(i, 2 * count)
            return numpy.where(period < count, period, 2 * count - 1 - period), numpy.ones_like(inside)
        clipped = numpy.clip(i, 0, count - 1)
        return clipped, inside if self.extension == "CLIP" else numpy.ones_like(inside)

    def _fetch(self, x, y):
        height, width = self.values.shape[:2]
        column, in_x = self._index(x, width)
        row, in_y = self._index(y, height)
        return self.values[row, column] * (in_x & in_y)[:, None]

    def at(self, u, v):
        """n x channels at points, n."""
        if self.matrix is not None:
            u, v = self.matrix[:, :2] @ numpy.stack((u, v)) + self.matrix[:, 2:]
        height, width = self.values.shape[:2]
        limit = 1e9  # of what becomes a whole number
        x = numpy.clip(numpy.nan_to_num(u) * width, -limit, limit)
        y = numpy.clip((1 - numpy.nan_to_num(v)) * height, -limit, limit)
        if self.closest:
            return self._fetch(numpy.floor(x).astype(numpy.int64), numpy.floor(y).astype(numpy.int64))
        left, top = numpy.floor(x - 0.5), numpy.floor(y - 0.5)
        fx, fy = (x - 0.5 - left)[:, None], (y - 0.5 - top)[:, None]
        left, top = left.astype(numpy.int64), top.astype(numpy.int64)
        upper = self._fetch(left, top) * (1 - fx) + self._fetch(left + 1, top) * fx
        lower = self._fetch(left, top + 1) * (1 - fx) + self._fetch(left + 1, top + 1) * fx
        return upper * (1 - fy) + lower * fy
