"""vectors.py: the pass Vector: where the point that a pixel sees was in the last frame and will be in the next one.

X, Y: its place in the last frame minus that in this one; Z, W: its place in this frame minus that in the next one; pixels, y upwards, as
Cycles writes it. It follows cameras, objects and the vertices of meshes that keep their triangles."""
import numpy

from . import motion

FRAMES = (-1.0, 1.0)  # from the frame that is rendered


class Vectors:
    """What is known of the frames before and after. It is made before the scene is exported."""

    def __init__(self, engine, depsgraph, size, views):
        self.steps = motion.read_steps(engine, depsgraph, FRAMES, views, size)
        self.view = views[0]  # that is being rendered

    def layer(self, export, rows, ask):
        """height x width x 4 of the pass in one view, of passes.Rows. ask: as of passes.Made."""
        points = rows["P"].astype(float)
        shape = points.shape[:2]
        seen = numpy.isfinite(rows["Z"]).ravel()
        points = points.reshape(-1, 3)
        instance, thing, face = (rows["id." + name].astype(numpy.int64).ravel() for name in ("instance", "object", "primitive"))
        ask()
        now = export.camera.project(points)
        result = numpy.zeros((len(points), 4))
        for column, step in enumerate(self.steps):
            if step.cameras.get(self.view) is None:
                continue
            moved = _moved(export, step, points, (instance, thing, face), ask)
            ask()
            then = step.cameras[self.view].project(moved)
            ask()
            good = seen & numpy.asarray(now.valid) & numpy.asarray(then.valid)
            sign = 1 if column == 0 else -1
            difference = sign * (numpy.asarray(then.pixels) - numpy.asarray(now.pixels))[good]
            result[good, 2 * column], result[good, 2 * column + 1] = difference[:, 0], -difference[:, 1]
        return result.reshape(shape + (4,))


def _moved(export, step, points, ids_of, ask):
    """Points, n x 3, where they are in another frame. ids_of: velo's ids of each: instance, object, primitive."""
    instance, thing, face = ids_of
    result = points.copy()
    for owners, ids in ((export.instances, instance), (export.shapes, numpy.where(instance > 0, 0, thing))):
        for number, places in _groups(ids):
            ask()
            placed = owners[number - 1]
            if placed is None:
                continue
            back = numpy.linalg.inv(placed.matrix)
            local = points[places] @ back[:3, :3].T + back[:3, 3]
            local = _deformed(export, step, placed, local, thing[places], face[places])
            then = step.pose_of(placed.key, placed.matrix)
            result[places] = local @ then[:3, :3].T + then[:3, 3]
    return result


def _groups(ids):
    """(id, places of it) of each id that is not 0."""
    order = numpy.argsort(ids, kind="stable")
    numbers, starts = numpy.unique(ids[order], return_index=True)
    for number, places in zip(numbers, numpy.split(order, starts[1:])):
        if number > 0:
            yield int(number), places


def _deformed(export, step, placed, local, thing, face):
    """Points of a mesh in its own space, n x 3, on its triangles in another frame."""
    mesh = step.meshes.get(placed.key[0])
    if mesh is None:
        return local
    result = local.copy()
    for number, places in _groups(thing):
        used = export.triangles.get(number)
        if used is None:
            continue
        positions, corners = used
        corners = corners[numpy.clip(face[places] - 1, 0, len(corners) - 1)]
        if corners.max(initial=0) >= len(mesh.positions):
            continue
        weights = _barycentric(local[places], positions[corners].astype(float))
        result[places] = (weights[..., None] * mesh.positions[corners]).sum(axis=1)
    return result


def _barycentric(points, corners):
    """n x 3 weights of the corners, n x 3 x 3, for points in the planes of the triangles."""
    u, v, w = corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0], points - corners[:, 0]
    uu, uv, vv = (u * u).sum(axis=1), (u * v).sum(axis=1), (v * v).sum(axis=1)
    wu, wv = (w * u).sum(axis=1), (w * v).sum(axis=1)
    size = numpy.maximum(uu * vv - uv * uv, 1e-300)
    b, c = (vv * wu - uv * wv) / size, (uu * wv - uv * wu) / size
    return numpy.stack((1 - b - c, b, c), axis=1)
