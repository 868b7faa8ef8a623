#!/usr/bin/python3
"""The Python module in another Python: 3.10, the oldest that loads it (Blender 3.4 to 4.0 carry it), and any later one that is found. Nothing here
needs numpy, which the others seldom have: buffers are Python's own arrays and memoryviews."""
import array
import ast
import gc
import glob
import hashlib
import math
import os
import shutil
import subprocess
import sys

import cases
from cases import case, raises

import velo

VERSIONS = ("3.10", "3.11", "3.12", "3.13")
POSITIONS = array.array("f", [-1, -1, 0, 1, -1, 0, 1, 1, 0, -1, 1, 0])
FACES = array.array("I", [0, 1, 2, 0, 2, 3])


def rows(numbers, columns):
    """A view of an array with this many columns."""
    return memoryview(numbers).cast("B").cast(numbers.typecode, (len(numbers) // columns, columns))


def quad(positions):
    scene = velo.Scene()
    scene.add_mesh(positions, rows(FACES, 3), material=scene.add_material("diffuse", reflectance=0.5))
    scene.add_light("infinite", color=(1, 1, 1))
    scene.camera = velo.Camera(24, 16, eye=(0, 0, 3), lookat=(0, 0, 0), fov=math.radians(60))
    return scene


def digest(view):
    return hashlib.sha256(bytes(memoryview(view))).hexdigest()


@case
def arrays_go_in():
    """Buffers of several types, formats and strides, and lists, are the same mesh."""
    first = digest(quad(rows(POSITIONS, 3)).render(spp=2))
    doubles = array.array("d", POSITIONS)
    twice = array.array("f", [x for row in range(4) for x in (*POSITIONS[3 * row:3 * row + 3], math.nan, math.nan, math.nan)])
    spread = memoryview(twice).cast("B").cast("f", (8, 3))[::2]
    assert not spread.contiguous
    for positions in (rows(doubles, 3), rows(POSITIONS, 3).tolist(), spread):
        assert digest(quad(positions).render(spp=2)) == first


@case
def images_come_out():
    """Views of images have their shapes, formats and strides, share the memory, and keep it."""
    image = quad(rows(POSITIONS, 3)).render(spp=2, channels=["Z", "N", "id.object"])
    pixels, depth, normals, ids = memoryview(image), memoryview(image["Z"]), memoryview(image["N"]), memoryview(image["id.object"])
    assert (pixels.shape, pixels.format, depth.shape, normals.shape, ids.format) == ((16, 24, 4), "f", (16, 24), (16, 24, 3), "I")
    before = digest(image)
    del image
    gc.collect()
    assert digest(pixels) == before
    assert abs(depth[8, 12] - 3) < 1e-5 and abs(normals[8, 12, 2]) > 0.99 and ids[8, 12] == 1
    assert math.isinf(depth[0, 0]) and ids[0, 0] == 0
    depth.release()
    assert normals[8, 12, 0] == 0


@case
def wrong_buffers_are_refused():
    with raises(velo.UsageError, "positions"):
        quad(array.array("f", [0, 1]))
    with raises(velo.UsageError, "positions"):
        quad(rows(array.array("f", [math.nan] * 9), 3))
    with raises(velo.UsageError):
        velo.load(cases.PINHOLE).render(spp="two")


@case
def calls_are_called_back():
    """The progress of renders, exceptions of it, and objects that end by themselves."""
    scene = quad(rows(POSITIONS, 3))
    seen = []
    scene.render(spp=2, progress=lambda step: seen.append(step) and None)
    assert seen

    def fail(step):
        raise RuntimeError("enough")
    with raises(RuntimeError, "enough"):
        scene.render(spp=2, progress=fail)
    assert digest(scene.render(spp=1)) == digest(scene.render(spp=1))


ALONE = [function.__name__ for function in cases.cases]
IMAGE = "import velo, hashlib; print(hashlib.sha256(bytes(memoryview(velo.load(%r).render(spp=2, resolution=(32, 24))))).hexdigest())"


@case
def the_add_ons_files_are_python_310():
    """Blender 3.4 to 4.0 read them."""
    for path in glob.glob(os.path.join(cases.SOURCE, "blender/velo_blender/*.py")) + glob.glob(os.path.join(cases.SOURCE, "python/velo/**/*.py"), recursive=True):
        with open(path, encoding="utf-8") as file:
            ast.parse(file.read(), path, feature_version=(3, 10))


def program(version):
    """Another Python of this version that runs; None: there is none."""
    found = [shutil.which("python" + version), *sorted(glob.glob(os.path.expanduser("~/.pyenv/versions/%s.*/bin/python3" % version)))]
    for path in found:
        if path and os.path.realpath(path) != os.path.realpath(sys.executable) and subprocess.run([path, "-c", ""], stderr=subprocess.DEVNULL).returncode == 0:
            return path
    return None


def same_in(version):
    """The cases above in that Python, and the bits of a render, which do not depend on Python."""
    def run():
        python = program(version)
        if python is None:
            raise cases.Skip("no other Python %s is installed" % version)
        result = subprocess.run([python, "-B", __file__, *ALONE], stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, check=False)
        assert result.returncode == 0 and result.stdout.count("ok ") == len(ALONE), result.stdout
        code = IMAGE % cases.PINHOLE
        images = {subprocess.run([each, "-B", "-c", code], stdout=subprocess.PIPE, text=True, check=True).stdout for each in (python, sys.executable)}
        assert len(images) == 1, images
    run.__name__ = "same_in_python_" + version
    return run


for number in VERSIONS:
    case(same_in(number))
cases.main()
