"""Films: the samples of an image. They are written to files, read, continued and merged."""
from __future__ import annotations

import os
from typing import Any, Optional, Sequence

from velo import _check, _velo
from velo._context import context_or_default
from velo._errors import UsageError
from velo.image import Image, Path


def _state_of(path: Path) -> Optional[tuple[int, int, int]]:
    """What tells whether a file is still the one that it was; None: there is none, or it is empty."""
    try:
        info = os.stat(path)
    except OSError:
        return None
    return (info.st_dev, info.st_ino, info.st_mtime_ns) if info.st_size else None


class Film(_velo.Film):
    """The samples of an image. `Scene.render(film=film)` adds samples until it has spp of them per pixel; a render that is
    interrupted keeps its finished passes. Sums are exact: the same samples give the same bits in any order."""

    def image(self, *, exposure: float = 1.0) -> Image:
        """The developed image: linear R G B A, float32, of the crop window. exposure: factor on the values."""
        return self._image("color", exposure)

    def errors(self, *, exposure: float = 1.0) -> Image:
        """Standard errors of image()'s values, error.R .G .B. The film must be made with errors=True."""
        return self._image("errors", exposure)

    def spectrum(self) -> Image:
        """Radiance per wavelength, a channel for each bucket. The film must be made with buckets."""
        return self._image("spectrum", 1.0)

    #: The files that this film was read from or written to, by their paths, as they were then.
    _files: Optional[dict[str, Optional[tuple[int, int, int]]]] = None

    def _knows(self, path: Path) -> None:
        self._files = {**(self._files or {}), os.path.abspath(os.fsdecode(path)): _state_of(path)}

    def write(self, path: Path, *, overwrite: bool = False) -> None:
        """Writes a film file, whole or not at all. A file that is there already must be one that this film was read from or
        has written, and unchanged since; overwrite: replaces any."""
        _check.path(path, "path")
        overwrite = _check.flag(overwrite, "overwrite")
        state = _state_of(path)
        if state and state not in (self._files or {}).values() and not overwrite:
            raise UsageError(f"{os.fsdecode(path)}: this file is not of this film; overwrite=True replaces it")
        self._write(path)
        self._knows(path)

    def close(self) -> None:
        """Frees the samples."""
        self._close()

    def __enter__(self) -> "Film":
        return self

    def __exit__(self, *unused: Any) -> None:
        self.close()

    def __repr__(self) -> str:
        width, height = self.resolution
        return f"<velo.Film {width} x {height}: {self.spp} samples per pixel>"


_velo.set_type("Film", Film)


def read_film(path: Path, *, partial: bool = False, context: Any = None) -> Film:
    """Reads a film file. partial: pixels may have different samples; such a film can be developed, not continued."""
    film = _velo.film_read(context_or_default(context), path, _check.flag(partial, "partial"))
    if not partial:
        film._knows(path)
    return film


def merge_films(paths: Sequence[Path], output: Path, *, overwrite: bool = False, context: Any = None) -> None:
    """Merges film files of one render, which have different samples or pixels, to one. A film that is there already must be
    of the same render, and the result must have all its samples; overwrite: replaces any film."""
    _velo.film_merge(context_or_default(context), _check.items(paths, "paths", "paths"), output, overwrite)
