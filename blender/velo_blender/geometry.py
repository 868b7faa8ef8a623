"""geometry.py: evaluated meshes as arrays, by buffers."""
import copy

import bpy
import numpy

from . import versions

MESHES = {"MESH", "CURVE", "SURFACE", "FONT", "META"}


def _read(collection, name, width, dtype):
    """A property of all elements: n x width, or n."""
    values = numpy.empty(len(collection) * width, dtype=dtype)
    collection.foreach_get(name, values)
    return values.reshape(-1, width) if width > 1 else values


#: Kinds of generic attributes: (member of their elements, numbers of each).
_GENERIC = {"FLOAT": ("value", 1), "INT": ("value", 1), "INT8": ("value", 1), "BOOLEAN": ("value", 1), "FLOAT2": ("vector", 2),
            "FLOAT_VECTOR": ("vector", 3), "FLOAT_COLOR": ("color", 4), "BYTE_COLOR": ("color", 4)}


def _is_generic(attribute, color_names):
    """Whether a shader may read an attribute that is no colour attribute; Cycles has none of edges."""
    return attribute.data_type in _GENERIC and attribute.domain in ("POINT", "FACE", "CORNER") and attribute.name not in color_names


class MeshArrays:
    """The arrays of a mesh, float32 and int32. Vertices are the mesh's vertices or, where uvs, colours or normals differ between the
    corners of one vertex, its corners.

    positions, normals: n x 3, in the object's space; normals may be None (flat). triangles: m x 3. slots: m, the material's slot.
    displaced: whether vertices were moved by a material. uvs: {name: n x 2}. smooth: m, whether a triangle is shaded smoothly."""

    def __init__(self, mesh, go_on):
        mesh.calc_loop_triangles()
        go_on()
        points = _read(mesh.vertices, "co", 3, numpy.float32)
        corners = _read(mesh.loops, "vertex_index", 1, numpy.int32)
        self.slots = _read(mesh.loop_triangles, "material_index", 1, numpy.int32)
        smooth = _read(mesh.polygons, "use_smooth", 1, bool)
        self.by_corner = bool(len(mesh.uv_layers) or len(mesh.color_attributes) or versions.splits_normals(mesh) or
                              (smooth.any() and not smooth.all()))
        of_triangles = "loops" if self.by_corner else "vertices"
        go_on()
        self.triangles = _read(mesh.loop_triangles, of_triangles, 3, numpy.int32)
        self.corners = corners
        self.positions = points[corners] if self.by_corner else points
        go_on()
        self.normals = self._normals(mesh, smooth, points) if smooth.any() else None
        go_on()
        self.uv_names = [layer.name for layer in mesh.uv_layers]
        self.render_uv = next((layer.name for layer in mesh.uv_layers if layer.active_render), None)
        self.uvs = {layer.name: _read(layer.data, "uv", 2, numpy.float32) for layer in mesh.uv_layers}
        self.color_names = [attribute.name for attribute in mesh.color_attributes]
        self.attribute_names = [attribute.name for attribute in mesh.attributes if _is_generic(attribute, self.color_names)]
        low, size = numpy.array(mesh.texspace_location), numpy.array(mesh.texspace_size)
        self.texture_space = low - size, 2 * size  # corner and size of the box of generated coordinates
        self.displaced = False
        self._mesh, self._has_faces = mesh, True

    def of(self, mesh):
        """The same arrays for a copy of the mesh, from which what else is asked for is read."""
        other = copy.copy(self)
        other._mesh, other._has_faces = mesh, False
        return other

    def _faces(self):
        """Blender's triangles of the mesh."""
        if not self._has_faces:
            self._mesh.calc_loop_triangles()
            self._has_faces = True
        return self._mesh.loop_triangles

    def _normals(self, mesh, smooth, points):
        if not self.by_corner:
            return _read(mesh.vertices, "normal", 3, numpy.float32)
        versions.prepare_normals(mesh)
        collection, name = versions.corner_normals(mesh)
        return _read(collection, name, 3, numpy.float32)

    def colors(self, name):
        """The colours of an attribute, n x 4, linear; an empty name is the one that is rendered; None: there is none."""
        attributes = self._mesh.color_attributes
        if len(attributes) == 0:
            return None
        index = attributes.render_color_index
        attribute = attributes.get(name) if name else attributes[index if 0 <= index < len(attributes) else 0]
        if attribute is None:
            return None
        colors = _read(attribute.data, "color", 4, numpy.float32)
        return colors[self.corners] if attribute.domain == "POINT" else colors

    def attribute(self, name, slot):
        """The values of a generic attribute at the corners of a slot's triangles, m x 3 x n, n 1, 2, 3 or 4 (a colour, linear)."""
        attribute = self._mesh.attributes[name]
        member, width = _GENERIC[attribute.data_type]
        values = _read(attribute.data, member, width, numpy.float32 if width > 1 or attribute.data_type == "FLOAT" else numpy.int32)
        mine = self.slots == slot
        if attribute.domain == "FACE":
            faces = _read(self._faces(), "polygon_index", 1, numpy.int32)[mine]
            rows = numpy.repeat(faces[:, None], 3, axis=1)
        elif attribute.domain == "CORNER":
            rows = _read(self._faces(), "loops", 3, numpy.int32)[mine]
        else:
            rows = self.vertex_of(self.triangles[mine])
        return values[rows].reshape(len(rows), 3, -1).astype(float)

    def radial_tangents(self, axis):
        """Directions about an axis, X, Y or Z, through the middle of the texture space, n x 3: Cycles' tangents where none are given."""
        low, size = self.texture_space
        x, y, z = ((self.positions - low) / numpy.where(size == 0, 1, size) - 0.5).T
        none = numpy.zeros_like(x)
        around = {"X": (none, -z, y), "Y": (-z, none, x), "Z": (-y, x, none)}[axis]
        return numpy.stack(around, axis=1).astype(numpy.float32)

    def vertex_of(self, rows):
        """The mesh's vertices of rows of positions."""
        return self.corners[rows] if self.by_corner else rows

    def vertex_normals(self):
        """The normals of the mesh's vertices."""
        return _read(self._mesh.vertices, "normal", 3, numpy.float32).astype(float)

    def move(self, vertices, offsets):
        """Moves vertices of the mesh, n, by offsets, n x 3. Smooth normals become those of the moved surface."""
        change = numpy.zeros((len(self._mesh.vertices), 3), dtype=numpy.float32)
        change[vertices] = offsets
        every = self.corners if self.by_corner else slice(None)
        self.positions = self.positions + change[every]
        if self.normals is not None:
            self._smooth_again(len(change))

    def _smooth_again(self, count):
        corners = self.positions[self.triangles].astype(float)
        flat = numpy.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
        total = numpy.zeros((count, 3))
        for k in range(3):
            numpy.add.at(total, self.vertex_of(self.triangles[:, k]), flat)
        normals = total[self.corners] if self.by_corner else total
        if self.by_corner:
            sharp = ~_read(self._faces(), "use_smooth", 1, bool)
            normals[self.triangles[sharp].ravel()] = numpy.repeat(flat[sharp], 3, axis=0)
        lengths = numpy.linalg.norm(normals, axis=1, keepdims=True)
        self.normals = (normals / numpy.maximum(lengths, 1e-30)).astype(numpy.float32)

    def part(self, slot):
        """The triangles of a slot and the vertices that they use: (triangles, used); used: None for all vertices."""
        mine = self.slots == slot
        if mine.all():
            return self.triangles, None
        used, triangles = numpy.unique(self.triangles[mine], return_inverse=True)
        return triangles.reshape(-1, 3).astype(numpy.int32), used

    def is_like(self, other):
        """Whether another mesh has the same triangles."""
        return len(self.positions) == len(other.positions) and numpy.array_equal(self.triangles, other.triangles)

    def is_finite(self):
        return bool(numpy.isfinite(self.positions).all())


def read(mesh, go_on=lambda: None):
    """The arrays of an evaluated mesh; None: it has no faces. go_on is called between steps that may take long; its exception ends them."""
    if mesh is None or len(mesh.polygons) == 0:
        return None
    return MeshArrays(mesh, go_on)


def data_of(item):
    """What says of evaluated objects, by its pointer, that they share a mesh: that of a mesh object; else the object itself."""
    return item.data if item.type == "MESH" else item


class Known:
    """The arrays of the meshes that a view has read, for its next export. last: the Known of the export before, or None."""

    def __init__(self, last=None):
        self._last, self._arrays = {} if last is None else last._arrays, {}

    def read(self, item, mesh, go_on):
        """As read, of an evaluated object whose mesh this is."""
        if mesh is None:
            return None
        key = item.name_full, data_of(item).as_pointer(), len(mesh.vertices), len(mesh.loops), len(mesh.polygons)
        arrays = self._last.get(key)
        arrays = read(mesh, go_on) if arrays is None else arrays.of(mesh)
        if arrays is not None:
            self._arrays[key] = arrays.of(None)
        return arrays


def has_changed(depsgraph):
    """Whether the shape of something has changed since the last evaluation. Blender says so of lamps whose power changes, too."""
    return any(update.is_updated_geometry and not _is_shapeless(update.id) for update in depsgraph.updates)


def _is_shapeless(item):
    if isinstance(item, bpy.types.Object):
        return item.type in ("LIGHT", "CAMERA")
    return isinstance(item, (bpy.types.Light, bpy.types.Camera))


def of_object(item):
    """The arrays of an evaluated object's mesh; None: it has no faces. Colours are not to be read from them."""
    mesh = item.to_mesh()
    try:
        return read(mesh)
    finally:
        item.to_mesh_clear()


def bounds(points):
    """(lowest, highest) numbers of each column of points, n x k; column by column, which takes a fifth of the time of min(axis=0)."""
    columns = points.T
    return numpy.array([column.min() for column in columns]), numpy.array([column.max() for column in columns])


def clean_normals(normals):
    """Normals of length 1; those that are 0 or no numbers point up."""
    lengths = numpy.linalg.norm(normals, axis=1)
    good = numpy.isfinite(lengths) & (lengths > 1e-12)
    if good.all():
        return normals
    normals = normals.copy()
    normals[~good] = (0, 0, 1)
    return normals
