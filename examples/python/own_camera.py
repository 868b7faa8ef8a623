"""own_camera: a camera of one's own: a fisheye that sees half of all directions in the largest circle of the image
(docs/own-code.md).

    python3 own_camera.py SCENE IMAGE
    PYTHONPATH=build/release/python python3 examples/python/own_camera.py examples/corner.pbrt fisheye.jpg
"""
import sys

import numpy
import velo


def fisheye(points: velo.FilmPoints) -> numpy.ndarray:
    half = min(points.width, points.height) / 2
    x, y = (points.x - points.width / 2) / half, (points.y - points.height / 2) / half
    r = numpy.hypot(x, y)
    angle = numpy.pi / 2 * r
    k = numpy.sinc(angle / numpy.pi) * numpy.pi / 2  # sin(angle) / r
    directions = numpy.stack((k * x, k * y, numpy.cos(angle)), axis=1)
    directions[r > 1] = 0  # no ray: black and transparent
    return directions


scene = velo.load(sys.argv[1])
image = scene.render(camera=velo.OwnCamera(fisheye, name="my fisheye"))
image.write(sys.argv[2])
