"""box_projection.py: images projected from the six sides of a box (Cycles' svm_node_tex_image_box)."""
import numpy


def weights(normals, blend):
    """The shares of the images along x, y and z, n x 3, for normals, n x 3. blend: from 0, hard edges, to 1."""
    n = numpy.abs(normals)
    n = n / numpy.maximum(n.sum(axis=1, keepdims=True), 1e-30)
    limit = 0.5 * (1 + blend)
    x, y, z = n.T
    alone = [(x > limit * (x + y)) & (x > limit * (x + z)), (y > limit * (x + y)) & (y > limit * (y + z)),
             (z > limit * (x + z)) & (z > limit * (y + z))]
    none = numpy.zeros_like(x)
    if blend <= 0:
        return numpy.select([part[:, None] for part in alone], list(numpy.eye(3)), numpy.array([1.0, 0, 0]))

    def share(a, b):
        return numpy.clip((a / numpy.maximum(a + b, 1e-30) - 0.5 * (1 - blend)) / blend, 0, 1)

    of_x, of_y, of_xz = share(x, y), share(y, z), share(x, z)
    two = [numpy.stack(parts, axis=1) for parts in ((of_x, 1 - of_x, none), (none, of_y, 1 - of_y), (of_xz, none, 1 - of_xz))]
    lacking = [z < (1 - limit) * (x + y), x < (1 - limit) * (y + z), y < (1 - limit) * (x + z)]
    three = ((2 - limit) * n + (limit - 1)) / (2 * limit - 1)
    conditions = [part[:, None] for part in alone + lacking]
    return numpy.select(conditions, [numpy.broadcast_to(row, n.shape) for row in numpy.eye(3)] + two, three)


def look_up(texels, points, normals, blend):
    """n x channels of an images.Texels at points with normals, both n x 3, in the object's space."""
    points, normals = numpy.broadcast_arrays(points, normals)
    share = weights(normals, min(max(blend, 0.0), 1.0))
    x, y, z = points.T
    sides = ((numpy.where(normals[:, 0] < 0, 1 - y, y), z), (numpy.where(normals[:, 1] > 0, 1 - x, x), z),
             (numpy.where(normals[:, 2] > 0, 1 - y, y), x))
    return sum(numpy.maximum(share[:, i:i + 1], 0) * texels.at(u, v) for i, (u, v) in enumerate(sides))
