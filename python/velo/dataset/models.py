"""The models of a dataset as triangles: for PLY files, and their largest extent."""
from __future__ import annotations

import math
from typing import Any

import numpy

import velo
from velo._errors import UsageError


def triangles(scene: Any, scale: float) -> tuple[Any, Any]:
    """All meshes of a model's scene: points (n x 3, float64) times `scale`, triangles (m x 3)."""
    points, faces, count = [], [], 0
    for handle in scene.handles("shapes"):
        try:
            mesh = scene.mesh(handle)
        except UsageError:  # spheres, curves: a BOP model has triangles only
            continue
        m = mesh.group_from_shape
        p = [numpy.asarray(mesh.positions[:, k], dtype="float64") for k in range(3)]
        points.append(numpy.stack([(m[i, 0] * p[0] + m[i, 1] * p[1] + m[i, 2] * p[2] + m[i, 3]) * scale for i in range(3)], 1))
        corners = numpy.asarray(mesh.indices, dtype="int64") + count
        if corners.shape[1] == 4:  # corners in rows: 0 1 / 2 3
            corners = numpy.concatenate([corners[:, [0, 1, 3]], corners[:, [0, 3, 2]]])
        faces.append(corners)
        count += len(mesh.positions)
    if not points:
        return numpy.zeros((0, 3)), numpy.zeros((0, 3), dtype="int64")
    return numpy.concatenate(points), numpy.concatenate(faces)


def ply(points: Any, faces: Any) -> bytes:
    """A binary PLY file: vertices x y z (float), faces of three corners."""
    head = ("ply\nformat binary_little_endian 1.0\ncomment velo %s\nelement vertex %d\nproperty float x\nproperty float y\n"
            "property float z\nelement face %d\nproperty list uchar int vertex_indices\nend_header\n")
    rows = numpy.zeros(len(faces), dtype=[("count", "u1"), ("corners", "<i4", (3,))])
    rows["count"] = 3
    rows["corners"] = faces
    text = head % (velo.__version__, len(points), len(faces))
    return text.encode() + bytes(points.astype("<f4")) + bytes(rows)


def _extreme(points: Any, count: int) -> Any:
    """The points that are the farthest in `count` directions, spread evenly."""
    kept: set[int] = set()
    for i in range(count):
        z = 1 - (2 * i + 1) / count
        r, a = math.sqrt(1 - z * z), 2.399963229728653 * i
        along = points[:, 0] * (r * math.cos(a)) + points[:, 1] * (r * math.sin(a)) + points[:, 2] * z
        kept.update((int(along.argmin()), int(along.argmax())))
    return points[sorted(kept)]


def diameter(points: Any) -> float:
    """The largest distance of two points. Of more than 5,000 candidates, those that are extreme in 1,000 directions are compared."""
    if len(points) < 2:
        return 0.0
    radius = numpy.sqrt(((points - (points.min(0) + points.max(0)) / 2) ** 2).sum(1))
    first = points[radius.argmax()]
    second = points[((points - first) ** 2).sum(1).argmax()]
    known = math.sqrt(max(((points - second) ** 2).sum(1).max(), ((points - first) ** 2).sum(1).max()))
    # Two points that are farther apart are both at least this far from the middle.
    points = points[radius >= known - radius.max() - 1e-9 * known]
    if len(points) > 5000:
        points = _extreme(points, 1000)
    largest = known * known
    for i in range(0, len(points), 256):
        part = points[i:i + 256, None]
        largest = max(largest, float(((part[..., 0] - points[:, 0]) ** 2 + (part[..., 1] - points[:, 1]) ** 2
                                      + (part[..., 2] - points[:, 2]) ** 2).max()))
    return math.sqrt(largest)
