"""Writes what a camera with a sensor gives: numbers, a developed image and a description of each."""
from __future__ import annotations

import os
from typing import Iterator

import numpy

from velo._errors import UsageError
from velo.dataset.png import png
from velo.dataset.stage import Frame, Stage
from velo.dataset.writer import Writer


class RawWriter(Writer):
    """OUT/raw: 000000_camera.png (the sensor's numbers, 16 bits), 000000_camera_developed.png (8 bits), 000000_camera.json (the
    sensor, the exposure, counts of pixels) and, where the recipe asks for it, 000000_camera.dng. The recipe must have a sensor."""

    def __init__(self, stage: Stage, folder: str) -> None:
        super().__init__(stage, os.path.join(folder, "raw"))
        if not stage.sensor:
            raise UsageError("the writer raw needs recipe.sensor")

    def names(self, frame: int, view: str, scene: int) -> Iterator[str]:
        yield f"{frame:06d}_{view}.png"
        yield f"{frame:06d}_{view}_developed.png"
        if self.stage.recipe.sensor and self.stage.recipe.sensor.dng:
            yield f"{frame:06d}_{view}.dng"
        yield f"{frame:06d}_{view}.json"

    def tables(self, scenes: int) -> Iterator[str]:
        yield from ()

    def write(self, frame: Frame, scene: int) -> None:
        exposure, sensor, rule = frame.exposure, self.stage.sensor, self.stage.recipe.sensor
        assert exposure and sensor and rule
        os.makedirs(self.folder, exist_ok=True)
        name = os.path.join(self.folder, f"{frame.frame:06d}_{frame.view}")
        self.write_bytes(name + ".png", png(numpy.asarray(exposure.numbers)[..., 0]))
        raw = exposure.raw()
        self.stage.context.check_output(name + "_developed.png")
        raw.develop().write(name + "_developed.png")
        if rule.dng:
            self.stage.context.check_output(name + ".dng")
            raw.write(name + ".dng")
        self.write_json(name + ".json", {
            "frame": frame.frame, "view": frame.view, "sensor": rule.name, "numbers": sensor.numbers, "exposure": rule.exposure,
            "full": exposure.full, "black": exposure.black, "white": exposure.white})
