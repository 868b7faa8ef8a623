"""panes.py: surfaces of glass that are open, such as a plane in a window. Light that enters one never leaves it: its radiance would stay
that of glass, divided by the square of the index of refraction (Veach 1997, 5.2), which Cycles leaves out. They become thin panes."""
import numpy

from . import versions

MIN_FLATNESS = 0.25  # of the sum of an open surface's normals by area to its area; a bottle with a small hole is a solid
MAX_STEPS = 10000  # of the search for connected triangles


def refracts(material):
    """Whether a material has glass."""
    if material is None or not material.use_nodes or material.node_tree is None:
        return False
    return _tree_refracts(material.node_tree, ())


def _tree_refracts(tree, seen):
    for node in tree.nodes:
        if node.type in ("BSDF_GLASS", "BSDF_REFRACTION"):
            return True
        if node.type == "BSDF_PRINCIPLED":
            socket = versions.principled_socket(node, "transmission")
            if socket is not None and (socket.is_linked or socket.default_value > 0):
                return True
        if node.type == "GROUP" and node.node_tree is not None and node.node_tree not in seen:
            if _tree_refracts(node.node_tree, seen + (node.node_tree,)):
                return True
    return False


def is_open(positions, triangles, mine):
    """Whether most of the area of some triangles is of open surfaces. positions: n x 3; triangles: m x 3; mine: m, True for those."""
    _, number = numpy.unique(positions, axis=0, return_inverse=True)
    corners = number.ravel()[triangles].astype(numpy.int64)
    edges = numpy.sort(numpy.stack((corners, numpy.roll(corners, -1, axis=1)), axis=2), axis=2).reshape(-1, 2)
    keys = edges[:, 0] * (int(corners.max()) + 1) + edges[:, 1]
    _, edge, uses = numpy.unique(keys, return_inverse=True, return_counts=True)
    bare = (uses[edge.ravel()] == 1).reshape(-1, 3).any(axis=1)
    if not bare[mine].any():
        return False
    island = _islands(corners)
    points = positions[triangles].astype(float)
    normals = 0.5 * numpy.cross(points[:, 1] - points[:, 0], points[:, 2] - points[:, 0])
    areas = numpy.linalg.norm(normals, axis=1)
    count = int(island.max()) + 1
    total = numpy.stack([numpy.bincount(island, normals[:, k], count) for k in range(3)], axis=1)
    flat = numpy.linalg.norm(total, axis=1) > MIN_FLATNESS * numpy.bincount(island, areas, count)
    opened = flat & (numpy.bincount(island, bare, count) > 0)
    return bool(areas[mine & opened[island]].sum() > 0.5 * areas[mine].sum())


def _islands(corners):
    """The number of the connected surface of each triangle: the lowest vertex spreads, by halves of the paths to it."""
    least = numpy.arange(int(corners.max()) + 1)
    for _ in range(MAX_STEPS):
        low = least[corners].min(axis=1)
        wanted = least.copy()
        numpy.minimum.at(wanted, corners.ravel(), numpy.repeat(low, 3))
        numpy.minimum.at(wanted, least, wanted)
        wanted = wanted[wanted]
        if numpy.array_equal(wanted, least):
            break
        least = wanted
    return numpy.unique(least[corners[:, 0]], return_inverse=True)[1].ravel()
