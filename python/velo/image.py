"""Images: pixels with named channels; image files, views, comparison."""
from __future__ import annotations

import os
import tempfile
from typing import TYPE_CHECKING, Any, Optional, Sequence, Union

from velo import _arrays, _check, _keywords, _velo
from velo._context import context_or_default
from velo._errors import UsageError, shown, wrong_value

if TYPE_CHECKING:
    from typing import Unpack  # since 3.11

Path = Union[str, "os.PathLike[str]"]
_POLLED_ROWS = 32  # that are joined between two calls of poll
#: What other programs call the channels.
OTHER_NAMES = {"depth": "Z", "normal": "N", "normals": "N", "position": "P", "positions": "P", "points": "P", "base_color": "albedo",
               "basecolor": "albedo", "diffuse": "albedo", "color": "R, G, B", "rgb": "R, G, B", "alpha": "A", "ids": "id.object",
               "segmentation": "id.object", "instances": "id.instance", "flow": "forward"}


class Image(_velo.Image):
    """Pixels of height x width x channels, rows from the top.

    `numpy.asarray(image)` is an array of this shape without a copy: float32, linear R G B A for rendered images. Further
    channels of a render (depth, normals, ids) are in parts with types of their own: `image["Z"]` is an array of height x
    width, `image["N"]` of height x width x 3, `image["id.object"]` of uint32. Arrays share the image's memory and keep it
    alive. Where numpy is not installed, they are memoryviews."""

    _more: tuple["Image", ...]

    def __new__(cls, array: Any, names: Optional[Sequence[str]] = None, *, encoding: Optional[str] = None,
                context: Any = None) -> "Image":
        """An image with a copy of an array of height x width or height x width x channels.

        names: a name for each channel ("R", "Z", "N.X"); default Y, Y A, R G B or R G B A.
        encoding: of integers, "linear" or "srgb"; default: srgb for 8-bit integers, else linear."""
        try:
            size = memoryview(array).itemsize
        except TypeError:
            raise wrong_value("image", "an array of rows x columns x channels", array) from None
        if encoding is None:
            encoding = "srgb" if size == 1 else "linear"
        if names is not None:
            names = _check.names(names, "names")
            if len(set(names)) < len(names):
                raise wrong_value("names", "a different name for each channel", names)
        return _velo.image_new(context_or_default(context), array, names, encoding)

    @property
    def parts(self) -> tuple["Image", ...]:
        """This image and the images that hold its further channels."""
        return (self,) + getattr(self, "_more", ())

    @property
    def channels(self) -> tuple[str, ...]:
        """The names of all channels: "R", "G", "B", "A", "Z", "N.X", ..."""
        return tuple(name for part in self.parts for name in part._names)

    @property
    def resolution(self) -> tuple[int, int]:
        """Width and height, pixels."""
        return self.width, self.height

    def plane(self, name: str) -> Any:
        """The channel of this name (height x width), or the channels of this layer ("N": "N.X", "N.Y", "N.Z"; height x width x
        3), as a buffer."""
        _check.text(name, "the name of a channel")
        for part in self.parts:
            names = part._names
            if name in names:
                return part._plane(names.index(name), 1, True)
            layer = [i for i, full in enumerate(names) if full.startswith(name + ".")]
            if layer and layer == list(range(layer[0], layer[0] + len(layer))):
                return part._plane(layer[0], len(layer), len(layer) == 1)
        known = ", ".join(self.channels)
        other = OTHER_NAMES.get(name.lower())
        hint = f"; it is called {other}" if other else ""
        raise UsageError(f"the image has no channel {shown(name)}{hint} (it has {known})")

    def __getitem__(self, name: Any) -> Any:
        """A channel or a layer by its name; or pixels, as of the array: image[..., 0], image[10:20, :, :3]."""
        if isinstance(name, str):
            return _arrays.from_buffer(self.plane(name))
        return _arrays.from_buffer(self)[name]

    def __contains__(self, name: object) -> bool:
        return any(full == name or full.startswith(f"{name}.") for full in self.channels)

    def __iter__(self) -> Any:
        raise TypeError("an Image is not iterable; its channels are image.channels")

    def write(self, path: Path, **options: Unpack[_keywords.Write]) -> None:
        """Writes a file; the suffix selects the format: .exr (all channels), .png .jpg .hdr .pfm .tga (the colours).

        half: EXR, 16-bit floats for colours. compression: EXR, 0 none, 1 ZIP. quality: JPEG, 1 to 100."""
        whole = isinstance(path, (str, os.PathLike)) and os.fspath(path).endswith(".exr")
        words: dict[str, Any] = {**options}
        _velo.image_write(list(self.parts) if whole else [self], path, words)

    def view(self, view: str = "standard", *, exposure: float = 0.0) -> "Image":
        """An 8-bit sRGB image for displays. view: standard, khronos_neutral, agx or raw. exposure: in stops."""
        return self._view(view, exposure)

    def compare(self, reference: "Image") -> dict[str, float]:
        """Differences from a reference of the same size: mse, rel_mse, psnr (dB), flip, mean_ratio, max_abs, differing and
        not_finite (pixels)."""
        return self._compare(_check.instance(reference, Image, "reference"), False)[0]

    def difference(self, reference: "Image") -> "Image":
        """FLIP's differences from a reference, in false colours, as an 8-bit image."""
        return self._compare(_check.instance(reference, Image, "reference"), True)[1]

    def denoise(self, denoiser: str = "velo") -> "Image":
        """A denoised copy. The image must have the channels "error" and should have "features" (scene.render(channels=...)).
        denoiser: velo, or oidn (the user's Open Image Denoise). Pixels that are not finite get their neighbours' light; a
        RuntimeWarning says how many there are."""
        return self._denoised(denoiser, None)

    def _denoised(self, denoiser: str, poll: Any) -> "Image":
        # poll: called about fifty times a second without arguments, None: by nobody; an exception ends the call.
        if len(self.parts) == 1:
            return self._denoise(denoiser, poll)
        numpy = _arrays.numpy_or_none()
        if numpy is None:
            raise UsageError("numpy is needed to join the image's channels")
        # Joined row by row into the image's own memory, so that whoever waits can be asked in between.
        kept, names = [], []
        for part in self.parts:
            array = numpy.asarray(part)
            used = [i for i, name in enumerate(part._names) if part is self or name.startswith(("error.", "feature."))]
            if array.dtype == numpy.float32 and used:
                kept.append((array, used))
                names += [part._names[i] for i in used]
        joined = self._unset(names)
        rows = numpy.asarray(joined)
        for row in range(self.height):
            if poll is not None and row % _POLLED_ROWS == 0:
                poll()
            numpy.concatenate([array[row][:, used] for array, used in kept], axis=1, out=rows[row])
        return joined._denoise(denoiser, poll)

    def __copy__(self) -> "Image":
        return _of_parts(*(_part(part) for part in self.parts))

    def __deepcopy__(self, memo: Any) -> "Image":
        return self.__copy__()

    def __reduce__(self) -> Any:
        """For pickle: pixels, names of the channels, encodings and attributes."""
        return _of_parts, tuple(_part(part) for part in self.parts)

    def _repr_png_(self) -> bytes:
        """The image as a PNG, for notebooks."""
        buffer: Any = self
        shown = self if memoryview(buffer).itemsize == 1 else self._view("standard", 0.0)
        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, "image.png")
            _velo.image_write([shown], path, {})
            with open(path, "rb") as file:
                return file.read()

    def close(self) -> None:
        """Frees the pixels. BufferError while arrays share them."""
        for part in self.parts:
            part._close()

    def __enter__(self) -> "Image":
        return self

    def __exit__(self, *unused: Any) -> None:
        try:
            self.close()
        except BufferError:
            pass  # arrays keep the memory

    def __repr__(self) -> str:
        return f"<velo.Image {self.width} x {self.height}: {' '.join(self.channels)}>"


_velo.set_type("Image", Image)
_keywords.show(Image.write, _keywords.Write)


#: Of a part of an image: pixels, their type, shape, names of channels, encoding, attributes.
_Part = tuple[bytes, str, tuple[int, ...], tuple[str, ...], str, list[Any]]


def _part(image: Image) -> _Part:
    buffer: Any = image
    view = memoryview(buffer)
    return view.tobytes(), view.format, tuple(view.shape or ()), tuple(image._names), image.encoding, image._attributes()


def _of_parts(*parts: _Part) -> Image:
    made = []
    for data, code, shape, names, encoding, attributes in parts:
        image = Image(memoryview(data).cast("B").cast(code, shape), names, encoding=encoding)
        image._set_attributes(attributes)
        made.append(image)
    return join(made[0], made[1:])


def join(first: Image, parts: Sequence[Optional[Image]]) -> Image:
    """Adds further parts to an image."""
    first._more = getattr(first, "_more", ()) + tuple(part for part in parts if part is not None)
    return first


def read_image(path: Path, channels: Optional[Sequence[str]] = None, *, context: Any = None) -> Image:
    """Reads an image file: EXR, PNG, JPEG, HDR, PFM, TGA, BMP, GIF, PNM, QOI, WebP.

    channels: of an EXR file, only these; if they have one type, so has the image (ids stay uint32)."""
    return _velo.image_read(context_or_default(context), path, channels)
