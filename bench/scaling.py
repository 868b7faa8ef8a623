#!/usr/bin/python3
"""How time and memory grow with threads, triangles, lights and pixels: a floor under small lit quads, rendered by velo.
Usage: script/bench scaling [threads|triangles|lights|resolution]... [--most N] [--json FILE]
--most: the largest number of triangles and lights, default 1000000. Prints user CPU and wall-clock seconds and the peak of
memory; writes them to bench/results/scaling.json. Wall-clock time needs an idle machine."""
import argparse
import json
import os
import random
import subprocess
import sys
import tempfile
import time

HEAD = """LookAt 0 6 14  0 0 0  0 1 0
Camera "perspective" "float fov" [50]
Sampler "zsobol"
Integrator "path" "integer maxdepth" [4]
Film "rgb" "integer xresolution" [256] "integer yresolution" [256]
WorldBegin
Material "diffuse" "rgb reflectance" [0.6 0.6 0.6]
Shape "bilinearmesh" "point3 P" [-9 0 -9  9 0 -9  -9 0 9  9 0 9]
"""


def quads(triangles, numbers):
    """One mesh of small quads at random places."""
    points, indices = [], []
    for k in range(max(1, triangles // 2)):
        x, y, z = (numbers.uniform(-8, 8) for _ in range(3))
        points += [x, 4 + y / 4, z, x + 0.1, 4 + y / 4, z, x + 0.1, 4 + y / 4, z + 0.1, x, 4 + y / 4, z + 0.1]
        indices += [4 * k, 4 * k + 1, 4 * k + 2, 4 * k, 4 * k + 2, 4 * k + 3]
    return 'Shape "trianglemesh" "point3 P" [%s] "integer indices" [%s]\n' % (
        " ".join("%.4g" % p for p in points), " ".join(map(str, indices)))


def write_scene(path, triangles, lights):
    numbers = random.Random(1)
    with open(path, "w") as file:
        file.write(HEAD + quads(triangles, numbers))
        file.write('AttributeBegin\nAreaLightSource "diffuse" "rgb L" [%g %g %g] "bool twosided" true\n' % ((4e3 / lights,) * 3))
        file.write(quads(2 * lights, numbers) + "AttributeEnd\n")


def render(scene, spp, threads, resolution, image):
    command = [os.environ["VELO"], "render", scene, "-o", image, "--quiet", "--spp", str(spp), "-t", str(threads),
               "--resolution", "%dx%d" % (resolution, resolution)]
    start = time.monotonic()
    process = subprocess.Popen(command)
    _, status, used = os.wait4(process.pid, 0)
    if status:
        sys.exit("scaling: failed: " + " ".join(command))
    return {"user_seconds": used.ru_utime, "wall_seconds": time.monotonic() - start, "peak_bytes": 1024 * used.ru_maxrss}


def powers(first, most):
    while first <= most:
        yield first
        first *= 10


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("what", nargs="*", choices=["threads", "triangles", "lights", "resolution"])
    parser.add_argument("--most", type=int, default=1000000)
    parser.add_argument("--json", default=os.path.join(os.environ["VELO_SOURCE_DIR"], "bench/results/scaling.json"))
    arguments = parser.parse_args()
    what = arguments.what or ["threads", "triangles", "lights", "resolution"]
    count = os.cpu_count() or 1
    threads = sorted({1, count} | {2 ** k for k in range(1, 8) if 2 ** k <= count})
    runs = {"threads": [(1000, 1, 32, n, 256) for n in threads],
            "triangles": [(n, 1, 8, 1, 256) for n in powers(1000, arguments.most)],
            "lights": [(1000, n, 8, 1, 256) for n in powers(1, arguments.most)],
            "resolution": [(1000, 1, 4, 1, n) for n in (128, 256, 512, 1024, 2048)]}
    results = []
    with tempfile.TemporaryDirectory() as folder:
        scene, image = os.path.join(folder, "scene.pbrt"), os.path.join(folder, "image.exr")
        for kind in what:
            for triangles, lights, spp, workers, resolution in runs[kind]:
                write_scene(scene, triangles, lights)
                row = {"kind": kind, "triangles": triangles, "lights": 2 * lights, "spp": spp, "threads": workers,
                       "resolution": resolution, **render(scene, spp, workers, resolution, image)}
                results.append(row)
                print("%-10s %8d triangles %8d lights %5d^2 pixels %3d threads  %8.2f s user %8.2f s wall %8.1f MB" % (
                    kind, triangles, 2 * lights, resolution, workers, row["user_seconds"], row["wall_seconds"],
                    row["peak_bytes"] / 1e6), flush=True)
    with open(arguments.json, "w") as file:
        json.dump({"bench": "scaling", "runs": results}, file, indent=1)
        file.write("\n")


if __name__ == "__main__":
    main()
