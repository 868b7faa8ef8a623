#!/usr/bin/python3
"""What annotations cost: frames of a dataset against the same samples in one image. 30 glTF objects move in a room; each
frame has colours, depth, normals, masks (also of what is hidden) and boxes, and is written as OpenEXR with its JSON.
Usage: script/bench dataset [--frames N] [--rounds N] [--resolution WxH] [--spp N] [--clock] [--profile] [--json FILE]
Each round makes N frames, then renders the scene of the round's middle frame with N times the samples. Prints the share of the
processor time that is the image's; writes bench/results/dataset.json. --clock: frames per second and the share by the clock, too;
they need an idle machine. --profile: prints what Python spends its time on instead. Default: 8 rounds of 25 frames, 640x480, 16 samples."""
import argparse
import json
import math
import os
import random
import struct
import sys
import tempfile
import time

ROOT = os.environ.get("VELO_SOURCE_DIR") or os.path.dirname(os.path.dirname(os.path.abspath(__file__)))
sys.path.insert(0, os.path.join(ROOT, "build/release/python"))
import numpy
import velo
from velo import dataset
from velo.dataset.png import png

OBJECTS = 30


def ring(n, m, tube, waves):
    """A torus about y whose tube has waves: points, normals, uvs, triangles."""
    a, b = numpy.meshgrid(numpy.linspace(0, 2 * numpy.pi, n + 1), numpy.linspace(0, 2 * numpy.pi, m + 1), indexing="ij")
    t = tube * (1 + 0.15 * numpy.sin(waves * a))
    r = 0.07 + t * numpy.cos(b)
    points = numpy.stack([r * numpy.cos(a), t * numpy.sin(b), r * numpy.sin(a)], 2).reshape(-1, 3)
    normals = numpy.stack([numpy.cos(b) * numpy.cos(a), numpy.sin(b), numpy.cos(b) * numpy.sin(a)], 2).reshape(-1, 3)
    uvs = numpy.stack([a * 4, b], 2).reshape(-1, 2) / (2 * numpy.pi)
    i = (numpy.arange(n)[:, None] * (m + 1) + numpy.arange(m)).ravel()
    faces = numpy.concatenate([numpy.stack([i, i + 1, i + m + 2], 1), numpy.stack([i, i + m + 2, i + m + 1], 1)])
    return points.astype("<f4"), normals.astype("<f4"), uvs.astype("<f4"), faces.astype("<u4")


def write_glb(path, number):
    """An object of about 10,000 triangles with a texture of 256 x 256."""
    draw = numpy.random.default_rng(number)
    points, normals, uvs, faces = ring(100, 50, 0.015 + 0.02 * draw.random(), int(draw.integers(3, 9)))
    texels = draw.integers(40, 230, (256, 256, 3), dtype=numpy.uint8)
    parts = [points.tobytes(), normals.tobytes(), uvs.tobytes(), faces.tobytes(), png(texels)]
    views, binary = [], b""
    for part in parts:
        views.append({"buffer": 0, "byteOffset": len(binary), "byteLength": len(part)})
        binary += part + b"\0" * (-len(part) % 4)
    n = len(points)
    document = {
        "asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0, "NORMAL": 1, "TEXCOORD_0": 2}, "indices": 3, "material": 0}]}],
        "materials": [{"pbrMetallicRoughness": {"baseColorTexture": {"index": 0}, "metallicFactor": float(number % 3 == 0),
                                                "roughnessFactor": 0.2 + 0.6 * draw.random()}}],
        "textures": [{"source": 0}], "images": [{"bufferView": 4, "mimeType": "image/png"}],
        "accessors": [
            {"bufferView": 0, "componentType": 5126, "count": n, "type": "VEC3", "min": points.min(0).tolist(), "max": points.max(0).tolist()},
            {"bufferView": 1, "componentType": 5126, "count": n, "type": "VEC3"},
            {"bufferView": 2, "componentType": 5126, "count": n, "type": "VEC2"},
            {"bufferView": 3, "componentType": 5125, "count": faces.size, "type": "SCALAR"}],
        "bufferViews": views, "buffers": [{"byteLength": len(binary)}]}
    text = json.dumps(document).encode()
    text += b" " * (-len(text) % 4)
    with open(path, "wb") as file:
        file.write(struct.pack("<4sII", b"glTF", 2, 28 + len(text) + len(binary)))
        file.write(struct.pack("<I4s", len(text), b"JSON") + text + struct.pack("<I4s", len(binary), b"BIN\0") + binary)


ROOM = """WorldBegin
AttributeBegin
AreaLightSource "diffuse" "rgb L" [9 9 8]
Translate 0 2.39 0 Rotate 90 1 0 0
Shape "disk" "float radius" [0.5]
AttributeEnd
Material "diffuse" "rgb reflectance" [0.7 0.7 0.68]
Shape "bilinearmesh" "point3 P" [-2 0 -2  -2 0 2  2 0 -2  2 0 2]
Shape "bilinearmesh" "point3 P" [-2 2.4 -2  2 2.4 -2  -2 2.4 2  2 2.4 2]
Shape "bilinearmesh" "point3 P" [-2 0 -2  2 0 -2  -2 2.4 -2  2 2.4 -2]
Shape "bilinearmesh" "point3 P" [2 0 2  -2 0 2  2 2.4 2  -2 2.4 2]
Material "diffuse" "rgb reflectance" [0.7 0.3 0.25]
Shape "bilinearmesh" "point3 P" [-2 0 2  -2 0 -2  -2 2.4 2  -2 2.4 -2]
Material "diffuse" "rgb reflectance" [0.3 0.4 0.7]
Shape "bilinearmesh" "point3 P" [2 0 -2  2 0 2  2 2.4 -2  2 2.4 2]
"""


def poses(count):
    """Of each frame: the objects on circles of their own."""
    draw = random.Random(1)
    orbits = [(draw.uniform(-0.7, 0.7), draw.uniform(0.3, 1.2), draw.uniform(-0.7, 0.7), draw.uniform(0.05, 0.3),
               draw.uniform(0, 6.28), draw.uniform(-1, 1)) for _ in range(OBJECTS)]
    frames = []
    for frame in range(count):
        items = []
        for number, (x, y, z, radius, phase, speed) in enumerate(orbits):
            a = phase + 0.1 * speed * frame
            c, s, d, e = math.cos(a), math.sin(a), math.cos(2 * a), math.sin(2 * a)
            items.append((f"object{number:02d}", [[c, -s * d, s * e, x + radius * c], [s, c * d, -c * e, y], [0, e, d, z + radius * s],
                                                  [0, 0, 0, 1]]))
        frames.append(items)
    return frames


def measure(call):
    """Processor seconds, seconds."""
    cpu, clock = time.process_time(), time.perf_counter()
    call()
    return time.process_time() - cpu, time.perf_counter() - clock


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--frames", type=int, default=25)
    parser.add_argument("--rounds", type=int, default=8)
    parser.add_argument("--resolution", default="640x480")
    parser.add_argument("--spp", type=int, default=16)
    parser.add_argument("--clock", action="store_true")
    parser.add_argument("--profile", action="store_true")
    parser.add_argument("--json", default=os.path.join(ROOT, "bench/results/dataset.json"))
    options = parser.parse_args()
    size = tuple(int(part) for part in options.resolution.split("x"))
    with tempfile.TemporaryDirectory(prefix="velo-dataset-") as folder:
        for number in range(OBJECTS):
            write_glb(os.path.join(folder, f"object{number:02d}.glb"), number)
        with open(os.path.join(folder, "room.pbrt"), "w") as file:
            file.write(ROOM)
        recipe = dataset.Recipe(
            seed=1, frames=options.rounds * options.frames, resolution=size, spp=options.spp, folder=folder, scene="room.pbrt",
            models=[dataset.Model(f"object{number:02d}.glb") for number in range(OBJECTS)],
            placing=dataset.Poses(poses(options.rounds * options.frames)),
            cameras=[dataset.Fixed({"eye": (0.2, 1.5, 1.9), "lookat": (0, 0.7, 0), "fov": 1.0})])
        if options.profile:
            import cProfile
            cProfile.runctx("dataset.generate(recipe, folder, writers=['exr'], frames=range(options.frames))",
                            {"dataset": dataset}, {"recipe": recipe, "folder": folder, "options": options}, sort="tottime")
            return
        run(options, recipe, folder, size)


def run(options, recipe, folder, size):
    stage = dataset.Stage(recipe)
    rounds = []
    for number in range(options.rounds):
        frames = range(number * options.frames, (number + 1) * options.frames)
        made = measure(lambda: dataset.generate(recipe, folder, writers=["exr"], frames=frames))
        plan = stage.plan(frames[len(frames) // 2])
        with stage.scene(plan) as scene:
            scene.world()
            one = measure(lambda: scene.render(camera=plan.views[0].camera, spp=options.spp * options.frames, seed=plan.seed))
        entry = {"frames": options.frames, "dataset_cpu": made[0], "image_cpu": one[0]}
        if options.clock:
            entry.update(dataset_seconds=made[1], image_seconds=one[1])
        rounds.append(entry)
        print("round %d: %s" % (number, entry), flush=True)
    sums = {name: sum(entry[name] for entry in rounds) for name in rounds[0]}
    result = {"resolution": list(size), "spp": options.spp, "objects": OBJECTS, "threads": velo.default_context().threads,
              "frames": sums["frames"], "cpu_per_frame": sums["dataset_cpu"] / sums["frames"],
              "share_cpu": sums["image_cpu"] / sums["dataset_cpu"], "rounds": rounds}
    if options.clock:
        result["frames_per_second"] = sums["frames"] / sums["dataset_seconds"]
        result["share_clock"] = sums["image_seconds"] / sums["dataset_seconds"]
    print({name: value for name, value in result.items() if name != "rounds"})
    with open(options.json, "w") as file:
        json.dump(result, file, indent=1)
        file.write("\n")


if __name__ == "__main__":
    main()
