"""Cameras: every model, K and poses as arrays, projection of arrays, camera files."""
from __future__ import annotations

import os
import tempfile
from typing import TYPE_CHECKING, Any, Callable, NamedTuple, Optional, Sequence, Union

from velo import _arrays, _check, _keywords, _velo
from velo._context import context_or_default
from velo.image import Path
from velo.own import bare

if TYPE_CHECKING:
    from typing import Unpack  # since 3.11


class Projection(NamedTuple):
    """Where points are seen. n: the shape of the points without their last axis: n, or rows x columns."""
    pixels: Any  #: n x 2: x, y; the first pixel's centre is (0.5, 0.5)
    z: Any  #: n: depth along the view axis, scene units
    valid: Any  #: n: False for points behind the camera or outside its domain, whose numbers are 0


class Rays(NamedTuple):
    """What pixels look along, in world space. n: as of Projection."""
    origins: Any  #: n x 3, scene units
    directions: Any  #: n x 3, unit vectors
    valid: Any  #: n: False for pixels outside the camera's domain, whose numbers are 0


class Jacobian(NamedTuple):
    """Derivatives at points or pixels. n: as of Projection."""
    values: Any  #: n x rows x len(JACOBIAN_COLUMNS); pixels, scene units, radians
    valid: Any  #: n: False where there is no derivative; the numbers are 0


#: The columns of a Jacobian (velo/jacobian.h): the point; translation and rotation of camera_from_world' = exp(.)
#: camera_from_world; intrinsics; the projection's numbers; the common form of all distortions (docs/cameras.md).
JACOBIAN_COLUMNS = ("point_x", "point_y", "point_z", "t_x", "t_y", "t_z", "r_x", "r_y", "r_z", "fx", "fy", "skew", "cx", "cy",
                    "shape_0", "shape_1", "n0", "n1", "n2", "n3", "n4", "n5", "d0", "d1", "d2", "p0", "p1", "t0", "t1", "t2", "t3",
                    "tau_x", "tau_y")


def _jacobian(data: tuple[bytearray, bytearray], points: Any, rows: int) -> Jacobian:
    n = _shape_of(points, len(data[1]))
    values = _arrays.from_bytes(data[0], "d", (*n, rows, len(JACOBIAN_COLUMNS)))
    return Jacobian(values, _flags(data[1], n))


def _flags(data: bytearray, shape: Sequence[int]) -> Any:
    flags = _arrays.from_bytes(data, "B", shape)
    return flags.astype(bool) if _arrays.numpy_or_none() is not None else [bool(flag) for flag in flags]


def _shape_of(points: Any, count: int) -> tuple[int, ...]:
    """The shape of an array of points without its last axis; (count,) of what has no shape."""
    numpy = _arrays.numpy_or_none()
    shape = () if numpy is None else numpy.shape(points)
    return tuple(shape[:-1]) if len(shape) > 2 else (count,)


class Camera(_velo.Camera):
    """A camera for an image of `width` x `height` pixels. It never changes; `replace` makes another one.

    Keywords are the members of vlCameraDef (docs/cameras.md): projection, fov, fx, fy, cx, cy, skew, focal_mm,
    sensor_width_mm, view_distance, zoom, pixel_size, eye, lookat, up, roll, lens_radius, f_number, focus_distance, shape,
    distortion, distortion_coefficients and so on. Angles are in radians, lengths in scene units. Further ones:

    K: 3 x 3, [fx skew cx; 0 fy cy; 0 0 1], pixels.
    world_from_camera, camera_from_world: 4 x 4; the camera's x points right, y down, z forward.
    colmap: (model, parameters), one of COLMAP's camera models.
    shutter: pairs of time (0 to 1) and opening.
    own: a velo.OwnCamera, in place of projection and lens.

    Without keywords it is a pinhole camera at the origin that looks along -z, with 90 degrees across the smaller side."""

    def __new__(cls, width: int, height: int, **keywords: Unpack[_keywords.Cameras]) -> "Camera":
        return _velo.camera_new(width, height, {name: bare(value) for name, value in keywords.items()})

    @property
    def width(self) -> int:
        """Pixels in a row."""
        return self.resolution[0]

    @property
    def height(self) -> int:
        """Number of rows."""
        return self.resolution[1]

    @property
    def K(self) -> Any:
        """3 x 3: [fx skew cx; 0 fy cy; 0 0 1], pixels. For the first pixel's centre at (0, 0), as OpenCV has it, subtract
        0.5 from cx and cy."""
        return _arrays.from_rows(self._k, 3, 3)

    @property
    def world_from_camera(self) -> Any:
        """4 x 4: the pose; x right, y down, z forward."""
        return _arrays.from_rows(self._world_from_camera, 4, 4)

    @property
    def camera_from_world(self) -> Any:
        """4 x 4: the inverse of the pose."""
        return _arrays.from_rows(self._camera_from_world, 4, 4)

    def get(self, name: str) -> Any:
        """A parameter as it was given; None: it was not."""
        return self._get(name)

    def replace(self, **keywords: Unpack[_keywords.Cameras]) -> "Camera":
        """This camera with other parameters. A given focal length replaces all that were given before. Numbers that are only a
        part of it (zoom, pixel_size; focal_mm, sensor_width_mm; an edge of the screen) go with those given before."""
        return self._replace({name: bare(value) for name, value in keywords.items()})

    def resize(self, width: int, height: int) -> "Camera":
        """This camera for another image size. Focal length and principal point scale with the smaller side."""
        return self._resize(width, height)

    def coarse(self, factor: int) -> "Camera":
        """The same view with pixels that are `factor` (1 to 64) times as wide and as high: pixel (x, y) covers the pixels from
        (factor x, factor y) on. The last column and row may reach beyond the image."""
        return self._coarse(factor)

    def move(self, world_from_camera: Any) -> "Camera":
        """This camera with another pose, 4 x 4, at rest."""
        return self._move(world_from_camera)

    def at(self, time: float) -> "Camera":
        """This camera frozen at a time, seconds."""
        return self._at(time)

    def eyes(self) -> tuple["Camera", "Camera"]:
        """The left and the right camera of a stereo pair (keywords stereo_mode, interocular, convergence)."""
        return self._stereo()

    def project(self, points: Any, *, jacobian: bool = False) -> Any:
        """Where points (n x 3 or rows x columns x 3, world space) are seen: a Projection. A moving camera
        sees them in the middle of its exposure, a rolling shutter when it exposes the row of their pixel.

        jacobian=True: a pair of it and its Jacobian, of the pixels (2) by JACOBIAN_COLUMNS."""
        if _check.flag(jacobian, "jacobian"):
            return self.project(points), _jacobian(self._project_jacobian(points), points, 2)
        pixels, z, valid = self._project(points)
        n = _shape_of(points, len(valid))
        return Projection(_arrays.from_bytes(pixels, "d", (*n, 2)), _arrays.from_bytes(z, "d", n), _flags(valid, n))

    def unproject(self, pixels: Any, *, jacobian: bool = False) -> Any:
        """The rays through film points (n x 2 or rows x columns x 2; the first pixel's centre is (0.5, 0.5)): Rays.

        jacobian=True: a pair of them and their Jacobian, of origin and direction (6) by JACOBIAN_COLUMNS; its columns
        point_x and point_y are the film point's x and y."""
        if _check.flag(jacobian, "jacobian"):
            return self.unproject(pixels), _jacobian(self._unproject_jacobian(pixels), pixels, 6)
        origins, directions, valid = self._unproject(pixels)
        n = _shape_of(pixels, len(valid))
        return Rays(_arrays.from_bytes(origins, "d", (*n, 3)), _arrays.from_bytes(directions, "d", (*n, 3)), _flags(valid, n))

    def film_times(self, pixels: Any) -> Any:
        """When film points (n x 2 or rows x columns x 2) see the world, seconds: the times of `project` and `unproject`. The
        middle of the exposure, with a rolling shutter that of each film point's row."""
        times = self._film_times(pixels)
        return _arrays.from_bytes(times, "d", _shape_of(pixels, len(times) // 8))

    def write(self, path: Path, *, dialect: Optional[str] = None, name: str = "", drop: Sequence[str] = (),
              context: Any = None) -> None:
        """Writes a camera file of velo or of another tool (docs/camera-files.md).

        dialect: "velo", "opencv", "colmap", "nerf", ...; default: by the suffix. drop: fields that may be lost, by
        the names that the errors give ("skew", "distortion", ...; docs/camera-files.md)."""
        self._write(context_or_default(context), path, dialect, name, _check.names(drop, "drop"))

    def __copy__(self) -> "Camera":
        return self  # it never changes

    def __deepcopy__(self, memo: Any) -> "Camera":
        return self

    def __reduce__(self) -> tuple[Callable[[str], "Camera"], tuple[str]]:
        """For pickle: the text of velo's camera file, from which the same camera is made. UsageError: an own camera."""
        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, "camera.json")
            self.write(path, dialect="velo")
            with open(path, encoding="utf-8") as file:
                return _from_text, (file.read(),)

    def __repr__(self) -> str:
        return f"<velo.Camera {self.projection}, {self.width} x {self.height}>"


_velo.set_type("Camera", Camera)
_keywords.show(Camera.__new__, _keywords.Cameras)
_keywords.show(Camera.replace, _keywords.Cameras)


def _from_text(text: str) -> Camera:
    with tempfile.TemporaryDirectory() as folder:
        path = os.path.join(folder, "camera.json")
        with open(path, "w", encoding="utf-8") as file:
            file.write(text)
        return read_camera(path, dialect="velo")


class TrajectoryFrame(NamedTuple):
    """A pose of a trajectory."""
    name: str  #: of the image; may be empty
    camera: Optional[Camera]  #: with this pose; None: the file has only poses
    world_from_camera: Any  #: 4 x 4
    time: Optional[float]  #: seconds; None: not in the file


def read_camera(path: Path, *, dialect: Optional[str] = None, frame: Union[str, int, None] = None, width: int = 0,
                height: int = 0, context: Any = None) -> Camera:
    """Reads a camera file of velo or of another tool; default: the file's contents decide the dialect.

    frame: name or number (from 0) of one of several cameras. width, height: for files without an image size. Of a .pbrt file it is
    the scene's camera."""
    by_name = dialect is None and isinstance(path, (str, os.PathLike)) and os.fspath(path).endswith((".pbrt", ".pbrt.gz"))
    if by_name or (isinstance(dialect, str) and dialect == "pbrt"):
        from velo.scene import load
        camera = load(path, context=context).camera
        return camera.resize(width, height) if width and height else camera
    return _velo.camera_read(context_or_default(context), path, dialect, frame, width, height)[0]


def read_trajectory(path: Path, *, dialect: Optional[str] = None, width: int = 0, height: int = 0,
                    context: Any = None) -> list[TrajectoryFrame]:
    """Reads a file of many poses and several cameras: COLMAP, transforms.json, Kalibr, TUM, KITTI, CSV (docs/rigs.md)."""
    frames = _velo.trajectory_read(context_or_default(context), path, dialect, width, height)
    return [TrajectoryFrame(name, camera, _arrays.from_rows(pose, 4, 4), time) for name, camera, pose, time in frames]
