"""tiles.py: tiled images (UDIM) as one image: tile 1001 + i + 10 j lies at i <= u < i + 1, j <= v < j + 1."""
import os
import tempfile

import bpy
import numpy

from . import images

MAX_SIDE = 16384  # of the joined image, pixels
MISSING = (1.0, 0.0, 1.0, 1.0)  # what Cycles shows where there is no tile


class Joined:
    """texels: height x width x 4, linear, rows from the top; low: (u, v) of its corner; count: tiles along u and v."""

    def __init__(self, texels, low, count):
        self.texels, self.low, self.count = texels, low, count

    def matrix(self):
        """(s, t) from (u, v), 2 x 3."""
        return numpy.array([[1 / self.count[0], 0, -self.low[0] / self.count[0]], [0, 1 / self.count[1], -self.low[1] / self.count[1]]])


def join(image, notes):
    """The tiles of an image as one; None, and a note: none of them can be read."""
    found = {}
    for tile in image.tiles:
        number = tile.number - 1001
        array = _read(image, tile, notes)
        if array is not None:
            found[number % 10, number // 10] = array
    if not found:
        return None
    low = numpy.min(list(found), axis=0)
    count = numpy.max(list(found), axis=0) - low + 1
    height = min(max(array.shape[0] for array in found.values()), MAX_SIDE // int(count[1]))
    width = min(max(array.shape[1] for array in found.values()), MAX_SIDE // int(count[0]))
    texels = numpy.empty((count[1] * height, count[0] * width, 4), dtype=numpy.float32)
    texels[:] = MISSING
    for (u, v), array in found.items():
        top, left = (count[1] - 1 - (v - low[1])) * height, (u - low[0]) * width
        rows = numpy.arange(height) * array.shape[0] // height
        columns = numpy.arange(width) * array.shape[1] // width
        texels[top:top + height, left:left + width] = array[rows][:, columns]
    return Joined(texels, low, count)


def _path(image, number):
    u, v = (number - 1001) % 10, (number - 1001) // 10
    path = bpy.path.abspath(image.filepath, library=image.library)
    return path.replace("<UDIM>", str(number)).replace("<UVTILE>", "u%d_v%d" % (u + 1, v + 1))


def _read(image, tile, notes):
    """The pixels of a tile; None, and a note: it cannot be read."""
    path = _path(image, tile.number)
    packed = next((known for known in image.packed_files if known.filepath and os.path.basename(known.filepath) == os.path.basename(path)),
                  None)
    if packed is not None:
        with tempfile.TemporaryDirectory() as folder:
            copy = os.path.join(folder, os.path.basename(path))
            with open(copy, "wb") as file:
                file.write(packed.data)
            return _load(image, copy, tile, notes)
    return _load(image, path, tile, notes)


def _load(image, path, tile, notes):
    if not os.path.exists(path):
        notes.add(image.name, "tile %d" % tile.number, "the file %s is missing" % path)
        return None
    try:
        loaded = bpy.data.images.load(path, check_existing=False)
    except RuntimeError:
        notes.add(image.name, "tile %d" % tile.number, "the file %s cannot be read" % path)
        return None
    try:
        loaded.colorspace_settings.name = image.colorspace_settings.name
        loaded.alpha_mode = image.alpha_mode
        why = images.problem(loaded)
        if why is None:
            return images.pixels(loaded, notes)
        notes.add(image.name, "tile %d" % tile.number, why)
        return None
    finally:
        bpy.data.images.remove(loaded)
