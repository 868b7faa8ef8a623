"""Makes the frames of a recipe and writes them."""
from __future__ import annotations

import os
from concurrent.futures import Future, ThreadPoolExecutor
from typing import Any, Callable, Iterable, Optional, Sequence, Union

from velo import _check
from velo._context import protecting_context
from velo._errors import UsageError, unknown, wrong_value
from velo.dataset.bop import BopWriter
from velo.dataset.check import checked
from velo.dataset.cameras import View
from velo.dataset.coco import CocoWriter
from velo.dataset.exr import ExrWriter
from velo.dataset.nerfstudio import NerfstudioWriter
from velo.dataset.raw import RawWriter
from velo.dataset.recipe import Recipe
from velo.dataset.stage import Frame, Stage
from velo.dataset.writer import Writer

WRITERS: dict[str, Any] = {"bop": BopWriter, "coco": CocoWriter, "nerfstudio": NerfstudioWriter, "exr": ExrWriter,
                           "raw": RawWriter}


def make_writers(stage: Stage, folder: str, names: Iterable[str]) -> list[Writer]:
    """The writers of these names: bop, coco, nerfstudio, exr, raw."""
    writers = []
    wanted = _check.names(names, "writers")
    if not wanted:
        raise UsageError(f"no writer is named (known: {', '.join(sorted(WRITERS))})")
    for name in wanted:
        if name not in WRITERS:
            raise unknown("writer", name, list(WRITERS))
        writers.append(WRITERS[name](stage, folder))
    return writers


def generate(recipe: Recipe, folder: Union[str, "os.PathLike[str]"], *, writers: Sequence[str] = ("bop",),
             frames: Optional[Iterable[int]] = None, progress: Optional[Callable[[int], None]] = None,
             context: Any = None) -> None:
    """Renders frames and writes them to a folder.

    frames: numbers from 0; default all of the recipe. Shards on several machines make different frames of one folder; the
    tables over all frames are written anew by each, from what is there. A file that was read for the dataset (the recipe,
    models, cameras, textures) is not overwritten: one that would be is found when the first frame is loaded, before anything is
    rendered or written. progress: called with each finished frame."""
    if not isinstance(folder, (str, os.PathLike)) or not os.fspath(folder):
        raise wrong_value("folder", "a path: a str or an os.PathLike", folder)
    _check.callback(progress, "progress")
    recipe = checked(recipe)
    context = protecting_context() if context is None else context
    stage = Stage(recipe, context=context)
    stage.note_inputs()
    last = stage.recipe.frames - 1
    numbers = range(last + 1) if frames is None else frames
    if not isinstance(numbers, range):
        numbers = [_check.whole(number, "each of frames", 0, last) for number in _check.items(frames, "frames", "numbers")]
    elif numbers and not (0 <= numbers[0] <= last and 0 <= numbers[-1] <= last):
        raise wrong_value("frames", f"numbers from 0 to {last}", numbers)
    made = make_writers(stage, os.fspath(folder), writers)

    def begin(views: Sequence[View]) -> None:
        for writer in made:
            writer.check(numbers, [view.name for view in views])
            for view in views:
                writer.check_camera(view.camera)
        for writer in made:
            writer.begin()

    def write(images: list[Frame]) -> None:
        for scene, frame in enumerate(images):
            for writer in made:
                writer.check_camera(frame.camera)
                writer.write(frame, scene)

    begun = False
    # A frame is written while the next one renders.
    with ThreadPoolExecutor(max_workers=1) as pool:
        pending: Optional[tuple[int, Future[None]]] = None
        for number in numbers:
            images = stage.render(number, None if begun else lambda plan: begin(plan.views))
            begun = True
            _finish(pending, progress)
            pending = number, pool.submit(write, images)
        _finish(pending, progress)
    if not begun:
        begin(stage.plan(0).views)
    for writer in made:
        writer.finish()


def _finish(pending: Optional[tuple[int, Future[None]]], progress: Optional[Callable[[int], None]]) -> None:
    """Waits until a frame is written."""
    if pending:
        pending[1].result()
        if progress:
            progress(pending[0])
