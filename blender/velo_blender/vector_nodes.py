"""vector_nodes.py: nodes that turn vectors: vector rotate, vector transform, normal."""
import numpy

from .math_nodes import column, unit


def _unsupported(node, text):
    from .evaluate import Unsupported
    return Unsupported(node, text)


def euler_matrix(euler):
    """Rotation about x, then y, then z, radians, 3 x 3."""
    (cx, cy, cz), (sx, sy, sz) = numpy.cos(euler), numpy.sin(euler)
    return numpy.array([[cy * cz, sy * sx * cz - cx * sz, sy * cx * cz + sx * sz],
                        [cy * sz, sy * sx * sz + cx * cz, sy * cx * sz - sx * cz], [-sy, cy * sx, cy * cx]])


def _about(vector, axis, angle):
    """Vectors turned about an axis, which may be 0: then they stay (Rodrigues)."""
    vector, axis = numpy.broadcast_arrays(vector, unit(axis))
    cosine, sine = column(numpy.cos(angle)), column(numpy.sin(angle))
    along = axis * (axis * vector).sum(axis=1, keepdims=True)
    turned = along + (vector - along) * cosine + numpy.cross(axis, vector) * sine
    return numpy.where((axis == 0).all(axis=1, keepdims=True), vector, turned)


def rotate(e, node, output, groups):
    vector, center = e.named(node, "Vector", groups), e.named(node, "Center", groups)
    kind = node.rotation_type
    if kind == "EULER_XYZ":
        euler = e.named(node, "Rotation", groups)
        if len(euler) != 1:
            raise _unsupported(node, "a rotation that varies")
        matrix = euler_matrix(euler[0])
        return (vector - center) @ (matrix if node.invert else matrix.T) + center
    angle = e.named(node, "Angle", groups)
    axes = {"X_AXIS": (1.0, 0, 0), "Y_AXIS": (0, 1.0, 0), "Z_AXIS": (0, 0, 1.0)}
    axis = numpy.array([axes[kind]]) if kind in axes else e.named(node, "Axis", groups)
    return _about(vector - center, axis, -angle if node.invert else angle) + center


def transform(e, node, output, groups):
    """Between the spaces of the object and the world."""
    vector = e.named(node, "Vector", groups)
    spaces = node.convert_from, node.convert_to
    if "CAMERA" in spaces and spaces[0] != spaces[1]:
        raise _unsupported(node, "the camera's space")
    if spaces[0] != spaces[1]:
        world = e.field("matrix", node)
        matrix = world if spaces[0] == "OBJECT" else numpy.linalg.pinv(world)
        if node.vector_type == "NORMAL":
            vector = vector @ numpy.linalg.pinv(matrix[:3, :3])
        else:
            vector = vector @ matrix[:3, :3].T + (matrix[:3, 3] if node.vector_type == "POINT" else 0.0)
    return unit(vector) if node.vector_type == "NORMAL" else vector


def normal(e, node, output, groups):
    """A direction, or its dot product with the vector's."""
    direction = unit(numpy.array([[float(x) for x in node.outputs[0].default_value]]))
    if output.name == "Normal":
        return direction
    return (direction * unit(e.input(node.inputs[0], groups))).sum(axis=1)


NODES = {"VECTOR_ROTATE": rotate, "VECT_TRANSFORM": transform, "NORMAL": normal}
