#!/usr/bin/python3
"""Every argument of every public function of the Python module, in turn, has each of many wrong values: numbers that are not
finite or do not fit, other types, empty and huge things. A call may succeed or raise a velo.Error, nothing else: no other
exception, no hang, no more memory. Numbers that are no values of an argument are refused with its name."""
import inspect
import math
import os

import cases
from cases import attempt, case, limited, report, work

numpy = cases.need("numpy")
import velo

NAN, INF = math.nan, math.inf


class Odd:
    """Its text cannot be made."""

    def __repr__(self):
        raise RuntimeError("no text")


# Values that no number is: of counts, of numbers, of flags, of names.
NO_COUNT = {"nan": NAN, "inf": INF, "-inf": -INF, "-1": -1, "2**32 + 8": 2**32 + 8, "2**64": 2**64, "10**400": 10**400,
            "-2**63": -2**63, "1.5": 1.5, "True": True, "text": "8x8", "list": [8], "dict": {}, "odd": Odd(), "complex": 1j}
NO_NUMBER = {"nan": NAN, "inf": INF, "-inf": -INF, "10**400": 10**400, "True": True, "text": "8", "empty": "", "list": [1.0, 2.0],
             "dict": {}, "odd": Odd(), "complex": 1j, "bytes": b"8"}
NO_FLAG = {"nan": NAN, "2": 2, "text": "no", "None": None, "list": [], "odd": Odd()}
NO_TEXT = {"number": 5, "nan": NAN, "list": ["a"], "bytes": b"a", "surrogate": "\ud800", "zero": "a\0b", "odd": Odd()}
NO_PATH = {name: value for name, value in NO_TEXT.items() if name not in ("bytes", "surrogate")}
NO_VECTOR = {"nan": [NAN, 0, 0], "inf": (0, INF, 0), "array of nan": numpy.full(3, numpy.nan), "10**400": [10**400, 0, 0],
             "empty": [], "short": [1], "rows": [[1, 2], [3]], "text": "abc", "texts": ["a", "b", "c"], "range": range(10**12),
             "dict": {}, "None": None, "odd": Odd(), "bytes": b"abc", "strings": numpy.array(["a"])}
NO_OBJECT = {"number": 5, "text": "x", "list": [1, 2], "dict": {}, "odd": Odd(), "nan": NAN}
# All of these are tried everywhere.
ANYTHING = {**{"no count " + name: value for name, value in NO_COUNT.items()}, **NO_VECTOR, **NO_TEXT, "0": 0, "": "",
            "long": "x" * 100000, "nested": [[[[[1]]]]], "function": len, "class": int, "no axis": numpy.array(1.0),
            "none of three": numpy.zeros((0, 3)), "complex array": numpy.zeros(3, dtype=complex), "objects": numpy.array([None, {}])}

QUAD = numpy.array([[-1, -1, 0], [1, -1, 0], [1, 1, 0], [-1, 1, 0]], dtype=numpy.float32)
FACES = numpy.array([[0, 1, 2], [0, 2, 3]], dtype=numpy.uint32)
K = numpy.array([[8, 0, 4], [0, 8, 4], [0, 0, 1.0]])
OBJ, EXR, FILM, CAMERA, DNG = work("a.obj"), work("a.exr"), work("a.film"), work("camera.json"), work("a.dng")


def quad_scene():
    scene = velo.Scene()
    material = scene.add_material("diffuse", name="white")
    scene.add_mesh(QUAD, FACES, name="quad", material=material)
    scene.add_light("infinite", color=(1, 1, 1))
    group = scene.add_group("pair")
    scene.add_sphere((0, 0, 0), 0.2, group=group)
    scene.add_instance(group, numpy.eye(4))
    scene.camera = velo.Camera(8, 8, eye=(0, 0, 3), lookat=(0, 0, 0))
    return scene


os.chdir(cases.WORK)
with open(OBJ, "w") as file:
    file.write("v -1 -1 0\nv 1 -1 0\nv 1 1 0\nf 1 2 3\n")
FIRST = quad_scene()
IMAGE = FIRST.render(spp=1, errors=True, buckets=2, lambda_min=400, lambda_max=700)
SPECTRAL = velo.Image(numpy.ones((4, 4, 2), dtype=numpy.float32), ["S0.450nm", "S0.550nm"], encoding="linear")
IMAGE.write(EXR)
FIRST.film.write(FILM)
FIRST.camera.write(CAMERA)
RAW = velo.Raw(numpy.zeros((4, 6), dtype=numpy.uint16))
BELLS = [numpy.exp(-((numpy.arange(471) - middle) / 40.0) ** 2) for middle in (240, 180, 90)]
RAW.match_color(BELLS)
RAW.write(DNG)

COUNT, NUMBER, FLAG, TEXT, PATH, VECTOR, OBJECT, ANY = "count", "number", "flag", "text", "path", "vector", "object", "any"
REFUSED = {COUNT: NO_COUNT, NUMBER: NO_NUMBER, FLAG: NO_FLAG, TEXT: NO_TEXT, PATH: NO_PATH,
           VECTOR: NO_VECTOR, OBJECT: NO_OBJECT, ANY: {}}


class Call:
    """A public function with arguments that it accepts: name: (value, what it is). make: makes the object of a method.
    keywords: what its further keywords are, or a family of kinds that has them."""

    def __init__(self, name, make=None, /, *, keywords=None, **arguments):
        self.name, self.make, self.arguments, self.keywords = name, make, arguments, keywords

    def function(self):
        owner = velo
        for part in self.name.split("."):
            owner = getattr(owner, part)
        if self.make is not None:
            owner = getattr(self.make(), self.name.split(".")[-1])
        return owner

    def run(self, **changes):
        arguments = {name: value for name, (value, _) in self.arguments.items()}
        arguments.update(changes)
        # Objects of a scene are made in the scene of the call.
        function = self.function()
        own = getattr(function, "__self__", None)
        arguments = {name: value(own) if isinstance(value, Own) else value for name, value in arguments.items()}
        result = function(**arguments)
        return list(result) if inspect.isgenerator(result) else result


class Own:
    """A value that is made from the call's own object."""

    def __init__(self, make):
        self.make = make

    def __call__(self, own):
        return self.make(own)


def handle(family, number=0):
    return Own(lambda scene: scene.handles(family)[number])


def film():
    return velo.read_film(FILM)


def scene_with_film():
    return quad_scene()


VIEW = dict(camera=(FIRST.camera, OBJECT), resolution=((4, 4), ANY), crop=((0, 0, 4, 4), ANY))


def keywords(group):
    """The settings of a group by their rows: what they are."""
    def kind(row):
        if row.kind in ("point3", "vector3"):
            return VECTOR
        if row.number:
            return ANY if row.optional or row.infinite else COUNT if row.kind == "integer" else NUMBER
        return FLAG if row.kind == "bool" else OBJECT if row.choices else ANY
    return {row.name: kind(row) for row in cases.setting_rows() if row.group == group and "[" not in row.name}


SETTINGS, LOAD = keywords("render"), keywords("load")
COMPLETE = {**keywords("complete"), "environment": ANY}  # also a path
# And those of cameras that no row has.
CAMERAS = {**keywords("camera"), **{name: VECTOR for name in ("K", "world_from_camera", "camera_from_world", "world_from_camera_close",
                                                               "pose_times", "focus_pixel")},
           "shape": ANY, "distortion_coefficients": ANY, "shutter": ANY, "colmap": OBJECT}
CALLBACK = (None, OBJECT)

CALLS = [
    Call("Camera", keywords=CAMERAS, width=(8, COUNT), height=(8, COUNT)),
    Call("Camera.get", lambda: FIRST.camera, name=("fov", TEXT)),
    Call("Camera.replace", lambda: FIRST.camera, keywords=CAMERAS),
    Call("Camera.resize", lambda: FIRST.camera, width=(4, COUNT), height=(4, COUNT)),
    Call("Camera.coarse", lambda: FIRST.camera, factor=(2, COUNT)),
    Call("Camera.move", lambda: FIRST.camera, world_from_camera=(numpy.eye(4), VECTOR)),
    Call("Camera.at", lambda: FIRST.camera, time=(0.5, NUMBER)),
    Call("Camera.eyes", lambda: FIRST.camera.replace(stereo_mode="parallel")),
    Call("Camera.project", lambda: FIRST.camera, points=(QUAD, ANY), jacobian=(True, FLAG)),
    Call("Camera.film_times", lambda: FIRST.camera, pixels=([[1, 2]], ANY)),
    Call("Camera.unproject", lambda: FIRST.camera, pixels=([[1, 2]], ANY), jacobian=(True, FLAG)),
    Call("Camera.solid_angle", lambda: FIRST.camera, _0=(1, ANY)),
    Call("Camera.write", lambda: FIRST.camera, path=(work("c.json"), PATH), dialect=("velo", OBJECT), name=("", TEXT), drop=((), ANY),
         context=(None, OBJECT)),
    Call("read_camera", path=(CAMERA, PATH), dialect=(None, OBJECT), frame=(None, ANY), width=(0, COUNT), height=(0, COUNT), context=(None, OBJECT)),
    Call("read_trajectory", path=(CAMERA, PATH), dialect=(None, OBJECT), width=(0, COUNT), height=(0, COUNT), context=(None, OBJECT)),
    Call("Context", threads=(1, COUNT), max_memory=(0, ANY), keep_inputs=(False, FLAG)),
    Call("Context.note_input", lambda: velo.Context(threads=1), _0=(OBJ, PATH)),
    Call("Context.check_output", lambda: velo.Context(threads=1), _0=(OBJ, PATH)),
    Call("default_context"),
    Call("set_threads", threads=(1, COUNT)),
    Call("Film.image", film, exposure=(1.0, NUMBER)),
    Call("Film.errors", film, exposure=(1.0, NUMBER)),
    Call("Film.spectrum", film), Call("Film.clear", film), Call("Film.close", film),
    Call("Film.write", film, path=(work("w.film"), PATH), overwrite=(True, FLAG)),
    Call("read_film", path=(FILM, PATH), partial=(False, FLAG), context=(None, OBJECT)),
    Call("merge_films", paths=([FILM], ANY), output=(work("m.film"), PATH), overwrite=(True, FLAG), context=(None, OBJECT)),
    Call("Image", array=(QUAD[None], ANY), names=(["a", "b", "c"], ANY), encoding=("linear", OBJECT), context=(None, OBJECT)),
    Call("Image.plane", lambda: IMAGE, name=("R", TEXT)),
    Call("Image.write", lambda: IMAGE, keywords={"half": FLAG, "compression": COUNT, "quality": COUNT}, path=(work("w.exr"), PATH)),
    Call("Image.view", lambda: IMAGE, view=("agx", OBJECT), exposure=(0.0, NUMBER)),
    Call("Image.compare", lambda: IMAGE, reference=(IMAGE, OBJECT)),
    Call("Image.difference", lambda: IMAGE, reference=(IMAGE, OBJECT)),
    Call("Image.denoise", lambda: FIRST.render(spp=2, errors=True, channels=["error"]), denoiser=("velo", OBJECT)),
    Call("Image.close", lambda: velo.Image(QUAD)),
    Call("Raw", numbers=(numpy.ones((2, 2), dtype=numpy.uint16), ANY), pattern=("RG/GB", TEXT), bits=(12, COUNT), black=(0, ANY),
         white=(4095, COUNT), camera=("a", TEXT), exposure_time=(0.1, NUMBER), f_number=(4, NUMBER), focal_length=(0.05, NUMBER),
         iso=(100, COUNT), gain=(1, NUMBER), read_noise=(1, NUMBER), baseline_exposure=(0, NUMBER), neutral=(None, OBJECT),
         matrices=(None, OBJECT), context=(None, OBJECT)),
    Call("Raw.write", lambda: RAW, path=(work("w.dng"), PATH)),
    Call("Raw.develop", lambda: RAW, stop_at=("tone", OBJECT), exposure=(0.0, NUMBER)),
    Call("Raw.match_color", lambda: RAW, sensitivities=(BELLS, OBJECT), light=(None, OBJECT)),
    Call("read_raw", path=(DNG, PATH), context=(None, OBJECT)),
    Call("read_image", path=(EXR, PATH), channels=(["R"], ANY), context=(None, OBJECT)),
    Call("World.ids", lambda: FIRST.world(), kind=("object", TEXT)),
    Call("World.trace", lambda: FIRST.world(), origins=([[0, 0, 3.0]], ANY), directions=([[0, 0, -1.0]], ANY), t_max=(None, ANY), times=(None, ANY),
         t_min=(None, ANY), hits=(1, COUNT), fields=(None, ANY)),
    Call("World.occluded", lambda: FIRST.world(), origins=([[0, 0, 3.0]], ANY), directions=([[0, 0, -1.0]], ANY), t_max=(None, ANY),
         times=(None, ANY), t_min=(None, ANY)),
    Call("World.close", lambda: quad_scene().world()),
    Call("Scene", context=(None, OBJECT)),
    Call("Scene.load", velo.Scene, keywords=LOAD, path=(OBJ, PATH), progress=CALLBACK),
    Call("Scene.complete", quad_scene, keywords=COMPLETE),
    Call("Scene.save", quad_scene, path=(work("w.pbrt"), PATH), strict=(False, FLAG)),
    Call("Scene.add_texture", quad_scene, keywords="textures", kind=("image", TEXT), image=(QUAD[None] + 1, ANY), range=((0, 2), ANY)),
    Call("Scene.add_material", quad_scene, keywords="materials", kind=("diffuse", TEXT)),
    Call("Scene.add_medium", quad_scene, keywords="media", kind=("homogeneous", TEXT)),
    Call("Scene.add_emission", quad_scene, keywords="emission"),
    Call("Scene.add_light", quad_scene, keywords="lights", kind=("point", TEXT)),
    Call("Scene.add_shape", quad_scene, keywords="shapes", kind=("sphere", TEXT)),
    Call("Scene.add_mesh", quad_scene, keywords={
        "normals": VECTOR, "uvs": VECTOR, "uvs_1": VECTOR, "tangents": VECTOR, "colors": VECTOR, "tangent_signs": VECTOR, "positions_close": VECTOR,
        "normals_close": VECTOR, "transform": VECTOR, "material": ANY, "emission": ANY, "group": ANY, "inside": ANY, "outside": ANY,
        "name": TEXT, "times": VECTOR, "reverse_orientation": FLAG, "backdrop": FLAG, "hidden_from_camera": FLAG}, positions=(QUAD, VECTOR), indices=(FACES, VECTOR)),
    Call("Scene.add_sphere", quad_scene, center=((0, 0, 0), VECTOR), radius=(0.5, NUMBER)),
    Call("Scene.add_box", quad_scene, low=((0, 0, 0), VECTOR), high=((1, 1, 1), VECTOR), keywords={"pose": VECTOR}),
    Call("Scene.add_plane", quad_scene, center=((0, 0, 0), VECTOR), normal=((0, 0, 1), VECTOR), width=(1.0, NUMBER), height=(2.0, NUMBER),
         keywords={"pose": VECTOR}),
    Call("Scene.add_disk", quad_scene, center=((0, 0, 0), VECTOR), radius=(0.5, NUMBER), normal=((0, 1, 0), VECTOR), keywords={"pose": VECTOR}),
    Call("Scene.add_cylinder", quad_scene, start=((0, 0, 0), VECTOR), end=((0, 1, 0), VECTOR), radius=(0.5, NUMBER), keywords={"pose": VECTOR}),
    Call("Scene.add_group", quad_scene, name=("g", ANY)),
    Call("Scene.load_group", quad_scene, keywords=LOAD, path=(OBJ, PATH), name=("g", ANY), progress=CALLBACK),
    Call("Scene.add_instance", quad_scene, group=(handle("groups"), OBJECT), transform=([numpy.eye(4)] * 2, VECTOR), times=([0, 1], ANY), pose=(None, ANY)),
    Call("Scene.handles", quad_scene, family=("shapes", TEXT)),
    Call("Scene.find", quad_scene, family=("materials", TEXT), name=("white", TEXT)),
    Call("Scene.set", quad_scene, handle=(handle("materials"), OBJECT), kind=("diffuse", ANY), keywords={"reflectance": ANY, "name": TEXT}),
    Call("Scene.show", quad_scene, handle=(handle("shapes"), OBJECT), shown=(True, FLAG)),
    Call("Scene.hide", quad_scene, handle=(handle("shapes"), OBJECT)),
    Call("Scene.remove", quad_scene, handle=(handle("instances"), OBJECT)),
    Call("Scene.get", quad_scene, handle=(handle("materials"), OBJECT), name=("reflectance", ANY)),
    Call("Scene.mesh", quad_scene, shape=(handle("shapes"), OBJECT)),
    Call("Scene.transform", quad_scene, instance=(handle("instances"), OBJECT)),
    Call("Settings.keywords", lambda: FIRST.settings(spp=2)), Call("Settings.names", lambda: FIRST.settings()),
    Call("Settings.copy", lambda: FIRST.settings()),
    Call("Settings.get", lambda: FIRST.settings(), _0=("spp", TEXT)),
    Call("Settings.set", lambda: FIRST.settings(), _0=("spp", TEXT), _1=(4, COUNT)),
    Call("Settings.set_size", lambda: FIRST.settings(), _0=(4, COUNT), _1=(4, COUNT)),
    Call("Settings.set_crop", lambda: FIRST.settings(), _0=(0, COUNT), _1=(0, COUNT), _2=(4, COUNT), _3=(4, COUNT)),
    Call("Settings.set_coarse", lambda: FIRST.settings(), _0=(2, COUNT)),
    Call("Scene.settings", lambda: FIRST, keywords=SETTINGS, resolution=((4, 4), ANY), crop=((0, 0, 4, 4), ANY)),
    Call("Scene.world", lambda: FIRST, previous=(None, OBJECT), progress=CALLBACK),
    Call("Scene.render", lambda: FIRST, **VIEW, channels=(["Z"], ANY), progress=CALLBACK, film=(None, OBJECT), denoise=(False, FLAG),
         keywords={"spp": COUNT, "seed": COUNT, "tracer": OBJECT, "exposure": NUMBER}),
    Call("Scene.passes", lambda: FIRST, **VIEW, channels=((), ANY), film=(None, OBJECT), coarse=((2,), ANY), keywords={"spp": COUNT}),
    Call("Scene.choose_tracer", lambda: FIRST, camera=VIEW["camera"], resolution=VIEW["resolution"], keywords={"spp": COUNT}),
    Call("Scene.ground_truth", lambda: FIRST, **VIEW, channels=(["Z"], ANY), film=(None, OBJECT), forward=(None, OBJECT),
         backward=(None, OBJECT), mode=("centre", OBJECT), ranks=(6, COUNT), time=(0.5, ANY)),
    Call("Scene.boxes", lambda: FIRST, **VIEW),
    Call("Scene.focus", lambda: FIRST, x=(4.0, NUMBER), y=(4.0, NUMBER)),
    Call("Scene.close", quad_scene),
    Call("load", keywords={**LOAD, **COMPLETE}, path=(OBJ, PATH), context=(None, OBJECT), progress=CALLBACK),
    Call("kinds", family=("materials", TEXT)),
    Call("OwnCamera", rays=(len, OBJECT), name=("own", TEXT), pixels=(None, ANY), lens=(False, FLAG)),
    Call("OwnSampler", numbers=(len, OBJECT), name=("own", TEXT)),
    Call("OwnTracer", radiance=(len, OBJECT), name=("own", TEXT)),
    Call("Sensor", keywords=keywords("sensor"), sensor=("ideal", TEXT), context=(None, OBJECT)),
    Call("Sensor.expose", lambda: velo.Sensor("generic_mono"), keywords=keywords("exposure"), image=(SPECTRAL, OBJECT)),
    Call("Exposure.raw", lambda: velo.Sensor("generic_rggb").expose(SPECTRAL), light=(None, OBJECT)),
    Call("Sensor.raw", lambda: velo.Sensor("generic_rggb"), keywords=keywords("exposure"), image=(SPECTRAL, OBJECT), light=(None, OBJECT)),
    Call("sensor_presets"),
    Call("channel_names"), Call("sensor_names"), Call("settings_names"), Call("spectrum_names"),
]
# Their values are checked where they are used: add_light's color, below.
SPECTRA = ("Spectrum", "rgb", "blackbody", "sampled", "named")
# Made by velo during a render: their arguments are tried there.
TRACE = ("Trace", "TraceRays", "TraceHits", "TraceLights", "TraceBounce")


# ---- running --------------------------------------------------------------------------------------------------------

def slots(call):
    """Name and kind of each argument and keyword."""
    for name, (_, kind) in call.arguments.items():
        if not name.startswith("_"):
            yield name, kind
    if isinstance(call.keywords, str):
        words = {word for row in velo.kinds(call.keywords).values() for word in row}
        for word in sorted(words | {"name", "transform", "material", "medium", "portal", "tint", "channel", "wrap_t", "space", "density",
                                    "materials", "data", "encoding", "spectrum", "centers", "radii", "widths", "indices", "image"}):
            if word not in call.arguments:
                yield word, ANY
    else:
        yield from (call.keywords or {}).items()


def check(call, name, label, value, refused, problems):
    result = attempt(call.run, **{name: value})
    place = "%s(%s=%s)" % (call.name, name, label)
    if isinstance(result, str):
        problems.append("%s: %s" % (place, result))
    elif refused and result is None:
        problems.append("%s is accepted" % place)
    elif refused and isinstance(result, velo.UsageError) and not mentions(str(result), name):
        problems.append("%s is not named: %s" % (place, result))
    elif result is not None and len(str(result)) > 900:
        problems.append("%s has a message of %d characters" % (place, len(str(result))))


def mentions(message, name):
    words = {"group": "scene's groups", "handle": "Handle", "instance": "Handle", "shape": "Handle", "K": "K", "camera_from_world": "camera"}
    return name in message or words.get(name, name).rstrip("s") in message or name.replace("_", " ") in message or "kind" in message or (name == "kind" and "must be one of" in message) \
        or "dialect" in message or "family" in message or "array" in message or "channel" in message


@case
@limited
def every_argument_of_every_function():
    problems, tried = [], 0
    for call in CALLS:
        if "_0" in call.arguments:
            continue
        for name, kind in slots(call):
            for label, value in REFUSED[kind].items():
                check(call, name, label, value, True, problems)
            for label, value in ANYTHING.items():
                if not (name == "progress" and callable(value)):  # what a callback raises is its own
                    check(call, name, label, value, False, problems)
            tried += len(REFUSED[kind]) + len(ANYTHING)
    print("  %d calls" % tried)
    report(problems)


@case
@limited
def the_calls_succeed_with_their_own_values():
    problems = []
    for call in CALLS:
        if "_0" not in call.arguments:
            result = attempt(call.run)
            if result is not None:
                problems.append("%s: %s" % (call.name, result))
    report(problems)


@case
def no_public_function_is_left_out():
    names = {call.name for call in CALLS}
    wanted = set()
    for name in velo.__all__:
        thing = getattr(velo, name)
        if inspect.isclass(thing) and issubclass(thing, (Exception, tuple)) or name in SPECTRA or \
                name in ("Handle", "Projection") or name in TRACE:
            continue
        if inspect.isclass(thing):
            wanted.update("%s.%s" % (name, member) for member, value in inspect.getmembers(thing)
                          if not member.startswith("_") and (inspect.isfunction(value) or inspect.ismethoddescriptor(value)) and
                          not isinstance(inspect.getattr_static(thing, member), property))
            if name not in ("Film", "Settings", "World", "Exposure"):
                wanted.add(name)
        elif callable(thing):
            wanted.add(name)
    assert wanted == names, (sorted(wanted - names), sorted(names - wanted))
    for call in CALLS:
        function = call.function()
        if call.name in ("Context", "Film.clear", "Settings.copy", "Settings.names") or "_0" in call.arguments:
            continue
        parameters = inspect.signature(function).parameters
        plain = {name for name, p in parameters.items() if p.kind not in (p.VAR_KEYWORD, p.VAR_POSITIONAL) and p.default is not ...}
        extra = set(call.arguments) - plain
        assert not plain - set(call.arguments) and (not extra or any(p.kind == p.VAR_KEYWORD for p in parameters.values())), call.name
    assert set(SETTINGS) == set(velo.settings_names()), set(SETTINGS) ^ set(velo.settings_names())


@case
@limited
def every_question_of_a_trace():
    problems, kept = [], []
    questions = {"hits": ("rays", NO_OBJECT), "occluded": ("rays", NO_OBJECT), "leave": ("direction", NO_VECTOR),
                 "lights": ("bounce", NO_COUNT), "bsdf": ("direction", NO_VECTOR), "bounce": ("bounce", NO_COUNT),
                 "numbers": ("purpose", NO_COUNT)}
    assert set(questions) == {name for name in vars(velo.Trace) if not name.startswith("_")}

    def radiance(trace, paths):
        hits = trace.hits(paths.rays)
        if not kept:
            for name, (argument, refused) in questions.items():
                call = Call("Trace." + name, lambda: trace, **{argument: (None, ANY)})
                for label, value in {**ANYTHING, **refused}.items():
                    numbers = argument == "direction" and label.replace("no count ", "") in ("nan", "inf", "array of nan")
                    check(call, argument, label, value, label in refused and not numbers, problems)
            kept.append(trace)
        return hits.emission

    FIRST.render(spp=1, tracer=velo.OwnTracer(radiance, name="asks"))
    report(problems)
    for name in questions:  # the render is over
        result = attempt(getattr(kept[0], name), **({} if name in ("lights", "bounce", "numbers") else
                                                    {questions[name][0]: None if name in ("hits", "occluded") else numpy.zeros((1, 3))}))
        assert isinstance(result, velo.UsageError), (name, result)


@case
@limited
def spectra_and_points():
    problems = []
    for label, value in ANYTHING.items():
        for name, make in (("rgb", lambda v: velo.rgb(v, 1, 1)), ("scale", lambda v: velo.rgb(1, 1, 1, scale=v)), ("space", lambda v: velo.rgb(1, 1, 1, space=v)),
                           ("blackbody", velo.blackbody), ("wavelengths", lambda v: velo.sampled(v, [1, 2, 3])),
                           ("values", lambda v: velo.sampled([400, 500, 600], v)), ("named", velo.named), ("kind", lambda v: velo.Spectrum(v, 1)),
                           ("value", lambda v: velo.Spectrum("sampled", v))):
            result = attempt(lambda: quad_scene().add_light("point", color=make(value)))
            if isinstance(result, str):
                problems.append("%s of %s: %s" % (name, label, result))
            if name in ("rgb", "scale", "blackbody") and label in ("no count nan", "no count inf", "no count 10**400") and result is None:
                problems.append("%s of %s is accepted" % (name, label))
        for method in (velo.default_context().note_input, velo.default_context().check_output):
            result = attempt(lambda: method(value))
            if isinstance(result, str) or (result is None and label in ("number", "list", "odd", "zero")):
                problems.append("%s of %s: %s" % (method, label, result))
        for point in ((value, 1), (1, value)):
            result = attempt(lambda: FIRST.camera.solid_angle(*point))
            if isinstance(result, str) or (result is None and label in ("no count nan", "no count inf", "no count 10**400")):
                problems.append("solid_angle of %s: %s" % (label, result))
        for member in ("camera",):
            result = attempt(lambda: setattr(quad_scene(), member, value))
            if isinstance(result, str) or result is None:
                problems.append("scene.%s = %s: %s" % (member, label, result))
    report(problems)


@case
def a_size_that_does_not_fit_is_refused_at_once():
    import time
    start = time.monotonic()
    for call in (FIRST.render, FIRST.boxes, lambda **k: list(FIRST.passes(**k)), lambda **k: FIRST.ground_truth(["Z", "N", "P"], **k)):
        with cases.raises(velo.OutOfMemoryError, "GB"):
            call(resolution=(65536, 65536))
    small = velo.Scene(context=velo.Context(threads=1, max_memory=30000000))
    small.camera = velo.Camera(8, 8)
    with cases.raises(velo.OutOfMemoryError, "max_memory allows"):
        small.render(spp=1, resolution=(2000, 2000))
    assert time.monotonic() - start < 5


@case
def more_threads_than_processors_need_are_not_made():
    most = 4 * velo.Context().threads
    assert velo.Context(threads=1000).threads == min(1000, most) and velo.Context(threads=2).threads == 2


@case
def messages_have_name_range_and_value():
    for call, texts in (
            (lambda: velo.Camera(8, 8, K=[[NAN, 0, 4], [0, 8, 4], [0, 0, 1]]), ("K", "nan", "finite")),
            (lambda: velo.Camera(2**32 + 8, 8), ("width", "1 to 16777216", "4294967304")),
            (lambda: FIRST.render(seed=2**32), ("seed", "0 to 4294967295", "4294967296")),
            (lambda: FIRST.render(resolution="8x8"), ("resolution", "(width, height)", "'8x8'")),
            (lambda: FIRST.render(camera="x"), ("camera must be a velo.Camera", "'x'")),
            (lambda: velo.set_threads(0), ("threads", "1 to 1024", "it is 0")),
            (lambda: FIRST.render(noise=None), ("noise", "0 to 0.5", "None")),
            (lambda: FIRST.render(sensor="nikon_d85"), ("nikon_d850",)),
            (lambda: velo.kinds("material"), ("materials",)),
            (lambda: quad_scene().add_material("diffuse", name="x" * 150, nothing=1), ("nothing",)),
            (lambda: FIRST.render(transparent="x" * 150), ("x" * 150,))):
        with cases.raises(velo.UsageError, *texts):
            call()


@case
def texts_that_are_not_utf_8_are_read():
    """An OpenEXR file with an attribute whose name is not UTF-8."""
    data = open(EXR, "rb").read()
    name = b"chromatic\xff\xfe\x80\xc3("
    assert data.count(b"chromaticities\0chromaticities\0") == 1
    with open(work("odd.exr"), "wb") as file:
        file.write(data.replace(b"chromaticities\0", name + b"\0", 1))
    attributes = velo.read_image(work("odd.exr")).attributes
    assert any(key.startswith("chromatic\ufffd") for key in attributes), attributes


if __name__ == "__main__":
    cases.main()
