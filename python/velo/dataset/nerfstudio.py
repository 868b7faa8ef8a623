"""Writes nerfstudio's transforms.json (https://docs.nerf.studio/quickstart/data_conventions.html).

Poses are world from camera with x right, y up, z back. Depths are 16-bit PNGs in millimetres."""
from __future__ import annotations

import os
from typing import Any, Iterator

import numpy

from velo._errors import UnsupportedError
from velo.dataset.png import png
from velo.dataset.stage import Frame, Stage
from velo.dataset.writer import Writer, depth_steps, display, refuse_moving

_NAMES = {"opencv": ("k1", "k2", "p1", "p2", "k3"), "radial": ("k1", "k2", "k3", "k4")}


def intrinsics(camera: Any) -> dict[str, Any]:
    """The camera in nerfstudio's names."""
    distortion = camera.get("distortion")
    numbers = list(camera.distortion_coefficients)
    fisheye = camera.projection.startswith("equidistant")
    names = _NAMES.get(distortion, ())
    if (camera.projection != "perspective" and not fisheye) or any(numbers[len(names):]) or (distortion == "radial") != fisheye and any(numbers):
        raise UnsupportedError(f"nerfstudio cannot hold this camera ({camera.projection}, distortion {distortion}): it has perspective "
                               "cameras with k1 k2 p1 p2 k3 and fisheyes with k1 to k4; the writer exr holds any")
    k = camera.K
    if k[0, 1] != 0:
        raise UnsupportedError("nerfstudio cannot hold a camera with skew; the writers bop and exr can")
    return {"camera_model": "OPENCV_FISHEYE" if fisheye else "OPENCV", "fl_x": float(k[0, 0]), "fl_y": float(k[1, 1]),
            "cx": float(k[0, 2]), "cy": float(k[1, 2]), "w": camera.width, "h": camera.height, **dict(zip(names, numbers))}


class NerfstudioWriter(Writer):
    """OUT/nerfstudio: transforms.json, images/*.png, depth/*.png."""

    def __init__(self, stage: Stage, folder: str) -> None:
        super().__init__(stage, os.path.join(folder, "nerfstudio"))

    def names(self, frame: int, view: str, scene: int) -> Iterator[str]:
        yield os.path.join("images", f"{frame:06d}_{view}.png")
        yield os.path.join("depth", f"{frame:06d}_{view}.png")
        yield self.part_name(frame, view)

    def tables(self, scenes: int) -> Iterator[str]:
        yield "transforms.json"

    def check_camera(self, camera: Any) -> None:
        intrinsics(camera)
        refuse_moving("nerfstudio", camera)

    def write(self, frame: Frame, scene: int) -> None:
        name = f"{frame.frame:06d}_{frame.view}.png"
        self.write_bytes(os.path.join(self.folder, "images", name), png(display(frame)))
        depth = depth_steps("nerfstudio", frame, 1.0, "use the writer exr")
        self.write_bytes(os.path.join(self.folder, "depth", name), png(depth))
        pose = numpy.array(frame.camera.world_from_camera) * [1, -1, -1, 1]  # the axes are columns
        self.part(frame, {"file_path": f"images/{name}", "depth_file_path": f"depth/{name}",
                          "transform_matrix": pose.tolist(), **intrinsics(frame.camera)})

    def finish(self) -> None:
        frames = [part for _, part in self.parts()]
        shared = {name: value for name, value in frames[0].items() if name not in
                  ("file_path", "depth_file_path", "transform_matrix")} if frames else {}
        same = all(all(frame.get(name) == value for name, value in shared.items()) for frame in frames)
        if same:
            frames = [{name: value for name, value in frame.items() if name not in shared} for frame in frames]
        self.write_json(os.path.join(self.folder, "transforms.json"), {**(shared if same else {}), "frames": frames})
