"""lamp_nodes.py: the nodes of a lamp: its colour and strength, which may differ between directions (point and spot) or between places on
the lamp (area)."""
import numpy

from . import evaluate, links
from .look import Look


class Tint:
    """What a lamp's nodes multiply its power with. color: three numbers; None: it varies: then at() has it."""

    def __init__(self, color, source=None, look=None, note=None):
        self.color, self._source, self._look, self._note = color, source, look, note

    def at(self, fields):
        """The factor, n x 3, where fields are known, as for evaluate.Evaluator. Unsupported, links.Cyclic: it is not known."""
        e = evaluate.Evaluator(fields, self._look, self._note)
        node, groups = self._source.node, self._source.groups
        color = evaluate.as_vector(e.input(node.inputs["Color"], groups))
        strength = evaluate.as_value(e.input(node.inputs["Strength"], groups))
        return numpy.maximum(color, 0) * numpy.maximum(strength, 0)[:, None]

    def along(self, directions, world):
        """The factor, n x 3, for directions from the lamp in its space, n x 3. world: world from lamp, 3 x 3, without scale."""
        turned = directions @ world.T
        return numpy.broadcast_to(self.at({"normal": directions, "world normal": turned, "world true normal": turned,
                                           "world incoming": turned}), directions.shape)


PLAIN = Tint(numpy.ones(3))


def of(light, notes):
    """The Tint of a light's nodes."""
    if not light.use_nodes or light.node_tree is None:
        return PLAIN
    output = links.output_node(light.node_tree, "OUTPUT_LIGHT")
    source = links.follow(output.inputs["Surface"])[0] if output is not None else None
    if source is None or source.node.type != "EMISSION":
        notes.add(light.name, source.node.name if source else "", "the light's nodes are not an emission and are ignored")
        return PLAIN
    tint = Tint(None, source, Look(notes, "light"), lambda node, text: notes.add(light.name, node.name, text))
    where = _fields_of(light.type)
    try:
        found = tint.at({})
        return Tint(found[0]) if len(found) == 1 else tint
    except evaluate.Unsupported:
        pass
    try:
        tint.at({name: numpy.zeros((1, 3)) for name in where})
        return tint
    except evaluate.Unsupported as error:
        notes.add(light.name, error.node.name, "%s; the nodes of the light are ignored" % error.text)
        return PLAIN


def _fields_of(kind):
    """What nodes of a light of a kind may ask for."""
    if kind in ("POINT", "SPOT"):
        return "normal", "world normal", "world true normal", "world incoming"
    return ("world parametric",) if kind == "AREA" else ()
