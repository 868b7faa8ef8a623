"""Keypoints: where points of objects are in an image, and whether they are seen."""
from __future__ import annotations

from typing import Any, NamedTuple

import numpy

import velo
from velo import _check
from velo._errors import wrong_value

#: COCO's flags of keypoints.
OUTSIDE, HIDDEN, VISIBLE = 0, 1, 2
#: Rays end so much before a keypoint, as a share of the distance: rounding errors of points on surfaces.
_SLACK = 1e-5


class Keypoints(NamedTuple):
    """Keypoints of an image, n of them."""
    pixels: Any  #: n x 2: x, y; the first pixel's centre is (0.5, 0.5); 0 where there is no projection
    visibility: Any  #: n, uint8: VISIBLE (2), HIDDEN (1) by a surface in front of it, OUTSIDE (0) the image
    points: Any  #: n x 3: camera space, x right, y down, z forward, scene units
    hidden_by: Any  #: n, uint32: the id.instance of what hides it; 0: not hidden, or by what is in no instance


def project_keypoints(world: Any, camera: Any, points: Any, *, depth: float = 0.0) -> Keypoints:
    """Where points (n x 3, world space, scene units) are in a camera's image, and whether they are seen: a ray from the camera to
    each is traced. Pixels, points in camera space and rays are those of the time at which `camera.project` sees the point: the middle of the
    exposure, with a rolling shutter that of the row of its pixel (of a point without a projection, of the image's middle).

    world: of a scene (Scene.world()). depth: how far below a surface a visible keypoint may be, scene units: for points inside of
    objects, such as joints. Points that are not finite, and points without a projection, are OUTSIDE."""
    _check.instance(world, velo.World, "world")
    _check.instance(camera, velo.Camera, "camera")
    depth = _check.number(depth, "depth", 0)
    try:
        at = numpy.array(points, dtype="float64")
    except (TypeError, ValueError):
        raise wrong_value("points", "an array of n x 3 numbers", points) from None
    if at.size == 0:
        at = at.reshape(0, 3)
    if at.ndim != 2 or at.shape[1] != 3:
        raise wrong_value("points", "an array of n x 3 numbers", points)
    finite = numpy.isfinite(at).all(1)
    at = numpy.where(finite[:, None], at, 0)
    seen = camera.project(at)
    width, height = camera.resolution
    x, y = seen.pixels[:, 0], seen.pixels[:, 1]
    inside = finite & seen.valid & (x >= 0) & (x < width) & (y >= 0) & (y < height)
    hidden, hider = _hidden(world, camera, at, seen.pixels, inside, depth)
    inside &= hidden >= 0
    visibility = numpy.where(inside, numpy.where(hidden == 1, HIDDEN, VISIBLE), OUTSIDE).astype("uint8")
    known = (finite & seen.valid)[:, None]
    pixels = numpy.where(known, seen.pixels, 0)
    times = camera.film_times(numpy.where(known, seen.pixels, (width / 2, height / 2)))
    return Keypoints(pixels, visibility, _in_camera(camera, at, times), numpy.where(inside, hider, 0).astype("uint32"))


def _in_camera(camera: Any, at: Any, times: Any) -> Any:
    """Points in the space of the camera of each point's time."""
    points = numpy.zeros((len(at), 3))
    for time in numpy.unique(times):
        # Sums of products in a fixed order: matrix products differ in their last bits between machines.
        m, which = camera.at(time).camera_from_world, times == time
        x, y, z = at[which].T
        points[which] = numpy.stack([m[i, 0] * x + m[i, 1] * y + m[i, 2] * z + m[i, 3] for i in range(3)], 1)
    return points


def _hidden(world: Any, camera: Any, at: Any, pixels: Any, inside: Any, depth: float) -> tuple[Any, Any]:
    """Of each point: 1: something is in front of it, 0: nothing, -1: the pixel has no ray; and the instance that is in front."""
    hidden, hider = numpy.zeros(len(at), dtype="int8"), numpy.zeros(len(at), dtype="uint32")
    which = numpy.flatnonzero(inside)
    if not len(which):
        return hidden, hider
    rays = camera.unproject(pixels[which])
    hidden[which[~rays.valid]] = -1
    which, origins, directions = which[rays.valid], rays.origins[rays.valid], rays.directions[rays.valid]
    to = at[which] - origins
    along = to[:, 0] * directions[:, 0] + to[:, 1] * directions[:, 1] + to[:, 2] * directions[:, 2]
    hits = world.trace(origins, directions, t_max=numpy.maximum(along * (1 - _SLACK) - depth, 0), times=camera.film_times(pixels[which]),
                       fields=["valid", "instance_id"])
    hidden[which], hider[which] = hits.valid, hits.instance_id
    return hidden, hider
