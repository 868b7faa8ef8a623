"""What the writers share. A frame's annotations go to a part of its own, so that shards write at once; finish() joins the
parts of all shards that are there."""
from __future__ import annotations

import glob
import json
import os
from typing import Any, Iterator, Sequence

import numpy

from velo.dataset.files import read_json, write_bytes
from velo.dataset.stage import Frame, Stage


class Writer:
    """Writes the frames of a dataset in one format."""

    def __init__(self, stage: Stage, folder: str) -> None:
        self.stage = stage
        self.folder = folder

    def write(self, frame: Frame, scene: int) -> None:
        """Writes the files of a frame. scene: the camera's number, from 0."""
        raise NotImplementedError

    def finish(self) -> None:
        """Writes what is about all frames."""

    def write_bytes(self, path: str, data: bytes) -> None:
        """Writes a file whole or not at all, and the folders above it; never over a file that the context has read."""
        write_bytes(path, data, self.stage.context)

    def write_json(self, path: str, data: Any) -> None:
        """Writes JSON in the same way. Numbers have as many digits as it takes to read the same bits."""
        self.write_bytes(path, (json.dumps(data, allow_nan=False) + "\n").encode())

    def part(self, frame: Frame, data: Any) -> None:
        """Keeps a frame's annotations for finish."""
        self.write_json(os.path.join(self.folder, "parts", f"{frame.frame:06d}_{frame.view}.json"), [frame.frame, data])

    def parts(self) -> Iterator[tuple[int, Any]]:
        """The annotations of all frames, in order: number of the frame, data."""
        for path in sorted(glob.glob(os.path.join(glob.escape(self.folder), "parts", "*.json"))):
            number, data = read_json(path, None)
            yield number, data


def box_of(mask: Any, nothing: Sequence[int]) -> list[int]:
    """x, y, width, height of the pixels of a mask."""
    rows, columns = numpy.flatnonzero(mask.any(1)), numpy.flatnonzero(mask.any(0))
    if not len(rows):
        return list(nothing)
    return [int(columns[0]), int(rows[0]), int(columns[-1] - columns[0] + 1), int(rows[-1] - rows[0] + 1)]


def display(frame: Frame) -> Any:
    """The image for displays: height x width x 3, uint8."""
    return numpy.asarray(frame.image.view())[..., :3]
