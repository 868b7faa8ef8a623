"""backdrop.py: what the camera sees behind everything, where it is not what lights: worlds that ask for camera rays or hide from them.

velo has one light for all rays. So such a scene is rendered with a transparent background, and the backdrop is laid behind it."""
import numpy

from . import evaluate, links, world


class Backdrop:
    """known: a Blender world; hidden: the camera does not see it. colors(directions) -> n x 3."""

    def __init__(self, known, hidden, notes):
        self._world, self._hidden, self._notes = known, hidden, notes
        self._camera, self._images = None, {}  # of the last call of behind; by place and size

    def colors(self, directions):
        if self._hidden:
            return numpy.zeros_like(directions)
        try:
            return world.seen_by_camera(self._world, directions, self._notes)
        except (evaluate.Unsupported, links.Cyclic) as error:
            self._notes.add(self._world.name, "Light Path", "%s; the camera sees black" % error)
            return numpy.zeros_like(directions)

    def behind(self, image, camera, corner):
        """An image, height x width x 4 with alpha multiplied in, laid over the backdrop. corner: x, y of its first pixel in the camera's
        image."""
        if self._camera is not camera:
            self._camera, self._images = camera, {}
        key = corner, image.shape
        if key not in self._images:
            self._images[key] = self._image(camera, corner, image.shape)
        result = image.copy()
        result[..., :3] += (1 - numpy.clip(image[..., 3:], 0, 1)) * self._images[key]
        return result

    def _image(self, camera, corner, shape):
        height, width = shape[:2]
        y, x = numpy.meshgrid(corner[1] + numpy.arange(height) + 0.5, corner[0] + numpy.arange(width) + 0.5, indexing="ij")
        rays = camera.unproject(numpy.stack((x.ravel(), y.ravel()), axis=1))
        directions = numpy.nan_to_num(numpy.asarray(rays.directions, dtype=float).reshape(-1, 3))
        lengths = numpy.maximum(numpy.linalg.norm(directions, axis=1, keepdims=True), 1e-30)
        colors = numpy.where(numpy.asarray(rays.valid).reshape(-1, 1), self.colors(directions / lengths), 0)
        return colors.reshape(height, width, 3).astype(numpy.float32)


def of(depsgraph, notes):
    """The backdrop of a scene; None: the camera sees what lights, or the film is transparent."""
    known = depsgraph.scene.world
    if known is None or depsgraph.scene.render.film_transparent or not depsgraph.view_layer.use_sky:
        return None
    if not getattr(getattr(known, "cycles_visibility", None), "camera", True):
        return Backdrop(known, True, notes)
    if known.use_nodes and known.node_tree is not None and _asks(known.node_tree, ()):
        return Backdrop(known, False, notes)
    return None


def _asks(tree, seen):
    """Whether a tree of nodes asks for camera rays."""
    for node in tree.nodes:
        if node.type == "LIGHT_PATH" and node.outputs["Is Camera Ray"].is_linked:
            return True
        if node.type == "GROUP" and node.node_tree is not None and node.node_tree not in seen:
            if _asks(node.node_tree, seen + (node.node_tree,)):
                return True
    return False
