"""Writes plain OpenEXR files: linear colours, depth, normals and ids as they are, and a JSON file beside each."""
from __future__ import annotations

import os
from typing import Iterator

from velo.dataset.stage import Frame, Stage
from velo.dataset.writer import Writer, box_of


class ExrWriter(Writer):
    """OUT/exr: 000000_camera.exr (R G B A, Z, N, id.instance, Recipe.channels), 000000_camera.json, and the camera as a file
    of velo's, cameras/000000_camera.json."""

    def __init__(self, stage: Stage, folder: str) -> None:
        super().__init__(stage, os.path.join(folder, "exr"))

    def names(self, frame: int, view: str, scene: int) -> Iterator[str]:
        yield f"{frame:06d}_{view}.exr"
        yield f"{frame:06d}_{view}.json"
        yield os.path.join("cameras", f"{frame:06d}_{view}.json")

    def tables(self, scenes: int) -> Iterator[str]:
        yield from ()

    def write(self, frame: Frame, scene: int) -> None:
        os.makedirs(os.path.join(self.folder, "cameras"), exist_ok=True)
        name = os.path.join(self.folder, f"{frame.frame:06d}_{frame.view}")
        frame.image.write(name + ".exr")
        camera = os.path.join(self.folder, "cameras", f"{frame.frame:06d}_{frame.view}.json")
        frame.camera.write(camera, dialect="velo", context=self.stage.context)
        ids = frame.image["id.instance"]
        self.write_json(name + ".json", {
            "frame": frame.frame, "view": frame.view, "width": frame.camera.width, "height": frame.camera.height,
            "K": [[float(value) for value in row] for row in frame.camera.K],
            "projection": frame.camera.projection, "distortion": frame.camera.get("distortion"), "distortion_coefficients": list(frame.camera.distortion_coefficients),
            "world_from_camera": [[float(value) for value in row] for row in frame.camera.world_from_camera],
            "instances": [{"class": item.name, "id_instance": int(ids[item.mask][0]) if item.mask.any() else 0,
                           "world_from_model": item.world_from_model, "scale": item.scale,
                           "box": box_of(item.mask, (0, 0, 0, 0)), "pixels": int(item.mask.sum()),
                           "pixels_whole": int(item.whole.sum()), "visible_fraction": item.visible_fraction,
                           "hidden_by": {str(number): pixels for number, pixels in item.hidden_by.items()},
                           **({} if item.keypoints is None else {
                               "keypoints": item.keypoints.pixels.tolist(), "keypoints_3d": item.keypoints.points.tolist(),
                               "visibility": item.keypoints.visibility.tolist()})} for item in frame.instances]})
