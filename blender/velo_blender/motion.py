"""motion.py: the scene at other times than that of the frame: for motion blur and for the pass Vector.

velo's time runs from 0, when the shutter opens, to 1. Poses are read at three times, and velo interpolates between them; vertices that
move are read when the shutter opens and when it closes, and move straight on."""
import math

import numpy

from . import camera, geometry

TIMES = (0.0, 0.5, 1.0)


def key_of(instance):
    """What an instance is called in all frames."""
    parent = instance.parent.name_full if instance.parent is not None else ""
    return instance.object.name_full, parent, tuple(instance.persistent_id) if instance.is_instance else ()


def interval(scene):
    """The times at which the shutter opens and closes, in frames from the frame that is rendered."""
    length = scene.render.motion_blur_shutter
    position = getattr(getattr(scene, "cycles", None), "motion_blur_position", "CENTER")
    begin = {"START": 0.0, "CENTER": -0.5, "END": -1.0}[position] * length
    return begin, begin + length


def moves(item, switch):
    """Whether Cycles' switch use_motion_blur or use_deform_motion of an object is on."""
    return getattr(getattr(item, "cycles", None), switch, True)


def deforms(item, scene):
    """Whether the vertices of an evaluated object may move."""
    if item.type not in geometry.MESHES or not (moves(item, "use_motion_blur") and moves(item, "use_deform_motion")):
        return False
    original = item.original
    data = original.data
    is_modified = original.is_deform_modified(scene, "RENDER") or any(known.type == "NODES" for known in original.modifiers)
    return is_modified or getattr(data, "animation_data", None) is not None or getattr(data, "shape_keys", None) is not None


class Step:
    """The scene at one time. poses: {key_of(instance): 4 x 4}; matrices: {view: of Blender's camera}; cameras: {view: velo's, None where it
    cannot be made}, empty where they are not asked for; meshes: {object: geometry.MeshArrays} of those that deform()."""

    def __init__(self, depsgraph, with_meshes, size, eyes):
        from . import export
        self.poses, self.meshes, self.matrices, self.cameras = {}, {}, {}, {}
        scene = depsgraph.scene
        for instance in depsgraph.object_instances:
            item = instance.object
            if item.type in ("CAMERA", "LIGHT", "EMPTY"):
                continue
            self.poses[key_of(instance)] = numpy.array(instance.matrix_world, dtype=float)
            if with_meshes and item.name_full not in self.meshes and deforms(item, scene):
                arrays = geometry.of_object(item)
                if arrays is not None and arrays.is_finite():
                    self.meshes[item.name_full] = arrays
        for eye in eyes:
            self.matrices[eye.name] = eye.matrix
            if size is not None:
                self.cameras[eye.name] = export.camera_or_none(depsgraph, size, eye)

    def pose_of(self, key, otherwise):
        """The pose of an instance that is there and has a place."""
        pose = self.poses.get(key)
        return otherwise if pose is None or not numpy.isfinite(pose).all() else pose


def read_steps(engine, depsgraph, frames, views, size=None, meshes_at=None):
    """The scene at times, in frames from the frame that is rendered: a list of Step. views: their names; size: of the image, for velo's cameras; meshes_at:
    the indices of the times at which meshes are read, default all."""
    scene = depsgraph.scene
    frame = scene.frame_current + scene.frame_subframe
    steps = []
    try:
        for number, offset in enumerate(frames):
            at = frame + offset
            engine.frame_set(math.floor(at), at - math.floor(at))
            eyes = camera.eyes_of(engine, depsgraph, views) if scene.camera is not None else []
            steps.append(Step(depsgraph, meshes_at is None or number in meshes_at, size, eyes))
    finally:
        engine.frame_set(math.floor(frame), frame - math.floor(frame))
    return steps


class Motion:
    """What moves while the shutter is open. cameras: {view: [4 x 4, ...] of Blender's camera at TIMES}."""

    def __init__(self, engine, depsgraph, views):
        begin, end = interval(depsgraph.scene)
        self._steps = read_steps(engine, depsgraph, [begin + time * (end - begin) for time in TIMES], views,
                                 meshes_at=(0, len(TIMES) - 1))
        self.cameras = {name: [step.matrices[name] for step in self._steps] for name in self._steps[0].matrices}

    def of(self, instance):
        """The poses of an instance that moves; None: it is at rest, or is not there all the time."""
        if not moves(instance.object, "use_motion_blur"):
            return None
        key = key_of(instance)
        poses = [step.poses.get(key) for step in self._steps]
        if any(pose is None for pose in poses) or not numpy.isfinite(poses).all():
            return None
        if min(abs(numpy.linalg.det(pose[:3, :3])) for pose in poses) < 1e-30:
            return None
        return None if all(numpy.allclose(pose, poses[0], rtol=0, atol=1e-7) for pose in poses[1:]) else poses

    def meshes_of(self, name, arrays):
        """The meshes of an object when the shutter opens and closes; None: its vertices are at rest, or it has other triangles then.

        arrays: geometry.MeshArrays of the frame."""
        ends = [self._steps[k].meshes.get(name) for k in (0, -1)]
        if any(mesh is None or not mesh.is_like(arrays) for mesh in ends):
            return None
        size = max(float(numpy.abs(arrays.positions).max()), 1e-30)
        if all(numpy.allclose(mesh.positions, arrays.positions, rtol=0, atol=1e-6 * size) for mesh in ends):
            return None
        return ends
