"""Films: the samples of an image. They are written to files, read, continued and merged."""
from __future__ import annotations

from typing import Any, Sequence

from velo import _velo
from velo._context import default_context
from velo.image import Image, Path


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

    def write(self, path: Path) -> None:
        """Writes a film file, whole or not at all."""
        self._write(path)

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
    return _velo.film_read(context or default_context(), path, partial)


def merge_films(paths: Sequence[Path], output: Path, *, context: Any = None) -> None:
    """Merges film files of one render, which have different samples or pixels, to one."""
    _velo.film_merge(context or default_context(), list(paths), output)
