"""look.py: the images of the nodes of a world or a lamp, for evaluate.Evaluator."""
from . import evaluate, images


class Look:
    """The texels of an image node; each image is read once while this lives. notes: report.Notes; what: of whose nodes, in messages."""

    def __init__(self, notes, what):
        self.notes, self.what = notes, what
        self.known = {}

    def __call__(self, node):
        why = images.problem(node.image)
        if why is not None:
            raise evaluate.Unsupported(node, why, is_missing=True)
        name = node.image.name_full
        if node.image.source == "TILED":
            raise evaluate.Unsupported(node, "a tiled image in a %s" % self.what)
        if name not in self.known:
            self.known[name] = images.pixels(node.image, self.notes)
        return images.Texels(self.known[name], getattr(node, "extension", "REPEAT"), node.interpolation == "Closest")
