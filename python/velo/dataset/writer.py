"""What the writers share. A frame's annotations go to a part of its own, so that shards write at once; finish() joins the
parts of all shards that are there."""
from __future__ import annotations

import glob
import json
import os
from typing import Any, Iterable, Iterator, Sequence

import numpy

from velo._errors import UnsupportedError
from velo.dataset.files import read_json, write_bytes
from velo.dataset.stage import Frame, Stage


class Folders:
    """The names of what is in the folders below one; each is read once."""

    def __init__(self, base: str) -> None:
        self._base = base
        self._names: dict[str, frozenset[str]] = {}

    def names(self, folder: str) -> frozenset[str]:
        """Of a folder, relative to the base. None where there is no such folder."""
        if folder not in self._names:
            try:
                self._names[folder] = frozenset(os.listdir(os.path.join(self._base, folder)))
            except OSError:
                self._names[folder] = frozenset()
        return self._names[folder]


class Writer:
    """Writes the frames of a dataset in one format."""

    def __init__(self, stage: Stage, folder: str) -> None:
        self.stage = stage
        self.folder = folder

    def names(self, frame: int, view: str, scene: int) -> Iterator[str]:
        """The files that write() may write for a frame, relative to the folder; view, scene: the camera's name and number."""
        raise NotImplementedError

    def tables(self, scenes: int) -> Iterator[str]:
        """The files that begin() and finish() may write; scenes: the number of cameras."""
        raise NotImplementedError

    def check_camera(self, camera: Any) -> None:
        """Raises velo.UnsupportedError for a camera that the format cannot hold; called before the first frame is rendered, and
        for each frame."""

    def begin(self) -> None:
        """Writes what is about the models, before the first frame."""

    def write(self, frame: Frame, scene: int) -> None:
        """Writes the files of a frame. scene: the camera's number, from 0."""
        raise NotImplementedError

    def finish(self) -> None:
        """Writes what is about all frames."""

    def check(self, frames: Iterable[int], views: Sequence[str]) -> None:
        """Raises the velo.UsageError of the first file that would replace one which the context has read."""
        folders = Folders(self.folder)
        if not folders.names(""):
            return
        for name in self.tables(len(views)):
            self._check_name(folders, name)
        for frame in frames:
            for scene, view in enumerate(views):
                for name in self.names(frame, view, scene):
                    self._check_name(folders, name)

    def _check_name(self, folders: Folders, name: str) -> None:
        folder, last = os.path.split(name)
        if last in folders.names(folder):
            self.stage.context.check_output(os.path.join(self.folder, name))

    def write_bytes(self, path: str, data: bytes) -> None:
        """Writes a file whole or not at all, and the folders above it; never over a file that the context has read."""
        write_bytes(path, data, self.stage.context)

    def write_json(self, path: str, data: Any) -> None:
        """Writes JSON in the same way. Numbers have as many digits as it takes to read the same bits."""
        self.write_bytes(path, (json.dumps(data, allow_nan=False) + "\n").encode())

    @staticmethod
    def part_name(frame: int, view: str) -> str:
        """The file of part(), relative to the folder."""
        return os.path.join("parts", f"{frame:06d}_{view}.json")

    def part(self, frame: Frame, data: Any) -> None:
        """Keeps a frame's annotations for finish."""
        self.write_json(os.path.join(self.folder, self.part_name(frame.frame, frame.view)), [frame.frame, data])

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


def refuse_moving(format: str, camera: Any) -> None:
    """Raises velo.UnsupportedError if the camera moves while the shutter is open: a format with one pose for an image cannot
    hold it."""
    ends = [camera.at(time).world_from_camera.tolist() for time in (-1e30, 1e30)]
    if ends[0] != ends[1]:
        raise UnsupportedError(f"{format} has one pose for an image and cannot hold a camera that moves; the writer exr can")


def depth_steps(format: str, frame: Frame, step: float, remedy: str) -> Any:
    """The depth along the view axis in whole steps of so many millimetres, uint16; 0: nothing is seen. A depth beyond 65535
    steps, or of less than half a step, is a velo.UnsupportedError, which names the remedy."""
    steps = numpy.rint(numpy.asarray(frame.image["Z"], dtype="float64") * 1000 / step)
    known = numpy.isfinite(steps) & (steps > 0)
    lost = (steps == 0) & (numpy.asarray(frame.image["Z"]) > 0)
    if lost.any():
        nearest = float(numpy.asarray(frame.image["Z"])[lost].min())
        raise UnsupportedError(f"{format}: frame {frame.frame} has a depth of {nearest:.6g} m, which in steps of {step:g} mm is 0, "
                               f"unknown; a smaller step or the writer exr can hold it")
    farthest = steps[known].max() if known.any() else 0
    if farthest > 65535:
        raise UnsupportedError(f"{format}: frame {frame.frame} has a depth of {farthest * step / 1000:.6g} m; 16 bits hold up to "
                               f"{65.535 * step:.6g} m in steps of {step:g} mm; {remedy}")
    return numpy.where(known, steps, 0).astype("uint16")


def display(frame: Frame) -> Any:
    """The image for displays: height x width x 3, uint8."""
    return numpy.asarray(frame.image.view())[..., :3]
