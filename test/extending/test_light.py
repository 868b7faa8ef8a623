#!/usr/bin/env python3
"""docs/extending.md: its light is added to a copy of the tree, which builds; the light is read, checked and rendered as
it should be; without any one of its parts the tree does not build."""
import os
import subprocess
import sys
import tempfile

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
import worked_example  # noqa: E402

ROOT = os.environ.get("VELO_SOURCE_DIR") or os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
SCENE = """LookAt 0 2 3  0 0 0  0 1 0
Camera "perspective"
Film "rgb" "integer xresolution" 24 "integer yresolution" 24
Sampler "sobol" "integer pixelsamples" 4
Integrator "%s"
WorldBegin
LightSource %s "point3 from" [ 0 1 0 ]
Shape "disk" "float radius" 2
Rotate 90 1 0 0
Shape "disk" "float radius" 2
"""
failed = 0


def say(name, fine, why=""):
    global failed
    failed += not fine
    print(("ok " if fine else "not ok ") + name)
    if not fine:
        print("\n".join("  | " + line for line in why.splitlines()[-20:]))


def velo(scratch, *args):
    return subprocess.run([scratch + "/build/bin/velo", *args], stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
                          cwd=scratch, check=False)


def render(scratch, light, tracer="path"):
    with open(scratch + "/t.pbrt", "w", encoding="utf-8") as file:
        file.write(SCENE % (tracer, light))
    run = velo(scratch, "render", "t.pbrt", "-o", "t.pfm", "--quiet")
    if run.returncode:
        return run.stdout
    with open(scratch + "/t.pfm", "rb") as file:
        return file.read()


def mean(image):
    import array
    return sum(array.array("f", image.split(b"\n", 3)[3]))


def check_light(scratch):
    point = render(scratch, '"point"')
    even = render(scratch, '"cosine" "point3 to" [ 0 0 0 ] "float exponent" 0')
    narrow = render(scratch, '"cosine" "point3 to" [ 0 0 0 ] "float exponent" 8')
    away = render(scratch, '"cosine" "point3 to" [ 0 2 0 ]')
    say("exponent 0 is a point light over the half space", even == point and mean(point) > 0, repr(even[:400]))
    say("a larger exponent leaves less light", 0 < mean(narrow) < 0.9 * mean(point))
    say("nothing behind", mean(away) == 0)
    both = render(scratch, '"cosine" "point3 to" [ 0 0 0 ] "float exponent" 8', "bdpt")
    say("light paths agree", abs(mean(both) / mean(narrow) - 1) < 0.1, repr(both[:400]))
    wrong = render(scratch, '"cosine" "point3 to" [ 0 0 0 ] "float exponent" -1')
    say("its range is checked", b'parameter "exponent" must be at least 0, it is -1' in wrong, repr(wrong[:400]))
    render(scratch, '"cosine" "point3 to" [ 0 0 0 ] "float exponent" 8')
    say("scene info lists it", b"cosine" in velo(scratch, "scene", "info", "t.pbrt").stdout)
    velo(scratch, "scene", "convert", "t.pbrt", "u.pbrt")
    with open(scratch + "/u.pbrt", encoding="utf-8") as file:
        say("scene convert writes it", '"float exponent" [8]' in file.read())


def check_without(scratch, parts):
    """Each part undone in turn, the others in place. Of an edited file, an object that needs the edit stands for the tree."""
    objects = {"include/velo/scene.h": "src/scene/schema/lights.c", "src/scene/schema/lights.c": "src/scene/schema/lights.c",
               "src/world/world.h": "src/world/light/cosine.c"}
    for part in parts:
        path = os.path.join(scratch, part.path)
        with open(path, encoding="utf-8") as file:
            whole = file.read()
        times = os.stat(path)
        target = "velo_app"
        if part.text is None:
            part.undo(scratch)
            target = "CMakeFiles/velo_objects.dir/%s.o" % objects[part.path]
        else:
            os.remove(path)
        code, output = worked_example.build(scratch, target)
        say("without %s it does not build" % part.path, code != 0 and "cosine" in output, output)
        with open(path, "w", encoding="utf-8") as file:
            file.write(whole)
        os.utime(path, ns=(times.st_atime_ns, times.st_mtime_ns))


def main():
    if not os.path.exists(os.path.join(ROOT, ".git")):
        print("skip light: needs the tree's list of files (git)")
        sys.exit(0)
    parts = list(worked_example.parts(os.path.join(ROOT, "docs/extending.md"), "## A light", "## A shape"))
    edited = [p.path for p in parts if p.text is None]
    say("three files are edited", len(edited) == 3, "\n".join(edited))
    with tempfile.TemporaryDirectory(dir=os.environ.get("TMPDIR")) as scratch:
        worked_example.copy_tree(ROOT, scratch)
        for part in parts:
            part.apply(scratch)
        worked_example.configure(scratch)
        code, output = worked_example.build(scratch, "velo_app")
        say("the tree with the light builds", code == 0, output)
        if code == 0:
            check_light(scratch)
            check_without(scratch, parts)
    sys.exit(failed > 0)


main()
