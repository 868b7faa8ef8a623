"""Writes COCO's annotations of instances and keypoints (https://cocodataset.org/#format-data).

Masks are polygons along the pixels' edges, or run lengths (columns first) where a mask has holes or `rle` is set. Keypoints
are in pixels whose first has its centre at (0.5, 0.5); v is 2: visible, 1: hidden, 0: outside the image. keypoints_3d, velo's
own, has them as x, y, z, v in the camera's axes (x right, y down, z forward), metres. Masks of whole objects
(amodal) have KINS's names a_segm, a_bbox and a_area (Qi et al., "Amodal instance segmentation with KINS dataset", CVPR 2019)."""
from __future__ import annotations

import os
from typing import Any, Iterator

import numpy

from velo.dataset.keypoints import Keypoints
from velo.dataset.png import png
from velo.dataset.stage import Frame, Instance, Stage
from velo.dataset.writer import Writer, box_of, display


def run_lengths(mask: Any) -> dict[str, Any]:
    """COCO's uncompressed run lengths of a mask: numbers of 0s and 1s in turn, columns first, 0s first."""
    flat = numpy.asarray(mask, dtype=bool).ravel(order="F")
    changes = numpy.flatnonzero(flat[1:] != flat[:-1]) + 1
    edges = numpy.concatenate([[0], changes, [len(flat)]])
    counts = numpy.diff(edges).tolist()
    if len(flat) and flat[0]:
        counts = [0] + counts
    return {"counts": counts, "size": [int(mask.shape[0]), int(mask.shape[1])]}


def outlines(mask: Any) -> tuple[list[list[float]], bool]:
    """The outer edges of a mask's parts as polygons x0, y0, x1, y1, ...; and whether a part has holes. Pixels that touch at a
    corner only are separate parts."""
    x0, y0, width, height = box_of(mask, (0, 0, 0, 0))
    padded = numpy.pad(numpy.asarray(mask, dtype=bool)[y0:y0 + height, x0:x0 + width], 1)
    # Directed edges around set pixels, with the mask on the right (y points down): from corner to corner.
    following: dict[tuple[int, int], list[tuple[int, int]]] = {}

    def add(edges: Any, start: tuple[int, int], end: tuple[int, int]) -> None:
        for y, x in numpy.argwhere(edges).tolist():
            following.setdefault((x + start[0] + x0, y + start[1] + y0), []).append((x + end[0] + x0, y + end[1] + y0))

    inner = padded[1:-1, 1:-1]
    add(inner & ~padded[:-2, 1:-1], (0, 0), (1, 0))  # upper edges, to the right
    add(inner & ~padded[1:-1, 2:], (1, 0), (1, 1))  # right edges, down
    add(inner & ~padded[2:, 1:-1], (1, 1), (0, 1))  # lower edges, to the left
    add(inner & ~padded[1:-1, :-2], (0, 1), (0, 0))  # left edges, up
    polygons, holes = [], False
    while following:
        start = next(iter(following))
        points, position, direction = [start], start, (0, 0)
        while True:
            ends = following[position]
            # At a corner where two pixels touch, the turn to the right stays with this pixel.
            best = max(ends, key=lambda end: direction[0] * (end[1] - position[1]) - direction[1] * (end[0] - position[0]))
            ends.remove(best)
            if not ends:
                del following[position]
            direction = (best[0] - position[0], best[1] - position[1])
            position = best
            if position == start:
                break
            points.append(position)
        corners = [p for i, p in enumerate(points)
                   if not (points[i - 1][0] == p[0] == points[(i + 1) % len(points)][0]
                           or points[i - 1][1] == p[1] == points[(i + 1) % len(points)][1])]
        area = sum(a[0] * b[1] - b[0] * a[1] for a, b in zip(corners, corners[1:] + corners[:1]))
        if area < 0:
            holes = True
        else:
            polygons.append([float(value) for corner in corners for value in corner])
    return polygons, holes


class CocoWriter(Writer):
    """OUT/coco: images/*.png and annotations.json."""

    def __init__(self, stage: Stage, folder: str, rle: bool = False) -> None:
        super().__init__(stage, os.path.join(folder, "coco"))
        self.rle = rle

    def names(self, frame: int, view: str, scene: int) -> Iterator[str]:
        yield os.path.join("images", f"{frame:06d}_{view}.png")
        yield self.part_name(frame, view)

    def tables(self, scenes: int) -> Iterator[str]:
        yield "annotations.json"

    def write(self, frame: Frame, scene: int) -> None:
        name = f"{frame.frame:06d}_{frame.view}.png"
        self.write_bytes(os.path.join(self.folder, "images", name), png(display(frame)))
        width, height = frame.camera.resolution
        annotations = [self._annotation(frame, item) for item in frame.instances if item.mask.any()]
        self.part(frame, {"image": {"file_name": f"images/{name}", "width": width, "height": height}, "annotations": annotations})

    def _annotation(self, frame: Frame, item: Instance) -> dict[str, Any]:
        result: dict[str, Any] = {"category_id": item.model + 1, "iscrowd": 0, "area": int(item.mask.sum()),
                                  "bbox": box_of(item.mask, (0, 0, 0, 0)),
                                  "segmentation": self._segmentation(item.mask)}
        if self.stage.recipe.occluded:
            whole = int(item.whole.sum())
            result.update(a_area=whole, a_bbox=box_of(item.whole, (0, 0, 0, 0)), a_segm=self._segmentation(item.whole),
                          visible_fraction=result["area"] / whole)
        if item.keypoints is not None:
            result.update(self._keypoints(item.keypoints))
        return result

    def _segmentation(self, mask: Any) -> Any:
        """A mask as polygons or, where they cannot hold it, as run lengths."""
        polygons, holes = ([], True) if self.rle else outlines(mask)
        return run_lengths(mask) if holes else polygons

    @staticmethod
    def _keypoints(found: Keypoints) -> dict[str, Any]:
        """x, y, v of each; x, y, z, v of each, camera space. All are 0 outside of the image."""
        flat: list[float] = []
        solid: list[float] = []
        for pixel, point, flag in zip(found.pixels.tolist(), found.points.tolist(), found.visibility.tolist()):
            flat += [*pixel, flag] if flag else [0, 0, 0]
            solid += [*point, flag] if flag else [0, 0, 0, 0]
        return {"keypoints": flat, "num_keypoints": int((found.visibility > 0).sum()), "keypoints_3d": solid}

    def finish(self) -> None:
        categories = []
        for number, (name, model) in enumerate(zip(self.stage.names, self.stage.recipe.models)):
            category: dict[str, Any] = {"id": number + 1, "name": name, "supercategory": "object"}
            if model.keypoints:
                category.update(keypoints=list(model.keypoints), skeleton=[list(pair) for pair in model.skeleton])
            categories.append(category)
        images: list[dict[str, Any]] = []
        annotations: list[dict[str, Any]] = []
        for image, (_, part) in enumerate(self.parts(), 1):
            images.append({"id": image, **part["image"]})
            for annotation in part["annotations"]:
                annotations.append({"id": len(annotations) + 1, "image_id": image, **annotation})
        self.write_json(os.path.join(self.folder, "annotations.json"),
                   {"images": images, "annotations": annotations, "categories": categories})
