"""world.py: Blender's world as velo's infinite light: one colour, or an image of what its nodes give in all directions."""
import math

import numpy
import velo

from . import evaluate, images, lights, links, sky, square
from .look import Look

MAX_SIDE = 2048  # of the octahedral image, pixels
PLAIN_SIDE = 512  # where no image asks for more


def _image_size(tree, seen=()):
    """The height of the largest image in a tree of nodes; 0: there is none."""
    best = 0
    for node in tree.nodes:
        if node.type in ("TEX_ENVIRONMENT", "TEX_IMAGE") and node.image is not None:
            best = max(best, node.image.size[1])
        if node.type == "GROUP" and node.node_tree is not None and node.node_tree not in seen:
            best = max(best, _image_size(node.node_tree, seen + (node.node_tree,)))
    return best


def _radiance(socket, groups, evaluator, notes, owner, depth=0):
    """The radiance of a shader socket in the evaluator's directions, n x 3."""
    source = links.follow(socket, groups)[0] if depth < 50 else None
    if source is None:
        return numpy.zeros((1, 3))
    node, inner = source.node, source.groups
    if node.type in ("BACKGROUND", "EMISSION"):
        color, strength = (evaluator.input(node.inputs[name], inner) for name in ("Color", "Strength"))
        return numpy.maximum(color, 0) * numpy.maximum(strength, 0)[:, None]
    if node.type == "MIX_SHADER":
        factor = evaluator.input(node.inputs[0], inner)[:, None]
        if len(factor) == 1 and (factor[0, 0] <= 0 or factor[0, 0] >= 1):
            return _radiance(node.inputs[1 if factor[0, 0] <= 0 else 2], inner, evaluator, notes, owner, depth + 1)
        first, second = (_radiance(node.inputs[i], inner, evaluator, notes, owner, depth + 1) for i in (1, 2))
        return first + numpy.clip(factor, 0, 1) * (second - first)
    if node.type == "ADD_SHADER":
        return sum(_radiance(node.inputs[i], inner, evaluator, notes, owner, depth + 1) for i in (0, 1))
    notes.add(owner, node.name, "velo has no such world shader; it is black")
    return numpy.zeros((1, 3))


def add(scene, world, notes, cancelled):
    """Adds the light of a world; nothing where it is black. cancelled(): whether the user has ended the export."""
    if world is None:
        return
    if not world.use_nodes or world.node_tree is None:
        _add_color(scene, numpy.array(world.color, dtype=float))
        return
    output = links.output_node(world.node_tree, "OUTPUT_WORLD")
    if output is None:
        return
    surface, look = output.inputs["Surface"], Look(notes, "world")
    try:
        try:
            values = _radiance(surface, (), _evaluator({}, look, notes, world), notes, world.name)
        except evaluate.Unsupported:
            values = None
        if values is not None and len(values) == 1:
            _add_color(scene, values[0])
            return
        _add_image(scene, world, surface, look, notes)
    except links.Cyclic as error:
        notes.add(world.name, "", "%s; it is black" % error)
    except evaluate.Unsupported as error:
        _add_sky(scene, world, error, notes, cancelled)


def _evaluator(fields, look, notes, world):
    return evaluate.Evaluator({**fields, "is world": numpy.ones(1)}, look, lambda node, text: notes.add(world.name, node.name, text))


def _add_color(scene, color):
    high = float(color.max())
    if numpy.isfinite(color).all() and high > 0:
        scene.add_light("infinite", color=tuple(float(x) / high for x in color), scale=high)


def _fields(directions):
    """What is known of directions, n x 3."""
    return {"direction": directions, "generated": directions, "object": directions, "normal": directions, "world position": directions,
            "world normal": directions, "world incoming": -directions}


def seen_by_camera(world, directions, notes):
    """The radiance that the camera sees in directions, n x 3, of a world with nodes. Unsupported, links.Cyclic: it is not known."""
    output = links.output_node(world.node_tree, "OUTPUT_WORLD")
    if output is None:
        return numpy.zeros_like(directions)
    fields = {**_fields(directions), "is camera": numpy.ones(1)}
    values = _radiance(output.inputs["Surface"], (), _evaluator(fields, Look(notes, "world"), notes, world), notes, world.name)
    return numpy.broadcast_to(values, directions.shape)


def _add_image(scene, world, surface, look, notes):
    height = _image_size(world.node_tree)
    side = PLAIN_SIDE if height == 0 else min(MAX_SIDE, max(64, int(1.5 * height)))
    values = _radiance(surface, (), _evaluator(_fields(square.directions(side)), look, notes, world), notes, world.name)
    _add_square(scene, numpy.broadcast_to(values, (side * side, 3)).reshape(side, side, 3))


def _add_square(scene, values):
    array = values.astype(numpy.float32)
    high = float(array.max())
    if high > 0 and math.isfinite(high):
        scene.add_light("infinite", image=velo.Image(numpy.ascontiguousarray(array), encoding="linear"), scale=1.0)


def _is_no_number(socket):
    """Whether a socket's own value counts and is NaN or infinite."""
    if socket.is_linked or socket.type not in ("VALUE", "RGBA", "VECTOR"):
        return False
    return not numpy.isfinite(evaluate.default_of(socket)).all()


def _add_sky(scene, world, error, notes, cancelled):
    """A world that is rendered by Cycles."""
    wrong = [socket for node in world.node_tree.nodes for socket in node.inputs if _is_no_number(socket)]
    for socket in wrong:
        notes.add(world.name, socket.node.name, "%s is no finite number; the world is black" % socket.name)
    if wrong:
        return
    if error.is_missing:
        notes.add(world.name, error.node.name, "%s; the world is black" % error.text)
        return
    try:
        made = sky.of(world, cancelled)
    except sky.Failed as reason:
        notes.add(world.name, error.node.name, "%s, and %s; the world is black" % (error.text, reason))
        return
    if not made.is_finite:
        notes.add(world.name, error.node.name, "radiance that is no finite number is 0")
    side = sky.WIDTH // 2
    directions = square.directions(side)
    texels = images.Texels(made.texels, "REPEAT")
    u = 0.5 - numpy.arctan2(directions[:, 1], directions[:, 0]) / (2 * math.pi)
    v = 0.5 + numpy.arctan2(directions[:, 2], numpy.hypot(directions[:, 0], directions[:, 1])) / math.pi
    # Not above the first or below the last row, which would be those of the other pole.
    edge = 0.5 / len(made.texels)
    _add_square(scene, numpy.maximum(texels.at(u, numpy.clip(v, edge, 1 - edge)), 0).reshape(side, side, 3))
    for axis, half, total in made.suns:
        if total.max() > 0:
            lights.add_disk(scene, axis, half, total)
