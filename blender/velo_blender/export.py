"""export.py: the evaluated depsgraph as a velo scene."""
from typing import Any, NamedTuple

import bpy
import numpy
import velo

from . import (atlas, backdrop, camera, camera_files, displace, fog, geometry, hair, ignored, lights, materials, motion, object_info, panes,
               points, textures, visibility, volumes, world)
from .report import Cancelled, Notes, Refused

FARTHEST = 1e12  # coordinates, scene units


class Part(NamedTuple):
    """The triangles of one material slot of a mesh, ready to be placed."""
    words: dict
    surface: Any
    material: Any
    corners: Any  # positions of the whole mesh, n x 3, and the part's triangles, m x 3; None: they are displaced
    slot: int


class Place(NamedTuple):
    """Where a mesh is and what its materials may ask of the object. matrix: world from object; known: object_info.fields; owner: what
    tells it from other objects that share the mesh, () where all are alike; seen: visibility.words_of."""
    matrix: Any
    known: dict
    owner: tuple
    seen: dict


class Prepared(NamedTuple):
    """A mesh in velo: its parts that do not emit are in a group. volumes: (positions, triangles, medium) of its parts with a medium."""
    group: Any
    parts: list
    emissive: list
    volumes: list = []


UNSEEN = {"CAMERA", "EMPTY", "ARMATURE", "LATTICE", "SPEAKER", "LIGHT_PROBE"}


class Placed(NamedTuple):
    """An object at its place. kind: its class in data sets; asset: the object at the top of its parents; key: motion.key_of."""
    name: str
    asset: str
    pass_index: int
    kind: str
    key: tuple
    matrix: Any
    look: tuple  # what else a render depends on and Blender may change without its mesh: names of materials, colour


class Export:
    """A velo scene made from a depsgraph. Members: scene (velo.Scene), notes, camera (velo.Camera), size; instances, shapes: a Placed for
    each of velo's ids 1, 2, ..., None for shapes of groups and lamps; prepared: a Prepared for each of the instances; triangles: {id of a shape: (positions and triangles of its whole
    mesh)}, where keep_triangles asks for them; material_indices: {name: pass index}. moves: motion.Motion, or None: everything is at
    rest. view: the camera, in place of the scene's. meshes: geometry.Known, which keeps the meshes' arrays, or None. backdrop:
    backdrop.Backdrop, or None."""

    def __init__(self, depsgraph, size, cancelled=None, moves=None, view=None, keep_triangles=False, meshes=None):
        self.depsgraph, self.size = depsgraph, size
        self.notes = Notes()
        self.scene = velo.Scene()
        self.instances, self.shapes, self.material_indices = [], [], {}
        self.prepared = []
        self.triangles = {}
        self._moves, self._keep_triangles = moves, keep_triangles
        self._known = meshes
        self._handles = {}  # {motion.key_of(instance): handle}
        self._keys = set()  # of all instances
        self._noted = set()  # names of objects
        self._seen = {}  # visibility.words_of of the instance that is read
        self._asked = False  # whether something depends on what the camera sees
        self._meshes, self._surfaces, self._cache = {}, {}, {}
        self._solids = []  # fog.Solid of each volume
        self._fog, self._air = None, None  # the world's volumes.Volume and its medium
        self._copies, self._varying = {}, {}  # objects of a mesh whose materials ask for the object; {material: whether it does}
        self._cancelled = cancelled or (lambda: False)
        self._settings = depsgraph.scene.velo
        self.camera = view if view is not None else camera_of(depsgraph, size)
        self.see(self.camera)
        self.backdrop = backdrop.of(depsgraph, self.notes)
        ignored.note_scene(depsgraph, self.notes)
        if depsgraph.view_layer.use_sky:
            world.add(self.scene, depsgraph.scene.world, self.notes, self._cancelled)
            self._add_fog(depsgraph.scene.world)
        self._read_objects()
        fog.note_overlaps(self._solids, self.notes)
        self.immerse(self.camera)

    def see(self, view, name=""):
        """Sets the camera that sees the scene. name: of the view of a stereo image; the camera moves as this one does."""
        self.camera = view
        poses = self._moves.cameras.get(name, ()) if self._moves is not None else ()
        if len(poses) > 1:
            self.camera = camera.moving(view, poses)
        self.scene.camera = self.camera
        self.immerse(self.camera)

    def immerse(self, view):
        """Puts the camera into the volume at its place."""
        eye = numpy.array(view.world_from_camera, dtype=float)[:3, 3]
        medium = fog.medium_at(eye, self._solids, self.notes, self._air)
        if medium != self.scene.camera_medium:
            self.scene.camera_medium = medium

    def _add_fog(self, known):
        if known is None:
            return
        inputs = textures.Inputs(self.scene, self.notes, known.name, textures.Maps(None), self._cache, self._settings.bake_size)
        self._fog = fog.of_world(known, inputs)
        self._air = None if self._fog is None else volumes.add_homogeneous(self._fog, inputs)

    # ---- objects

    def _go_on(self):
        """Called between steps that may take long: Cancelled where the user has ended the export."""
        if self._cancelled():
            raise Cancelled()

    def _read_objects(self):
        for instance in self.depsgraph.object_instances:
            self._go_on()
            item = instance.object
            if not (instance.show_self or instance.show_particles) or item.type in UNSEEN:
                continue
            if not instance.show_self and item.type not in geometry.MESHES:
                continue
            self._note_ignored(item)
            self._keys.add(motion.key_of(instance))
            self._seen = self._words_of(instance)
            matrix = numpy.array(instance.matrix_world, dtype=float)
            if not numpy.isfinite(matrix).all():
                self.notes.add(item.name, "", "its place is no number (NaN or infinite); it is left out")
            elif abs(matrix).max() > FARTHEST:
                self.notes.add(item.name, "", "it is too large or too far away; it is left out")
            elif item.type != "LIGHT" and abs(numpy.linalg.det(matrix[:3, :3])) < 1e-30:
                self.notes.add(item.name, "", "it is scaled to nothing and left out")
            elif item.type == "LIGHT":
                lights.add(self.scene, item, instance.matrix_world, self._camera_sees, self.notes)
                self.shapes += [None] * (len(self.scene.handles("shapes")) - len(self.shapes))
            elif item.type in geometry.MESHES:
                self._add_mesh(instance, _placed(instance, matrix))
            elif item.type == "POINTCLOUD":
                self._add_points(item, _placed(instance, matrix))
            elif item.type == "CURVES":
                self._add_hair(item, hair.of_curves(item.data), 0, _placed(instance, matrix), matrix)
            elif item.type == "VOLUME":
                self._add_volume(item, _placed(instance, matrix))
            elif item.type != "GPENCIL":
                self.notes.add(item.name, "", "objects of type %s are not rendered" % item.type.lower())

    def _add_mesh(self, instance, placed):
        """A mesh, and the hair that grows on it."""
        item, layer = instance.object, self.depsgraph.view_layer
        if layer.use_solid and instance.show_self:
            handle = self._place(instance, placed, self._moves.of(instance) if self._moves is not None else None)
            if handle is not None:
                self._handles[placed.key] = handle
        for system in item.particle_systems if layer.use_strand and instance.show_particles and not instance.is_instance else ():
            if system.settings.type == "HAIR" and system.settings.render_type == "PATH":
                self._add_hair(item, hair.of_particles(item, system), system.settings.material - 1, placed, numpy.eye(4))

    def _note_ignored(self, item):
        """Notes what an object has that velo does not, once for all its instances."""
        if item.name_full in self._noted:
            return
        self._noted.add(item.name_full)
        if item.type == "LIGHT":
            ignored.note_light(item, self.depsgraph.scene, self.notes)
        else:
            ignored.note_object(item, self.depsgraph.scene, self.notes)

    def _words_of(self, instance):
        """Keywords of the shapes of an instance: what the camera sees of them."""
        words = visibility.words_of(instance, self.depsgraph.view_layer)
        if "backdrop" in words:
            visibility.note_opaque_film(self.depsgraph.scene, instance.object.name, self.notes)
        return words

    def _slots_of(self, item):
        """The materials of an object's slots, at least one; those of the view layer's override where it has one."""
        override = self.depsgraph.view_layer.material_override
        slots = [slot.material for slot in item.material_slots] or [None]
        return slots if override is None else [override] * len(slots)

    def move(self, depsgraph):
        """Moves the instances whose place alone has changed. False: something else has changed, too; nothing is moved then."""
        moved = set()
        for update in depsgraph.updates:
            item = update.id
            if isinstance(item, bpy.types.Scene) and not update.is_updated_geometry and not update.is_updated_shading:
                continue
            if not isinstance(item, bpy.types.Object) or item.type != "MESH" or update.is_updated_geometry or update.is_updated_shading:
                return False
            moved.add(item.name_full)
        changes = []
        for instance in depsgraph.object_instances:
            if instance.object.name_full not in moved:
                continue
            handle = self._handles.get(motion.key_of(instance))
            matrix = numpy.array(instance.matrix_world, dtype=float)
            if handle is None or not numpy.isfinite(matrix).all() or abs(numpy.linalg.det(matrix[:3, :3])) < 1e-30:
                return False
            changes.append((handle, matrix))
        for handle, matrix in changes:
            self.scene.set(handle, transform=matrix)
        return True

    def follow(self, depsgraph):
        """For the next frame of an animation, with Blender's persistent data: moves the camera and the instances whose place alone has
        changed. False: something else has changed, too; nothing is moved then."""
        changed = _changed_objects(depsgraph)
        if changed is None or (self._asked and any(kind == "CAMERA" for kind in changed.values())):
            return False
        known = {placed.key: number for number, placed in enumerate(self.instances)}
        keys, changes = set(), []
        for instance in depsgraph.object_instances:
            if not instance.show_self or instance.object.type in UNSEEN:
                continue
            key = motion.key_of(instance)
            keys.add(key)
            if instance.object.name_full not in changed:
                continue
            matrix = numpy.array(instance.matrix_world, dtype=float)
            placed, handle = _placed(instance, matrix), self._handles.get(key)
            if handle is None or not numpy.isfinite(matrix).all() or abs(numpy.linalg.det(matrix[:3, :3])) < 1e-30:
                return False
            slots = self._slots_of(instance.object)
            if placed._replace(matrix=None) != self.instances[known[key]]._replace(matrix=None) or any(map(self._varies, slots)):
                return False
            changes.append((known[key], handle, placed))
        if keys != self._keys:
            return False
        self.depsgraph, self.camera = depsgraph, camera_of(depsgraph, self.size)
        self.scene.camera = self.camera
        self.immerse(self.camera)
        for number, handle, placed in changes:
            self.instances[number] = placed
            self.scene.set(handle, transform=placed.matrix)
        return True

    def _camera_sees(self, points):
        """Whether some point of a box may be in the image: the box of its film points, a tenth wider."""
        self._asked = True
        pixels, _, valid = self.camera.project(points)
        if not valid.any():
            return False
        if not valid.all():
            return True
        low, high = pixels.min(axis=0), pixels.max(axis=0)
        margin = 0.1 * numpy.array(self.size)
        return bool((high > -margin).all() and (low < numpy.array(self.size) + margin).all())

    def _place(self, instance, placed, poses):
        """Adds an object; returns the handle of its instance if that is all that it is and it is at rest."""
        item, matrix = instance.object, placed.matrix
        prepared = self._prepared(item, matrix, instance)
        if prepared is None:
            return None
        if any("tangents" in part.words for part in prepared.parts) and not _is_similar(matrix):
            self.notes.add(item.name, "Anisotropy", "its directions are scaled and sheared as the object is")
        handle = None
        if prepared.group is not None:
            if poses is None:
                handle = self.scene.add_instance(prepared.group, matrix)
            else:
                self.scene.add_instance(prepared.group, poses, times=motion.TIMES)
            self.instances.append(placed)
            self.prepared.append(prepared)
        self._solids += [fog.Solid(item.name, matrix, *volume) for volume in prepared.volumes]
        for part in prepared.emissive:
            if poses is not None:
                self.notes.add(item.name, "", "surfaces that emit are at rest")
            self._add_shape(part, placed, pose=matrix, name=item.name)
        alone = any(map(self._varies, self._slots_of(item)))  # its colours change with its place
        return None if prepared.emissive or prepared.volumes or alone else handle

    def _add_hair(self, item, strands, slot, placed, matrix):
        if strands is None:
            return
        positions, widths = hair.segments(*strands)
        if len(widths) == 0:
            return
        slots = self._slots_of(item)
        surface, words = self._bare_surface(item, slots[min(max(slot, 0), len(slots) - 1)], matrix, "hair")
        self.scene.add_shape("curves", positions=positions, widths=widths, curve="cylinder", material=surface.material, pose=matrix,
                             name=item.name, **words)
        self.shapes.append(placed)

    def _bare_surface(self, item, material, matrix, what):
        """(surface, keywords of the shape) of what has no uv maps and does not emit."""
        place = Place(matrix, object_info.fields(item, matrix, 0), (item.name_full,), self._seen)
        surface = self._surface(material, textures.Maps(None), None, place)
        if surface.emission is not None:
            self.notes.add(item.name, "", "%s does not emit" % what)
        if self._moves is not None:
            self.notes.add(item.name, "", "%s is at rest" % what)
        return surface, {**place.seen, **({} if surface.alpha is None else {"alpha": surface.alpha})}

    def _add_volume(self, item, placed):
        """The density of an OpenVDB file, inside of the box of its voxels."""
        place = Place(placed.matrix, object_info.fields(item, placed.matrix, 0), (item.name_full,), self._seen)
        inputs = self._inputs(self._slots_of(item)[0], textures.Maps(None), None, place)
        inputs.owner = item.name
        found = volumes.add_file(item.data, self._slots_of(item)[0], inputs, placed.matrix, self._fog)
        if found is None:
            return
        medium, pose, grid = found
        if self._moves is not None:
            self.notes.add(item.name, "", "a volume is at rest")
        box = self.scene.add_box(grid.low, grid.high, pose=pose, inside=medium, outside=self._air, material=self.scene.add_material("interface"),
                                 name=item.name, **place.seen)
        mesh = self.scene.mesh(box)
        self._solids.append(fog.Solid(item.name, pose, mesh.positions, mesh.indices, medium))
        self.shapes.append(placed)

    def _add_points(self, item, placed):
        matrix = placed.matrix
        centers, radii = points.read(item.data, self.notes, item.name)
        if len(radii) == 0:
            return
        slots = self._slots_of(item)
        surface, words = self._bare_surface(item, slots[0], matrix, "a point cloud")
        self.scene.add_shape("sphere", centers=centers, radii=radii, material=surface.material, pose=matrix, name=item.name, **words)
        self.shapes.append(placed)

    def _add_shape(self, part, placed, **words):
        """placed: None in a group."""
        surface = part.surface
        if surface.alpha is not None:
            words["alpha"] = surface.alpha
        if surface.emission is not None:
            words["emission"] = surface.emission
        self.scene.add_shape("triangles", material=surface.material, **part.words, **words)
        self.shapes.append(placed)
        if self._keep_triangles and part.corners is not None:
            self.triangles[len(self.shapes)] = part.corners

    # ---- meshes

    def _prepared(self, item, matrix, instance):
        """The mesh of an object in velo, made once for all objects that share it and its materials; None: it has no faces. instance: of the
        depsgraph, for the object's random number, which takes longer than what all copies need."""
        slots = self._slots_of(item)
        key = (geometry.data_of(item).as_pointer(), tuple(None if material is None else material.name_full for material in slots), tuple(self._seen))
        owner = ()
        if any(self._varies(material) for material in slots):
            self._copies[key] = self._copies.get(key, 0) + 1
            if self._copies[key] <= object_info.MAX_COPIES:
                owner = (item.name_full, object_info.random_id(instance), matrix.tobytes())
            else:
                self.notes.add(item.name, "", "of its copies the first %d have colours of their own" % object_info.MAX_COPIES)
        if key + owner not in self._meshes:
            known = object_info.fields(item, matrix, object_info.random_id(instance))
            self._meshes[key + owner] = self._make(item, slots, Place(matrix, known, owner, self._seen))
        return self._meshes[key + owner]

    def _varies(self, material):
        name = None if material is None else material.name_full
        if name not in self._varying:
            self._varying[name] = object_info.varies(material)
        return self._varying[name]

    def _make(self, item, slots, place):
        mesh = item.to_mesh()
        try:
            self._go_on()
            arrays = geometry.read(mesh, self._go_on) if self._known is None else self._known.read(item, mesh, self._go_on)
            if arrays is None:
                return None
            if not numpy.abs(geometry.bounds(arrays.positions)).max() <= FARTHEST:  # also where a number is NaN
                self.notes.add(item.name, "", "its vertices are no numbers (NaN or infinite) or too far away; it is left out")
                return None
            self._go_on()
            self._displace(arrays, slots, place)
            self._go_on()
            parts = self._parts(item, arrays, slots, place)
        finally:
            item.to_mesh_clear()
        plain = [part for part in parts if part.surface.emission is None]
        inner = [(arrays.positions, arrays.triangles[arrays.slots == part.slot], part.words["inside"]) for part in parts if "inside" in part.words]
        group = self.scene.add_group(item.name) if plain else None
        for part in plain:
            self._go_on()
            self._add_shape(part, None, group=group, name=item.name)
        return Prepared(group, parts, [part for part in parts if part.surface.emission is not None], inner)

    def _displace(self, arrays, slots, place):
        for slot in numpy.unique(arrays.slots):
            material = slots[slot] if 0 <= slot < len(slots) else slots[-1]
            if displace.is_displaced(material):
                inputs = self._inputs(material, textures.Maps(arrays), None, place)
                displace.apply(arrays, slot, material, inputs, place.matrix)
                arrays.displaced = True

    def _parts(self, item, arrays, slots, place):
        maps = textures.Maps(arrays)
        moving = self._moves.meshes_of(item.name_full, arrays) if self._moves is not None else None
        if moving is not None and arrays.displaced:
            moving = None
            self.notes.add(item.name, "", "vertices that are displaced are at rest")
        if len(maps.names) > 4:
            self.notes.add(item.name, "", "of its %d uv maps the first 4 are rendered" % len(maps.names))
        parts = []
        for slot in numpy.unique(arrays.slots):
            material = slots[slot] if 0 <= slot < len(slots) else slots[-1]
            corners = atlas.Corners(arrays, slot, place.matrix, maps.names[:4], arrays.texture_space)
            self._go_on()
            is_open = panes.refracts(material) and panes.is_open(arrays.positions, arrays.triangles, arrays.slots == slot)
            surface = self._surface(material, maps, corners, place, is_open)
            if moving is not None and surface.emission is not None:
                self.notes.add(item.name, "", "surfaces that emit are at rest")
            self._go_on()
            words = self._arrays_of(arrays, slot, maps, surface, moving if surface.emission is None else None)
            self._go_on()
            words.update(place.seen)
            if visibility.is_hole(material):
                words["backdrop"] = True
                visibility.note_opaque_film(self.depsgraph.scene, material.name, self.notes)
            medium = self._medium(material, arrays, maps, place)
            if medium is not None:
                words.update(inside=medium, outside=self._air)
            whole = None
            if self._keep_triangles and not arrays.displaced:
                whole = arrays.positions, arrays.triangles[arrays.slots == slot]
            parts.append(Part(words, surface, material, whole, slot))
        return parts

    def _medium(self, material, arrays, maps, place):
        box = geometry.bounds(arrays.positions)
        key = ("medium", None if material is None else material.name_full, place.owner, box[0].tobytes(), box[1].tobytes())
        if key not in self._cache:
            self._cache[key] = volumes.medium(material, self._inputs(material, maps, None, place), box, place.matrix, self._fog)
        return self._cache[key]

    def _inputs(self, material, maps, corners, place, is_open=False):
        owner = "default" if material is None else material.name
        return textures.Inputs(self.scene, self.notes, owner, maps, self._cache, self._settings.bake_size, corners, place.known,
                               self._cancelled, is_open)

    def _surface(self, material, maps, corners, place, is_open=False):
        key = (None if material is None else material.name_full, maps.key(), place.owner if self._varies(material) else (), is_open)
        if key not in self._surfaces:
            inputs = self._inputs(material, maps, corners, place, is_open)
            surface = materials.convert(material, inputs)
            self.material_indices[inputs.owner] = 0 if material is None else material.pass_index
            if material is not None and surface.alpha is not None:
                ignored.note_shadow(material, self.notes)
            if surface.atlas is not None:
                return surface  # of this mesh alone
            self._surfaces[key] = surface
        return self._surfaces[key]

    def _arrays_of(self, arrays, slot, maps, surface, moving):
        """Keywords of velo's triangles for one slot. moving: the meshes when the shutter opens and closes; None: it is at rest."""
        triangles, used = arrays.part(slot)
        if surface.atlas is not None:  # each triangle has corners of its own
            used = arrays.triangles[arrays.slots == slot].ravel()
            triangles = numpy.arange(len(used), dtype=numpy.int32).reshape(-1, 3)
        pick = (lambda array: array) if used is None else (lambda array: array[used])
        words = {"positions": pick(arrays.positions), "indices": triangles}
        if arrays.normals is not None:
            words["normals"] = geometry.clean_normals(pick(arrays.normals))
        if moving is not None:
            first, last = moving
            words.update(positions=pick(first.positions), positions_close=pick(last.positions), times=(0.0, 1.0))
            if arrays.normals is not None and first.normals is not None and last.normals is not None:
                words.update(normals=geometry.clean_normals(pick(first.normals)), normals_close=geometry.clean_normals(pick(last.normals)))
        if surface.tangent is not None:
            words["tangents"] = pick(arrays.radial_tangents(surface.tangent))
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


def _is_similar(matrix):
    """Whether a transform, 4 x 4, keeps angles."""
    product = matrix[:3, :3].T @ matrix[:3, :3]
    return bool(abs(product - numpy.eye(3) * product[0, 0]).max() < 1e-3 * abs(product).max())


def camera_of(depsgraph, size, eye=None):
    """The scene's camera in velo. eye: camera.Eye; None: its only one."""
    eye = eye or camera.eye_of(depsgraph)
    return camera_files.convert(eye, size) or camera.convert(depsgraph, size, eye)


def camera_or_none(depsgraph, size, eye):
    """The scene's camera in velo; None: it cannot be made."""
    try:
        return camera_of(depsgraph, size, eye)
    except (Refused, velo.Error):
        return None


def _placed(instance, matrix):
    item = instance.object
    top = item.parent
    while top is not None and top.parent is not None:
        top = top.parent
    look = (tuple("" if slot.material is None else slot.material.name_full for slot in item.material_slots), tuple(item.color),
            item.visible_camera, item.is_holdout)
    return Placed(item.name, top.name if top is not None else item.name, item.pass_index, str(item.get("class", "")), motion.key_of(instance),
                  matrix, look)


def _changed_objects(depsgraph):
    """{name: type} of the objects that have changed since the last evaluation; None: more than the places of meshes and the camera has."""
    changed = {}
    for update in depsgraph.updates:
        item = update.id
        if isinstance(item, (bpy.types.Action, bpy.types.Camera)):
            changed[item.name_full] = "CAMERA" if isinstance(item, bpy.types.Camera) else "ACTION"
        elif isinstance(item, bpy.types.Scene):
            if update.is_updated_geometry or update.is_updated_shading:
                return None
        elif not isinstance(item, bpy.types.Object) or (item.type == "MESH" and update.is_updated_geometry):
            return None
        elif item.type not in ("MESH", "CAMERA", "EMPTY"):
            return None
        else:
            changed[item.name_full] = item.type
    return changed


__all__ = ["Cancelled", "Export", "Refused", "camera_of", "camera_or_none"]
