"""Plans a frame (numbers only) and renders it."""
from __future__ import annotations

import logging
import math
import os
from dataclasses import dataclass, field
from typing import Any, Callable, NamedTuple, Optional

import numpy

import velo
from velo import _check
from velo._errors import UsageError, at_place, unknown
from velo.dataset.cameras import Cameras, View
from velo.dataset.check import MAX_FRAMES, checked
from velo.dataset.files import images_of
from velo.dataset.geometry import Matrix, Vector3, multiply, place, rigid_inverse, transform
from velo.dataset.keypoints import Keypoints, project_keypoints
from velo.dataset.placing import Thing, place_things
from velo.dataset.random import Random
from velo.dataset.recipe import Materials, Model, OnScene, Poses, Recipe

_log = logging.getLogger("velo.dataset")


class Placed(NamedTuple):
    """An object of a plan."""
    model: int  #: number of the model in the recipe, from 0
    pose: Matrix  #: world from the model's file, with the model's scale


@dataclass
class Plan:
    """What a frame shows. It depends on the recipe and the frame's number only."""
    frame: int
    seed: int  #: of the render
    objects: list[Placed]
    views: list[View]
    distractors: list[dict[str, Any]] = field(default_factory=list)
    lights: list[dict[str, Any]] = field(default_factory=list)
    environment: Optional[dict[str, Any]] = None
    ground: Optional[dict[str, Any]] = None


@dataclass
class Instance:
    """An object in an image."""
    model: int  #: number of the model in the recipe, from 0
    name: str  #: its class
    world_from_model: Matrix  #: rigid: of the scaled model
    scale: float  #: from the file's unit to metres
    mask: Any  #: height x width, bool: the pixels whose centres show it
    whole: Any  #: the same with everything else taken away; with Recipe.occluded False the mask
    keypoints: Optional[Keypoints] = None  #: those of the model, in its order
    hidden_by: dict[int, int] = field(default_factory=dict)  #: pixels of `whole` by what covers them: the number of another object of the frame, from 0; -1: the rest of the scene

    @property
    def visible_fraction(self) -> float:
        """The share of `whole` that is seen, 0 to 1; 0 where there is none."""
        whole = int(self.whole.sum())
        return int(self.mask.sum()) / whole if whole else 0.0


@dataclass
class Frame:
    """An image of a frame with its annotations."""
    frame: int
    view: str
    camera: Any  #: velo.Camera
    image: Any  #: velo.Image: R G B A, Z, N, id.instance, ...
    instances: list[Instance]
    exposure: Optional[velo.Exposure] = None  #: of the recipe's sensor


class _Loaded(NamedTuple):
    """A model in a scene of its own."""
    scene: velo.Scene
    name: str
    low: Any
    high: Any
    world: Any


def _load_model(scene: Any, model: Model, folder: str) -> tuple[Any, str, Any, Any]:
    """Adds a model to a scene: group, name, bounding box."""
    if model.path:
        loaded = scene.load_group(os.path.join(folder, model.path), model.name or None)
        return loaded.group, loaded.name, loaded.low, loaded.high
    if model.positions is None or model.indices is None or not model.name:
        raise UsageError("a model needs a path, or a name, positions and indices")
    group = scene.add_group(model.name)
    keywords: dict[str, Any] = {}
    if model.material:
        settings = dict(model.material)
        keywords["material"] = scene.add_material(settings.pop("kind", "principled"), **settings)
    positions = numpy.ascontiguousarray(model.positions, dtype="float32")
    scene.add_mesh(positions, numpy.ascontiguousarray(model.indices, dtype="uint32"), group=group, name=model.name,
                   **keywords)
    return group, model.name, positions.min(0).tolist(), positions.max(0).tolist()


def silhouette(scene: velo.Scene, low: Vector3, high: Vector3, pose: Matrix, camera: velo.Camera) -> Any:
    """The pixels whose centres would show an object if it were alone, height x width, bool. scene: the object alone, in its own space,
    as instance 1; low, high: its bounding box there; pose: world from that space, a rotation, uniform scale and translation."""
    width, height = camera.resolution
    mask = numpy.zeros((height, width), dtype=bool)
    there = [[float(value) for value in row] for row in camera.world_from_camera]
    camera = camera.move(multiply(rigid_inverse(pose), there))
    corners = [[x, y, z] for x in (low[0], high[0]) for y in (low[1], high[1]) for z in (low[2], high[2])]
    seen = camera.project(corners)
    crop = [0, 0, width, height]
    # The image of a box is inside that of its corners for perspective cameras without distortion only.
    if seen.valid.all() and camera.projection == "perspective" and not len(camera.distortion_coefficients):
        first, last = numpy.floor(seen.pixels.min(0)) - 1, numpy.ceil(seen.pixels.max(0)) + 1
        crop = [int(min(max(first[0], 0), width)), int(min(max(first[1], 0), height)),
                int(max(min(last[0], width), 0)), int(max(min(last[1], height), 0))]
    if crop[0] >= crop[2] or crop[1] >= crop[3]:
        return mask
    truth = scene.ground_truth(["id.instance"], camera=camera, crop=crop)
    mask[crop[1]:crop[3], crop[0]:crop[2]] = truth["id.instance"] == 1
    return mask


def _random_material(bounds: Materials, random: Random) -> dict[str, Any]:
    low, high = bounds.color
    material: dict[str, Any] = {"reflectance": random.point(low, high), "roughness": random.within(bounds.roughness),
                                "metallic": random.within(bounds.metallic)}
    if bounds.textures:
        material["texture"] = random.choice(list(bounds.textures))
    return material


def _covers(ids: Any, hidden: Any, first: int, count: int) -> dict[int, int]:
    """Instance.hidden_by of these pixels; the objects have the ids from `first` on."""
    found: dict[int, int] = {}
    for number, pixels in zip(*(part.tolist() for part in numpy.unique(ids[hidden], return_counts=True))):
        cover = number - first if first <= number < first + count else -1
        found[cover] = found.get(cover, 0) + pixels
    return found


class Stage:
    """Renders the frames of a recipe."""

    def __init__(self, recipe: Recipe, *, context: Any = None) -> None:
        recipe = checked(recipe)
        self.recipe = recipe
        self.context = context
        self._world: Any = None  # of the last frame
        self._build = {name: recipe.render[name] for name in ("color", "light_sampler", "imitate_pbrt", "regularize", "bits", "accelerator")
                       if name in recipe.render}
        with at_place("recipe.render"):
            settings = {name: value for name, value in recipe.render.items() if name not in ("denoise", "tracer") or value != "auto"}
            velo.Scene(context=context).settings(**{name: value for name, value in settings.items() if name != "denoise"})
        self.sensor = self._make_sensor()  #: velo.Sensor, or None
        self._find_files()
        self._cameras = Cameras(recipe)
        self._cameras.views(0)
        self._solo = []
        for i, model in enumerate(recipe.models):
            with at_place(f"recipe.models[{i}]"):
                self._solo.append(self._load(model))
        names = [solo.name for solo in self._solo]
        if len(set(names)) < len(names):
            raise UsageError("two models have the same name: give them names")
        self.names = names  #: the classes, in the recipe's order
        #: bounding boxes in metres, in the models' own spaces
        self.boxes = [([value * model.scale for value in solo.low], [value * model.scale for value in solo.high])
                      for model, solo in zip(recipe.models, self._solo)]

        self._ground = self._surfaces() if isinstance(recipe.placing, OnScene) else None

    def _find_files(self) -> None:
        """Replaces folders of images by the images in them."""
        recipe = self.recipe
        if recipe.environment:
            with at_place("recipe.environment.files"):
                recipe.environment.files = images_of(recipe.environment.files, recipe.folder)
        for place_of, rule in (("ground", recipe.ground), ("distractors", recipe.distractors)):
            if rule:
                with at_place(f"recipe.{place_of}.materials.textures"):
                    rule.materials.textures = images_of(rule.materials.textures, recipe.folder)

    def _surfaces(self) -> Any:
        """The world on whose surfaces things stand."""
        recipe = self.recipe
        if not recipe.scene and not recipe.ground:
            raise UsageError("recipe.placing: there is nothing to stand on: the kind on_scene needs a scene or a ground")
        scene = velo.Scene(context=self.context)
        if recipe.scene:
            scene.load(os.path.join(recipe.folder, recipe.scene))
        if recipe.ground:
            self._add_ground(scene, {})
        return scene.world()

    def _make_sensor(self) -> Optional[velo.Sensor]:
        rule = self.recipe.sensor
        if not rule:
            return None
        with at_place("recipe.sensor"):
            is_file = rule.name.endswith((".yaml", ".yml"))
            sensor = velo.Sensor(os.path.join(self.recipe.folder, rule.name) if is_file else rule.name, context=self.context,
                                 **rule.numbers)
            # One pixel: whether the exposure's numbers are right.
            sensor.expose(velo.Image(numpy.zeros((1, 1, 2), "float32"), ["S0.500nm", "S0.600nm"], encoding="linear",
                                     context=self.context), **rule.exposure)
        return sensor

    @property
    def most_objects(self) -> int:
        """The largest number of objects in a frame."""
        if isinstance(self.recipe.placing, Poses):
            return max(len(frame) for frame in self.recipe.placing.frames)
        return sum(count if isinstance(count, int) else int(count[1]) for count in (model.count for model in self.recipe.models))

    def note_inputs(self) -> None:
        """Tells the context of the recipe's files, also of those that only later frames read."""
        recipe = self.recipe
        looks = [rule.materials for rule in (recipe.ground, recipe.distractors) if rule]
        files = [name for rule in looks for name in rule.textures] + list(recipe.environment.files if recipe.environment else ())
        for path in [recipe.path] + [os.path.join(recipe.folder, name) for name in files]:
            if path and os.path.exists(path):
                self.context.note_input(path)

    def _load(self, model: Model) -> _Loaded:
        scene = velo.Scene(context=self.context)
        group, name, low, high = _load_model(scene, model, self.recipe.folder)
        scene.add_instance(group, place(((1, 0, 0), (0, 1, 0), (0, 0, 1)), (0, 0, 0)))
        return _Loaded(scene, name, low, high, scene.world())

    def model(self, number: int) -> velo.Scene:
        """The scene (velo.Scene) that has model `number`, from 0, alone, in the file's own space and units."""
        return self._solo[number].scene

    # ---- plans

    def plan(self, frame: int) -> Plan:
        """What a frame shows."""
        _check.whole(frame, "frame", 0, MAX_FRAMES - 1)
        recipe = self.recipe

        def random(purpose: str) -> Random:
            return Random(recipe.seed, frame, purpose)

        things, sizes = self._things(random)
        if isinstance(recipe.placing, Poses):
            objects = self._given(frame)
            distractors: list[dict[str, Any]] = []
        else:
            objects, distractors = [], []
            for thing, pose in place_things(recipe.placing, things, frame, random("placing"), self._ground):
                if pose is None:
                    _log.warning("frame %d: no room for %s", frame, thing.name)
                elif thing.number >= 0:
                    objects.append(Placed(thing.number, pose))
                else:
                    distractors.append({**sizes[-1 - thing.number], "pose": pose})
        plan = Plan(frame, random("render").seed32(), objects, self._cameras.views(frame), distractors)
        plan.lights = self._plan_lights(random("lights"))
        plan.environment = self._plan_environment(random("environment"))
        if recipe.ground:
            plan.ground = _random_material(recipe.ground.materials, random("ground"))
        return plan

    def _things(self, random: Any) -> tuple[list[Thing], list[dict[str, Any]]]:
        things = []
        counts = random("counts")
        for number, (model, solo) in enumerate(zip(self.recipe.models, self._solo)):
            for _ in range(counts.count(model.count)):
                things.append(Thing(number, solo.name, solo.low, solo.high, model.scale))
        sizes: list[dict[str, Any]] = []
        rule = self.recipe.distractors
        if rule:
            draw = random("distractors")
            for number in range(draw.count(rule.count)):
                half = [draw.within(rule.size) / 2 for _ in range(3)]
                ball = draw.number(0, 1) < 0.5
                half = [half[0]] * 3 if ball else half
                sizes.append({"half": half, "ball": ball, "material": _random_material(rule.materials, draw)})
                things.append(Thing(-1 - number, "distractor", [-h for h in half], half, 1.0))
        return things, sizes

    def _given(self, frame: int) -> list[Placed]:
        frames = self.recipe.placing.frames
        objects = []
        for name, pose in frames[frame % len(frames)]:
            if name not in self.names:
                raise unknown("model in recipe.placing:", name, self.names)
            model = self.names.index(name)
            matrix = [[float(value) for value in row] for row in pose]
            scale = self.recipe.models[model].scale
            objects.append(Placed(model, [[value * scale if j < 3 else value for j, value in enumerate(row)]
                                          for row in matrix[:3]] + [[0.0, 0.0, 0.0, 1.0]]))
        return objects

    def _plan_lights(self, random: Random) -> list[dict[str, Any]]:
        rule = self.recipe.lights
        if not rule:
            return []
        return [{"from_": random.point(rule.low, rule.high), "power": random.within(rule.power),
                 "kelvin": random.within(rule.kelvin)} for _ in range(random.count(rule.count))]

    def _plan_environment(self, random: Random) -> Optional[dict[str, Any]]:
        rule, recipe = self.recipe.environment, self.recipe
        if not rule:
            return {"environment": "studio"} if not recipe.lights and not recipe.scene else None
        kind = os.path.join(recipe.folder, random.choice(list(rule.files))) if rule.files else rule.kind
        degrees = random.number(0, 360) if rule.rotation is None else rule.rotation
        return {"environment": kind, "strength": random.within(rule.strength), "rotation": math.radians(degrees)}

    # ---- rendering

    def _material(self, scene: Any, settings: dict[str, Any]) -> Any:
        keywords = dict(settings)
        texture = keywords.pop("texture", None)
        if texture:
            keywords["reflectance"] = scene.add_texture("image", path=os.path.join(self.recipe.folder, texture))
        return scene.add_material("principled", **keywords)

    def scene(self, plan: Plan) -> velo.Scene:
        """The scene of a plan. Its last instances are the plan's objects, in order."""
        recipe = self.recipe
        scene = velo.Scene(context=self.context)
        if recipe.scene:
            scene.load(os.path.join(recipe.folder, recipe.scene))
        scene.camera = plan.views[0].camera
        groups: dict[int, Any] = {}
        for item in plan.objects:
            if item.model not in groups:
                groups[item.model] = _load_model(scene, recipe.models[item.model], recipe.folder)[0]
        if plan.ground is not None and recipe.ground:
            self._add_ground(scene, plan.ground)
        for distractor in plan.distractors:
            self._add_distractor(scene, distractor)
        for light in plan.lights:
            scene.add_light("point", from_=light["from_"], power=light["power"], color=velo.blackbody(light["kelvin"]))
        if plan.environment:
            up = recipe.ground.up if recipe.ground else getattr(recipe.placing, "up", (0, 1, 0))
            scene.complete(up=up, **plan.environment)
        for item in plan.objects:
            scene.add_instance(groups[item.model], item.pose)
        return scene

    def _add_ground(self, scene: Any, material: dict[str, Any]) -> None:
        from velo.dataset.geometry import basis
        rule = self.recipe.ground
        assert rule is not None
        x, y, z = basis(rule.up)
        h = rule.size / 2
        corners = [[a * h * x[i] + b * h * y[i] + rule.height * z[i] for i in range(3)]
                   for a, b in ((-1, -1), (1, -1), (1, 1), (-1, 1))]
        scene.add_mesh(corners, [[0, 1, 2], [0, 2, 3]], uvs=[[0, 0], [1, 0], [1, 1], [0, 1]], name="ground",
                       material=self._material(scene, material))

    def _add_distractor(self, scene: Any, item: dict[str, Any]) -> None:
        material = self._material(scene, item["material"])
        if item["ball"]:
            radius = item["half"][0]
            scene.add_shape("sphere", radius=radius, z_min=-radius, z_max=radius, transform=item["pose"],
                            material=material, name="distractor")
            return
        a, b, c = item["half"]
        corners = [(sx * a, sy * b, sz * c) for sx in (-1, 1) for sy in (-1, 1) for sz in (-1, 1)]
        faces = [(0, 1, 3), (0, 3, 2), (4, 6, 7), (4, 7, 5), (0, 4, 5), (0, 5, 1), (2, 3, 7), (2, 7, 6), (0, 2, 6),
                 (0, 6, 4), (1, 5, 7), (1, 7, 3)]
        scene.add_mesh(corners, faces, transform=item["pose"], material=material, name="distractor")

    def render(self, frame: int, ready: Optional[Callable[[Plan], None]] = None) -> list[Frame]:
        """The images of a frame, one for each camera. ready: called when all is loaded, before the first image."""
        plan = self.plan(frame)
        with self.scene(plan) as scene:
            # Meshes and images are those of the last frame's world. The bits do not depend on it.
            self._world = scene.world(previous=self._world, **self._build)
            if ready:
                ready(plan)
            return [self._render_view(scene, plan, view) for view in plan.views]

    def _render_view(self, scene: Any, plan: Plan, view: View) -> Frame:
        recipe = self.recipe
        channels = ["Z", "N", "id.instance"]
        channels += [name for name in recipe.channels if name not in channels]
        settings: dict[str, Any] = dict(recipe.render)
        if recipe.sensor:
            settings = {"filter": "box", "buckets": recipe.sensor.buckets, **settings}
        image = scene.render(camera=view.camera, spp=recipe.spp, seed=plan.seed, channels=channels, **settings)
        exposure = None
        if self.sensor and recipe.sensor:
            exposure = self.sensor.expose(scene.film.spectrum(), seed=plan.seed, frame=plan.views.index(view), **recipe.sensor.exposure)
        total = len(scene.world(**self._build).ids("instance"))
        ids, first = image["id.instance"], total - len(plan.objects) + 1
        instances = []
        for k, item in enumerate(plan.objects):
            mask = ids == first + k
            scale = recipe.models[item.model].scale
            rigid = [[value / scale if j < 3 else value for j, value in enumerate(row)] for row in item.pose[:3]]
            solo = self._solo[item.model]
            whole = mask | silhouette(solo.scene, solo.low, solo.high, item.pose, view.camera) if recipe.occluded else mask
            instances.append(Instance(item.model, self.names[item.model], rigid + [[0.0, 0.0, 0.0, 1.0]], scale, mask, whole,
                                      self._keypoints(scene, item, view), _covers(ids, whole & ~mask, first, len(plan.objects))))
        return Frame(plan.frame, view.name, view.camera, image, instances, exposure)

    def _keypoints(self, scene: Any, item: Placed, view: View) -> Optional[Keypoints]:
        model = self.recipe.models[item.model]
        if not model.keypoints:
            return None
        points = [transform(item.pose, point) for point in model.keypoints.values()]
        depth = model.keypoint_depth
        if depth is None:
            low, high = self.boxes[item.model]
            depth = 0.01 * math.sqrt(sum((b - a) * (b - a) for a, b in zip(low, high)))
        return project_keypoints(scene.world(**self._build), view.camera, points, depth=depth)
