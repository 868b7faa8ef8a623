#!/usr/bin/python3
"""Flow in Sintel's and KITTI's formats, read back by readers written here from the formats' specifications."""
import os
import struct
import zlib

import cases
from cases import case, raises, work

numpy = cases.need("numpy")
import velo
from velo import dataset

WIDTH, HEIGHT = 24, 16


def wall(shift):
    """The flow of a wall at z = 0, seen from 2 away, to a camera that is moved to the right."""
    scene = velo.Scene()
    scene.add_mesh([[-9, -9, 0], [9, -9, 0], [9, 9, 0], [-9, 9, 0]], [[0, 1, 2], [0, 2, 3]], material=scene.add_material("diffuse"))
    scene.camera = velo.Camera(WIDTH, HEIGHT, eye=(0, 0, 2), lookat=(0, 0, 0), fov=1.0)
    other = velo.Camera(WIDTH, HEIGHT, eye=(shift, 0, 2), lookat=(shift, 0, 0), fov=1.0)
    return scene.ground_truth(["forward", "backward"], forward=other, backward=other)


def made(u, v, hidden):
    """An image with this flow."""
    planes = [numpy.asarray(plane, dtype="float32") for plane in (u, v, hidden)]
    return velo.Image(numpy.stack(planes, axis=-1), ["forward.U", "forward.V", "forward.hidden"])


def read_flo(path):
    with open(path, "rb") as file:
        data = file.read()
    tag, width, height = struct.unpack("<fii", data[:12])
    assert tag == 202021.25
    assert len(data) == 12 + 8 * width * height
    return numpy.frombuffer(data[12:], dtype="<f4").reshape(height, width, 2)


def read_kitti(path):
    """u v, and whether they are valid. The PNG has one IDAT chunk, and filter 0 in all rows."""
    with open(path, "rb") as file:
        data = file.read()
    width, height, depth, color = struct.unpack(">IIBB", data[16:26])
    assert (depth, color) == (16, 2)
    start = data.index(b"IDAT")
    size = struct.unpack(">I", data[start - 4:start])[0]
    rows = numpy.frombuffer(zlib.decompress(data[start + 4:start + 4 + size]), dtype="uint8").reshape(height, -1)
    assert not rows[:, 0].any()
    pixels = numpy.ascontiguousarray(rows[:, 1:]).view(">u2").reshape(height, width, 3).astype(float)
    return (pixels[..., :2] - 32768) / 64, pixels[..., 2]


@case
def both_formats_hold_the_flow_of_a_render():
    image = wall(0.25)
    for channel in ("forward", "backward"):
        expected = numpy.stack([image[channel + ".U"], image[channel + ".V"]], axis=-1)
        assert (numpy.abs(expected[..., 0]) > 1).all()
        dataset.write_flow(image, work("a.flo"), channel)
        assert (read_flo(work("a.flo")) == expected).all()
        dataset.write_flow(image, work("a.png"), channel)
        flow, valid = read_kitti(work("a.png"))
        assert (valid == 1).all()
        assert numpy.abs(flow - expected).max() <= 1 / 128


@case
def unknown_pixels_are_marked():
    u = [[1, 2, 0, numpy.nan], [5, 6, 7, numpy.inf]]
    image = made(u, numpy.zeros((2, 4)), [[0, 1, 3, 0], [2, 0, 0, 0]])
    for hidden, known in ((True, [[1, 1, 0, 0], [1, 1, 1, 0]]), (False, [[1, 0, 0, 0], [0, 1, 1, 0]])):
        known = numpy.array(known, dtype=bool)
        dataset.write_flow(image, work("b.flo"), hidden=hidden)
        flow = read_flo(work("b.flo"))
        assert (flow[~known] > 1e9).all()
        assert (flow[known][:, 0] == numpy.array(u)[known]).all()
        dataset.write_flow(image, work("b.png"), hidden=hidden)
        flow, valid = read_kitti(work("b.png"))
        assert (valid == known).all()
        assert (flow[known][:, 0] == numpy.array(u)[known]).all()
        assert (flow[~known] == -512).all()


@case
def flow_beyond_the_png_is_an_error():
    for u in (511.984375, -512):
        dataset.write_flow(made([[u]], [[0]], [[0]]), work("c.png"))
        assert read_kitti(work("c.png"))[0][0, 0, 0] == u
    for u in (512, -512.02, 1e30):
        with raises(velo.UnsupportedError, "column 1, row 0", "1 pixels beyond", ".flo"):
            dataset.write_flow(made([[0, u]], [[0, 0]], [[0, 0]]), work("never.png"))
    assert not os.path.exists(work("never.png"))


@case
def wrong_arguments_are_named():
    image = made([[1]], [[1]], [[0]])
    with raises(velo.UsageError, "d.exr", ".flo"):
        dataset.write_flow(image, work("d.exr"))
    with raises(velo.UsageError, "backward"):
        dataset.write_flow(image, work("d.flo"), "backward")
    with raises(velo.UsageError, "channel"):
        dataset.write_flow(image, work("d.flo"), "sideways")
    with raises(velo.UsageError, "hidden"):
        dataset.write_flow(image, work("d.flo"), hidden=3)
    with raises(velo.UsageError, "image"):
        dataset.write_flow(numpy.zeros((2, 2, 2)), work("d.flo"))
    with raises(velo.UsageError, "path"):
        dataset.write_flow(image, 7)
    with raises(velo.OutputError):
        dataset.write_flow(image, "/proc/none/d.flo")


if __name__ == "__main__":
    cases.main()
