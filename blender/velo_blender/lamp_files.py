"""lamp_files.py: the node IES Texture: a lamp file's intensities over directions, as Cycles reads and interpolates them (util/ies.cpp,
svm/ies.h). The format is LM-63; velo's own reader has more of it (docs/lights.md), and other units and interpolation."""
import os

import bpy
import numpy

#: Cycles' radiant flux of candelas: 4 pi steradians by the 177.83 lm/W of a spectrum of equal energy.
WATTS = 0.0706650768394
MAX_SIZE = 1000000  # bytes, and angles


class Wrong(Exception):
    """A file that cannot be read; its text says why."""


def text_of(node):
    """The text of an IES node."""
    if node.mode == "INTERNAL":
        if node.ies is None:
            raise Wrong("no lamp file is chosen")
        return node.ies.as_string()
    path = bpy.path.abspath(node.filepath, library=node.id_data.library)
    if not path or not os.path.isfile(path):
        raise Wrong("the lamp file %s is missing" % path if path else "no lamp file is chosen")
    with open(path, encoding="latin-1") as file:
        return file.read(MAX_SIZE)


class Lamp:
    """The web of a file. across, down: angles about and from the axis, degrees, rising; values: across x down."""

    def __init__(self, text):
        words = _numbers(text)
        try:
            factor, count_down, count_across, kind = words[2], int(words[3]), int(words[4]), int(words[5])
            self._read(words, factor * words[10] * WATTS, count_down, count_across, kind)
        except (IndexError, ValueError, OverflowError):
            raise Wrong("it is no lamp file of LM-63") from None

    def _read(self, words, factor, count_down, count_across, kind):
        if kind != 1:
            raise Wrong("its photometry is not of type C")
        if not (2 <= count_down and 1 <= count_across and count_down * count_across <= MAX_SIZE):
            raise ValueError
        start, middle = 13 + count_down, 13 + count_down + count_across
        self.down, self.across = numpy.array(words[13:start]), numpy.array(words[start:middle])
        values = numpy.array(words[middle:middle + count_down * count_across])
        self.values = values.reshape(count_across, count_down) * factor
        if not all(numpy.isfinite(part).all() for part in (self.down, self.across, self.values)):
            raise ValueError
        if (numpy.diff(self.down) <= 0).any() or (numpy.diff(self.across) <= 0).any():
            raise ValueError
        self._complete()

    def _complete(self):
        """Angles about the axis over 360 degrees, by the file's symmetry."""
        last = self.across[-1]
        if last == 0 or len(self.across) == 1:
            self.across, self.values = numpy.array([0.0, 360]), numpy.repeat(self.values[:1], 2, axis=0)
            return
        for end in (90.0, 180.0):
            if self.across[-1] == end:
                self.across = numpy.concatenate((self.across, 2 * end - self.across[-2::-1]))
                self.values = numpy.concatenate((self.values, self.values[-2::-1]))
        if self.across[0] != 0 or self.across[-1] != 360:
            raise Wrong("its angles about the axis are neither 0 to 90, 180 nor 360 degrees")

    def at(self, about, below):
        """Values at angles about the axis and from it, degrees, n: cubic between angles, 0 beyond those of the file."""
        row, t = _place(self.across, about % 360)
        known = [(row + shift) % (len(self.across) - 1) for shift in (-1, 0, 1, 2)]
        lines = [self._down(number, below) for number in known]
        inside = (below >= self.down[0]) & (below <= self.down[-1])
        return numpy.where(inside, numpy.maximum(_cubic(*lines, t), 0), 0.0)

    def _down(self, row, below):
        column, t = _place(self.down, below)
        last = len(self.down) - 1
        before = numpy.where(column == 0, column + 1, column - 1)
        known = [self.values[row, numpy.minimum(number, last)] for number in (before, column, column + 1, column + 2)]
        return _cubic(*known, t)


def _numbers(text):
    """The numbers after the line TILT=."""
    lines = text.splitlines()
    for number, line in enumerate(lines):
        if line.strip().startswith("TILT="):
            tilt = line.strip()[5:].strip()
            rest = " ".join(lines[number + 1:]).replace(",", " ").split()
            break
    else:
        raise Wrong("it is no lamp file of LM-63")
    try:
        if tilt == "INCLUDE":
            rest = rest[2 + 2 * int(rest[1]):]
        elif tilt != "NONE":
            raise Wrong("its tilt is in another file")
        return [float(word) for word in rest]
    except (ValueError, IndexError):
        raise Wrong("it has a word where a number should be") from None


def _place(angles, values):
    """(the last angle below each value, how far it is to the next)."""
    number = numpy.clip(numpy.searchsorted(angles, values, side="right") - 1, 0, len(angles) - 2)
    return number, numpy.clip((values - angles[number]) / (angles[number + 1] - angles[number]), 0, 1)


def _cubic(a, b, c, d, x):
    """Catmull and Rom's curve between b and c."""
    return 0.5 * (((d + 3 * (b - c) - a) * x + (2 * a - 5 * b + 4 * c - d)) * x + (c - a)) * x + b


def ies(e, node, output, groups):
    """Cycles looks up the direction from the lamp, in the lamp's space, where nothing is linked."""
    from .evaluate import Unsupported
    socket = node.inputs["Vector"]
    vector = e.input(socket, groups) if socket.is_linked else e.field("normal", node)
    vector = vector / numpy.maximum(numpy.linalg.norm(vector, axis=1, keepdims=True), 1e-30)
    try:
        lamp = Lamp(text_of(node))
    except Wrong as error:
        raise Unsupported(node, str(error), is_missing=True) from None
    below = numpy.degrees(numpy.arccos(numpy.clip(-vector[:, 2], -1, 1)))
    about = numpy.degrees(numpy.arctan2(vector[:, 0], vector[:, 1])) + 180
    return lamp.at(about, below) * e.named(node, "Strength", groups)


NODES = {"TEX_IES": ies}
