"""sky.py: a world that velo cannot evaluate, such as one with a sky texture, rendered once by Cycles in a Blender of its own to an image of
all directions; the disk of a sky's sun is rendered apart, with more pixels. Results are kept by what the world's nodes say."""
import hashlib
import math
import os
import subprocess
import tempfile
import time

import bpy
import numpy
import velo

from . import report

WIDTH = 2048  # of the image of all directions, pixels
SECONDS = 300  # after which Cycles is given up
POLL = 0.02  # seconds between looks at Cycles
KEPT = 8

_known = {}


class Sky:
    """texels: WIDTH / 2 x WIDTH x 3, equirectangular, rows from the top. suns: list of (direction, half the disk's angle, its radiance summed
    over directions, 3). is_finite: all its numbers were; else those that were not are 0."""

    def __init__(self, texels, suns, is_finite):
        self.texels, self.suns, self.is_finite = texels, suns, is_finite


class Failed(Exception):
    """Cycles gave no image; its text is one line."""


def of(world, cancelled):
    """The Sky of a world of Blender. report.Cancelled where cancelled() says that the user has ended the export."""
    world = world.original
    key = signature(world.node_tree)
    if key not in _known:
        while len(_known) >= KEPT:
            del _known[next(iter(_known))]
        _known[key] = _render(world, cancelled)
    return _known[key]


def signature(tree):
    """A hash of what the nodes of a tree say."""
    text = []
    _describe(tree, text, ())
    return hashlib.sha256("\n".join(text).encode()).hexdigest()


def _describe(tree, text, seen):
    for node in tree.nodes:
        text.append("%s %s %s" % (node.name, node.type, node.mute))
        for known in node.bl_rna.properties:
            if known.type in ("FLOAT", "INT", "BOOLEAN", "ENUM", "STRING") and not known.identifier.startswith(("location", "select", "width")):
                value = getattr(node, known.identifier)
                text.append("%s=%r" % (known.identifier, value if isinstance(value, (int, float, str)) else list(value)))
        for socket in node.inputs:
            value = getattr(socket, "default_value", None)
            text.append("%s=%r" % (socket.identifier, value if isinstance(value, (int, float, str, type(None))) else list(value)))
        image = getattr(node, "image", None)
        if image is not None:
            text.append("image %s %s %s" % (image.name_full, image.filepath, image.as_pointer()))
        ramp = getattr(node, "color_ramp", None)
        if ramp is not None:
            text += ["%r %r %s" % (point.position, list(point.color), ramp.interpolation) for point in ramp.elements]
        inner = getattr(node, "node_tree", None)
        if node.type == "GROUP" and inner is not None and inner.name_full not in seen:
            _describe(inner, text, seen + (inner.name_full,))
    text += ["%s.%s>%s.%s" % (link.from_node.name, link.from_socket.identifier, link.to_node.name, link.to_socket.identifier)
             for link in tree.links]


def _render(world, cancelled):
    with tempfile.TemporaryDirectory(prefix="velo") as folder:
        bpy.data.libraries.write(os.path.join(folder, "world.blend"), {world}, path_remap="ABSOLUTE", fake_user=True)
        script = os.path.join(os.path.dirname(os.path.abspath(__file__)), "sky_render.py")
        command = [bpy.app.binary_path, "-b", "--factory-startup", "--disable-autoexec", "-P", script, "--", folder, str(WIDTH)]
        code = _run(command, cancelled)
        if not os.path.exists(os.path.join(folder, "done")):
            raise Failed("Cycles ended with %d" % code)
        texels, is_finite = _read(os.path.join(folder, "sky.exr"))
        suns = []
        with open(os.path.join(folder, "done"), encoding="ascii") as file:
            for number, line in enumerate(file):
                *axis, half = (float(part) for part in line.split())
                suns.append((numpy.array(axis), half, _sum_of_sun(folder, number)))
        return Sky(texels, suns, is_finite)


def _run(command, cancelled):
    """Runs a program; its exit code."""
    try:
        with subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL) as child:
            begin = time.monotonic()
            while child.poll() is None:
                ended, late = cancelled(), time.monotonic() - begin > SECONDS
                if ended or late:
                    child.kill()
                if ended:
                    raise report.Cancelled()
                if late:
                    raise Failed("Cycles took too long")
                time.sleep(POLL)
            return child.returncode
    except OSError as error:
        raise Failed("Cycles could not be started (%s)" % type(error).__name__) from None


def _read(path):
    """(height x width x 3 with 0 for what is not finite, whether all was finite)."""
    image = velo.read_image(path)
    values = numpy.stack([numpy.asarray(image[letter], dtype=numpy.float32) for letter in "RGB"], axis=2)
    return numpy.nan_to_num(values, nan=0.0, posinf=0.0, neginf=0.0), bool(numpy.isfinite(values).all())


def _sum_of_sun(folder, number):
    """The radiance that a sun's disk adds, summed over directions: from two perspective images, with the disk and without."""
    with_disk, without = (_read(os.path.join(folder, "sun%d_%s.exr" % (number, name)))[0] for name in ("with", "without"))
    side = len(with_disk)
    with open(os.path.join(folder, "sun%d_angle" % number), encoding="ascii") as file:
        reach = math.tan(0.5 * float(file.read()))
    place = reach * (2 * (numpy.arange(side) + 0.5) / side - 1)
    solid = (2 * reach / side)**2 / (1 + place[:, None]**2 + place[None, :]**2)**1.5
    return numpy.maximum((with_disk - without) * solid[..., None], 0).sum(axis=(0, 1)).astype(float)
