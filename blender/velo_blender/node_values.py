"""node_values.py: the value of each kind of node; NODES maps the kind's name in Blender to a function (evaluator, node, output
socket, groups) -> array. Formulas are those of Cycles 3.4 (kernel/svm)."""
import math

import numpy

from . import box_projection, color_nodes, curve_nodes, facing, images, lamp_files, math_nodes, procedural, vector_nodes


def _unsupported(node, text):
    from .evaluate import Unsupported
    return Unsupported(node, text)


def vector_of(e, node, groups, default):
    """The vector at which a texture is looked up: its input, or Cycles' default."""
    socket = node.inputs.get("Vector")
    if socket is not None and socket.is_linked:
        return e.input(socket, groups)
    if default == "uv":
        return three(e.field("uv:", node))
    return e.field(default, node)


def three(uv):
    return numpy.concatenate([uv, numpy.zeros((len(uv), 1))], axis=1) if uv.shape[1] == 2 else uv


# ---- coordinates and attributes ----------------------------------------------------------------------------------------

def tex_coord(e, node, output, groups):
    if output.name == "UV":
        return three(e.field("uv:", node))
    if output.name == "Object" and node.object is not None:
        inverse = numpy.linalg.pinv(numpy.nan_to_num(numpy.array(node.object.matrix_world, dtype=float)))
        return e.field("world position", node) @ inverse[:3, :3].T + inverse[:3, 3]
    return e.field(output.name.lower(), node)


def uv_map(e, node, output, groups):
    if "uv:" + node.uv_map not in e.fields and "attribute:" + node.uv_map in e.fields:
        return _generic(e, node, node.uv_map)[:, :3]
    return three(e.field("uv:" + node.uv_map, node))


def geometry(e, node, output, groups):
    if output.name == "Backfacing":
        e.note(node, "back faces are as front faces")
        return numpy.zeros(1)
    return e.field("world " + output.name.lower(), node)


def object_info(e, node, output, groups):
    return e.field("object info " + output.name.lower(), node)


def vertex_color(e, node, output, groups):
    return _color_or_generic(e, node, output, node.layer_name)


def attribute(e, node, output, groups):
    if node.attribute_type != "GEOMETRY":
        value = e.fields.get("property:" + node.attribute_name)
        if value is None:
            raise _unsupported(node, "the object has no property %s of numbers" % node.attribute_name)
        return value
    if "uv:" + node.attribute_name in e.fields:
        return three(e.field("uv:" + node.attribute_name, node))
    return _color_or_generic(e, node, output, node.attribute_name)


def _color_or_generic(e, node, output, name):
    """The value of a colour attribute or of another one of the mesh, by its name."""
    if "color:" + name in e.fields:
        values = e.field("color:" + name, node)
    elif "attributes" in e.fields:
        values = _generic(e, node, name)
    else:
        raise _unsupported(node, "it depends on the attribute %s, which is not known here" % name)
    if output.name == "Alpha":
        return values[:, 3] if values.shape[1] > 3 else numpy.ones(len(values))
    return values[:, 0] if values.shape[1] == 1 else values[:, :3]


def _generic(e, node, name):
    """The values of a mesh's attribute, n x 1, 3 or 4; one that it does not have is 0, as in Cycles."""
    values = e.fields.get("attribute:" + name)
    if values is None:
        e.note(node, "the mesh has no attribute %s; it is 0" % name)
        return numpy.zeros((1, 1))
    return three(values)


def mapping(e, node, output, groups):
    vector = e.named(node, "Vector", groups)
    place, turn, scale = (e.named(node, name, groups) for name in ("Location", "Rotation", "Scale"))
    if any(len(part) != 1 for part in (turn,)):
        raise _unsupported(node, "a rotation that varies")
    matrix = vector_nodes.euler_matrix(turn[0])
    if node.vector_type == "TEXTURE":
        return ((vector - place) @ matrix) / numpy.where(scale == 0, numpy.inf, scale)
    if node.vector_type == "NORMAL":
        result = (vector / numpy.where(scale == 0, numpy.inf, scale)) @ matrix.T
        return result / numpy.maximum(numpy.linalg.norm(result, axis=1, keepdims=True), 1e-30)
    result = (vector * scale) @ matrix.T
    return result + place if node.vector_type == "POINT" else result


# ---- textures ------------------------------------------------------------------------------------------------------------

def image(e, node, output, groups):
    texels = e.textures(node)
    vector = vector_of(e, node, groups, "uv")
    if node.projection == "BOX":
        values = box_projection.look_up(texels, vector, e.field("normal", node), node.projection_blend)
        return values[:, 3] if output.name == "Alpha" else values[:, :3]
    if node.projection in ("SPHERE", "TUBE"):
        vector = _round(vector * 2 - 1, node.projection)
    values = texels.at(vector[:, 0], vector[:, 1])
    return values[:, 3] if output.name == "Alpha" else values[:, :3]


def _round(p, kind):
    """Cycles' map_to_sphere and map_to_tube."""
    length = numpy.linalg.norm(p if kind == "SPHERE" else p[:, :2], axis=1)
    u = numpy.where((p[:, 0] == 0) & (p[:, 1] == 0), 0, 0.5 * (1 - numpy.arctan2(p[:, 0], p[:, 1]) / math.pi))
    safe = numpy.maximum(length, 1e-30)
    v = 1 - numpy.arccos(numpy.clip(p[:, 2] / safe, -1, 1)) / math.pi if kind == "SPHERE" else (p[:, 2] + 1) / 2
    return numpy.stack((u, v, numpy.zeros_like(u)), axis=1)


def environment(e, node, output, groups):
    texels = e.textures(node)
    d = vector_of(e, node, groups, "world position" if "direction" not in e.fields else "direction")
    d = d / numpy.maximum(numpy.linalg.norm(d, axis=1, keepdims=True), 1e-30)
    if node.projection == "MIRROR_BALL":
        depth = numpy.sqrt(numpy.maximum(2 * (1 - d[:, 1]), 1e-30))
        u, v = 0.5 * (d[:, 0] / depth + 1), 0.5 * (d[:, 2] / depth + 1)
    else:
        u = -numpy.arctan2(d[:, 1], d[:, 0]) / (2 * math.pi) + 0.5
        v = numpy.arctan2(d[:, 2], numpy.hypot(d[:, 0], d[:, 1])) / math.pi + 0.5
    return texels.at(u, v)[:, :3]


def checker(e, node, output, groups):
    p = vector_of(e, node, groups, "generated") * math_nodes.column(e.named(node, "Scale", groups))
    cells = numpy.abs(numpy.floor((p + 0.000001) * 0.999999)).astype(numpy.int64) % 2
    first = (cells[:, 0] == cells[:, 1]) == (cells[:, 2] == 1)
    if output.name == "Fac":
        return first.astype(float)
    return numpy.where(first[:, None], e.named(node, "Color1", groups), e.named(node, "Color2", groups))


def gradient(e, node, output, groups):
    p = vector_of(e, node, groups, "generated")
    x, y = p[:, 0], p[:, 1]
    kind = node.gradient_type
    radius = numpy.maximum(0.999999 - numpy.linalg.norm(p, axis=1), 0)
    values = {"LINEAR": lambda: x, "QUADRATIC": lambda: numpy.maximum(x, 0)**2, "DIAGONAL": lambda: (x + y) / 2,
              "EASING": lambda: math_nodes.smooth(numpy.clip(x, 0, 1)), "RADIAL": lambda: numpy.arctan2(y, x) / (2 * math.pi) + 0.5,
              "QUADRATIC_SPHERE": lambda: radius**2, "SPHERICAL": lambda: radius}[kind]()
    values = numpy.clip(values, 0, 1)
    return values if output.name == "Fac" else numpy.repeat(values[:, None], 3, axis=1)


def ambient_occlusion(e, node, output, groups):
    e.note(node, "nothing is occluded")
    return numpy.ones(1) if output.name == "AO" else e.named(node, "Color", groups)


def light_falloff(e, node, output, groups):
    if output.name != "Quadratic":
        raise _unsupported(node, "a strength that does not fall with the square of the distance")
    if (e.named(node, "Smooth", groups) > 0).any():
        e.note(node, "the strength is not smoothed close to the lamp")
    return e.named(node, "Strength", groups)


NODES = {"LIGHT_FALLOFF": light_falloff, "TEX_COORD": tex_coord, "UVMAP": uv_map, "NEW_GEOMETRY": geometry, "ATTRIBUTE": attribute, "MAPPING": mapping,
         "OBJECT_INFO": object_info, "VERTEX_COLOR": vertex_color, "TEX_IMAGE": image, "TEX_ENVIRONMENT": environment,
         "TEX_CHECKER": checker, "TEX_GRADIENT": gradient, "AMBIENT_OCCLUSION": ambient_occlusion, **math_nodes.NODES, **color_nodes.NODES,
         **curve_nodes.NODES, **lamp_files.NODES, **vector_nodes.NODES, **facing.NODES, **procedural.NODES}
