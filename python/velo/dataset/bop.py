"""Writes the BOP challenge's format (https://github.com/thodan/bop_toolkit, docs/bop_datasets_format.md).

Poses are those of the models in millimetres, model to camera; cameras are OpenCV's (x right, y down, z forward, the first
pixel's centre at (0, 0)). depth * depth_scale is the depth along the view axis in millimetres; 0: nothing. The format has perspective
cameras without lens distortion only."""
from __future__ import annotations

import os
from typing import Any, Iterator

import numpy

from velo._errors import UnsupportedError
from velo.dataset.geometry import multiply
from velo.dataset.models import diameter, ply, triangles
from velo.dataset.png import png
from velo.dataset.stage import Frame, Stage
from velo.dataset.writer import Writer, box_of, depth_steps, display, refuse_moving

MM = 1000.0


class BopWriter(Writer):
    """OUT/bop: models/models_info.json, models/obj_000001.ply, ..., camera.json, and a scene for each camera: train_pbr/000000."""

    def __init__(self, stage: Stage, folder: str) -> None:
        super().__init__(stage, os.path.join(folder, "bop"))
        self.depth_scale = float(stage.recipe.depth_scale)

    def check_camera(self, camera: Any) -> None:
        distorted = any(camera.distortion_coefficients)
        if camera.projection != "perspective" or distorted:
            lens = "lens distortion" if distorted else f"the projection {camera.projection}"
            raise UnsupportedError(f"bop holds perspective cameras without distortion only; this one has {lens}: render without it, "
                                   "or use the writers nerfstudio or exr")
        refuse_moving("bop", camera)

    def names(self, frame: int, view: str, scene: int) -> Iterator[str]:
        folder, name = os.path.join("train_pbr", f"{scene:06d}"), f"{frame:06d}"
        yield os.path.join(folder, "rgb", f"{name}.png")
        yield os.path.join(folder, "depth", f"{name}.png")
        for number in range(self.stage.most_objects):
            yield os.path.join(folder, "mask", f"{name}_{number:06d}.png")
            yield os.path.join(folder, "mask_visib", f"{name}_{number:06d}.png")
        yield self.part_name(frame, view)

    def tables(self, scenes: int) -> Iterator[str]:
        for number in range(len(self.stage.boxes)):
            yield os.path.join("models", f"obj_{number + 1:06d}.ply")
        yield os.path.join("models", "models_info.json")
        for scene in range(scenes):
            for name in ("scene_camera", "scene_gt", "scene_gt_info"):
                yield os.path.join("train_pbr", f"{scene:06d}", f"{name}.json")
        yield "camera.json"

    def begin(self) -> None:
        info = {}
        for number, (low, high) in enumerate(self.stage.boxes):
            size = [(b - a) * MM for a, b in zip(low, high)]
            points, faces = triangles(self.stage.model(number), self.stage.recipe.models[number].scale * MM)
            self.write_bytes(os.path.join(self.folder, "models", f"obj_{number + 1:06d}.ply"), ply(points, faces))
            info[str(number + 1)] = {"name": self.stage.names[number],
                                     "diameter": diameter(points) or sum(s * s for s in size) ** 0.5,
                                     **{f"min_{axis}": value * MM for axis, value in zip("xyz", low)},
                                     **{f"size_{axis}": value for axis, value in zip("xyz", size)}}
        self.write_json(os.path.join(self.folder, "models", "models_info.json"), info)

    def write(self, frame: Frame, scene: int) -> None:
        folder = os.path.join(self.folder, "train_pbr", f"{scene:06d}")
        name = f"{frame.frame:06d}"
        self.write_bytes(os.path.join(folder, "rgb", f"{name}.png"), png(display(frame)))
        depth = depth_steps("bop", frame, self.depth_scale, "a larger step (depth_scale) or the writer exr can hold it")
        self.write_bytes(os.path.join(folder, "depth", f"{name}.png"), png(depth))
        k = numpy.array(frame.camera.K)
        k[0, 2] -= 0.5
        k[1, 2] -= 0.5
        camera_from_world = [[float(value) for value in row] for row in frame.camera.camera_from_world]
        camera = {"cam_K": k.ravel().tolist(), "depth_scale": self.depth_scale,
                  "cam_R_w2c": [value for row in camera_from_world[:3] for value in row[:3]],
                  "cam_t_w2c": [row[3] * MM for row in camera_from_world[:3]]}
        truths, infos = [], []
        for number, item in enumerate(frame.instances):
            pose = multiply(camera_from_world, item.world_from_model)
            truths.append({"cam_R_m2c": [value for row in pose[:3] for value in row[:3]],
                           "cam_t_m2c": [row[3] * MM for row in pose[:3]], "obj_id": item.model + 1})
            self.write_bytes(os.path.join(folder, "mask", f"{name}_{number:06d}.png"), png(item.whole))
            self.write_bytes(os.path.join(folder, "mask_visib", f"{name}_{number:06d}.png"), png(item.mask))
            whole, seen = int(item.whole.sum()), int(item.mask.sum())
            infos.append({"bbox_obj": box_of(item.whole, (-1, -1, -1, -1)), "bbox_visib": box_of(item.mask, (-1, -1, -1, -1)),
                          "px_count_all": whole, "px_count_valid": int((item.whole & (depth > 0)).sum()),
                          "px_count_visib": seen, "visib_fract": seen / whole if whole else 0.0})
        self.part(frame, {"scene": scene, "camera": camera, "gt": truths, "info": infos,
                          "size": list(frame.camera.resolution)})

    def finish(self) -> None:
        scenes: dict[int, dict[str, dict[str, Any]]] = {}
        first: Any = None
        for number, part in self.parts():
            first = first or part
            tables = scenes.setdefault(part["scene"], {"scene_camera": {}, "scene_gt": {}, "scene_gt_info": {}})
            tables["scene_camera"][str(number)] = part["camera"]
            tables["scene_gt"][str(number)] = part["gt"]
            tables["scene_gt_info"][str(number)] = part["info"]
        for scene, tables in scenes.items():
            for name, table in tables.items():
                self.write_json(os.path.join(self.folder, "train_pbr", f"{scene:06d}", f"{name}.json"), table)
        if first:
            k = first["camera"]["cam_K"]
            self.write_json(os.path.join(self.folder, "camera.json"),
                       {"fx": k[0], "fy": k[4], "cx": k[2], "cy": k[5], "width": first["size"][0], "height": first["size"][1],
                        "depth_scale": self.depth_scale})
