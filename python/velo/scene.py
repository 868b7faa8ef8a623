"""Scenes: load them from files or build them from arrays, and render them."""
from __future__ import annotations

import math
import os
import warnings
from typing import TYPE_CHECKING, Any, Callable, Iterator, NamedTuple, Optional, Sequence, Union

from velo import _arrays, _check, _keywords, _solids, _velo, rays
from velo._context import context_or_default
from velo._errors import Progress, SceneError, Step, UsageError, shown, unknown, wrong_value
from velo._texels import texels
from velo.camera import Camera
from velo.film import Film
from velo.image import OTHER_NAMES, Image, Path, join
from velo.own import OwnCamera
from velo.settings import Settings
from velo.spectrum import Spectrum

if TYPE_CHECKING:
    from typing import Unpack  # since 3.11

Handle = _velo.Handle
Callback = Callable[[Progress], Optional[bool]]
StepCallback = Callable[[Step], Optional[bool]]
AnyCamera = Union[Camera, OwnCamera, None]

# Keywords of vlLoadDef; the other keywords of load() are those of vlCompleteDef.
_LOAD = ("permissive", "strict", "search_path", "time", "time_close", "scene", "animation", "variant", "camera", "scene_unit")
_ENVIRONMENTS = ("auto", "none", "studio", "sky", "white", "file", "lamps", "window", "evening")
# Settings that the world depends on; the others belong to the film and the render.
_BUILD = ("color", "light_sampler", "imitate_pbrt", "regularize", "bits", "accelerator")
_MAX_RACED = 64  # samples for which a race is planned, as by velo render: longer renders have the same tracer


def _is_auto(tracer: Any) -> bool:
    return isinstance(tracer, str) and tracer == "auto"


def _render(world: Any, view: Camera, film: Film, settings: Any, callback: Any) -> None:
    """Adds samples to a film, with a warning about those that were left out."""
    left_out, replaced, x, y = _velo.render(world, view, film, settings, callback)
    if left_out:
        warnings.warn(f"{left_out} samples were not finite or negative and were left out; one of them at pixel {x}, {y}",
                      RuntimeWarning, stacklevel=3)
    if replaced:
        warnings.warn(f"{replaced} numbers of the sampler were not in [0, 1) and were replaced", RuntimeWarning, stacklevel=3)


class World(_velo.World):
    """A compiled scene. It never changes; several renders may share it."""

    def ids(self, kind: str = "object") -> list[dict[str, Any]]:
        """What the ids of a kind (object, material, instance) stand for: dicts with id, name, path, type, file, line and
        material; id 1 first."""
        return self._ids(kind)

    def trace(self, origins: Any, directions: Any, t_max: Any = None, times: Any = None, *, t_min: Any = None, hits: int = 1,
              fields: Optional[Sequence[str]] = None) -> rays.RayHits:
        """What rays hit (docs/rays.md): the nearest surface, or up to `hits` (1 to 256) along each ray.

        origins, directions: n x 3, or of any shape with a last axis of 3; one of them may have a single row for all rays.
        Directions have any length but 0. t_min, t_max: n numbers, or one for all: the part of the ray that counts, in lengths
        of its direction. times: seconds, n or one; default 0. float32 and float64 arrays are read without a copy.
        fields: the names of velo.RayHits to compute; default all. shading_normal takes the longest.

        Rays whose numbers are not finite or whose direction is 0 hit nothing; they are counted in the result, and a
        RuntimeWarning says how many there are."""
        return rays.trace(self, origins, directions, t_max, times, t_min, hits, fields)

    def occluded(self, origins: Any, directions: Any, t_max: Any = None, times: Any = None, *, t_min: Any = None) -> Any:
        """Whether anything lies on each ray between t_min and t_max: n bools. Arguments as of trace (n x 3, scene units; seconds);
        with directions that lead from the origins to targets, t_max=1 asks whether the targets are hidden."""
        return rays.occluded(self, origins, directions, t_max, times, t_min)

    def close(self) -> None:
        """Frees the world."""
        self._close()

    def __enter__(self) -> "World":
        return self

    def __exit__(self, *unused: Any) -> None:
        self.close()


_velo.set_type("World", World)


# Families of what a model's file brings besides its group, each before what it uses.
_BROUGHT = ("materials", "emission", "media", "textures")


class Model(NamedTuple):
    """A file that was loaded as a group."""
    group: Handle  #: for add_instance
    name: str  #: of the group and its instances
    low: tuple[float, float, float]  #: the bounding box, in the file's own space
    high: tuple[float, float, float]
    shapes: int  #: number of shapes
    first_object: int  #: id.object of the first shape; the others follow
    handles: tuple[Handle, ...] = ()  #: all that the file brought: the group, its materials, textures, ...; each before what it uses


class Mesh(NamedTuple):
    """The arrays of a mesh."""
    positions: Any  #: n x 3, float32, scene units, in the shape's own space
    indices: Any  #: m x 3 or, of bilinear patches, m x 4, uint32: numbers of positions, from 0
    group_from_shape: Any  #: 4 x 4


def _read(value: Any) -> Any:
    """A value that _velo reads back: spectra and arrays are tuples with a tag."""
    if not isinstance(value, tuple) or not value or not isinstance(value[0], str):
        return value
    if value[0] == "array":
        return _arrays.from_bytes(*value[1:])
    kind, what, scale, space = value[1:]
    if kind == "sampled":
        what = tuple(tuple(_arrays.from_bytes(*part[1:]).tolist()) for part in what)
    return Spectrum(kind, what, scale, space)


def _as_image(value: Any, encoding: Optional[str] = None) -> Image:
    return value if isinstance(value, Image) else Image(value, encoding=encoding)


def _take_texels(keywords: dict[str, Any], color: bool) -> None:
    """The keywords image and range of a texture as one image."""
    limits = keywords.pop("range", None)
    if "image" in keywords:
        keywords["image"] = texels(keywords["image"], limits, color, keywords.get("scale"))
    elif limits is not None:
        raise UsageError("range: there is no image that it is of")


def _channels(value: Any) -> list[str]:
    names = _check.names(value, "channels")
    known = _velo.channel_names()
    for name in names:
        other = OTHER_NAMES.get(name.lower())
        if other and name not in known:
            raise UsageError(f"channels: {shown(name)} is called {other}")
        if name not in known:
            raise unknown("channel", name, known)
    return names


class _Asked:
    # A progress callback, or None, that is asked again after the render: poll gets its last state, without an answer; None before.
    def __init__(self, progress: Optional[Callback]) -> None:
        self._progress = progress
        self._last: Optional[Progress] = None
        self.callback: Any = self._ask if callable(progress) else progress

    def _ask(self, state: Progress) -> Any:
        self._last = state
        return self._progress(state) if self._progress is not None else None

    @property
    def poll(self) -> Optional[Callable[[], Any]]:
        return None if self._last is None else self._again

    def _again(self) -> None:
        if self._progress is not None and self._last is not None:
            self._progress(self._last._replace(pass_done=False))


class Scene(_velo.Scene):
    """The description of a world and of how its image is taken. A new scene is empty; `velo.load` reads a file.

    After an error of any method the scene is as it was before the call."""

    _world: Optional[tuple[Any, World]]
    _changed: bool
    _film: Optional[Film]
    _file: Optional[str]

    def __new__(cls, *, context: Any = None) -> "Scene":
        self = super().__new__(cls, context_or_default(context))
        self._world = None
        self._changed = False
        self._film = None
        self._file = None
        return self

    # ---- files and camera

    def load(self, path: Path, *, progress: Optional[StepCallback] = None, **keywords: Unpack[_keywords.Load]) -> None:
        """Adds the contents of a file: .pbrt, .gltf, .glb, .obj, .ply, .stl, .off. Keywords: vlLoadDef's. progress: called
        about twenty times a second with a velo.Step; False ends the load with a CancelledError. After this, and after a
        KeyboardInterrupt, the scene is as it was before."""
        words: dict[str, Any] = {**keywords}
        self._changed = True
        self._load(path, words, progress)
        self._file = self._file or os.fsdecode(path)

    def complete(self, **keywords: Unpack[_keywords.Complete]) -> None:
        """Adds a camera and lights if there are none, and what is asked for. Keywords: vlCompleteDef's; environment may also
        be the path of an image."""
        words: dict[str, Any] = {**keywords}
        self._changed = True
        environment = words.get("environment", "auto")
        if not (isinstance(environment, str) and environment in _ENVIRONMENTS):
            words.update(environment="file", path=environment)
        self._complete(words)

    def save(self, path: Path, *, strict: bool = False) -> dict[str, int]:
        """Writes the scene as .gltf, .glb or .pbrt. Returns what the format cannot hold and how often the scene has it;
        strict: such a loss is an UnsupportedError."""
        return self._save(path, strict)

    @property
    def camera(self) -> Camera:
        """The scene's camera. Setting it also sets the image size."""
        return self._camera()

    @camera.setter
    def camera(self, camera: Camera) -> None:
        self._set_camera(camera)

    @property
    def camera_medium(self) -> Optional[Handle]:
        """The medium that the camera is in, a handle that add_medium gave; None: vacuum. Light that crosses no surface with media stays
        in it, so it is that of the whole space around the shapes. Any camera that the scene is rendered with is in it."""
        return self._camera_medium()

    @camera_medium.setter
    def camera_medium(self, medium: Optional[Handle]) -> None:
        self._set_camera_medium(medium)
        self._changed = True

    # ---- contents

    def _new(self, family: str, kind: Optional[str], keywords: dict[str, Any]) -> Handle:
        self._changed = True
        return self._add(family, kind, keywords)

    def add_texture(self, kind: str, **keywords: Unpack[_keywords.Textures]) -> Handle:
        """Adds a texture: constant, image, checkerboard, fbm, ... Keywords: members of vlTextureDef (velo.kinds("textures")).
        spectrum: True (default) for a colour texture, False for a float texture. image: a velo.Image or an array of
        height x width x channels: uint8 (sRGB) and uint16 (linear) are scaled by 255 and 65535, floats are linear and taken as they
        are. range: (low, high), the array's numbers that are 0 and 1 of linear values; it is needed for other integers, and for
        floats beyond 0 to 1 of a colour texture."""
        words: dict[str, Any] = {**keywords}
        _take_texels(words, words.get("spectrum", True) is not False)
        return self._new("textures", kind, words)

    def add_material(self, kind: str, **keywords: Unpack[_keywords.Materials]) -> Handle:
        """Adds a material: diffuse, conductor, dielectric, principled, ... Keywords: members of vlMaterialDef
        (velo.kinds("materials")); numbers and spectra may be textures. name: its name."""
        words: dict[str, Any] = {**keywords}
        return self._new("materials", kind, words)

    def add_medium(self, kind: str, **keywords: Unpack[_keywords.Media]) -> Handle:
        """Adds a participating medium: homogeneous, grid, rgb_grid, cloud, nanovdb. Keywords: members of vlMediumDef.
        density and other grids: arrays of nz x ny x nx (rgb: x 3). pose: 4 x 4, world from medium."""
        words: dict[str, Any] = {**keywords}
        return self._new("media", kind, words)

    def add_emission(self, **keywords: Unpack[_keywords.Emission]) -> Handle:
        """Adds an emission of surfaces (keyword emission of add_shape). Keywords: radiance, scale, power (lm), radiant_power (W), two_sided, spread (radians), image."""
        words: dict[str, Any] = {**keywords}
        return self._new("emission", "diffuse", words)

    def add_light(self, kind: str, **keywords: Unpack[_keywords.Lights]) -> Handle:
        """Adds a light: point, spot, distant, infinite, goniometric, ... (velo.kinds("lights")). Keywords: members of vlLightDef: color,
        scale, power (lm), illuminance (lx), radiant_power (W), radiant_intensity (W/sr), irradiance (W/m2), position, to, image;
        path or lamp_data: a lamp file or its bytes; pose: 4 x 4, world from light. The member from, a word that Python reserves, is position or from_."""
        words: dict[str, Any] = {**keywords}
        if "image" in words:
            words["image"] = _as_image(words["image"], "linear")
        return self._new("lights", kind, words)

    def add_shape(self, kind: str, **keywords: Unpack[_keywords.Shapes]) -> Handle:
        """Adds a shape: triangles, bilinear, sphere, disk, cylinder, curves. Keywords: members of vlShapeDef: positions
        (n x 3), normals (n x 3), uvs (n x 2), indices (m x 3), radius, ...; material, emission, group, inside, outside:
        handles; pose (or transform): 4 x 4, group from shape; name: its name."""
        words: dict[str, Any] = {**keywords}
        return self._new("shapes", kind, words)

    def add_mesh(self, positions: Any, indices: Any, **keywords: Unpack[_keywords.Meshes]) -> Handle:
        """Adds triangles: positions n x 3, scene units; indices m x 3, from 0. Keywords: as add_shape."""
        return self.add_shape("triangles", positions=positions, indices=indices, **keywords)

    def add_sphere(self, center: Sequence[float], radius: float, **keywords: Unpack[_keywords.Quadrics]) -> Handle:
        """Adds a whole sphere: center (x, y, z) and radius in scene units. Keywords: as add_shape; a pose moves it on."""
        words: dict[str, Any] = {**keywords}
        radius = _check.number(radius, "radius")
        _solids.place(words, _solids.shift(_solids.vector(center, "center")))
        return self.add_shape("sphere", radius=radius, z_min=-radius, z_max=radius, **words)

    def add_box(self, low: Sequence[float], high: Sequence[float], **keywords: Unpack[_keywords.AllShapes]) -> Handle:
        """Adds a box from corner low to corner high (x, y, z), scene units: 12 triangles whose normals point outwards, uvs from 0
        to 1 on each side. Keywords: as add_shape."""
        return self.add_shape("triangles", **_solids.box(_solids.vector(low, "low"), _solids.vector(high, "high")), **keywords)

    def add_plane(self, center: Sequence[float], normal: Sequence[float], width: float, height: float, **keywords: Unpack[_keywords.AllShapes]) -> Handle:
        """Adds a rectangle about a center (x, y, z), scene units. Its width is along the horizontal axis across the normal (z being
        up; x where the normal is along z); uvs from 0 to 1. Keywords: as add_shape."""
        size = _check.number(width, "width", 0), _check.number(height, "height", 0)
        return self.add_shape("triangles", **_solids.plane(_solids.vector(center, "center"), _solids.vector(normal, "normal"), *size),
                              **keywords)

    def add_disk(self, center: Sequence[float], radius: float, normal: Sequence[float], **keywords: Unpack[_keywords.Quadrics]) -> Handle:
        """Adds a disk about a center (x, y, z), scene units; it emits along its normal. Keywords: as add_shape."""
        words: dict[str, Any] = {**keywords}
        place = _solids.frame(_solids.vector(center, "center"), _solids.vector(normal, "normal"), "normal")
        _solids.place(words, place)
        return self.add_shape("disk", radius=_check.number(radius, "radius"), **words)

    def add_cylinder(self, start: Sequence[float], end: Sequence[float], radius: float, **keywords: Unpack[_keywords.Quadrics]) -> Handle:
        """Adds a cylinder about the line from start to end (x, y, z), scene units; it is open, add_disk closes it. Keywords: as
        add_shape."""
        words: dict[str, Any] = {**keywords}
        first, last = _solids.vector(start, "start"), _solids.vector(end, "end")
        axis = (last[0] - first[0], last[1] - first[1], last[2] - first[2])
        _solids.place(words, _solids.frame(first, axis, "end minus start"))
        return self.add_shape("cylinder", radius=_check.number(radius, "radius"), z_min=0.0, z_max=math.hypot(*axis), **words)

    def add_group(self, name: Optional[str] = None) -> Handle:
        """Adds an empty group. Shapes join it (keyword group); add_instance places it."""
        return self._new("groups", name, {})

    def load_group(self, path: Path, name: Optional[str] = None, *, progress: Optional[StepCallback] = None,
                   **keywords: Unpack[_keywords.Load]) -> "Model":
        """Loads a model's file as one group, which add_instance places; the file's camera, lights and emission are ignored.
        name: the name of its instances; default the file's name without suffix. progress, keywords: as load."""
        words: dict[str, Any] = {**keywords}
        self._changed = True
        if name is None and isinstance(path, (str, os.PathLike)):
            name = os.path.basename(os.fspath(path)).split(".")[0]
        before = {family: self._handles(family)[-1:] for family in _BROUGHT}
        group, info = self._load_group(path, name, words, progress)
        brought = [group]
        for family in _BROUGHT:
            highest = before[family][0].index if before[family] else 0
            brought += [handle for handle in reversed(self._handles(family)) if handle.index > highest]
        return Model(group, name, info["low"], info["high"], info["shapes"], info["first_object"], tuple(brought))

    def add_instance(self, group: Handle, transform: Any = None, times: Optional[Sequence[float]] = None, *, pose: Any = None) -> Handle:
        """Places a group: pose (or transform) is 4 x 4, world from group. With times (seconds, ascending) it moves: a matrix for
        each time."""
        if (transform is None) == (pose is None):
            raise UsageError("pose: give either it or transform, 4 x 4 numbers")
        self._changed = True
        return self._add_instance(group, transform if pose is None else pose, times, "transform" if pose is None else "pose")

    # ---- changes

    def handles(self, family: str) -> list[Handle]:
        """The scene's textures, materials, media, emission, lights, shapes, groups or instances (those not removed), in the
        order in which they were added or are in the file."""
        return self._handles(family)

    def find(self, family: str, name: str) -> Handle:
        """The first object of a family with this name."""
        _check.text(name, "name")
        names = []
        for handle in self._handles(family):
            if handle.name == name:
                return handle
            names.append(handle.name)
        raise unknown(f"name of the scene's {family}", name, [known for known in names if known])

    def set(self, handle: Handle, kind: Optional[str] = None, **keywords: Unpack[_keywords.Anything]) -> None:
        """Changes what the keywords name; the rest stays. Textures, materials, emission and lights take the keywords of their
        add_ method; with a kind they become one of this kind, with defaults where nothing is given. So do shapes: new positions of
        the same number keep the mesh's faces, normals and uvs; an array that is None is taken away; material, emission (None: none),
        group and transform stay with another kind. Instances take pose (4 x 4, world from group)."""
        _check.instance(handle, Handle, "handle")
        words: dict[str, Any] = {**keywords}
        if handle.family == "lights" and "image" in words:
            words["image"] = _as_image(words["image"], "linear")
        if handle.family == "textures" and ("image" in words or "range" in words):
            _take_texels(words, self._get(handle)["spectrum"])
        self._changed = True
        self._set(handle, kind, words)

    def show(self, handle: Handle, shown: bool = True) -> None:
        """Shows or hides a light, a shape (in all instances of its group) or an instance."""
        self._changed = True
        self._show(handle, shown)

    def hide(self, handle: Handle) -> None:
        """Hides a light, a shape or an instance. Hidden instances have no id.instance: the ids of those after it are lower by
        1."""
        self.show(handle, False)

    def remove(self, handle: Union[Handle, Model]) -> None:
        """Removes an object of any family, or a Model with all that its file brought and nothing else uses, for good; its handle is of no further use. What another object still uses is a
        SceneError that names the user (of a Model: it stays, and so do the bytes of a .glb file with images, until the scene is closed); the shapes of a group are removed with it. The next object of the family that is added takes
        its place, and the id.object of a shape."""
        self._changed = True
        if not isinstance(handle, Model):
            self._remove(handle)
            return
        self._remove(handle.group)
        for part in handle.handles[1:]:
            try:
                self._remove(part)
            except SceneError:  # another object uses it
                pass

    def get(self, handle: Handle, name: Optional[str] = None) -> Any:
        """What an object is, as the keywords that make it: a dict, or the value of one name. Spectra are velo.Spectrum, textures and
        other objects handles, images copies. `scene.add_material(handle.kind, **scene.get(handle))` makes another one."""
        values = {key: _read(value) for key, value in self._get(handle).items()}
        if name is None:
            return values
        _check.text(name, "name")
        if name not in values:
            raise unknown(f"keyword of this object of the scene's {handle.family}", name, list(values))
        return values[name]

    def mesh(self, shape: Handle) -> Mesh:
        """A copy of a mesh: positions n x 3, scene units; indices m x 3 or m x 4. Other shapes are a UsageError."""
        positions, indices, corners, matrix = self._mesh(shape)
        return Mesh(_arrays.from_bytes(positions, "f", (len(positions) // 12, 3)),
                    _arrays.from_bytes(indices, "I", (len(indices) // (4 * corners), corners)), _arrays.from_rows(matrix, 4, 4))

    def transform(self, instance: Handle) -> Any:
        """An instance's pose, 4 x 4, world from group; of a moving one that at its first time."""
        return _arrays.from_rows(self._instance(instance)[1], 4, 4)

    # ---- rendering

    def settings(self, *, resolution: Optional[tuple[int, int]] = None, crop: Optional[Sequence[int]] = None,
                 **keywords: Unpack[_keywords.Settings]) -> Settings:
        """The settings of the scene's file, changed by keywords (render lists them)."""
        settings = _velo.scene_settings(self)
        if resolution is not None:
            settings.set_size(*_check.tuple_of(resolution, 2, "resolution", "(width, height), two whole numbers from 1 to 65536"))
        if crop is not None:
            settings.set_crop(*_check.tuple_of(crop, 4, "crop", "(x0, y0, x1, y1), four whole numbers"))
        for name, value in keywords.items():
            if name in ("width", "height"):
                raise UsageError(f"{name}: the size of the image is resolution=(width, height)")
            settings.set(name, value)
        return settings

    def world(self, *, previous: Optional[World] = None, progress: Optional[StepCallback] = None, **keywords: Unpack[_keywords.Settings]) -> World:
        """The compiled scene. It is kept until the scene changes. The next one shares with it what has not changed: meshes,
        their part of the accelerator, images; the bits are those of a world that shares nothing.

        previous: a world of another scene to share with, one that the same file was loaded into for example. progress: called
        about twenty times a second with a velo.Step; False ends the build with a CancelledError. Keywords: color, light_sampler,
        regularize, bits, accelerator."""
        _check.instance(previous, World, "previous", optional=True)
        return self._build(self.settings(**keywords), previous, _check.callback(progress, "progress"))

    def _build(self, settings: Any, previous: Optional[World] = None, progress: Optional[StepCallback] = None) -> World:
        key = tuple(settings.get(name) for name in _BUILD)
        last = self._world
        if last is not None and last[1].closed:
            last = None
        if last is None or self._changed or last[0] != key:
            if previous is None and last is not None:
                previous = last[1]
            last = (key, _velo.world_build(self, settings, previous, progress))
            self._world = last
            self._changed = False
        return last[1]

    def _camera_for(self, camera: Optional[Camera], settings: Any) -> Camera:
        return (camera if camera is not None else self.camera).resize(*settings.size)

    @property
    def film(self) -> Optional[Film]:
        """The film of the last render. After a KeyboardInterrupt it has the finished passes."""
        return self._film

    def render(self, *, camera: AnyCamera = None, resolution: Optional[tuple[int, int]] = None,
               crop: Optional[Sequence[int]] = None, channels: Sequence[str] = (), progress: Optional[Callback] = None,
               film: Optional[Film] = None, denoise: bool = False, **keywords: Unpack[_keywords.Settings]) -> Image:
        """Renders an image: linear R G B A, float32.

        camera: default the scene's; a velo.OwnCamera takes its place and its size. resolution: (width, height), pixels. crop: x0, y0, x1, y1, pixels, exclusive.
        channels: ground truth of the pixels' centres as further channels: "Z", "P", "N", "uv", "albedo", "id.object",
        "id.instance", ... (velo.channel_names(), docs/ground-truth.md).
        progress: called about forty times a second with a velo.Progress; False ends the render after its finished passes. While
        channels and denoising are computed it gets the last one again, and False means nothing. Its exception ends the call at once.
        film: adds samples to this film, until it has spp per pixel.
        denoise: denoises the colours.
        Further keywords: the members of vlRenderDef, vlFilmDef, vlBuildDef and vlDevelopDef: spp, seed, tracer, sampler,
        max_depth, filter, exposure, color, transparent, noise, time_limit, ... (velo.settings_names()). tracer="auto": the
        tracer that choose_tracer names. sampler may be a velo.OwnSampler, tracer a velo.OwnTracer.

        A RuntimeWarning says how many samples were not finite and left out, and how many numbers of a velo.OwnSampler were replaced.
        KeyboardInterrupt ends the render; scene.film keeps its finished passes."""
        words: dict[str, Any] = {**keywords}
        denoise = _check.flag(denoise, "denoise")
        settings, view = self._prepare(camera, resolution, crop, channels, film, denoise, words)
        target = film if film is not None else _velo.film_new(self._context_of(), settings)
        world = self._build(settings)
        self._choose(world, view, target, settings, words)
        self._film = target
        asked = _Asked(progress)
        _render(world, view, target, settings, asked.callback)
        return self._develop(world, view, target, settings, channels, denoise, asked.poll)

    def passes(self, *, camera: AnyCamera = None, resolution: Optional[tuple[int, int]] = None,
               crop: Optional[Sequence[int]] = None, channels: Sequence[str] = (), film: Optional[Film] = None,
               coarse: Sequence[int] = (), **keywords: Unpack[_keywords.Settings]) -> Iterator[Image]:
        """Renders and yields the images so far: at 1, 2, 4, ... and finally spp samples per pixel. The last one has the bits
        of render's image. Keywords: as render.

        coarse: factors from 1 to 64, (8, 4, 2) for example: yields images of 1 / factor of the width and height first, with 1
        sample per pixel (Camera.coarse)."""
        words: dict[str, Any] = {**keywords}
        factors = [_check.whole(factor, "an item of coarse", 1, 64) for factor in _check.items(coarse, "coarse", "numbers")]
        settings, view = self._prepare(camera, resolution, crop, channels, film, False, words)
        target = film if film is not None else _velo.film_new(self._context_of(), settings)
        world = self._build(settings)
        self._choose(world, view, target, settings, words)
        self._film = target
        for factor in factors:
            yield self._coarse(world, view, settings, factor, channels)
        total = settings.get("spp")
        spp = max(1, target.spp)
        if settings.get("sequence") == 0:
            settings.set("sequence", self._sequence(settings, total))
        while True:
            spp = min(spp, total)
            settings.set("spp", spp)
            _render(world, view, target, settings, None)
            yield self._develop(world, view, target, settings, channels, False)
            if spp >= total:
                return
            spp *= 2

    def _coarse(self, world: World, view: Camera, settings: Any, factor: int, channels: Sequence[str]) -> Image:
        small = settings.copy()
        small.set_coarse(factor)
        small.set("spp", 1)
        film = _velo.film_new(self._context_of(), small)
        _render(world, view.coarse(factor), film, small, None)
        wanted = [name for name in channels if name != "error"]
        return self._develop(world, view.coarse(factor), film, small, wanted, False)

    @staticmethod
    def _sequence(settings: Any, total: int) -> int:
        # As vlRenderDef.sequence has it: samplers that divide the sequence into cells are laid out for the final number.
        open_ended = settings.get("sampler") in ("independent", "halton", "sobol", "zsobol")
        return 65536 if open_ended else total

    def _context_of(self) -> Any:
        return self.context

    def _prepare(self, camera: AnyCamera, resolution: Optional[tuple[int, int]], crop: Optional[Sequence[int]],
                 channels: Sequence[str], film: Optional[Film], denoise: bool,
                 keywords: dict[str, Any]) -> tuple[Any, Camera]:
        channels = _channels(channels)
        if isinstance(camera, OwnCamera):
            size = film.resolution if film is not None else resolution
            base = self.camera if size is None else self.camera.resize(*size)
            camera = base.replace(own=camera)
        _check.instance(camera, Camera, "camera", optional=True)
        _check.instance(film, Film, "film", optional=True)
        if film is not None:
            resolution, crop = film.resolution, film.crop
        elif camera is not None and resolution is None:
            resolution = camera.resolution
        if ("error" in channels or denoise) and film is None:
            keywords.setdefault("errors", True)
        known = {name: value for name, value in keywords.items() if not (name == "tracer" and _is_auto(value))}
        settings = self.settings(resolution=resolution, crop=crop, **known)
        return settings, self._camera_for(camera, settings)

    @staticmethod
    def _choose(world: World, view: Camera, film: Film, settings: Any, keywords: dict[str, Any]) -> None:
        if not _is_auto(keywords.get("tracer")):
            return
        if film.spp:
            raise UsageError('tracer="auto": the film has samples of a tracer already; give its name')
        chosen, _ = _velo.choose_tracer(world, view, settings, min(settings.get("spp"), _MAX_RACED))
        for name, value in chosen.items():
            settings.set(name, value)

    def choose_tracer(self, *, camera: AnyCamera = None, resolution: Optional[tuple[int, int]] = None,
                      **keywords: Unpack[_keywords.Settings]) -> tuple[dict[str, Any], list[dict[str, Any]]]:
        """A short race of tracers (docs/tracers.md): (the keywords of render with which it has the least error for the same
        time, the trials). A trial has tracer, light_paths, error, tail, missing, cost, and work: error times cost over that of the
        first. Without trials the image is too small for a race. camera, resolution, further keywords: as render."""
        words: dict[str, Any] = {**keywords}
        settings, view = self._prepare(camera, resolution, None, (), None, False, words)
        return _velo.choose_tracer(self._build(settings), view, settings, min(settings.get("spp"), _MAX_RACED))

    def _develop(self, world: World, view: Camera, film: Film, settings: Any, channels: Sequence[str],
                 denoise: bool, poll: Optional[Callable[[], None]] = None) -> Image:
        image = film.image(exposure=settings.get("exposure"))
        more: Any = ()
        if channels and film.spp:
            more = _velo.channels(world, view, film, settings, list(channels), {}, None, None, poll)
        if denoise:
            # What the denoiser reads, in an image of its own: it reads nothing else, and the image keeps only what is asked for.
            if film.spp:
                join(image, _velo.channels(world, view, film, settings, ["error", "features"], {}, None, None, poll))
            image = image._denoised("velo", poll)
        join(image, more)
        _velo.image_describe(list(image.parts), view, settings, self._file, film.spp, None, "centre" if channels else None,
                             "velo" if denoise else None)
        return image

    def ground_truth(self, channels: Sequence[str], *, camera: AnyCamera = None,
                     resolution: Optional[tuple[int, int]] = None, crop: Optional[Sequence[int]] = None,
                     film: Optional[Film] = None, forward: Optional[Camera] = None, backward: Optional[Camera] = None,
                     mode: str = "centre", ranks: int = 6, time: Optional[float] = None, **keywords: Unpack[_keywords.Settings]) -> Image:
        """Ground truth without rendering colours (docs/ground-truth.md). forward, backward: the other cameras of the flow
        channels. mode: centre, nearest or coverage. ranks: of Cryptomatte. time: seconds; by default
        the middle of the exposure, of a rolling shutter that of each row."""
        words: dict[str, Any] = {**keywords}
        channels = _channels(channels)
        if not channels:
            raise wrong_value("channels", "a list of at least one name", channels)
        settings, view = self._prepare(camera, resolution, crop, channels, film, False, words)
        options: dict[str, Any] = {"mode": mode, "ranks": ranks}
        if time is not None:
            options["time"] = time
        parts = [part for part in _velo.channels(self._build(settings), view, film, settings, list(channels), options,
                                                 forward, backward, None) if part is not None]
        _velo.image_describe(parts, view, settings, self._file, film.spp if film is not None else 0, time, mode, None)
        return join(parts[0], parts[1:])

    def boxes(self, *, camera: AnyCamera = None, resolution: Optional[tuple[int, int]] = None,
              crop: Optional[Sequence[int]] = None, **keywords: Unpack[_keywords.Settings]) -> dict[str, list[dict[str, Any]]]:
        """Bounding boxes of "object" and "instance" ids, that of id 1 first: seen and all (pixels: visible, and with what
        occludes it away), seen_box and all_box (x0, y0, x1, y1; exclusive), outline, space (velo/boxes.h)."""
        words: dict[str, Any] = {**keywords}
        settings, view = self._prepare(camera, resolution, crop, (), None, False, words)
        objects, instances = _velo.boxes(self._build(settings), view, settings)
        return {"object": objects, "instance": instances}

    def focus(self, x: float, y: float, **keywords: Unpack[_keywords.Settings]) -> float:
        """The focus distance, scene units, for the surface that film point (x, y) sees."""
        return _velo.autofocus(self.world(**keywords), self.camera, x, y)

    def close(self) -> None:
        """Frees the scene and its world."""
        self._world = None
        self._film = None
        self._close()

    def __enter__(self) -> "Scene":
        return self

    def __exit__(self, *unused: Any) -> None:
        self.close()


_velo.set_type("Scene", Scene)
_SHOWN: dict[type, Sequence[Callable[..., Any]]] = {
    _keywords.Load: (Scene.load, Scene.load_group), _keywords.Complete: (Scene.complete,), _keywords.Textures: (Scene.add_texture,),
    _keywords.Materials: (Scene.add_material,), _keywords.Media: (Scene.add_medium,), _keywords.Emission: (Scene.add_emission,),
    _keywords.Lights: (Scene.add_light,), _keywords.Shapes: (Scene.add_shape,), _keywords.Meshes: (Scene.add_mesh,),
    _keywords.Anything: (Scene.set,), _keywords.AllShapes: (Scene.add_box, Scene.add_plane), _keywords.Quadrics: (Scene.add_sphere, Scene.add_disk, Scene.add_cylinder),
    _keywords.Settings: (Scene.settings, Scene.world, Scene.render, Scene.passes, Scene.choose_tracer, Scene.ground_truth, Scene.boxes,
                         Scene.focus)}
for _group, _functions in _SHOWN.items():
    for _function in _functions:
        _keywords.show(_function, _group)


def load(path: Path, *, context: Any = None, progress: Optional[StepCallback] = None, **keywords: Unpack[_keywords.Opening]) -> Scene:
    """Reads a scene file: .pbrt, .gltf, .glb, .obj, .ply, .stl, .off. A file without a camera or lights gets a camera that
    frames it and a studio. progress: called about twenty times a second with a velo.Step; False ends the load with a
    CancelledError.

    Keywords: the members of vlLoadDef (permissive, strict, search_path, time, scene, animation, variant, camera, scene_unit) and of
    vlCompleteDef (environment: auto, none, studio, window, evening, sky, white, lamps or the path of an image; rotation in radians, strength, up,
    front, ground, reframe, framing, azimuth, elevation, backdrop, ground_middle, ground_radius, open_walls, walls_from, both_sides)."""
    scene = Scene(context=context)
    words: dict[str, Any] = {**keywords}
    loading = {name: words.pop(name) for name in _LOAD if name in words}
    scene.load(path, progress=progress, **loading)
    scene.complete(**words)
    return scene


_keywords.show(load, _keywords.Opening)


def settings_names() -> list[str]:
    """The keywords of Scene.render that are settings."""
    return _velo.scene_settings(Scene()).names()
