"""Raw images: the numbers of a sensor behind its colour filters; their files, colour and development."""
from __future__ import annotations

from typing import Any, Optional, Sequence

from velo import _arrays, _velo
from velo._context import context_or_default
from velo.image import Image, Path


class Raw:
    """A raw image: one 16-bit number for each pixel, and what is needed to develop it (docs/raw.md).

    The attributes may be changed; each call checks them anew. 0, "" and None mean: not known."""

    pattern: str  #: colours of the filters, rows separated by "/": "RG/GB", "W"
    bits: int  #: of a number, 1 to 16
    black: Any  #: the number for no light; or a list, one for each cell of the pattern
    white: int  #: the number for light that saturates
    camera: str  #: name of the camera
    exposure_time: float  #: seconds
    f_number: float
    focal_length: float  #: metres
    iso: int
    gain: float  #: numbers per electron
    read_noise: float  #: electrons
    baseline_exposure: float  #: EV that development adds
    neutral: Optional[Sequence[float]]  #: the numbers for white, the greatest 1
    matrices: Any  #: colours x 3 factors from XYZ, for A and for D65

    _names = ("pattern", "bits", "black", "white", "camera", "exposure_time", "f_number", "focal_length", "iso", "gain", "read_noise",
              "baseline_exposure", "neutral", "matrices")
    _image: Image

    def __init__(self, numbers: Any, *, pattern: str = "RG/GB", bits: int = 12, black: Any = 0, white: Optional[int] = None,
                 camera: str = "", exposure_time: float = 0.0, f_number: float = 0.0, focal_length: float = 0.0, iso: int = 0,
                 gain: float = 0.0, read_noise: float = 0.0, baseline_exposure: float = 0.0,
                 neutral: Optional[Sequence[float]] = None, matrices: Any = None, context: Any = None) -> None:
        """A raw image with a copy of an array of uint16, rows x columns. white: default 2^bits - 1."""
        image = Image(numbers, encoding="linear", context=context)
        if white is None:
            white = 2 ** bits - 1 if isinstance(bits, int) and 1 <= bits <= 16 else 65535
        values = dict(pattern=pattern, bits=bits, black=black, white=white, camera=camera, exposure_time=exposure_time,
                      f_number=f_number, focal_length=focal_length, iso=iso, gain=gain, read_noise=read_noise,
                      baseline_exposure=baseline_exposure, neutral=neutral, matrices=matrices)
        self._take(image, _velo.raw_check(image, values))

    def _take(self, image: Image, values: dict[str, Any]) -> None:
        self._image = image
        self.__dict__.update(values)

    def _values(self) -> dict[str, Any]:
        return {name: getattr(self, name) for name in self._names}

    @property
    def numbers(self) -> Any:
        """The numbers, rows x columns of uint16; the array shares the raw image's memory."""
        return _arrays.from_buffer(self._image._plane(0, 1, True))

    @property
    def resolution(self) -> tuple[int, int]:
        """Width and height, pixels."""
        return self._image.resolution

    def match_color(self, sensitivities: Any, light: Any = None) -> None:
        """Sets matrices and neutral from spectral sensitivities.

        sensitivities: colours x 471 values, for each nm from 360 to 830, the colours in the order R G B C M Y W. light: the
        spectrum of the scene's light, 471 values; default D65."""
        self._take(self._image, _velo.raw_match_color(self._image, self._values(), sensitivities, light))

    def write(self, path: Path) -> None:
        """Writes a file; the suffix selects the format: .dng (all), .tif .png (the numbers), .exr (electrons)."""
        _velo.raw_write(self._image, self._values(), path)

    def develop(self, stop_at: str = "tone", *, exposure: float = 0.0) -> Image:
        """A developed image. stop_at: the last step, black, white, demosaic, color or tone. exposure: EV that tone adds."""
        return _velo.raw_develop(self._image, self._values(), stop_at, exposure)

    def __repr__(self) -> str:
        width, height = self.resolution
        return f"<velo.Raw {width} x {height}, {self.bits} bits, {self.pattern}>"


def raw_of(image: Image, values: dict[str, Any]) -> Raw:
    """The raw image of an image of numbers, which it keeps, and values of the extension's."""
    raw = Raw.__new__(Raw)
    raw._take(image, values)
    return raw


def read_raw(path: Path, *, context: Any = None) -> Raw:
    """Reads a DNG file that velo wrote."""
    return raw_of(*_velo.raw_read(context_or_default(context), path))
