#!/usr/bin/python3
"""examples/lecture.c is velo's camera in 250 lines: its rays are those of `velo camera unproject` for every scene of the
lecture with a pinhole camera, and for zoom, pixel size, roll, the axis-aligned loop and the orthographic camera. Its
image of the lecture's spheres is that of velo's raycast tracer."""
import os
import re
import struct
import subprocess
import sys
import tempfile

ROOT = os.environ.get("VELO_SOURCE_DIR") or "."
VELO = os.environ.get("VELO") or "build/release/bin/velo"
PROGRAM = os.path.join(os.environ.get("VELO_BINARY_DIR") or "build/release", "bin/example_lecture")
SCENES = os.path.join(ROOT, "scenes/lecture")
GOLD = "0.8 0.6 0.2"  # in the program; in the scene, the metal's spectra
failures = 0


def report(name, error):
    global failures
    print("%s %s" % ("not ok" if error else "ok", name))
    if error:
        print("  %s" % error)
        failures += 1


def run(*words, text=None):
    done = subprocess.run([str(w) for w in words], input=text, stdout=subprocess.PIPE, stderr=subprocess.PIPE)
    return done.returncode, done.stdout, done.stderr.decode(errors="replace")


def output(*words, text=None):
    code, out, err = run(*words, text=text)
    if code:
        sys.exit("not ok %s: exit code %d: %s" % (" ".join(map(str, words)), code, err))
    return out


def camera_of(text):
    """The arguments of the program for the camera of a scene's text; None: not a pinhole camera."""
    if 'Camera "pinhole"' not in text:
        return None
    found = dict(re.findall(r'"(?:point3|vector3|float) (eye|lookat|up|d|zoom|pixelsize|roll)"\s*\[?\s*([-0-9. ]*[0-9])', text))
    size = [re.search(r'"integer %sresolution"\s*\[?\s*(\d+)' % axis, text).group(1) for axis in "xy"]
    values = {"s": found.pop("pixelsize", "1"), "size": "x".join(size)}
    values.update((name, ",".join(numbers.split())) for name, numbers in found.items())
    return values


def arguments(values):
    return ["%s=%s" % item for item in values.items()]


def compare_rays(path, words, values):
    """The largest difference of a coordinate: direction absolute, origin relative to the eye's size."""
    width, height = map(int, values["size"].split("x"))
    own = output(PROGRAM, "n=1", "tracer=print", *words).decode().split("\n")
    pixels = [(c, r) for r in range(0, height, 13) for c in range(0, width, 7)]
    pixels += [(c, r) for c in (0, width - 1) for r in (0, height - 1)]
    asked = "".join("%g,%g\n" % (c + 0.5, height - 1 - r + 0.5) for c, r in pixels)  # the lecture's r counts upwards
    theirs = output(VELO, "camera", "unproject", "--camera", path, "-", text=asked.encode()).decode().split("\n")[1:]
    if len(own) != width * height + 1 or len(theirs) != len(pixels) + 1:
        return float("inf")
    worst = 0.0
    for (c, r), line in zip(pixels, theirs):
        a = [float(x) for x in own[r * width + c].split(",")]
        b = [float(x) for x in line.split(",")]
        scale = max(1.0, max(abs(x) for x in b[:3]))
        worst = max(worst, max(abs(x - y) / scale for x, y in zip(a[:3], b[:3])), max(abs(x - y) for x, y in zip(a[3:], b[3:6])))
        if b[6] != 1:
            return float("inf")
    return worst


def check_rays(name, path, words, values):
    worst = compare_rays(path, words, values)
    report(name, None if worst < 1e-12 else "the rays differ by %g" % worst)


def rays_of_the_scenes():
    seen = 0
    for name in sorted(os.listdir(SCENES)):
        path = os.path.join(SCENES, name)
        values = os.path.isfile(path) and camera_of(open(path, encoding="utf-8").read())
        if values:
            check_rays("rays_of_" + name[:-5], path, arguments(values), values)
            seen += 1
    report("scenes_with_a_pinhole_camera", None if seen >= 25 else "only %d" % seen)


def rays_of_more_cameras(work):
    path = os.path.join(work, "camera.pbrt")

    def scene(camera, name, values, words=()):
        size = values["size"].split("x")
        with open(path, "w", encoding="utf-8") as file:
            file.write('%s\nFilm "rgb" "integer xresolution" %s "integer yresolution" %s\nWorldBegin\n' % (camera, *size))
        check_rays(name, path, arguments(values) + list(words), values)

    pose = {"eye": "7,-3,20", "lookat": "1,2,-4", "up": "0.2,1,0.1", "size": "61x40"}
    pinhole = ('Camera "pinhole" "point3 eye" [ 7 -3 20 ] "point3 lookat" [ 1 2 -4 ] "vector3 up" [ 0.2 1 0.1 ] '
               '"float d" 300 "float zoom" 1.5 "float pixelsize" 2 "float roll" %g')
    for roll in (0, 25, -110):
        scene(pinhole % roll, "rays_with_roll_%d" % roll, dict(pose, d="300", zoom="1.5", s="2", roll=roll))
    axis = 'Camera "pinhole" "point3 eye" [ 0 0 120 ] "point3 lookat" [ 0 0 119 ] "float d" 85 "float pixelsize" 0.5'
    scene(axis, "rays_of_render_perspective", {"eye": "0,0,120", "d": "85", "s": "0.5", "size": "40x30"}, ["camera=axis"])
    # pbrt's LookAt is left-handed: mirrored, its x is to the right
    parallel = ('Scale -1 1 1\nLookAt 7 -3 20  1 2 -4  0.2 1 0.1\n'
                'Camera "orthographic" "float screenwindow" [ -30.5 30.5 -20 20 ]')
    scene(parallel, "rays_of_the_orthographic_camera", dict(pose, s="1"), ["camera=orthographic"])


def spheres_of(path):
    """(x, y, z, radius, reflectance) of the spheres of a scene's file: their Translate, and the last material."""
    tokens = re.findall(r'"[^"]*"|\[|\]|[-\w.]+', re.sub(r"#.*", "", open(path, encoding="utf-8").read()))
    spheres, stack, place, color = [], [], [0.0, 0.0, 0.0], None
    for i, token in enumerate(tokens):
        if token == "AttributeBegin":
            stack.append((place, color))
        elif token == "AttributeEnd":
            place, color = stack.pop()
        elif token == "Translate":
            place = [a + float(b) for a, b in zip(place, tokens[i + 1:i + 4])]
        elif token == "Material":
            color = GOLD if tokens[i + 1] == '"conductor"' else None
        elif token == '"rgb reflectance"':
            color = " ".join(tokens[i + 2:i + 5])
        elif token == '"sphere"':
            spheres.append((*place, float(tokens[i + 2]), color))
    return spheres


def write_scene(path, camera, world, floor, same_color):
    """The camera of a lecture's scene, and the spheres of one of its worlds, with a floor of squares."""
    size = camera["size"].split("x")
    with open(path, "w", encoding="utf-8") as file:
        file.write('Camera "pinhole" "point3 eye" [ %s ] "point3 lookat" [ %s ] "float d" %s\n' % (
            camera["eye"].replace(",", " "), camera["lookat"].replace(",", " "), camera["d"]))
        file.write('Film "rgb" "integer xresolution" %s "integer yresolution" %s\nPixelFilter "box"\nWorldBegin\n' % tuple(size))
        for x, y, z, radius, color in spheres_of(os.path.join(SCENES, "objects", world + ".pbrt")):
            file.write('Material "diffuse" "rgb reflectance" [ %s ]\nAttributeBegin Translate %g %g %g\n'
                       'Shape "sphere" "float radius" %g AttributeEnd\n' % (same_color or color, x, y, z, radius))
        if floor:
            y, side = floor
            half = 200 * side
            dark = " ".join("%g" % (0.8 * c) for c in (0.58, 0.56, 0.52))
            file.write('Texture "squares" "spectrum" "checkerboard" "float uscale" 400 "float vscale" 400 '
                       '"rgb tex1" [ %s ] "rgb tex2" [ 0.58 0.56 0.52 ]\nMaterial "diffuse" "texture reflectance" "squares"\n'
                       % dark)
            file.write('Shape "trianglemesh" "point3 P" [ %g %g %g  %g %g %g  %g %g %g  %g %g %g ] '
                       '"point2 uv" [ 0 0  1 0  1 1  0 1 ] "integer indices" [ 0 1 2 0 2 3 ]\n'
                       % (-half, y, half, half, y, half, half, y, -half, -half, y, -half))


def read_pfm(path):
    data = open(path, "rb").read()
    kind, width, height, scale, data = re.match(rb"(P[Ff])\s(\d+)\s(\d+)\s(\S+)\n(.*)", data, re.S).groups()
    assert kind == b"PF" and float(scale) < 0
    width, height = int(width), int(height)
    values = struct.unpack("<%df" % (3 * width * height), data)
    return [values[3 * width * row:3 * width * (row + 1)] for row in range(height - 1, -1, -1)]  # rows from the top


def read_ppm(data):
    width, height, pixels = re.match(rb"P6 (\d+) (\d+) 255\n(.*)", data, re.S).groups()
    width, height = int(width), int(height)
    return [pixels[3 * width * row:3 * width * (row + 1)] for row in range(height)]


def images(work):
    # d of example_1: on the slide 500, with which samples lie exactly on edges of the floor's squares
    cases = (("pinhole", "build", (-100, 100), None, {"size": "200x150", "d": "200", "s": "1"}), ("example_1", "still", (-10, 10), None, {"d": "499.3"}),
             ("distortion_e2_d85", "spheres", None, "0.62 0.4 0.12", {}))
    for scene, world, floor, color, change in cases:
        camera = camera_of(open(os.path.join(SCENES, scene + ".pbrt"), encoding="utf-8").read())
        camera.update(change)
        path, image = os.path.join(work, "scene.pbrt"), os.path.join(work, "image.pfm")
        write_scene(path, camera, world, floor, color)
        output(VELO, "render", path, "--tracer", "raycast", "--color", "rgb", "--sampler", "regular", "--spp", 16, "--quiet", "-o", image)
        theirs, own = read_pfm(image), read_ppm(output(PROGRAM, "n=4", "world=" + world, *arguments(camera)))
        if len(own) != len(theirs) or len(own[0]) != len(theirs[0]):
            report("image_of_" + world, "sizes differ")
            continue
        horizon = range(196, 204) if world == "still" else ()  # velo's floor ends there, the program's does not
        wrong, worst, covered = 0, 0.0, 0
        for row, (a, b) in enumerate(zip(own, theirs)):
            for x, y in zip(a, b) if row not in horizon else ():
                difference = abs(x - 255 * min(max(y, 0.0), 1.0) ** (1 / 2.2))
                covered += x > 0
                wrong += difference > 0.51
                worst = max(worst, difference)
        # one of 16 samples may fall on either side of an edge
        good = covered > 20000 and wrong < 2e-3 * covered and worst < 10
        report("image_of_" + world, None if good else "%d of %d values differ, by %g at most" % (wrong, covered, worst))


def the_program():
    with open(os.path.join(ROOT, "examples/lecture.c"), encoding="utf-8") as file:
        lines = file.read().split("\n")[:-1]
    report("at_most_250_lines", None if len(lines) <= 250 else "%d lines" % len(lines))
    includes = sorted(line.split()[1] for line in lines if line.startswith("#include"))
    report("only_the_c_library", None if includes == ["<math.h>", "<stdio.h>", "<stdlib.h>", "<string.h>"] else str(includes))
    for word in ("d", "eye=1,2", "camera=none", "world=none", "n=0", "size=0x4", "size=99999x99999", "lookat=300,400,500"):
        code, out, err = run(PROGRAM, word)
        report("refused_" + word, None if code == 2 and not out and err.count("\n") == 1 else "exit code %d: %s" % (code, err))
    code, _, err = run(PROGRAM, "eye=0,0,5", "lookat=0,0,0", "up=0,0,1")
    report("refused_up_along_the_view_direction", None if code == 2 and err.count("\n") == 1 else "exit code %d: %s" % (code, err))
    code, _, err = run("sh", "-c", '"$0" >/dev/full', PROGRAM)
    report("full_disk", None if code == 5 else "exit code %d: %s" % (code, err))


def main():
    if not os.access(PROGRAM, os.X_OK):
        print("skip program: no %s" % PROGRAM)
        return 77
    the_program()
    with tempfile.TemporaryDirectory() as work:
        rays_of_the_scenes()
        rays_of_more_cameras(work)
        images(work)
    return 1 if failures else 0


if __name__ == "__main__":
    sys.exit(main())
