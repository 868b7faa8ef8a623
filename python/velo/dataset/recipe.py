"""The description of a dataset: dataclasses, and the same from YAML. Lengths are in metres (scene units), angles in degrees.
A pair of numbers where one is expected means: at random between them, anew in each frame."""
from __future__ import annotations

import dataclasses
import os
from dataclasses import dataclass, field
from typing import Any, Optional, Sequence, Union

from velo._errors import UsageError
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
class InVolume:
    """Anywhere in a box, in any rotation, without collisions of bounding boxes."""
    low: Vector = (-0.5, 0, -0.5)
    high: Vector = (0.5, 0.5, 0.5)
    gap: float = 0.0
    tries: int = 100


@dataclass
class Fixed:
    """A camera at rest. keywords: velo.Camera's (fov in radians); or `file`: a camera file of any dialect."""
    keywords: dict[str, Any] = field(default_factory=dict)
    file: str = ""
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
    keywords: dict[str, Any] = field(default_factory=dict)  #: intrinsics of files with poses only
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
    """Light from all directions: studio, sky, white, or one of these images. Rotation is at random unless given."""
    kind: str = "studio"
    files: Sequence[str] = ()
    strength: Range = 1.0
    rotation: Optional[float] = None  #: degrees


@dataclass
class Materials:
    """Bounds of random principled materials."""
    color: Sequence[Vector] = ((0.05, 0.05, 0.05), (0.9, 0.9, 0.9))
    roughness: Range = (0.1, 1.0)
    metallic: Range = (0.0, 1.0)
    textures: Sequence[str] = ()  #: images; one of them replaces the colour


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
    render: dict[str, Any] = field(default_factory=dict)  #: further keywords of Scene.render: max_depth, exposure, ...
    channels: Sequence[str] = ()  #: further channels of the EXR writer
    occluded: bool = True  #: also find the masks of whole objects, behind what occludes them
    folder: str = ""  #: relative paths are relative to it
    path: str = ""  #: the recipe's file, if it came from one


_KINDS = {"poses": Poses, "on_surface": OnSurface, "in_volume": InVolume, "fixed": Fixed, "around": Around,
          "trajectory": Trajectory, "rig": Rig}
_MEMBERS = {"lights": Lights, "environment": Environment, "materials": Materials, "ground": Ground,
            "distractors": Distractors}


def _make(kind: type, data: Any, where: str) -> Any:
    if not isinstance(data, dict):
        raise UsageError(f"{where}: expected names and values")
    known = {member.name for member in dataclasses.fields(kind)}
    values = {}
    for name, value in data.items():
        if name not in known:
            raise UsageError(f"{where}: unknown name '{name}' (known: {', '.join(sorted(known))})")
        values[name] = _value(name, value, f"{where}.{name}")
    return kind(**values)


def _kind(data: Any, where: str) -> Any:
    if not isinstance(data, dict) or data.get("kind") not in _KINDS:
        raise UsageError(f"{where}: needs a kind, one of {', '.join(sorted(_KINDS))}")
    return _make(_KINDS[data["kind"]], {name: value for name, value in data.items() if name != "kind"}, where)


def _value(name: str, value: Any, where: str) -> Any:
    if name in _MEMBERS and isinstance(value, dict):
        return _make(_MEMBERS[name], value, where)
    if name == "models":
        return [_make(Model, {"path": item} if isinstance(item, str) else item, f"{where}[{i}]")
                for i, item in enumerate(value)]
    if name in ("placing", "base") and isinstance(value, dict):
        return _kind(value, where)
    if name == "cameras":
        return [_kind(item, f"{where}[{i}]") for i, item in enumerate(value)]
    return value


def recipe_from(data: dict[str, Any], folder: str = "") -> Recipe:
    """A recipe from dicts and lists, as YAML or JSON have them."""
    recipe: Recipe = _make(Recipe, data, "recipe")
    recipe.folder = recipe.folder or folder
    return recipe


def read_recipe(path: Union[str, "os.PathLike[str]"]) -> Recipe:
    """Reads a recipe from a YAML file (needs python3-yaml) or a JSON file. Its paths are relative to its folder."""
    import json
    text = open(path, encoding="utf-8").read()
    if os.fspath(path).endswith(".json"):
        data = json.loads(text)
    else:
        try:
            import yaml  # type: ignore[import]
        except ImportError:
            raise UsageError("YAML recipes need Python's module yaml (Debian: python3-yaml); JSON ones do not") from None
        data = yaml.safe_load(text)
    recipe = recipe_from(data, os.path.dirname(os.path.abspath(path)))
    recipe.path = os.path.abspath(path)
    return recipe
