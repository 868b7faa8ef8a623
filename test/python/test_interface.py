#!/usr/bin/python3
"""What calls promise in small: copies and pickles, words of other programs, names in messages, shapes of arrays, files that are
read again, types of keywords, and the unit of every angle."""
import copy
import inspect
import locale
import math
import os
import pickle
import re
import subprocess

import cases
from cases import PINHOLE, VELO, case, raises, work

numpy = cases.need("numpy")
import velo
from velo import dataset

LONG = "a_material_whose_name_says_all_that_there_is_to_say_about_it_and_about_its_use_in_the_scene_of_the_kitchen"


def small():
    scene = velo.Scene()
    scene.add_plane((0, 0, 0), (0, 1, 0), 2, 2, material=scene.add_material("diffuse", name="grey"))
    scene.add_light("infinite", color=1)
    scene.camera = velo.Camera(8, 6, eye=(0, 1, 2), lookat=(0, 0, 0))
    return scene


def copies(thing):
    return pickle.loads(pickle.dumps(thing)), copy.copy(thing), copy.deepcopy(thing)


@case
def images_keep_encoding_and_attributes():
    image = small().render(spp=1, channels=["Z", "id.object"])
    assert len(image.attributes) > 20
    for first in (image, image.view()):
        for other in copies(first):
            assert other.attributes == first.attributes
            assert [part.encoding for part in other.parts] == [part.encoding for part in first.parts]
    for number, other in enumerate(copies(image)):
        image.write(work("first.exr"))
        other.write(work("other.exr"))
        assert open(work("first.exr"), "rb").read() == open(work("other.exr"), "rb").read(), number


@case
def focal_lengths_replace_each_other():
    """Whatever gave the focal length before."""
    ways = ({"fov": 0.7}, {"view_distance": 50.0}, {"view_distance": 30.0, "zoom": 2.0}, {"view_distance": 3.0, "pixel_size": 0.05},
            {"focal_mm": 35.0, "sensor_width_mm": 36.0}, {"fx": 90.0}, {"fx": 80.0, "fy": 70.0},
            {"screen_min_x": -1.0, "screen_max_x": 1.0, "screen_min_y": -0.75, "screen_max_y": 0.75}, {"fov": 0.9, "fov_axis": "vertical"})
    words = {word for way in ways for word in way if word != "fov_axis"}
    for one in ways:
        for other in ways:
            axis = {"fov_axis": "smaller"} if "fov_axis" not in other else {}
            replaced = velo.Camera(40, 30, **one).replace(**axis, **other)
            assert numpy.allclose(replaced.K, velo.Camera(40, 30, **other).K, rtol=1e-12), (one, other)
            for word in words - set(other):
                assert replaced.get(word) is None, (one, other, word)
    for way in ways:  # their parts, one after the other
        for word in set(way) & {"zoom", "pixel_size", "focal_mm", "sensor_width_mm", "screen_max_x"}:
            longer = {**way, word: 1.25 * way[word]}
            assert numpy.allclose(velo.Camera(40, 30, **way).replace(**{word: longer[word]}).K, velo.Camera(40, 30, **longer).K), (way, word)
    for word in ("zoom", "pixel_size"):  # there is no view distance that stays
        with raises(velo.UsageError, "view distance"):
            velo.Camera(40, 30, fov=0.7).replace(**{word: 2.0})


@case
def settings_are_copied_and_pickled():
    scene = small()
    for keywords in ({}, dict(spp=3, seed=4, tracer="ambient_occlusion", ao_distance=2.0), dict(filter="lanczos", filter_tau=2.5),
                     dict(filter="mitchell", filter_b=0.25), dict(sensor="canon_eos_5d", exposure=0.5, color="rgb")):
        settings = scene.settings(resolution=(12, 10), crop=(1, 2, 9, 8), **keywords)
        for other in copies(settings):
            assert type(other) is velo.Settings and other.size == (12, 10) and other.crop == (1, 2, 9, 8)
            assert all(other.get(name) == settings.get(name) for name in settings.names()), keywords
        assert numpy.array_equal(scene.render(**settings.keywords()), scene.render(resolution=(12, 10), crop=(1, 2, 9, 8), **keywords))
    first = scene.settings(spp=3)
    second = copy.copy(first)
    second.set("spp", 9)
    assert first.get("spp") == 3 and "3 samples" in repr(first)
    with raises(velo.UsageError, "of one's own"):
        pickle.dumps(scene.settings(tracer=velo.OwnTracer(lambda trace: None, name="mine")))
    middle = velo.OwnSampler(lambda samples: numpy.full((len(samples.x), samples.dimensions), 0.5), name="middle")
    own = scene.settings(resolution=(12, 10), spp=1, sampler=middle)
    for other in (own, copy.copy(own), own.copy(), scene.settings(**own.keywords())):
        assert other.get("sampler") is middle and other.get("tracer") == "volpath"
    assert numpy.array_equal(scene.render(**own.keywords()), scene.render(resolution=(12, 10), spp=1, sampler=middle))
    plain = own.copy()
    plain.set("sampler", "sobol")
    assert plain.get("sampler") == "sobol" and own.get("sampler") is middle
    pickle.dumps(plain)


@case
def settings_forget_what_they_were():
    """The last value of each keyword counts, also after a sampler, tracer or sensor of another kind."""
    scene = small()
    choices = {row.name: row.choices for row in cases.setting_rows() if row.choices}
    mine = {"sampler": [velo.OwnSampler(lambda samples: None, name="mine")], "tracer": [velo.OwnTracer(lambda trace: None, name="mine")]}
    settings = scene.settings()
    changes = 0
    start = settings.keywords()
    for name in sorted(set(start) - {"resolution", "crop"}):
        before = settings.get(name)
        for value in [True, False, 2, 3, 0.25, *choices.get(name, []), *mine.get(name, [])]:
            try:
                settings.set(name, value)
            except velo.Error:
                continue
            changes += name not in mine and settings.get(name) != before
            settings.set(name, before)
            now = settings.keywords()
            assert now == start, (name, value, [key for key in now if now.get(key) != start.get(key)])
    assert changes > 60, changes


@case
def trajectories_are_copied_and_pickled():
    small().camera.write(work("pose.json"))
    frames = velo.read_trajectory(work("pose.json"))
    for other in copies(frames):
        assert len(other) == len(frames)
        for a, b in zip(other, frames):
            assert a.name == b.name and a.time == b.time and numpy.array_equal(a.world_from_camera, b.world_from_camera)
            assert numpy.array_equal(a.camera.K, b.camera.K)


@case
def words_of_other_programs_are_answered():
    scene = small()
    image = scene.render(spp=1, channels=["Z"])
    for word, ours in (("depth", "Z"), ("normal", "N"), ("base_color", "albedo")):
        with raises(velo.UsageError, "is called " + ours):
            scene.render(spp=1, channels=[word])
        with raises(velo.UsageError, "is called " + ours):
            image[word]
    for call, text in ((lambda: scene.render(width=8), "width: the size of the image is resolution=(width, height)"),
                       (lambda: scene.settings(height=8), "height: the size of the image"),
                       (lambda: scene.add_material("principled", base_color=1), "it is called reflectance"),
                       (lambda: scene.set(scene.handles("materials")[0], base_color=1), "it is called reflectance"),
                       (lambda: velo.Camera(8, 6, focal_length=50), "it is called focal_mm"),
                       (lambda: image.write(work("a.exr"), compresion=1), 'did you mean "compression"?'),
                       (lambda: scene.camera.write(work("c.yaml"), drop=["pose", "skw"]), '"skw"; the nearest is "skew"')):
        with raises(velo.UsageError, text):
            call()
    assert image[..., 0].shape == (6, 8) and numpy.array_equal(image[..., 0], image["R"])


COMMA = """comment_char %
escape_char /
LC_NUMERIC
decimal_point ","
thousands_sep "."
grouping 3
END LC_NUMERIC
"""


def comma_locale():
    """Makes a locale whose numbers have a decimal comma, and chooses it. False: the system cannot."""
    source, folder = work("comma"), work("locales")
    with open(source, "w") as file:
        file.write(COMMA)
    os.makedirs(folder)
    try:
        subprocess.run(["localedef", "-c", "-i", source, folder + "/xx"], capture_output=True)
        os.environ["LOCPATH"] = folder
        locale.setlocale(locale.LC_NUMERIC, "xx")
    except (OSError, locale.Error):
        return False
    return locale.localeconv()["decimal_point"] == ","


@case
def files_have_decimal_points_in_every_locale():
    camera = velo.Camera(64, 48, fx=50.25, fy=50.25)
    written = ("c.json", "c.yaml", "c.pbrt", "c.usda", "c.xml", "c.gltf")
    for name in written:
        camera.write(work(name))
    texts = [open(work(name)).read() for name in written]
    scene = small()
    scene.save(work("s.pbrt"))
    saved = open(work("s.pbrt")).read()
    picture = scene.render(spp=1)
    picture.write(work("plain.exr"))
    try:
        if not comma_locale():
            raise cases.Skip("there is no localedef")
        for name, text in zip(written, texts):
            camera.write(work(name))
            assert open(work(name)).read() == text, name
        assert velo.read_camera(work("c.json")).get("fx") == 50.25
        os.makedirs(work("model"), exist_ok=True)
        with open(work("model/cameras.txt"), "w") as file:
            file.write("1 PINHOLE 640 480 500.75 501 320 240\n")
        assert velo.read_camera(work("model")).get("fx") == 500.75
        scene.save(work("s.pbrt"))
        assert open(work("s.pbrt")).read() == saved
        again = scene.render(spp=1)
        assert again.attributes == picture.attributes
        again.write(work("comma.exr"))
        assert open(work("comma.exr"), "rb").read() == open(work("plain.exr"), "rb").read()
    finally:
        locale.setlocale(locale.LC_NUMERIC, "C")


@case
def names_are_whole_in_messages():
    scene = small()
    image = scene.render(spp=1)
    for call in (lambda: scene.add_material(LONG), lambda: scene.add_material("diffuse", **{LONG: 1}), lambda: velo.Camera(8, 8, **{LONG: 1}),
                 lambda: scene.find("materials", LONG), lambda: scene.handles(LONG), lambda: scene.render(channels=[LONG]),
                 lambda: scene.render(filter=LONG), lambda: scene.render(sensor=LONG), lambda: image.view(LONG), lambda: image[LONG],
                 lambda: scene.add_material("diffuse", reflectance=LONG), lambda: velo.read_camera(LONG), lambda: image.write(work("a.") + LONG),
                 lambda: velo.Camera(8, 8).write(work("a.json"), dialect=LONG), lambda: velo.Camera(8, 8).write(work("a.json"), drop=[LONG])):
        with raises(velo.Error, LONG):
            call()
    with raises(velo.UsageError, ", sony_ilce_6400, ...; it is 'kodak'"):
        scene.render(sensor="kodak")  # a list of many names ends with a whole one
    with raises(velo.UsageError, "names must be a different name for each channel"):
        velo.Image(numpy.zeros((2, 2, 3), dtype="float32"), ["a", "b", "a"])


@case
def points_keep_their_rows_and_columns():
    camera = small().camera
    points = numpy.random.default_rng(1).normal(size=(4, 5, 3))
    for given in (points, points.tolist(), tuple(map(tuple, points.tolist()))):
        seen = camera.project(given)
        assert seen.pixels.shape == (4, 5, 2) and seen.z.shape == seen.valid.shape == (4, 5)
        assert numpy.array_equal(seen.pixels.reshape(-1, 2), camera.project(points.reshape(-1, 3)).pixels)
        rays = camera.unproject(seen.pixels.tolist())
        assert rays.origins.shape == rays.directions.shape == (4, 5, 3) and rays.valid.shape == (4, 5)
    assert camera.project([0, 0, 0]).pixels.shape == (1, 2)


@case
def cameras_in_pbrt_files_are_read_again():
    for keywords in (dict(fov=0.9), dict(fov=0.9, lens_radius=0.1, focus_distance=2), dict(projection="orthographic", fx=4, fy=4),
                     dict(K=[[9, 0, 4.5], [0, 9, 2.5], [0, 0, 1]])):
        camera = velo.Camera(8, 6, eye=(0, 1, 2), lookat=(0, 0, 0), **keywords)
        for name, dialect in (("a.pbrt", None), ("a.pbrt", "pbrt")):
            camera.write(work(name), dialect=dialect)
            other = velo.read_camera(work(name), dialect=dialect)
            assert (other.width, other.height, other.projection) == (8, 6, camera.projection)
            assert numpy.allclose(other.K, camera.K, atol=1e-12) and numpy.allclose(other.world_from_camera, camera.world_from_camera, atol=1e-12)
            lens = [(c.get("lens_radius"), c.get("focus_distance")) for c in (camera, other)]
            assert numpy.allclose(*[[value or 0 for value in pair[:1]] for pair in lens], atol=1e-12), lens


@case
def double_sphere_takes_its_documented_names():
    camera = velo.Camera(64, 48, projection="double_sphere", xi=-0.2, alpha=0.6, fx=30, fy=30)
    assert camera.get("xi") == -0.2 and camera.get("alpha") == 0.6
    # Usenko et al., "The double sphere camera model", 3DV 2018, eq. 40.
    x, y, z = 0.3, -0.2, 1.0
    d1 = math.sqrt(x * x + y * y + z * z)
    k = -0.2 * d1 + z
    scale = 0.6 * math.sqrt(x * x + y * y + k * k) + 0.4 * k
    point = camera.world_from_camera @ numpy.array([x, y, z, 1])
    pixel = camera.project(point[:3]).pixels[0]
    assert numpy.allclose(pixel, (32 + 30 * x / scale, 24 + 30 * y / scale), atol=1e-9), pixel
    with raises(velo.UsageError, "beta"):
        velo.Camera(64, 48, projection="double_sphere", xi=-0.2, beta=0.6, fx=30, fy=30)


@case
def keywords_have_types():
    for function, word in ((velo.Scene.set, "roughness"), (velo.Scene.set, "positions"), (velo.Image.write, "quality")):
        assert word in inspect.signature(function).parameters, (function, word)
    for function in (velo.Scene.set, velo.Image.write, velo.Scene.render, velo.Camera.replace):
        source = inspect.getsource(function).split(":\n")[0]
        assert not re.search(r"\bAny\b", source.split("**")[1].split(")")[0]), source


# ---- angles ----

#: Rows whose angles have the same number in files and in calls.
SAME = {("materials", "hair", "alpha"): "degrees",  # pbrt's, and its textures hold degrees
        ("cameras", "fov", "omega"): "radians"}  # a parameter of the model, as its calibrations have it
ANGLE = re.compile(r"\b(angle|rotation|tilt|field of view|roll|longitude|latitude|phi)\b", re.I)
NO_ANGLE = re.compile(r"cos\^4|map from the angle|scale|natural vignetting|extent of the image|projection's limit, or half|"
                      r"texture is not|mapping", re.I)


def printed(family):
    """(kind, name, default and unit, description) of each row, as files have it."""
    text = subprocess.run([VELO, "scene", "kinds", family], stdout=subprocess.PIPE, text=True, check=True).stdout
    kind = ""
    for line in text.splitlines():
        head = re.match(r"\*\*`(\w+)`\*\*", line)
        kind = head.group(1) if head else kind
        row = re.match(r"\| `([\w.\[\]]+)`.*? \| (.*?) \| (.*?) \| (.*?) ?\| (.*) \|$", line)
        if row:
            yield kind, row.group(1), row.group(3), row.group(5)


FAMILIES = ("materials", "textures", "media", "lights", "shapes", "cameras", "settings", "samplers", "filters", "tracers", "films")


@case
def each_angle_has_its_unit_in_its_row():
    found = 0
    for family in FAMILIES:
        for kind, name, default, text in printed(family):
            has_unit = re.search(r"\b(degrees|radians)\b", default + " " + text)
            if re.search(r"\bradians\b", default):
                assert (family, kind, name) in SAME, (family, kind, name)
            number = re.match(r"[–\d.-]", default)
            if number and re.search(ANGLE, text) and not re.search(NO_ANGLE, text) and not has_unit:
                raise AssertionError((family, kind, name, default, text))
            found += bool(has_unit)
    assert found > 35, found


@case
def calls_have_radians():
    """What files and the command line have in degrees is in radians in calls, and said so, apart from SAME."""
    degrees = {(family, name) for family in FAMILIES for kind, name, default, text in printed(family) if "degrees" in default}
    assert len(degrees) > 20
    for family in ("materials", "lights", "shapes", "cameras"):
        for kind, words in velo.kinds(family).items():
            for word, text in words.items():
                apart = (family, kind, word) in SAME
                assert "(degrees)" not in text or apart, (family, kind, word, text)
                if not apart and re.search(r"\b(angle by|angle between|angle inside|angle of|angle about|angle that|rotation of|tilt of)\b", text):
                    assert text.endswith("(radians)"), (family, kind, word, text)
    scene = small()
    spot = scene.add_light("spot", cone_angle=math.radians(40), cone_delta=math.radians(7))
    scene.add_cylinder((0, 0, 0), (0, 1, 0), 0.1, phi_max=math.radians(90))
    scene.camera = velo.Camera(8, 6, fov=math.radians(50), roll=math.radians(10))
    scene.save(work("angles.pbrt"))
    text = open(work("angles.pbrt")).read()
    for name, value in (("coneangle", 40), ("conedeltaangle", 7), ("phimax", 90)):
        number = float(re.search(r'"float %s" \[(.*?)\]' % name, text).group(1))
        assert abs(number - value) < 1e-4, (name, number)
    assert scene.get(spot, "cone_angle") == numpy.float32(math.radians(40))


@case
def the_command_line_has_degrees():
    run = subprocess.run([VELO, "render", PINHOLE, "--environment-rotation", "2e6", "-o", work("a.exr")], stderr=subprocess.PIPE, text=True)
    assert run.returncode == 2 and "degrees" in run.stderr, run.stderr
    with raises(velo.UsageError, "radians (3437.75 degrees)"):
        velo.Camera(8, 6, fov=60)  # degrees where radians belong
    for call in (lambda: velo.Scene().add_light("spot", cone_angle=40), lambda: velo.Camera(8, 6, tilt_x=45), lambda: velo.load(PINHOLE, elevation=90),
                 lambda: velo.Camera(8, 6, projection="equidistant", max_angle=90)):
        with raises(velo.UsageError, " radians; it is "):
            call()


@case
def recipes_have_degrees():
    recipe = dataset.Recipe(models=[dataset.Model(name="a", positions=[[0, 0, 0], [1, 0, 0], [0, 1, 0]], indices=[[0, 1, 2]])], resolution=(8, 6),
                            cameras=[dataset.Fixed(fov=50), dataset.Around(fov=50), dataset.Fixed(keywords={"fov": math.radians(50)})])
    cameras = [view.camera for view in dataset.Stage(recipe).plan(0).views]
    assert all(abs(camera.K[0, 0] - 3 / math.tan(math.radians(25))) < 1e-9 for camera in cameras), [camera.K[0, 0] for camera in cameras]


if __name__ == "__main__":
    cases.main()
