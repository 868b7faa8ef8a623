"""export.py: the evaluated depsgraph as a velo scene."""
from typing import Any, NamedTuple

import numpy
import velo

from . import atlas, camera, geometry, lights, materials, textures, world
from .report import Notes, Refused

MESHES = {"MESH", "CURVE", "SURFACE", "FONT", "META"}


class Placed(NamedTuple):
    """An instance or a shape of the world, in the order of velo's ids."""
    name: str
    pass_index: int


class Part(NamedTuple):
    """The triangles of one material slot of a mesh, ready to be placed."""
    words: dict
    surface: Any
    material: Any


class Prepared(NamedTuple):
    """A mesh in velo: its parts that do not emit are in a group."""
    group: Any
    parts: list
    emissive: list


class Export:
    """A velo scene made from a depsgraph. Members: scene (velo.Scene), notes, camera (velo.Camera), size, materials: {velo's name of a
    material: Blender's}, objects: names by velo's object ids, instances: list of Placed by velo's instance ids."""

    def __init__(self, depsgraph, size, camera_object=None, cancelled=None):
        self.depsgraph, self.size = depsgraph, size
        self.notes = Notes()
        self.scene = velo.Scene()
        self.instances, self.shapes = [], []
        self._meshes, self._surfaces, self._cache = {}, {}, {}
        self._cancelled = cancelled or (lambda: False)
        self._settings = depsgraph.scene.velo
        item = camera_object or depsgraph.scene.camera
        if item is None:
            raise Refused("the scene has no camera")
        self.camera = camera.convert(depsgraph.scene, item.evaluated_get(depsgraph), depsgraph, size)
        self.scene.camera = self.camera
        world.add(self.scene, depsgraph.scene.world, self.notes)
        self._read_objects()

    # ---- objects

    def _read_objects(self):
        for instance in self.depsgraph.object_instances:
            if self._cancelled():
                raise Cancelled()
            item = instance.object
            if not instance.show_self or item.type in ("CAMERA", "EMPTY", "ARMATURE", "LATTICE", "SPEAKER", "LIGHT_PROBE"):
                continue
            matrix = numpy.array(instance.matrix_world, dtype=float)
            if not numpy.isfinite(matrix).all():
                self.notes.add(item.name, "", "its place is no number (NaN or infinite); it is left out")
            elif item.type == "LIGHT":
                lights.add(self.scene, item, instance.matrix_world, self._camera_sees, self.notes)
            elif item.type in MESHES:
                self._place(item, matrix)
            elif item.type != "GPENCIL":
                self.notes.add(item.name, "", "objects of type %s are not rendered" % item.type.lower())

    def _camera_sees(self, points):
        """Whether some point of a box may be in the image: the box of its film points, a tenth wider."""
        pixels, _, valid = self.camera.project(points)
        if not valid.any():
            return False
        if not valid.all():
            return True
        low, high = pixels.min(axis=0), pixels.max(axis=0)
        margin = 0.1 * numpy.array(self.size)
        return bool((high > -margin).all() and (low < numpy.array(self.size) + margin).all())

    def _place(self, item, matrix):
        if abs(numpy.linalg.det(matrix[:3, :3])) < 1e-30:
            self.notes.add(item.name, "", "it is scaled to nothing and left out")
            return
        prepared = self._prepared(item)
        if prepared is None:
            return
        if prepared.group is not None:
            self.scene.add_instance(prepared.group, matrix)
            self.instances.append(Placed(item.name, item.pass_index))
        for part in prepared.emissive:
            self._add_shape(part, pose=matrix, name=item.name)

    def _add_shape(self, part, **words):
        surface = part.surface
        if surface.alpha is not None:
            words["alpha"] = surface.alpha
        if surface.emission is not None:
            words["emission"] = surface.emission
        self.scene.add_shape("triangles", material=surface.material, **part.words, **words)
        self.shapes.append(words.get("name", ""))

    # ---- meshes

    def _prepared(self, item):
        """The mesh of an object in velo, made once for all objects that share it and its materials; None: it has no faces."""
        slots = [slot.material for slot in item.material_slots] or [None]
        data = item.data if item.type == "MESH" else item
        key = (data.as_pointer(), tuple(None if material is None else material.name_full for material in slots))
        if key not in self._meshes:
            self._meshes[key] = self._make(item, slots)
        return self._meshes[key]

    def _make(self, item, slots):
        mesh = item.to_mesh()
        try:
            arrays = geometry.read(mesh)
            if arrays is None:
                return None
            if not arrays.is_finite():
                self.notes.add(item.name, "", "its vertices are no numbers (NaN or infinite); it is left out")
                return None
            parts = self._parts(item, arrays, slots)
        finally:
            item.to_mesh_clear()
        plain = [part for part in parts if part.surface.emission is None]
        group = self.scene.add_group(item.name) if plain else None
        for part in plain:
            self._add_shape(part, group=group, name=item.name)
        return Prepared(group, parts, [part for part in parts if part.surface.emission is not None])

    def _parts(self, item, arrays, slots):
        maps = textures.Maps(arrays)
        if len(maps.names) > 4:
            self.notes.add(item.name, "", "of its %d uv maps the first 4 are rendered" % len(maps.names))
        parts = []
        for slot in numpy.unique(arrays.slots):
            material = slots[slot] if 0 <= slot < len(slots) else slots[-1]
            corners = atlas.Corners(arrays, slot, item, maps.names[:4], arrays.texture_space)
            surface = self._surface(material, maps, corners)
            parts.append(Part(self._arrays_of(arrays, slot, maps, surface), surface, material))
        return parts

    def _surface(self, material, maps, corners):
        key = (None if material is None else material.name_full, maps.key())
        if key not in self._surfaces:
            owner = "default" if material is None else material.name
            inputs = textures.Inputs(self.scene, self.notes, owner, maps, self._cache, self._settings.bake_size, corners)
            surface = materials.convert(material, inputs)
            if surface.atlas is not None:
                return surface  # of this mesh alone
            self._surfaces[key] = surface
        return self._surfaces[key]

    def _arrays_of(self, arrays, slot, maps, surface):
        """Keywords of velo's triangles for one slot."""
        triangles, used = arrays.part(slot)
        if surface.atlas is not None:  # each triangle has corners of its own
            used = arrays.triangles[arrays.slots == slot].ravel()
            triangles = numpy.arange(len(used), dtype=numpy.int32).reshape(-1, 3)
        pick = (lambda array: array) if used is None else (lambda array: array[used])
        words = {"positions": pick(arrays.positions), "indices": triangles}
        if arrays.normals is not None:
            words["normals"] = geometry.clean_normals(pick(arrays.normals))
        uvs = [numpy.nan_to_num(pick(arrays.uvs[name])) for name in maps.names[:4]]
        if surface.atlas is not None:
            uvs = uvs[:3] + [surface.atlas.uvs.reshape(-1, 2)]
        for number, values in enumerate(uvs):
            words["uvs_%d" % number if number else "uvs"] = values
        if surface.color_attribute is not None:
            colors = arrays.colors(surface.color_attribute)
            if colors is not None:
                words["colors"] = numpy.clip(numpy.nan_to_num(pick(colors)), 0, None)
        return words


class Cancelled(Exception):
    """The user ended the export."""


__all__ = ["Cancelled", "Export", "Refused"]
