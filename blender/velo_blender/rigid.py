"""rigid.py: objects as the rigid models of BOP: what is rendered of a mesh, with the object's scale, in the object's own axes.

Objects of one class that have the same triangles at the same size are one model; a class may have several models."""
import dataclasses
from types import SimpleNamespace
from typing import Any, NamedTuple

import numpy
import velo
from velo._errors import UnsupportedError
from velo.dataset.stage import silhouette

SAME = 1e-5  # points that differ by less than this share of the model's size are the same


class Model(NamedTuple):
    """A model in Blender's units. kind: its class; points: n x 3; triangles: m x 3; scene: the model alone, as instance 1."""
    kind: str
    points: Any
    triangles: Any
    low: Any
    high: Any
    scene: Any

    def is_like(self, kind, points, triangles):
        """Whether it is the model of these triangles."""
        if kind != self.kind or points.shape != self.points.shape or not numpy.array_equal(triangles, self.triangles):
            return False
        size = float((self.high - self.low).max())
        return bool(abs(points - self.points).max() <= SAME * size)


def pose_of(matrix):
    """(rotation and translation, 4 x 4; stretch, 3 x 3) of an object's matrix, which is their product: the polar decomposition. The
    stretch is symmetric, and negative for a mirrored object."""
    u, sizes, v = numpy.linalg.svd(matrix[:3, :3])
    sign = 1.0 if numpy.linalg.det(u @ v) > 0 else -1.0
    pose = numpy.eye(4)
    pose[:3, :3] = sign * (u @ v)
    pose[:3, 3] = matrix[:3, 3]
    return pose, sign * (v.T * sizes) @ v


def _triangles(parts):
    """Points and triangles of a mesh's parts that do not emit, in the object's space."""
    points, triangles, count = [], [], 0
    for part in parts:
        if part.surface.emission is None:
            points.append(numpy.asarray(part.words["positions"], dtype=float))
            triangles.append(numpy.asarray(part.words["indices"], dtype=numpy.int64) + count)
            count += len(points[-1])
    return numpy.concatenate(points), numpy.concatenate(triangles)


def _alone(points, triangles):
    """A scene with one instance of these triangles; points that are equal are one."""
    points, numbers = numpy.unique(points[triangles.ravel()], axis=0, return_inverse=True)
    triangles = numbers.reshape(-1, 3)
    scene = velo.Scene()
    group = scene.add_group("model")
    scene.add_mesh(points.astype(numpy.float32), triangles.astype(numpy.uint32), group=group)
    scene.add_instance(group, numpy.eye(4))
    return scene


class Models:
    """The models of a data set, as they come. It is what velo's writer of BOP asks of a recipe's stage: names, boxes, model(number),
    recipe, context. unit: metres of a unit of Blender; depth_scale: millimetres of a step of the depth."""

    def __init__(self, unit, depth_scale):
        self.names, self.boxes = [], []
        self.context = velo.Scene().context
        self.recipe = SimpleNamespace(depth_scale=depth_scale, occluded=True, models=[])
        self._unit = unit
        self._models = []
        self._known = {}  # {motion.key_of(instance): number of its model}

    def model(self, number):
        """The scene that has model `number`, from 0, alone, in Blender's units."""
        return self._models[number].scene

    def _number_of(self, placed, prepared, stretch):
        """The model of an instance. velo.UnsupportedError: it had another one in an earlier frame."""
        points, triangles = _triangles(prepared.parts)
        points = points @ stretch.T
        if numpy.linalg.det(stretch) < 0:
            triangles = triangles[:, ::-1]
        like = (number for number, model in enumerate(self._models) if model.is_like(placed.kind, points, triangles))
        number = next(like, None)
        if number is None:
            number = len(self._models)
        if self._known.setdefault(placed.key, number) != number:
            raise UnsupportedError("bop has rigid models, and the shape or scale of %s changes; the formats coco and exr can hold it" %
                                   placed.name)
        if number == len(self._models):
            self._add(placed.kind, points, triangles)
        return number

    def _add(self, kind, points, triangles):
        used = points[numpy.unique(triangles)]
        low, high = used.min(axis=0), used.max(axis=0)
        self._models.append(Model(kind, points, triangles, low, high, _alone(points, triangles)))
        self.names.append(kind)
        self.boxes.append(((low * self._unit).tolist(), (high * self._unit).tolist()))
        self.recipe.models.append(SimpleNamespace(keypoints={}, scale=self._unit))

    def frame(self, frame, places, made):
        """A frame as BOP has it: in metres, with the numbers of models in place of those of classes, and whole masks. places: for each of
        the frame's instances which of export.Export's instances it is, from 0; made: that export."""
        order = sorted(places, key=lambda place: (made.instances[place].kind, made.instances[place].key))
        numbers, poses = {}, {}
        for place in order:
            poses[place], stretch = pose_of(made.instances[place].matrix)
            numbers[place] = self._number_of(made.instances[place], made.prepared[place], stretch)
        instances = []
        for item, place in zip(frame.instances, places):
            model, pose = self._models[numbers[place]], poses[place]
            whole = item.mask | silhouette(model.scene, model.low.tolist(), model.high.tolist(), pose.tolist(), frame.camera)
            instances.append(dataclasses.replace(item, model=numbers[place], world_from_model=self._in_metres(pose).tolist(), scale=self._unit,
                                                 whole=whole))
        view = frame.camera.move(self._in_metres(numpy.array(frame.camera.world_from_camera, dtype=float)))
        return dataclasses.replace(frame, camera=view, image=InMetres(frame.image, self._unit), instances=instances)

    def _in_metres(self, pose):
        pose = pose.copy()
        pose[:3, 3] *= self._unit
        return pose


class InMetres:
    """An image whose depth is in metres."""

    def __init__(self, image, unit):
        self._image, self._unit = image, unit

    def __getitem__(self, name):
        return numpy.asarray(self._image[name]) * (self._unit if name == "Z" else 1)

    def view(self):
        """The image for displays."""
        return self._image.view()
