"""evaluate.py: values of nodes at many points at once, by numpy: constants, baked textures, the world's image.

A value is an array of n, a colour or a vector one of n x 3; n is 1 for what is the same everywhere. The functions of single nodes are
in node_values.py; each is asked for an output by its name."""
import numpy

from . import links, node_values

MAX_DEPTH = 200  # of nodes that feed each other
LUMINANCE = numpy.array([0.2126, 0.7152, 0.0722])  # Rec. 709, as Blender turns a colour into a value


class Unsupported(Exception):
    """A node that cannot be evaluated here; its text says which and why. is_missing: it has no image."""

    def __init__(self, node, text, is_missing=False):
        super().__init__(text)
        self.node, self.text, self.is_missing = node, text, is_missing


def as_value(array):
    return array if array.ndim == 1 else array @ LUMINANCE if array.shape[1] == 3 else array[:, 0]


def as_vector(array):
    return array if array.ndim == 2 else numpy.repeat(array[:, None], 3, axis=1)


def convert(array, source_type, wanted_type):
    """Blender's conversion between the types of sockets."""
    if wanted_type in ("VALUE", "INT", "BOOLEAN"):
        if array.ndim == 2:
            return array @ LUMINANCE if source_type == "RGBA" else array.mean(axis=1)
        return array
    return as_vector(array)


def default_of(socket):
    """The value of a socket that is not linked."""
    value = getattr(socket, "default_value", None)
    if value is None:
        return numpy.zeros(1)
    if isinstance(value, (int, float, bool)):
        return numpy.array([float(value)])
    return numpy.array([[float(x) for x in value][:3]])


class Evaluator:
    """Values at points. fields: what is known of the points, by name: "uv:NAME" (NAME empty: the active map) n x 2, "generated",
    "object", "position", "normal", "direction" n x 3. What is missing makes nodes Unsupported. textures: a function that gives an
    images.Texels for an image node. note: a function (node, text) that hears what a value leaves out."""

    def __init__(self, fields, textures, note=None):
        self.fields = fields
        self.textures = textures
        self.note = note or (lambda node, text: None)
        self._depth = 0

    def input(self, socket, groups=()):
        """The value of an input socket."""
        source, socket_here = links.follow(socket, groups)
        if source is None:
            value = default_of(socket_here)
            if not numpy.isfinite(value).all():
                self.note(socket_here.node, "%s is no finite number; it is 0" % socket_here.name)
                value = numpy.where(numpy.isfinite(value), value, 0.0)
            return convert(value, socket_here.type, socket.type)
        array = self.output(source)
        return convert(array, source.socket.type, socket.type)

    def named(self, node, name, groups):
        """The value of a node's input by its name or identifier."""
        for socket in node.inputs:
            if socket.enabled and (socket.name == name or socket.identifier == name):
                return self.input(socket, groups)
        socket = node.inputs.get(name)
        return numpy.zeros(1) if socket is None else self.input(socket, groups)

    def output(self, source):
        function = node_values.NODES.get(source.node.type)
        if function is None:
            raise Unsupported(source.node, "velo cannot evaluate this node")
        self._depth += 1
        if self._depth > MAX_DEPTH:
            self._depth = 0
            raise links.Cyclic(links.TOO_DEEP)
        try:
            array = function(self, source.node, source.socket, source.groups)
        except ArithmeticError:
            raise Unsupported(source.node, "its numbers cannot be computed") from None
        finally:
            self._depth = max(0, self._depth - 1)
        return numpy.nan_to_num(numpy.asarray(array, dtype=float), nan=0.0, posinf=1e30, neginf=-1e30)

    def field(self, name, node):
        """What is known of the points."""
        if name not in self.fields:
            what = "uv map %s" % name[3:] if name.startswith("uv:") and name != "uv:" else name.rstrip(":")
            raise Unsupported(node, "it depends on %s, which is not known here" % what)
        return self.fields[name]


def constant(socket, groups=(), fields=None, note=None):
    """The value of a socket as a float or three floats where it is the same everywhere; None: it is not. fields, note: as for
    Evaluator."""
    try:
        array = Evaluator(fields or {}, _no_textures, note).input(socket, groups)
    except Unsupported:
        return None
    if len(array) != 1:
        return None
    return float(array[0]) if array.ndim == 1 else tuple(float(x) for x in array[0])


def _no_textures(node):
    raise Unsupported(node, "it is an image")
