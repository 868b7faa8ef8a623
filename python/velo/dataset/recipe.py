"""The description of a dataset: dataclasses, and the same from YAML. Lengths are in metres (scene units), angles in degrees; what is
passed on to calls of velo (keywords, render, material) is as these calls have it, angles in radians.
A pair of numbers where one is expected means: at random between them, anew in each frame."""
from __future__ import annotations

import dataclasses
import os
from dataclasses import dataclass, field
from typing import Any, Optional, Sequence, Union

from velo._errors import UsageError, shown, unknown, wrong_value
from velo.dataset.random import Range

Vector = Sequence[float]
Count = Union[int, Sequence[int]]


@dataclass
class Model:
    """An object model: a file, or arrays. The name is its class: default the file's name without suffix."""
    path: str = ""
    name: str = ""
    count: Count = 1  #: instances in a frame
    scale: float = 1.0  #: from the file's unit to metres; fixed, so that poses are rigid
    positions: Any = None  #: instead of a file: n x 3
    indices: Any = None  #: m x 3
    material: dict[str, Any] = field(default_factory=dict)  #: of positions: {"kind": "principled", "reflectance": ...}
    keypoints: dict[str, Vector] = field(default_factory=dict)  #: names and points in the file's space, for COCO
    skeleton: Sequence[Sequence[int]] = ()  #: COCO: pairs of numbers of keypoints, from 1
    keypoint_depth: Optional[float] = None  #: metres below a surface at which a keypoint still counts as seen; default 1 % of the bounding box's diagonal


@dataclass
class Poses:
    """Given poses: for each frame a list of (model's name, 4 x 4 world from model). Frames beyond the last repeat."""
    frames: Sequence[Sequence[Any]] = ()


@dataclass
class OnSurface:
    """On a rectangle, upright or tumbled, without collisions of bounding boxes. Objects without room are left out."""
    center: Vector = (0, 0, 0)
    size: Sequence[float] = (1, 1)
    up: Vector = (0, 1, 0)
    gap: float = 0.005  #: least distance between bounding boxes
    tumble: bool = False  #: any rotation, instead of one about `up`
    tries: int = 100


@dataclass
class OnScene:
    """On the surfaces that a box holds of the recipe's scene and ground, found by rays straight down: a thing stands on the highest
    point below it. Its bounding box meets neither those of others nor, by 147 rays through it, the scene: what is thinner than a
    seventh of it may be missed."""
    low: Vector = (-1, -1, -1)  #: corner of the box, in which the surfaces are
    high: Vector = (1, 1, 1)
    up: Vector = (0, 1, 0)
    slope: float = 10.0  #: degrees: the steepest surface
    gap: float = 0.005  #: least distance between bounding boxes
    tumble: bool = False  #: any rotation, instead of one about `up`
    tries: int = 100


@dataclass
class InVolume:
    """Anywhere in a box, in any rotation, without collisions of bounding boxes."""
    low: Vector = (-0.5, 0, -0.5)
    high: Vector = (0.5, 0.5, 0.5)
    gap: float = 0.0
    tries: int = 100


@dataclass
class Fixed:
    """A camera at rest. keywords: velo.Camera's (angles in radians); or `file`: a camera file of any dialect."""
    keywords: dict[str, Any] = field(default_factory=dict)
    file: str = ""
    fov: Optional[float] = None  #: degrees, across the smaller side
    name: str = "camera"


@dataclass
class Around:
    """A camera somewhere around a target, looking at it. keywords: further ones of velo.Camera (K, distortion, ...)."""
    target: Vector = (0, 0, 0)
    distance: Range = 1.0
    elevation: Sequence[float] = (10, 80)  #: above the horizon, degrees
    up: Vector = (0, 1, 0)
    jitter: float = 0.0  #: radius of a ball around the target, from which the point looked at is taken
    fov: Optional[float] = None  #: degrees, across the smaller side
    keywords: dict[str, Any] = field(default_factory=dict)
    name: str = "camera"


@dataclass
class Trajectory:
    """A camera along a file of poses (docs/rigs.md): frame i has pose i; frames beyond the last repeat."""
    file: str = ""
    fov: Optional[float] = None  #: degrees, across the smaller side; of files with poses only
    keywords: dict[str, Any] = field(default_factory=dict)  #: velo.Camera's (angles in radians), of files with poses only
    name: str = "camera"


@dataclass
class Rig:
    """Several cameras that move as one. parts: for each a dict with pose (4 x 4, base from camera) and name; a stereo pair is
    two of them."""
    base: Any = None  #: Fixed, Around or Trajectory: the pose of the rig's base, and the intrinsics
    parts: Sequence[dict[str, Any]] = ()


@dataclass
class Lights:
    """Point lights in a box."""
    count: Count = (1, 3)
    low: Vector = (-2, 2, -2)
    high: Vector = (2, 3, 2)
    power: Range = (20, 60)  #: watts each
    kelvin: Range = (2800, 6500)


@dataclass
class Environment:
    """Light from all directions: studio, window, evening, sky, white, or one of these images. Rotation is at random unless given."""
    kind: str = "studio"
    files: Sequence[str] = ()  #: images, or folders that stand for all images in them
    strength: Range = 1.0
    rotation: Optional[float] = None  #: degrees


@dataclass
class Materials:
    """Bounds of random principled materials."""
    color: Sequence[Vector] = ((0.05, 0.05, 0.05), (0.9, 0.9, 0.9))
    roughness: Range = (0.1, 1.0)
    metallic: Range = (0.0, 1.0)
    textures: Sequence[str] = ()  #: images, or folders of images; one of them replaces the colour


@dataclass
class Ground:
    """A square under everything, with a random material."""
    size: float = 6.0
    height: float = 0.0
    up: Vector = (0, 1, 0)
    materials: Materials = field(default_factory=lambda: Materials(metallic=0.0))


@dataclass
class Distractors:
    """Boxes and balls with random materials, placed like the objects but without annotations."""
    count: Count = (0, 5)
    size: Range = (0.02, 0.1)
    materials: Materials = field(default_factory=Materials)


@dataclass
class Sensor:
    """A sensor that is exposed to each image, for the writer `raw` (docs/sensor.md). The images then have a box filter and samples of
    their own."""
    name: str = "generic_rggb"  #: a preset, or a sensor file (.yaml)
    numbers: dict[str, Any] = field(default_factory=dict)  #: in place of its own: further keywords of velo.Sensor
    exposure: dict[str, Any] = field(default_factory=dict)  #: keywords of velo.Sensor.expose: exposure_time, f_number, iso, ...
    buckets: int = 32  #: of the images' spectrum
    dng: bool = False  #: a DNG file of each image, too


@dataclass
class Recipe:
    """All of a dataset."""
    seed: int = 0
    frames: int = 1
    resolution: Sequence[int] = (640, 480)
    spp: int = 16
    scene: str = ""  #: a scene's file, in which everything is placed
    models: Sequence[Model] = ()
    placing: Any = field(default_factory=OnSurface)
    cameras: Sequence[Any] = field(default_factory=lambda: [Around()])
    lights: Optional[Lights] = None
    environment: Optional[Environment] = None  #: default: studio where there is no other light
    ground: Optional[Ground] = None
    distractors: Optional[Distractors] = None
    sensor: Optional[Sensor] = None
    render: dict[str, Any] = field(default_factory=dict)  #: further keywords of Scene.render: max_depth, exposure, ...
    channels: Sequence[str] = ()  #: further channels of the EXR writer
    depth_scale: float = 0.1  #: millimetres of a step of the BOP writer's 16-bit depth
    occluded: bool = True  #: also find the masks of whole objects, behind what occludes them
    folder: str = ""  #: relative paths are relative to it
    path: str = ""  #: the recipe's file, if it came from one


_PLACINGS = {"poses": Poses, "on_surface": OnSurface, "on_scene": OnScene, "in_volume": InVolume}
_CAMERAS = {"fixed": Fixed, "around": Around, "trajectory": Trajectory, "rig": Rig}
_MEMBERS = {"lights": Lights, "environment": Environment, "materials": Materials, "ground": Ground,
            "distractors": Distractors, "sensor": Sensor}
_MAX_VALUES = 10000000  # of a recipe's file
_MAX_LETTERS = 1 << 28


def _make(kind: type, data: Any, where: str) -> Any:
    if not isinstance(data, dict):
        raise wrong_value(where, "names and values", data)
    known = sorted(member.name for member in dataclasses.fields(kind))
    values = {}
    for name, value in data.items():
        if name not in known:
            raise unknown(f"name in {where}:", str(name), known)
        values[name] = _value(name, value, f"{where}.{name}")
    return kind(**values)


def _kind(data: Any, kinds: dict[str, type], where: str) -> Any:
    word = data.get("kind") if isinstance(data, dict) else None
    if not isinstance(word, str):
        raise wrong_value(where, f"names and values with a kind, one of {', '.join(sorted(kinds))}", data if word is None else word)
    if word not in kinds:
        raise unknown(f"kind of {where}:", word, list(kinds))
    return _make(kinds[word], {name: value for name, value in data.items() if name != "kind"}, where)


def _list(value: Any, where: str) -> list[Any]:
    if not isinstance(value, list):
        raise wrong_value(where, "a list", value)
    return value


def _value(name: str, value: Any, where: str) -> Any:
    if name in _MEMBERS:
        return value if value is None else _make(_MEMBERS[name], value, where)
    if name == "models":
        return [_make(Model, {"path": item} if isinstance(item, str) else item, f"{where}[{i}]")
                for i, item in enumerate(_list(value, where))]
    if name == "placing":
        return _kind(value, _PLACINGS, where)
    if name == "base":
        return _kind(value, _CAMERAS, where)
    if name == "cameras":
        return [_kind(item, _CAMERAS, f"{where}[{i}]") for i, item in enumerate(_list(value, where))]
    return value


def _bounded(data: Any, left: int, depth: int = 0) -> int:
    # YAML's references can make a few lines as large as one likes, or a list that contains itself.
    if depth > 32:
        raise UsageError("recipe: nested too deeply, or a part contains itself")
    left -= 1
    if isinstance(data, (list, tuple)):
        for item in data:
            left = _bounded(item, left, depth + 1)
    elif isinstance(data, dict):
        for item in data.values():
            left = _bounded(item, left, depth + 1)
    if left < 0:
        raise UsageError(f"recipe: more than {_MAX_VALUES} values")
    return left


def recipe_from(data: dict[str, Any], folder: str = "") -> Recipe:
    """A recipe from dicts and lists, as YAML or JSON have them."""
    from velo.dataset.check import checked
    _bounded(data, _MAX_VALUES)
    recipe: Recipe = _make(Recipe, data, "recipe")
    recipe = checked(recipe)
    recipe.folder = recipe.folder or folder
    return recipe


def _pairs(pairs: list[tuple[str, Any]]) -> dict[str, Any]:
    names = [name for name, _ in pairs]
    for i, name in enumerate(names):
        if len(set(names)) < len(names) and name in names[:i]:
            raise UsageError(f"the name {shown(name)} is there twice in one place")
    return dict(pairs)


def _read_json(text: str) -> Any:
    import json
    try:
        return json.loads(text, object_pairs_hook=_pairs)
    except json.JSONDecodeError as problem:
        error = UsageError(f"this is not JSON: {problem.msg}")
        error.line, error.column = problem.lineno, problem.colno
        raise error from None


def _read_yaml(text: str) -> Any:
    try:
        import yaml  # type: ignore[import]
    except ImportError:
        raise UsageError("YAML recipes need Python's module yaml (Debian: python3-yaml); JSON ones do not") from None

    class Loader(yaml.SafeLoader):  # type: ignore[misc]
        def construct_mapping(self, node: Any, deep: bool = False) -> Any:
            seen = set()
            for key, _ in node.value:
                if key.value.__hash__ and key.value in seen:
                    error = UsageError(f"the name {shown(key.value)} is there twice in one place")
                    error.line, error.column = key.start_mark.line + 1, key.start_mark.column + 1
                    raise error
                if key.value.__hash__:
                    seen.add(key.value)
            return super().construct_mapping(node, deep)

    try:
        return yaml.load(text, Loader)
    except yaml.YAMLError as problem:
        place = getattr(problem, "problem_mark", None)
        error = UsageError(f"this is not YAML: {shown(getattr(problem, 'problem', None) or str(problem))}")
        if place is not None:
            error.line, error.column = place.line + 1, place.column + 1
        raise error from None


def read_recipe(path: Union[str, "os.PathLike[str]"]) -> Recipe:
    """Reads a recipe from a YAML file (needs python3-yaml) or a JSON file. Its paths are relative to its folder."""
    if not isinstance(path, (str, os.PathLike)):
        raise wrong_value("path", "a path: a str or an os.PathLike", path)
    try:
        try:
            with open(path, encoding="utf-8") as file:
                text = file.read(_MAX_LETTERS + 1)
            if len(text) > _MAX_LETTERS:
                raise UsageError(f"a recipe has at most {_MAX_LETTERS} letters")
            data = _read_json(text) if os.fspath(path).endswith(".json") else _read_yaml(text)
        except UnicodeDecodeError as problem:
            raise UsageError(f"this is not UTF-8: byte {problem.start}") from None
        except RecursionError:
            raise UsageError("recipe: nested too deeply") from None
        except ValueError as problem:  # a date or a number that Python cannot hold; a path with zeros
            if isinstance(problem, UsageError):
                raise
            raise UsageError(f"this cannot be read: {shown(str(problem))}") from None
        recipe = recipe_from(data, os.path.dirname(os.path.abspath(path)))
        recipe.path = os.path.abspath(path)
        return recipe
    except UsageError as error:
        error.file = error.file or os.fspath(path)
        raise
