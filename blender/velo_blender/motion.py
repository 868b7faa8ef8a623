"""motion.py: motion blur: the poses of instances and camera while the shutter is open.

velo's time runs from 0, when the shutter opens, to 1. Poses are read at three times, and velo interpolates between them. Vertices that
move are at rest."""
import math

import numpy

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


class Motion:
    """Poses at TIMES. poses: {key_of(instance): [4 x 4, ...]}; camera: [4 x 4, ...] of Blender's camera."""

    def __init__(self, engine, depsgraph):
        scene = depsgraph.scene
        frame = scene.frame_current + scene.frame_subframe
        begin, end = interval(scene)
        self.poses, self.camera = {}, []
        try:
            for time in TIMES:
                at = frame + begin + time * (end - begin)
                engine.frame_set(math.floor(at), at - math.floor(at))
                self._read(depsgraph)
        finally:
            engine.frame_set(math.floor(frame), frame - math.floor(frame))

    def _read(self, depsgraph):
        for instance in depsgraph.object_instances:
            if instance.object.type in ("CAMERA", "LIGHT", "EMPTY"):
                continue
            self.poses.setdefault(key_of(instance), []).append(numpy.array(instance.matrix_world, dtype=float))
        if depsgraph.scene.camera is not None:
            camera = depsgraph.scene.camera.evaluated_get(depsgraph)
            self.camera.append(camera.matrix_world.copy())

    def of(self, instance):
        """The poses of an instance that moves; None: it is at rest, or is not there all the time."""
        poses = self.poses.get(key_of(instance), [])
        if len(poses) != len(TIMES) or not numpy.isfinite(poses).all():
            return None
        if min(abs(numpy.linalg.det(pose[:3, :3])) for pose in poses) < 1e-30:
            return None
        return None if all(numpy.allclose(pose, poses[0], rtol=0, atol=1e-7) for pose in poses[1:]) else poses
