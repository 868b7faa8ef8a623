"""openvdb_files.py: the grids of OpenVDB files that volume objects refer to, read by the Python module pyopenvdb where it is installed."""
import importlib
import os
from typing import Any, NamedTuple

import numpy

MAX_VOXELS = 1 << 27  # of the box of a grid's active voxels
MODULES = "pyopenvdb", "openvdb"  # before and since OpenVDB 11


class Grid(NamedTuple):
    """The voxels of a grid with a layer of its background around them. values: z x y x x, of colours x 3, float32, at least 0; low, high: the box, where
    voxel (i, j, k) is from i to i + 1, as in Cycles (OpenVDB's own begin half a voxel earlier); matrix: object from voxels, 4 x 4;
    odd: the number of voxels that are NaN or infinite in the file; they are 0 here."""
    values: Any
    low: tuple
    high: tuple
    matrix: Any
    odd: int = 0

    def in_box(self, low, high):
        """The values in another box of voxels; 0 beyond this one's."""
        size = [int(high[i] - low[i]) for i in (2, 1, 0)]
        values = numpy.zeros(size + list(self.values.shape[3:]), dtype=numpy.float32)
        mine, other = [], []
        for i in (2, 1, 0):
            first, last = max(low[i], self.low[i]), min(high[i], self.high[i])
            if first >= last:
                return values
            mine.append(slice(int(first - self.low[i]), int(last - self.low[i])))
            other.append(slice(int(first - low[i]), int(last - low[i])))
        values[tuple(other)] = self.values[tuple(mine)]
        return values


class Unread(Exception):
    """A grid that cannot be read; its text says why."""


def name_of(volume):
    """The name of the file of a volume object's data; empty: it has none, as those that geometry nodes make."""
    return os.path.basename(volume.filepath.replace("\\", "/"))


def label(volume, name):
    """What the list calls a grid of a volume object's data: its name and that of its file."""
    file_name = name_of(volume)
    return "grid %s of %s" % (name, file_name) if file_name else "grid %s" % name


def _module():
    for name in MODULES:
        try:
            return importlib.import_module(name)
        except ImportError:
            continue
    raise Unread("the Python module pyopenvdb is not installed")


def has(volume, name):
    """Whether the file of an evaluated volume object's data has a grid of a name."""
    return bool(name and volume.filepath and volume.grids.load()) and any(grid.name == name for grid in volume.grids)


def read(volume, name, colors=False):
    """The Grid of a name in the file of an evaluated volume object's data, of the scene's frame. colors: of three numbers. Unread."""
    if not volume.filepath:
        raise Unread("it has no file")
    if not volume.grids.load():
        raise Unread("the file cannot be read")
    known = next((grid for grid in volume.grids if grid.name == name), None)
    if known is None or known.data_type not in (("VECTOR_FLOAT", "VECTOR_DOUBLE") if colors else ("FLOAT", "DOUBLE")):
        raise Unread("it has no grid %s of %s" % (name, "colours" if colors else "numbers"))
    try:
        grid = _module().read(volume.grids.frame_filepath, name)
    except (OSError, RuntimeError, KeyError, ValueError, TypeError) as error:
        raise Unread("the file cannot be read (%s)" % " ".join(str(error).split())) from error
    if "Frustum" in grid.transform.typeName:
        raise Unread("its voxels are in the frustum of a camera")
    matrix = numpy.array(known.matrix_object, dtype=float)
    if not numpy.isfinite(matrix).all() or abs(numpy.linalg.det(matrix)) < 1e-30:
        raise Unread("its voxels have no size")
    return _dense(grid, matrix, (3,) if colors else ())


def _dense(grid, matrix, more):
    low, high = (numpy.array(corner, dtype=numpy.int64) for corner in grid.evalActiveVoxelBoundingBox())
    size = high - low + 3
    if grid.activeVoxelCount() == 0 or size.min() < 3:
        raise Unread("the grid is empty")
    if float(size[0]) * float(size[1]) * float(size[2]) > MAX_VOXELS:
        raise Unread("its %d x %d x %d voxels are too many" % tuple(size))
    values = numpy.zeros(tuple(size) + more, dtype=numpy.float32)
    grid.copyToArray(values, ijk=tuple(int(index) - 1 for index in low))
    finite = numpy.isfinite(values)
    odd = values.size - int(numpy.count_nonzero(finite))
    values = numpy.maximum(numpy.where(finite, values, 0), 0).swapaxes(0, 2)
    return Grid(numpy.ascontiguousarray(values, dtype=numpy.float32), tuple(low - 1.0), tuple(high + 2.0), matrix, odd)
