#!/usr/bin/python3
"""Every member of a dataset's recipe, in turn, has each of many wrong values, and recipes come as files that are none. A
recipe may be refused by a velo.Error that names the place, or make a stage: no other exception, no hang, no more memory."""
import copy
import dataclasses
import math
import os
import subprocess
import sys

import cases
from cases import attempt, case, limited, report, work

numpy = cases.need("numpy")
import velo
from velo import dataset
from velo.dataset import check
from velo.dataset.__main__ import frame_numbers

NAN, INF = math.nan, math.inf
os.chdir(cases.WORK)
with open("a.obj", "w") as file:
    file.write("v -1 -1 0\nv 1 -1 0\nv 1 1 0\nf 1 2 3\n")
with open("poses.tum", "w") as file:
    file.write("0 0 0 1 0 0 0 1\n")

EYE = [[1, 0, 0, 0], [0, 1, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]]
FULL = {"seed": 1, "frames": 2, "resolution": [8, 6], "spp": 1, "scene": "", "render": {"max_depth": 2}, "channels": ["P"],
        "depth_scale": 0.1, "occluded": True, "folder": "", "path": "",
        "models": [{"path": "a.obj", "name": "a", "count": [0, 1], "scale": 1.0, "keypoints": {"top": [0, 1, 0]}, "skeleton": [[1, 1]], "keypoint_depth": 0.01},
                   {"name": "b", "positions": [[0, 0, 0], [1, 0, 0], [0, 1, 0]], "indices": [[0, 1, 2]],
                    "material": {"kind": "diffuse", "reflectance": 0.5}}],
        "placing": {"kind": "on_surface", "center": [0, 0, 0], "size": [1, 1], "up": [0, 1, 0], "gap": 0.01, "tumble": False, "tries": 5},
        "cameras": [{"kind": "around", "target": [0, 0, 0], "distance": [4, 5], "elevation": [10, 20], "up": [0, 1, 0], "jitter": 0.1,
                     "fov": 40, "keywords": {"distortion": "none"}, "name": "one"},
                    {"kind": "fixed", "fov": 50, "keywords": {"roll": 0.1}, "name": "two"}, {"kind": "fixed", "file": "", "name": "five"},
                    {"kind": "trajectory", "file": "poses.tum", "keywords": {"fov": 1.0}, "name": "three"},
                    {"kind": "rig", "base": {"kind": "around"}, "parts": [{"pose": EYE, "name": "four"}]}],
        "lights": {"count": [0, 1], "low": [0, 2, 0], "high": [1, 3, 1], "power": [1, 2], "kelvin": [3000, 4000]},
        "environment": {"kind": "white", "files": [], "strength": 1.0, "rotation": 30},
        "ground": {"size": 5, "height": 0, "up": [0, 1, 0], "materials": {"color": [[0, 0, 0], [1, 1, 1]], "roughness": [0, 1], "metallic": 0,
                                                                          "textures": []}},
        "distractors": {"count": [0, 1], "size": [0.1, 0.2], "materials": {"roughness": 0.3}},
        "sensor": {"name": "generic_mono", "numbers": {"read_noise": 3.0}, "exposure": {"f_number": 2.8}, "buckets": 3, "dng": False}}
OTHER = [{"kind": "on_scene", "low": [-1, -1, -1], "high": [1, 1, 1], "up": [0, 1, 0], "slope": 10, "gap": 0.1, "tumble": False, "tries": 3},
         {"kind": "in_volume", "low": [0, 0, 0], "high": [1, 1, 1], "gap": 0.1, "tries": 3}, {"kind": "poses", "frames": [[["a", EYE]]]}]

ODD = {"nan": NAN, "inf": INF, "-inf": -INF, "-1": -1, "0": 0, "2**32 + 8": 2**32 + 8, "2**64": 2**64, "10**400": 10**400, "1e300": 1e300,
       "1.5": 1.5, "true": True, "null": None, "empty text": "", "text": "8x8", "1e3": "1e3", "zero": "a\0b", "surrogate": "\ud800", "long": "x" * 100000,
       "list": [], "list of lists": [[]], "names": {}, "number names": {5: 5}, "numbers": [1, 2, 3, 4, 5, 6, 7], "bounds": [-3, -1],
       "reversed": [2, 1], "nans": [NAN, NAN, NAN], "nan pair": [NAN, 1], "texts": ["a", "b"], "deep": [[[[[[[[1]]]]]]]], "above": "../../x",
       "date": __import__("datetime").date(2001, 1, 1), "bytes": b"ab", "set": {1, 2}, "complex": 1j, "range": range(10**12),
       "kind": {"kind": ["around"]}, "matrix": [[1, 2, 3, 4]] * 4, "object": object()}
# What no number, no text and no list is: at numbers these must be refused.
NEVER = ("nan", "inf", "-inf", "10**400", "nans", "nan pair", "texts", "date", "complex", "range", "object", "bytes", "set", "deep", "kind",
         "number names", "long", "text", "true")


def places(data, path=()):
    """The path of each value."""
    yield path
    items = data.items() if isinstance(data, dict) else enumerate(data) if isinstance(data, list) else ()
    for name, value in items:
        yield from places(value, path + (name,))


def changed(data, path, value):
    result = copy.deepcopy(data)
    if not path:
        return value
    place = result
    for name in path[:-1]:
        place = place[name]
    place[path[-1]] = value
    return result


def make(data):
    """A recipe, its stage and the plan of a frame."""
    stage = dataset.Stage(dataset.recipe_from(data, cases.WORK))
    assert stage.plan(0).views


@case
@limited
def every_value_of_every_member():
    problems, tried = [], 0
    for base in [FULL] + [dict(FULL, placing=placing, ground={} if placing["kind"] == "on_scene" else None) for placing in OTHER]:
        result = attempt(lambda: make(base))
        assert result is None, result
        for path in places(base):
            if base is not FULL and path[:1] != ("placing",):
                continue
            for label, value in ODD.items():
                tried += 1
                result = attempt(lambda: make(changed(base, path, value)))
                place = "%s = %s" % (".".join(str(name) for name in path), label)
                if isinstance(result, str):
                    problems.append("%s: %s" % (place, result))
                elif result is None and label in NEVER and path and not isinstance(value, (str, bool)) \
                        and not (label == "texts" and path[-1] in ("files", "textures")):
                    problems.append("%s is accepted" % place)
                elif result is not None and path and path[0] != "folder" and not str(path[0]) in str(result):
                    problems.append("%s has no place: %s" % (place, result))
                elif result is not None and len(str(result)) > 1200:
                    problems.append("%s: %d letters" % (place, len(str(result))))
    print("  %d recipes" % tried)
    report(problems)


@case
def every_member_has_a_rule():
    for kind, rules in check._RULES.items():
        assert {member.name for member in dataclasses.fields(kind)} == set(rules), kind
    classes = {getattr(dataset, name) for name in dataset.__all__}
    assert {kind for kind in classes if dataclasses.is_dataclass(kind)} - set(check._RULES) == {dataset.Frame, dataset.Instance, dataset.Plan}
    # The recipe above has all of them.
    used = {name for path in places(dict(FULL, more=OTHER)) for name in path if isinstance(name, str)}
    for rules in check._RULES.values():
        assert set(rules) <= used, set(rules) - used


@case
@limited
def wrong_data_is_refused_with_name_value_and_range():
    for change, texts in (({"frames": -1}, ("recipe.frames", "1 to 1000000", "-1")), ({"frames": 0}, ("recipe.frames",)),
                          ({"models": [{"path": "a.obj", "count": [-3, -1]}]}, ("recipe.models[0].count[0]", "0 to 10000", "-3")),
                          ({"models": [{"path": "a.obj", "count": [3, 1]}]}, ("recipe.models[0].count", "the lower one first")),
                          ({"cameras": []}, ("recipe.cameras", "1 to 1000")), ({"models": []}, ("recipe.models",)),
                          ({"resolution": [2**32 + 8, 8]}, ("recipe.resolution[0]", "65536", "4294967304")),
                          ({"cameras": [{"kind": "arund"}]}, ("recipe.cameras[0]", '"around"', '"arund"')),
                          ({"cameras": [{"kind": "fixed", "keywords": {"fow": 1}}]}, ("recipe.cameras[0]", '"fow"')),
                          ({"cameras": [{"kind": "fixed", "keywords": {"fov": NAN}}]}, ("recipe.cameras[0]", "fov", "nan")),
                          ({"cameras": [{"kind": "around", "keywords": {"eye": [0, 0, 1]}}]}, ("recipe.cameras[0].keywords.eye",)),
                          ({"cameras": [{"kind": "rig", "base": {"kind": "around"}, "parts": []}]}, ("recipe.cameras[0].parts",)),
                          ({"cameras": [{"kind": "rig", "base": {"kind": "around"}, "parts": [{"pose": EYE, "nam": "a"}]}]},
                           ("recipe.cameras[0].parts[0]", '"nam"', '"name"')),
                          ({"render": {"spp": 3}}, ("recipe.render.spp", "recipe.spp")), ({"render": {"max_deph": 3}}, ("recipe.render", "max_depth")),
                          ({"render": {"max_depth": -1}}, ("recipe.render", "max_depth", "-1")), ({"channels": ["distanse"]}, ("recipe.channels[0]", '"distanse"', '"distance"')),
                          ({"environment": {"kind": "studiio"}}, ("recipe.environment.kind", "studio", "'studiio'")),
                          ({"model": []}, ('"model"', "models")), ({"placing": {"kind": "poses", "frames": [[["a", [[2, 0, 0, 0]] + EYE[1:]]]]}},
                                                                ("recipe.placing.frames[0][0][1]", "rotation"))):
        with cases.raises(velo.UsageError, *texts):
            make({**FULL, **change})
    with cases.raises(velo.UsageError, "recipe.frames", "-1"):  # also where the recipe is made in Python
        dataset.Stage(dataset.Recipe(frames=-1, models=[dataset.Model("a.obj")]))


def run(*arguments):
    return subprocess.run([sys.executable, "-m", "velo.dataset", *arguments], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True,
                          errors="replace", timeout=120)


@case
def files_that_are_no_recipes():
    try:
        import yaml  # noqa: F401
        texts = {"bomb.yaml": "a: &a [x, x, x, x, x, x, x, x, x]\n" + "".join(
                     "%s: &%s [%s]\n" % (b, b, ", ".join(["*" + a] * 9)) for a, b in zip("abcdefgh", "bcdefghi")) + "models: *i\n",
                 "self.yaml": "models: &m [*m]\n", "twice.yaml": "seed: 1\nframes: 2\nseed: 3\nmodels: [a.obj]\n",
                 "twice2.yaml": "models:\n  - {path: a.obj, count: 1, count: 2}\n", "tab.yaml": "models:\n\t- a.obj\n", "open.yaml": "models: [a.obj\n",
                 "date.yaml": "models: [a.obj]\nseed: 2001-99-99\n", "tag.yaml": "models: !!python/object:os.system [a]\n",
                 "deep.yaml": "models: " + "[" * 5000 + "]" * 5000, "list.yaml": "- 1\n", "empty.yaml": "", "text.yaml": "hello\n",
                 "key.yaml": "? [1, 2]\n: 3\n", "latin.yaml": b"models: [\xff\xfe.obj]\n", "binary.yaml": bytes(range(256)),
                 "int.yaml": "seed: " + "9" * 5000 + "\n", "two.yaml": "seed: 1\n---\nseed: 2\n"}
    except ImportError:
        texts = {}
    texts.update({"twice.json": '{"seed": 1, "seed": 2, "models": ["a.obj"]}', "open.json": '{"models": [', "nan.json": '{"models": ["a.obj"], "seed": NaN}',
                  "deep.json": "[" * 100000, "int.json": '{"seed": ' + "9" * 5000 + "}", "list.json": "[]", "empty.json": "", "null.json": "null",
                  "latin.json": b'{"models": ["\xff"]}', "bom.json": "\ufeff{}"})
    problems = []
    for name, text in texts.items():
        with open(work(name), "wb") as file:
            file.write(text if isinstance(text, bytes) else text.encode())
        result = attempt(lambda: dataset.read_recipe(work(name)))
        if not isinstance(result, velo.UsageError) or result.file != work(name):
            problems.append("%s: %r" % (name, result))
    for name in ("twice.json", "nan.json"):  # in a process of their own
        done = run(work(name), "-o", work("nothing"))
        if done.returncode != 2 or "Traceback" in done.stderr or len(done.stderr.splitlines()) != 1:
            problems.append("%s: exit %d, %s" % (name, done.returncode, done.stderr))
    report(problems)
    if "twice.yaml" in texts:
        with cases.raises(velo.UsageError, "twice.yaml:3:1", "'seed'"):
            dataset.read_recipe(work("twice.yaml"))


@case
def frames_and_shards():
    assert list(frame_numbers("1-5:2", None, 10)) == [1, 3, 5] and list(frame_numbers(None, "2/3", 10)) == [1, 4, 7]
    for text in ("", "-1", "5-3", "0-10", "3:0", "1-2-3", "9" * 5000, "0-999999999", "nan", "\u0663"):
        with cases.raises(velo.UsageError, "--frames"):
            frame_numbers(text, None, 10)
    for text in ("", "0/3", "4/3", "1/0", "x", "9" * 5000 + "/1"):
        with cases.raises(velo.UsageError, "--shard"):
            frame_numbers(None, text, 10)
    recipe = dataset.recipe_from(FULL, cases.WORK)
    for frames in ([-1], [2], [2**32 + 8], [NAN], "12", 5, [0.5], [None], range(10**12), range(-3, 1)):
        with cases.raises(velo.UsageError, "frames"):
            dataset.generate(recipe, work("none"), frames=frames)
    for writers in ([], "bop", [5], ["pob"], None):
        with cases.raises(velo.UsageError, "writer"):
            dataset.generate(recipe, work("none"), writers=writers)
    for folder in (5, "", None):
        with cases.raises(velo.UsageError, "folder"):
            dataset.generate(recipe, folder)
    for frame in (-1, NAN, 2**32 + 8, "1", None):
        with cases.raises(velo.UsageError, "frame"):
            dataset.Stage(recipe).plan(frame)


if __name__ == "__main__":
    cases.main()
