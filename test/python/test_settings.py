#!/usr/bin/python3
"""Every setting's row (velo/setting.h) has hostile values by each way in that reaches it: options of the program, the Python
module, recipes of datasets, velo's JSON of cameras. What the row does not hold is refused with the name, what it must be, and the right exit code or exception; what is accepted has a finite result."""
import json
import math
import os
import re
import subprocess

import cases
from cases import VELO, attempt, case, limited, report, work

numpy = cases.need("numpy")
import velo
from velo import dataset

NAN, INF, LONG = math.nan, math.inf, 10**7
ROWS = cases.setting_rows()
NUMBERS = {"nan": NAN, "inf": INF, "-inf": -INF, "2**32 + 8": 2**32 + 8, "-1": -1, "1.5": 1.5, "1e300": 1e300}
OTHERS = {"empty": "", "long": "x" * LONG, "text": "8", "true": True, "list": [1, 2], "names": {}}
os.chdir(cases.WORK)
with open("a.obj", "w") as file:
    file.write("v -1 -1 0\nv 1 -1 0\nv 1 1 0\nf 1 2 3\n")


def rows(*groups):
    return [row for row in ROWS if row.group in groups and "[" not in row.name]


def wrong(row, value):
    """Whether the value must be refused: True, False, or None where the table does not say."""
    if row.kind == "bool":
        return not isinstance(value, bool)
    if row.number:
        if isinstance(value, bool) or not isinstance(value, (int, float)):
            return True
        holds = row.holds(value)
        return None if holds is None else not holds
    if row.choices:
        return not (isinstance(value, str) and value in row.choices)
    return None if isinstance(value, str) else True if row.kind == "string" else None


def rule(row):
    """A part of what messages say that it must be."""
    return "true or false" if row.kind == "bool" else "one of" if row.choices else "number" if row.number else ""


def judge(row, label, value, result, way, problems):
    """result: None where the value was accepted, else the message; or a text that begins with ! for what must not happen."""
    place = "%s: %s.%s = %s" % (way, row.group, row.name, label)
    if result is not None and result.startswith("!"):
        problems.append("%s: %s" % (place, result))
    elif result is None and wrong(row, value):
        problems.append("%s is accepted" % place)
    elif result is not None and len(result) > 1000:
        problems.append("%s has a message of %d characters" % (place, len(result)))
    elif result is not None and wrong(row, value) and (rule(row) not in result or not named(row, result)):
        problems.append("%s does not say name and rule: %s" % (place, result))


def named(row, message):
    words = {"width": "resolution", "height": "resolution", "ranks": "crypto", "view_distance": "d ", "pixel_size": "s ", "near_plane": "near",
             "far_plane": "far", "ratio": "ratio", "rotation": "rotation", "stereo_mode": "stereo"}
    return row.name in message or row.name.replace("_", "-") in message or words.get(row.name, row.name) in message


def through_python(call):
    result = attempt(call)
    if isinstance(result, str):
        return "!" + result
    return None if result is None else str(result) if isinstance(result, velo.Error) else "!" + repr(result)


def scene():
    made = velo.Scene()
    made.add_sphere((0, 0, 0), 0.5)
    made.add_light("infinite", color=(1, 1, 1))
    made.camera = velo.Camera(8, 8, eye=(0, 0, 3), lookat=(0, 0, 0))
    return made


SCENE = scene()
IMAGE = SCENE.render(resolution=(4, 4), spp=1)
# Of the rows of the program alone, Python reaches these.
PYTHON = {"render": lambda name, v: SCENE.settings(**{name: v}), "camera": lambda name, v: velo.Camera(8, 8, **{name: v}),
          "load": lambda name, v: velo.Scene().load("a.obj", **{name: v}), "complete": lambda name, v: scene().complete(**{name: v}),
          "channels": lambda name, v: SCENE.ground_truth(["Z"], resolution=(4, 4), **{name: v}),
          "write": lambda name, v: IMAGE.write("w.exr", **{name: v}), "context": lambda name, v: velo.Context(**{name: v})}
PROGRAM = {"exposure": lambda v: IMAGE.view("standard", exposure=v), "width": lambda v: SCENE.settings(resolution=(v, 4)),
           "height": lambda v: SCENE.settings(resolution=(4, v))}


@case
@limited
def by_python():
    problems, tried = [], 0
    for row in ROWS:
        call = PYTHON.get(row.group)
        if row.group == "program" and row.name in PROGRAM:
            call = lambda name, v: PROGRAM[name](v)
        if not call or "[" in row.name or (row.group == "camera" and (row.name in ("width", "height"))) or row.name == "environment":  # also a path
            continue
        for label, value in {**NUMBERS, **OTHERS}.items():
            tried += 1
            judge(row, label, value, through_python(lambda: call(row.name, value)), "Python", problems)
    print("  %d values" % tried)
    report(problems)


@case
@limited
def by_recipes():
    member = {"spp": "spp", "width": "resolution", "height": "resolution"}
    problems, tried = [], 0
    for row in rows("render", "camera", "program", "complete"):
        for label, value in {**NUMBERS, **OTHERS}.items():
            data = {"models": ["a.obj"], "cameras": [{"kind": "fixed", "keywords": {"fov": 1.0}}]}
            if row.group == "program" and row.name in ("width", "height"):
                data["resolution"] = [value, 8] if row.name == "width" else [8, value]
            elif row.group == "complete" and row.name in ("strength", "rotation"):
                data["environment"] = {row.name: value}
            elif row.name in member and row.group == "render":
                data[member[row.name]] = value
            elif row.group == "render" and row.name not in ("seed", "first_sample"):
                data["render"] = {row.name: value}
            elif row.group == "camera" and row.name not in ("width", "height", "aperture"):
                data["cameras"][0]["keywords"] = {row.name: value}
            else:
                continue
            if label == "list" and row.name in ("strength", "rotation"):
                continue  # a pair is a range of random values
            tried += 1
            result = through_python(lambda: dataset.Stage(dataset.recipe_from(data, cases.WORK)).plan(0))
            judge(row, label, value, result, "recipe", problems)
            if result is not None and not result.startswith("!") and "recipe" not in result and wrong(row, value):
                problems.append("recipe: %s = %s has no place: %s" % (row.name, label, result))
    print("  %d values" % tried)
    report(problems)


def run(*arguments):
    done = subprocess.run([VELO, *arguments], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, errors="replace", timeout=60)
    return done.returncode, done.stderr.strip()


def spelled(value):
    """As one types it."""
    if isinstance(value, str):
        return value
    return "true" if value is True else repr(value) if isinstance(value, float) else str(value)


@case
def by_options_of_the_program():
    aliases = {"rotation": "environment-rotation", "strength": "environment-strength", "ranks": "crypto-ranks"}
    texts = ("noise", "samples")  # have forms of their own; view looks at --exposure after it has loaded the scene
    problems, tried, reached = [], 0, set()
    pages = {command: run_help(command) for command in ("render", "view", "camera paths", "scene verify", "image denoise", "sensor expose")}
    for row in ROWS:
        option = aliases.get(row.name, row.name.replace("_", "-"))
        for command, page in pages.items():
            found = re.search(r"^ +(?:-\w, )?--%s ([A-Z]+)\b" % option, page, re.M)
            if (row.group in ("sensor", "exposure")) != (command == "sensor expose") or row.group == "sensor":
                continue
            if not found or row.kind == "string" or option in texts or (command, option) == ("view", "exposure") or (row.group in ("load", "complete") and row.name not in aliases):
                continue
            reached.add((command, option))
            for label, value in {**NUMBERS, **OTHERS}.items():
                text = spelled(value)[:100000]  # the system takes no more
                number = isinstance(value, (int, float)) and not isinstance(value, bool)
                code, message = run(*command.split(), "nothing.pbrt", "--%s=%s" % (option, text))
                tried += 1
                must = wrong(row, value) if number or label != "text" else wrong(row, 8)
                if value in (INF, -INF):
                    must = True  # a command line has no infinities
                if must and (code != 2 or "--" + option not in message or "must " not in message or "\n" in message):
                    problems.append("%s --%s=%s: exit %d, %s" % (command, option, label, code, message[:300]))
                elif code not in (2, 4, 5, 3) or "Traceback" in message:
                    problems.append("%s --%s=%s: exit %d, %s" % (command, option, label, code, message[:300]))
    print("  %d values of %d options" % (tried, len(reached)))
    assert len(reached) > 25, reached
    report(problems)


def run_help(command):
    return subprocess.run([VELO, "help", *command.split(), "--all"], stdout=subprocess.PIPE, text=True).stdout or \
        subprocess.run([VELO, *command.split(), "--help"], stdout=subprocess.PIPE, text=True).stdout


@case
def by_json_of_cameras():
    names = {"rotation": "aperture_rotation", "ratio": "aperture_ratio", "seconds": "exposure_seconds", "stereo_mode": "stereo"}
    problems, tried = [], 0
    for row in rows("camera"):
        name = names.get(row.name, row.name)
        if name in ("distortion", "projection", "aperture"):  # words of the file's own
            continue
        for label, value in {**NUMBERS, **OTHERS}.items():
            if label == "long" and row.name not in ("fx", "fov_axis", "vignetting"):
                continue
            with open("c.json", "w") as file:
                json.dump({"velo_camera": 1, "width": 8, "height": 8, **{name: value}}, file)
            code, message = run("camera", "info", "c.json")
            tried += 1
            if code not in (0, 3) or "\n" in message:
                problems.append("JSON %s = %s: exit %d, %s" % (name, label, code, message[:300]))
            elif code == 0 and wrong(row, value):
                problems.append("JSON %s = %s is accepted" % (name, label))
            elif code == 3 and wrong(row, value) and label not in ("nan", "inf", "-inf") and (name not in message or "must be" not in message):
                problems.append("JSON %s = %s: %s" % (name, label, message[:300]))
    print("  %d values" % tried)
    report(problems)


@case
@limited
def both_ends_of_every_range_have_finite_images():
    """Both ends of a range are in it, or not where the table says so; images with them are finite."""
    problems, tried = [], 0
    for row in rows("render", "camera"):
        if not row.number or row.name in ("spp", "sequence", "first_sample", "light_paths", "width", "height"):
            continue
        for end, outside in ((row.low, row.above), (row.high, row.below)):
            if not math.isfinite(end):
                continue
            value = int(end) if row.kind == "integer" else math.radians(end) if row.group == "camera" and row.unit == "degrees" else end
            tried += 1
            keywords = {row.name: value} if row.group == "render" else {}
            result = attempt(lambda: finite(keywords, {row.name: value} if row.group == "camera" else {}))
            if isinstance(result, str):
                problems.append("%s = %g: %s" % (row.name, value, result))
            if outside and result is None and value == end:
                problems.append("%s = %g is accepted" % (row.name, value))
    print("  %d ends" % tried)
    report(problems)


def finite(settings, camera):
    cam = velo.Camera(8, 8, eye=(0, 0, 3), lookat=(0, 0, 0), **camera)
    image = SCENE.render(camera=cam, resolution=(8, 8), spp=1, **settings)
    assert numpy.isfinite(numpy.asarray(image)).all(), "not finite"


if __name__ == "__main__":
    cases.main()
