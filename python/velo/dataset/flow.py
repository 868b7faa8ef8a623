"""Writes and reads optical flow in the formats of two benchmarks.

Sources: Butler et al., "A naturalistic open source movie for optical flow evaluation", ECCV 2012 (.flo, which Sintel has from
Baker et al., "A database and evaluation methodology for optical flow", IJCV 2011); the KITTI 2015 development kit, readme.txt
(16-bit PNG)."""
from __future__ import annotations

import os
import struct
from typing import Any, NamedTuple, Union

import numpy

import velo
from velo import _check
from velo._context import context_or_default
from velo._errors import MissingFileError, OutputError, SceneError, UnsupportedError, UsageError
from velo.dataset.files import write_bytes
from velo.dataset.png import png

TAG = b"PIEH"  # 202021.25 as a little-endian float
UNKNOWN = 1e10  # in .flo files
MAX_KNOWN = 1e9  # what is beyond is unknown
KITTI_STEPS = 64  # steps of a pixel
KITTI_ZERO = 32768
NO_PROJECTION = 3  # VL_HIDDEN_NOWHERE


def write_flow(image: Any, path: Union[str, "os.PathLike[str]"], channel: str = "forward", *, hidden: bool = True,
               context: Any = None) -> None:
    """Writes the flow of an image of ground truth: NAME.flo (Sintel, Middlebury: float) or NAME.png (KITTI: steps of 1/64 pixel
    from -512 to 511.98, and whether the pixel is valid).

    channel: forward or backward. Pixels whose point has no projection in the other image are unknown; with hidden=False those
    whose point is hidden or outside there are, too (KITTI's flow_noc). Errors: velo.UsageError for another suffix, an image
    without the channel, or a file that the context has read and keeps; velo.UnsupportedError for a flow that the PNG cannot hold;
    velo.OutputError."""
    _check.instance(image, velo.Image, "image")
    name = os.fsdecode(_check.path(path, "path"))
    _check.choice(channel, "channel", ("forward", "backward"))
    _check.flag(hidden, "hidden")
    suffix = os.path.splitext(name)[1].lower()
    if suffix not in (".flo", ".png"):
        raise UsageError(f"{name}: flow is written to .flo (Sintel) or .png (KITTI)")
    if f"{channel}.U" not in image:
        raise UsageError(f'the image has no flow: make it with ground_truth(["{channel}"], {channel}=CAMERA)')
    flow = numpy.stack([numpy.asarray(image[f"{channel}.{axis}"], dtype="float32") for axis in "UV"], axis=-1)
    state = numpy.asarray(image[f"{channel}.hidden"])
    known = (state != NO_PROJECTION if hidden else state == 0) & numpy.isfinite(flow).all(axis=-1)
    data = _flo(flow, known) if suffix == ".flo" else _kitti(flow, known)
    write_bytes(os.path.abspath(name), data, context_or_default(context))


class Flow(NamedTuple):
    """Optical flow of a file."""
    flow: Any  #: height x width x 2, float32: by how many pixels a point moves to the right and down; 0 where it is unknown
    known: Any  #: height x width, bool


def read_flow(path: Union[str, "os.PathLike[str]"], *, context: Any = None) -> Flow:
    """Reads flow (a Flow: arrays of height x width x 2 and height x width) of a .flo file (Sintel, Middlebury) or of KITTI's PNG,
    also those of other programs. Errors: velo.UsageError for another suffix, velo.SceneError for a file that is none, and those of
    velo.read_image."""
    name = os.fsdecode(_check.path(path, "path"))
    suffix = os.path.splitext(name)[1].lower()
    if suffix == ".flo":
        return _from_flo(name)
    if suffix != ".png":
        raise UsageError(f"{name}: flow is read from .flo (Sintel) or .png (KITTI)")
    pixels = numpy.asarray(velo.read_image(name, context=context))
    if pixels.dtype != numpy.uint16 or pixels.ndim != 3 or pixels.shape[2] != 3:
        raise _damaged(name, "KITTI's flow is a PNG of three channels of 16 bits")
    known = pixels[..., 2] > 0
    steps = pixels[..., :2].astype("float32") - numpy.float32(KITTI_ZERO)
    return Flow(numpy.where(known[..., None], steps / numpy.float32(KITTI_STEPS), numpy.float32(0)), known)


def _damaged(name: str, reason: str) -> SceneError:
    error = SceneError(reason)
    error.file = name
    return error


def _from_flo(name: str) -> Flow:
    try:
        with open(name, "rb") as file:
            head = file.read(12)
            if len(head) < 12 or head[:4] != TAG:
                raise _damaged(name, "this is no flow in the format .flo: it does not begin with PIEH")
            width, height = struct.unpack("<ii", head[4:])
            size = os.fstat(file.fileno()).st_size
            if width < 1 or height < 1 or 12 + 8 * width * height != size:
                raise _damaged(name, f"the header says {width} x {height} pixels, which take {12 + 8 * width * height} bytes; "
                                     f"the file has {size}")
            data = file.read(8 * width * height)
    except FileNotFoundError:
        raise MissingFileError(f"no such file: {name}") from None
    except OSError as problem:
        raise OutputError(f"cannot read {name}: {problem.strerror}") from None
    flow = numpy.frombuffer(data, dtype="<f4").reshape(height, width, 2).astype("float32")
    known = (numpy.abs(flow) < MAX_KNOWN).all(axis=-1)  # NaN is unknown, too
    return Flow(numpy.where(known[..., None], flow, numpy.float32(0)), known)


def _flo(flow: Any, known: Any) -> bytes:
    """Tag, width, height, and u v of each pixel, row by row; little-endian."""
    height, width = known.shape
    values = numpy.where(known[..., None], flow, UNKNOWN).astype("<f4")
    return TAG + struct.pack("<ii", width, height) + values.tobytes()


def _kitti(flow: Any, known: Any) -> bytes:
    """Red and green: u and v in steps from KITTI_ZERO; blue: 1 where the pixel is valid. Others are 0 0 0."""
    steps = numpy.rint(numpy.where(known[..., None], flow, 0).astype("float64") * KITTI_STEPS) + KITTI_ZERO
    beyond = ((steps < 0) | (steps > 65535)).any(axis=-1)
    if beyond.any():
        row, column = (int(index[0]) for index in numpy.nonzero(beyond))
        u, v = flow[row, column]
        raise UnsupportedError(f"KITTI's flow holds -512 to 511.98 pixels; that of column {column}, row {row} is {u:.6g} {v:.6g} "
                               f"(of {int(beyond.sum())} pixels beyond); .flo can hold it")
    pixels = numpy.concatenate([steps, numpy.ones((*known.shape, 1))], axis=-1)
    return png(numpy.where(known[..., None], pixels, 0).astype("uint16"))
