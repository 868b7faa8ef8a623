#!/usr/bin/python3
"""Datasets: the files are read back by readers written here from the formats' specifications. The models' points are
projected by OpenCV with the written K and poses and rasterised at pixel centres: masks and depths must agree."""
import glob
import hashlib
import json
import os
import struct
import subprocess
import sys
import zlib

import cases
from cases import case, raises, work

numpy = cases.need("numpy")
import velo
from velo import dataset
from velo.dataset.coco import outlines, run_lengths

try:
    import cv2
except ImportError:
    cv2 = None

WIDTH, HEIGHT = 320, 240


def ring(radius, tube, n, m):
    """A torus about y: points and triangles."""
    points, faces = [], []
    for i in range(n):
        for j in range(m):
            a, b = 2 * numpy.pi * i / n, 2 * numpy.pi * j / m
            r = radius + tube * numpy.cos(b)
            points.append((r * numpy.cos(a), tube * numpy.sin(b), r * numpy.sin(a)))
            p, q = i * m + j, i * m + (j + 1) % m
            s, t = (i + 1) % n * m + j, (i + 1) % n * m + (j + 1) % m
            faces += [(p, q, t), (p, t, s)]
    return numpy.array(points), numpy.array(faces)


def block(x, y, z):
    points = numpy.array([(a * x, b * y, c * z) for a in (-1, 1) for b in (-1, 1) for c in (-1, 1)], dtype=float)
    faces = numpy.array([(0, 1, 3), (0, 3, 2), (4, 6, 7), (4, 7, 5), (0, 4, 5), (0, 5, 1), (2, 3, 7), (2, 7, 6), (0, 2, 6),
                         (0, 6, 4), (1, 5, 7), (1, 7, 3)])
    return points, faces


MESHES = {"ring": ring(110.0, 45.0, 48, 24), "block": block(0.1, 0.06, 0.08)}
SCALES = {"ring": 0.001, "block": 1.0}


def write_obj(path, mesh):
    with open(path, "w") as file:
        for point in mesh[0]:
            file.write("v %.9g %.9g %.9g\n" % tuple(point))
        for face in mesh[1]:
            file.write("f %d %d %d\n" % tuple(face + 1))


for name, mesh in MESHES.items():
    write_obj(work(name + ".obj"), mesh)


def recipe(**changes):
    settings = dict(
        seed=3, frames=3, resolution=(WIDTH, HEIGHT), spp=2, folder=cases.WORK,
        models=[dataset.Model("ring.obj", scale=SCALES["ring"], count=(1, 2),
                              keypoints={"top": (110, 45, 0), "inside": (110, 0, 0), "under": (110, -45, 0)}),
                dataset.Model("block.obj", count=2)],
        placing=dataset.OnSurface(size=(0.7, 0.7)), ground=dataset.Ground(),
        lights=dataset.Lights(), environment=dataset.Environment(), distractors=dataset.Distractors(count=(1, 3)),
        cameras=[dataset.Around(distance=(0.7, 0.9), elevation=(35, 70), fov=50)])
    settings.update(changes)
    return dataset.Recipe(**settings)


OUT = work("all")
dataset.generate(recipe(), OUT, writers=["bop", "coco", "nerfstudio", "exr"])


# ---- readers --------------------------------------------------------------------------------------------------------

def read_png(path):
    """PNG with filter 0 only, as the writer makes them; checks the chunks' sums."""
    data = open(path, "rb").read()
    assert data[:8] == b"\x89PNG\r\n\x1a\n", path
    position, body = 8, b""
    while position < len(data):
        size, kind = struct.unpack(">I4s", data[position:position + 8])
        chunk = data[position + 8:position + 8 + size]
        assert struct.unpack(">I", data[position + 8 + size:position + 12 + size])[0] == zlib.crc32(kind + chunk)
        if kind == b"IHDR":
            width, height, depth, color = struct.unpack(">IIBB", chunk[:10])
        body += chunk if kind == b"IDAT" else b""
        position += 12 + size
    channels = {0: 1, 2: 3}[color]
    rows = numpy.frombuffer(zlib.decompress(body), dtype="uint8").reshape(height, -1)
    assert not rows[:, 0].any()
    pixels = numpy.ascontiguousarray(rows[:, 1:]).view(">u2" if depth == 16 else "u1")
    return pixels.reshape((height, width, channels) if channels > 1 else (height, width))


def rasterise(pixels, z, faces):
    """Depth along the view axis at pixel centres of triangles given by their corners in pixels (first centre at (0, 0)); inf:
    nothing. In doubles, with perspective: 1/z is linear in the image."""
    depth = numpy.full((HEIGHT, WIDTH), numpy.inf)
    for face in faces:
        (ax, ay), (bx, by), (cx, cy) = pixels[face]
        area = (bx - ax) * (cy - ay) - (by - ay) * (cx - ax)
        if abs(area) < 1e-12:
            continue
        x0, x1 = int(max(numpy.ceil(min(ax, bx, cx)), 0)), int(min(numpy.floor(max(ax, bx, cx)), WIDTH - 1))
        y0, y1 = int(max(numpy.ceil(min(ay, by, cy)), 0)), int(min(numpy.floor(max(ay, by, cy)), HEIGHT - 1))
        if x0 > x1 or y0 > y1:
            continue
        x, y = numpy.meshgrid(numpy.arange(x0, x1 + 1.0), numpy.arange(y0, y1 + 1.0))
        u = ((bx - x) * (cy - y) - (by - y) * (cx - x)) / area
        v = ((cx - x) * (ay - y) - (cy - y) * (ax - x)) / area
        w = 1 - u - v
        inside = (u >= 0) & (v >= 0) & (w >= 0)
        inverse = u / z[face[0]] + v / z[face[1]] + w / z[face[2]]
        with numpy.errstate(divide="ignore"):
            here = numpy.where(inside & (inverse > 0), 1 / inverse, numpy.inf)
        part = depth[y0:y1 + 1, x0:x1 + 1]
        numpy.minimum(part, here, out=part)
    return depth


def bop_frames():
    folder = os.path.join(OUT, "bop/train_pbr/000000")
    tables = [json.load(open(os.path.join(folder, name + ".json"))) for name in ("scene_camera", "scene_gt", "scene_gt_info")]
    models = json.load(open(os.path.join(OUT, "bop/models/models_info.json")))
    for key in tables[1]:
        yield folder, int(key), models, tables[0][key], tables[1][key], tables[2][key]


# ---- cases ----------------------------------------------------------------------------------------------------------

@case
def bop_masks_and_depths_agree_with_opencv():
    if cv2 is None:
        raise cases.Skip("needs cv2")
    masks = 0
    for folder, number, models, camera, truths, infos in bop_frames():
        k = numpy.array(camera["cam_K"]).reshape(3, 3)
        depth = read_png(os.path.join(folder, "depth/%06d.png" % number)).astype(float) * camera["depth_scale"]
        layers = []
        for i, (truth, info) in enumerate(zip(truths, infos)):
            name = models[str(truth["obj_id"])]["name"]
            points = MESHES[name][0] * SCALES[name] * 1000
            rotation = numpy.array(truth["cam_R_m2c"]).reshape(3, 3)
            assert numpy.allclose(rotation @ rotation.T, numpy.eye(3), atol=1e-12) and numpy.linalg.det(rotation) > 0
            pixels = cv2.projectPoints(points, cv2.Rodrigues(rotation)[0], numpy.array(truth["cam_t_m2c"]), k, None)[0][:, 0]
            z = points @ rotation[2] + truth["cam_t_m2c"][2]
            layers.append(rasterise(pixels, z, MESHES[name][1]))
            mask = read_png(os.path.join(folder, "mask/%06d_%06d.png" % (number, i))) > 0
            wanted = numpy.isfinite(layers[-1])
            iou = (mask & wanted).sum() / max(1, (mask | wanted).sum())
            assert info["px_count_all"] == mask.sum()
            if wanted.sum() >= 2000:
                masks += 1
                assert iou >= 0.99, (number, i, iou)
        for i, info in enumerate(infos):
            visible = read_png(os.path.join(folder, "mask_visib/%06d_%06d.png" % (number, i))) > 0
            mask = read_png(os.path.join(folder, "mask/%06d_%06d.png" % (number, i))) > 0
            assert not (visible & ~mask).any() and visible.sum() == info["px_count_visib"]
            assert abs(info["visib_fract"] - visible.sum() / max(1, mask.sum())) < 1e-12
            if visible.any():
                x, y, w, h = info["bbox_visib"]
                assert visible[y:y + h, x:x + w].sum() == visible.sum()
                assert visible[:, x].any() and visible[:, x + w - 1].any() and visible[y].any() and visible[y + h - 1].any()
            both = visible & numpy.isfinite(layers[i])
            error = numpy.abs(depth[both] - layers[i][both])
            if not both.any():
                continue
            # Half a step where both see the same surface; edges of the rings' facets differ by rounding.
            assert numpy.median(error) <= camera["depth_scale"] / 2 and (error < camera["depth_scale"] * 0.51).mean() > 0.99
            # No other object is nearer where this one is visible.
            others = [layer for j, layer in enumerate(layers) if j != i]
            for other in others:
                assert (other[both] < layers[i][both] - 0.5).mean() < 0.01
    assert masks >= 5, masks


@case
def bop_models_are_in_millimetres():
    info = json.load(open(os.path.join(OUT, "bop/models/models_info.json")))
    assert [info[str(i)]["name"] for i in (1, 2)] == ["ring", "block"]
    for number in (1, 2):
        name = info[str(number)]["name"]
        wanted = MESHES[name][0] * SCALES[name] * 1000
        data = open(os.path.join(OUT, "bop/models/obj_%06d.ply" % number), "rb").read()
        head, body = data.split(b"end_header\n", 1)
        vertices, faces = (int(line.split()[2]) for line in head.decode().split("\n") if line.startswith("element"))
        points = numpy.frombuffer(body, "<f4", vertices * 3).reshape(-1, 3)
        rows = numpy.frombuffer(body[12 * vertices:], [("count", "u1"), ("corners", "<i4", (3,))])
        assert len(rows) == faces == len(MESHES[name][1]) and (rows["count"] == 3).all()
        mine = numpy.sort(points[rows["corners"]].reshape(-1, 9), 0)
        assert numpy.allclose(mine, numpy.sort(wanted[MESHES[name][1]].reshape(-1, 9), 0), atol=1e-3)
        largest = max(numpy.linalg.norm(wanted - point, axis=1).max() for point in wanted)
        assert abs(info[str(number)]["diameter"] - largest) < 1e-3, (info, largest)
        assert abs(info[str(number)]["min_x"] - wanted[:, 0].min()) < 1e-3
        assert abs(info[str(number)]["size_z"] - numpy.ptp(wanted[:, 2])) < 1e-3
    from velo.dataset.models import diameter
    draw = numpy.random.default_rng(4)
    for count in (2, 50, 3000):
        points = draw.normal(size=(count, 3))
        largest = max(numpy.linalg.norm(points - point, axis=1).max() for point in points)
        assert abs(diameter(points) - largest) < 1e-12 * count
    ball = draw.normal(size=(20000, 3))
    assert 1.999 < diameter(ball / numpy.linalg.norm(ball, axis=1)[:, None]) <= 2.0000001


@case
def exr_depths_are_exact():
    """The EXR's depth against the BOP poses of the same frame, at about 1 m: 0.02 mm in the median."""
    if cv2 is None:
        raise cases.Skip("needs cv2")
    errors = []
    for path in glob.glob(os.path.join(OUT, "exr/*.json")):
        about = json.load(open(path))
        z = velo.read_image(path[:-4] + "exr", ["Z"])["Z"].astype(float)
        ids = velo.read_image(path[:-4] + "exr", ["id.instance"])["id.instance"]
        k = numpy.array(about["K"]) - [[0, 0, 0.5], [0, 0, 0.5], [0, 0, 0]]
        camera_from_world = numpy.linalg.inv(numpy.array(about["world_from_camera"]))
        for item in about["instances"]:
            if not item["id_instance"]:
                continue
            pose = camera_from_world @ numpy.array(item["world_from_model"])
            points = MESHES[item["class"]][0] * item["scale"]
            pixels = cv2.projectPoints(points, cv2.Rodrigues(pose[:3, :3])[0], pose[:3, 3], k, None)[0][:, 0]
            layer = rasterise(pixels, points @ pose[2, :3] + pose[2, 3], MESHES[item["class"]][1])
            both = (ids == item["id_instance"]) & numpy.isfinite(layer)
            assert both.sum() == 0 or item["pixels"] == (ids == item["id_instance"]).sum()
            errors.append(numpy.abs(z[both] - layer[both]))
    errors = numpy.concatenate(errors) * 1000
    print("  %d pixels: median error %.5f mm" % (len(errors), numpy.median(errors)))
    assert len(errors) > 5000 and numpy.median(errors) <= 0.02


def tight_box(mask):
    """x, y, width and height of the smallest box of a mask, as COCO has them."""
    rows, columns = numpy.nonzero(mask)
    return [columns.min(), rows.min(), columns.max() - columns.min() + 1, rows.max() - rows.min() + 1]


@case
def coco_masks_are_those_of_bop():
    table = json.load(open(os.path.join(OUT, "coco/annotations.json")))
    assert [category["name"] for category in table["categories"]] == ["ring", "block"]
    assert len({annotation["id"] for annotation in table["annotations"]}) == len(table["annotations"]) >= 6
    images = {image["id"]: image for image in table["images"]}
    visible, whole = {}, {}
    for folder, number, _, _, truths, _ in bop_frames():
        whole[number] = [read_png(os.path.join(folder, "mask/%06d_%06d.png" % (number, i))) > 0 for i in range(len(truths))]
        visible[number] = [(truth["obj_id"], read_png(os.path.join(folder, "mask_visib/%06d_%06d.png" % (number, i))) > 0)
                           for i, truth in enumerate(truths)]
    points = 0
    for annotation in table["annotations"]:
        image = images[annotation["image_id"]]
        assert os.path.exists(os.path.join(OUT, "coco", image["file_name"]))
        mask = decode(annotation["segmentation"], image["height"], image["width"])
        frame = int(os.path.basename(image["file_name"])[:6])
        matching = [i for i, (category, seen) in enumerate(visible[frame]) if category == annotation["category_id"] and
                    numpy.array_equal(seen, mask)]
        assert len(matching) == 1 and annotation["area"] == mask.sum()
        amodal = whole[frame][matching[0]]
        assert numpy.array_equal(decode(annotation["a_segm"], image["height"], image["width"]), amodal)
        assert annotation["a_area"] == amodal.sum() and annotation["visible_fraction"] == mask.sum() / amodal.sum()
        assert annotation["a_bbox"] == tight_box(amodal) and annotation["bbox"] == tight_box(mask)
        if annotation["category_id"] == 1:
            flags = annotation["keypoints"][2::3]
            assert len(flags) == 3 and flags[1] != 2 and annotation["num_keypoints"] == sum(flag > 0 for flag in flags)
            points += flags[0] == 2
    assert points >= 1


def decode(segmentation, height, width):
    if isinstance(segmentation, dict):
        assert segmentation["size"] == [height, width] and sum(segmentation["counts"]) == height * width
        flat = numpy.concatenate([numpy.full(count, i % 2, dtype=bool) for i, count in enumerate(segmentation["counts"])])
        return flat.reshape(width, height).T
    # Even-odd rule at pixel centres.
    y, x = numpy.mgrid[0:height, 0:width] + 0.5
    mask = numpy.zeros((height, width), dtype=bool)
    for polygon in segmentation:
        corners = numpy.array(polygon).reshape(-1, 2)
        inside = numpy.zeros((height, width), dtype=bool)
        for (ax, ay), (bx, by) in zip(corners, numpy.roll(corners, -1, axis=0)):
            if ay != by:
                inside ^= ((ay > y) != (by > y)) & (x < (bx - ax) * (y - ay) / (by - ay) + ax)
        mask |= inside
    return mask


@case
def run_lengths_and_outlines_hold_any_mask():
    generator = numpy.random.default_rng(1)
    holes_seen = 0
    for i in range(60):
        mask = generator.random((9, 11)) < (i % 10) / 10
        assert numpy.array_equal(decode(run_lengths(mask), 9, 11), mask)
        polygons, holes = outlines(mask)
        holes_seen += holes
        if not holes:
            assert numpy.array_equal(decode(polygons, 9, 11), mask)
    assert 0 < holes_seen < 60


@case
def nerfstudio_frames_are_read_by_velo():
    path = os.path.join(OUT, "nerfstudio/transforms.json")
    frames = velo.read_trajectory(path)
    assert len(frames) == 3
    stage = dataset.Stage(recipe())
    for number, frame in enumerate(frames):
        camera = stage.plan(number).views[0].camera
        assert numpy.allclose(frame.camera.world_from_camera, camera.world_from_camera, atol=1e-12)
        assert numpy.allclose(frame.camera.K, camera.K) and frame.camera.resolution == camera.resolution
    table = json.load(open(path))
    depth = read_png(os.path.join(OUT, "nerfstudio", table["frames"][0]["depth_file_path"]))
    assert depth.dtype.itemsize == 2 and 300 < numpy.median(depth) < 2000


LENSES = {
    "plain": {"fov": 0.9}, "brown": {"fov": 0.9, "distortion": "opencv", "distortion_coefficients": [-0.15, 0.03, 1e-3, -2e-3, 0.01]},
    "fisheye": {"projection": "equidistant", "fov": 2.0, "distortion": "radial", "distortion_coefficients": [0.02, -0.01, 0.003, 0.001]},
    "double_sphere": {"projection": "double_sphere", "fx": 30.0, "fy": 30.0, "shape": [-0.2, 0.6]},
    "moving": {"fov": 0.9, "world_from_camera_close": [[1, 0, 0, 0.1], [0, 1, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]]}}
HELD = {"bop": ["plain"], "nerfstudio": ["plain", "brown", "fisheye"], "exr": list(LENSES)}


def small(lens, distance=2.0, **changes):
    pose = [[1, 0, 0, 0], [0, 1, 0, 0], [0, 0, 1, distance], [0, 0, 0, 1]]
    keywords = dict(LENSES[lens], world_from_camera=[[1, 0, 0, 0], [0, 1, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]])
    return dataset.Recipe(frames=1, resolution=(64, 48), spp=1, cameras=[dataset.Fixed(keywords)], models=[
        dataset.Model(name="block", positions=MESHES["block"][0], indices=MESHES["block"][1], scale=distance / 2)], placing=dataset.Poses([[("block", pose)]]), **changes)


@case
def a_writer_reads_back_as_the_same_camera_or_refuses_it():
    points = numpy.random.default_rng(5).uniform([-0.5, -0.4, 1.5], [0.5, 0.4, 3.0], (200, 3))
    for writer, held in HELD.items():
        for lens in LENSES:
            folder = work(f"lens_{writer}_{lens}")
            if lens not in held:
                with raises(velo.UnsupportedError, writer, "exr"):
                    dataset.generate(small(lens), folder, writers=[writer])
                assert not os.path.exists(folder), "a refused camera has written files"
                continue
            dataset.generate(small(lens), folder, writers=[writer])
            path = {"bop": "bop/train_pbr/000000/scene_camera.json", "nerfstudio": "nerfstudio/transforms.json",
                    "exr": "exr/cameras/000000_camera.json"}[writer]
            unit = 1000 if writer == "bop" else 1
            wanted = dataset.Stage(small(lens)).plan(0).views[0].camera.project(points)
            found = velo.read_camera(os.path.join(folder, path), width=64, height=48).project(points * unit)
            assert wanted.valid.sum() > 100 and numpy.array_equal(wanted.valid, found.valid), (writer, lens)
            assert numpy.abs((wanted.pixels - found.pixels)[wanted.valid]).max() < 1e-9, (writer, lens)


@case
def coco_holds_whole_masks_and_visible_fractions():
    def written(places, **changes):
        frame = small("plain", **changes)
        frame.placing = dataset.Poses([[("block", [[1, 0, 0, x], [0, 1, 0, 0], [0, 0, 1, z], [0, 0, 0, 1]]) for x, z in places]])
        folder = work("whole%d%d" % (len(places), len(changes)))
        dataset.generate(frame, folder, writers=["coco"])
        return json.load(open(os.path.join(folder, "coco/annotations.json")))["annotations"]

    def mask(annotation, name):
        return decode(annotation[name], 48, 64)

    behind, before = written([(0, 2), (0.1, 1.5)])
    alone = written([(0, 2)])[0]
    assert alone["visible_fraction"] == before["visible_fraction"] == 1 and alone["a_segm"] == alone["segmentation"]
    assert numpy.array_equal(mask(behind, "a_segm"), mask(alone, "segmentation"))
    assert numpy.array_equal(mask(behind, "segmentation"), mask(alone, "segmentation") & ~mask(before, "segmentation"))
    assert behind["a_bbox"] == alone["bbox"] and behind["a_area"] == alone["area"]
    assert 0.2 < behind["visible_fraction"] == behind["area"] / alone["area"] < 0.8
    for annotation in written([(0, 2), (0.1, 1.5)], occluded=False):
        assert not {"a_segm", "a_bbox", "a_area", "visible_fraction"} & set(annotation)


@case
def depths_beyond_a_png_are_an_error():
    for writer, distance, remedy in (("bop", 7.0, "depth_scale"), ("nerfstudio", 70.0, "exr")):
        with raises(velo.UnsupportedError, writer, "16 bits", remedy):
            dataset.generate(small("plain", distance), work("far"), writers=[writer])
    dataset.generate(small("plain", 7.0, depth_scale=0.5), work("far_enough"), writers=["bop"])
    folder = os.path.join(work("far_enough"), "bop/train_pbr/000000")
    scale = json.load(open(os.path.join(folder, "scene_camera.json")))["0"]["depth_scale"]
    depth = read_png(os.path.join(folder, "depth/000000.png"))
    assert scale == 0.5 and abs(depth[24, 32] * scale - 6720) < 0.5


def digests(folder):
    result = {}
    for path in sorted(glob.glob(os.path.join(folder, "**"), recursive=True)):
        if os.path.isfile(path):
            result[os.path.relpath(path, folder)] = hashlib.sha256(open(path, "rb").read()).hexdigest()
    return result


@case
def a_frame_made_alone_has_the_same_bits():
    whole = {name: digest for name, digest in digests(OUT).items() if os.path.basename(name).startswith("000002")}
    alone = work("alone")
    dataset.generate(recipe(frames=5000), alone, writers=["bop", "coco", "nerfstudio", "exr"], frames=[2, 4711])
    again = {name: digest for name, digest in digests(alone).items() if os.path.basename(name).startswith("000002")}
    different = [name for name in whole if whole[name] != again.get(name)]
    assert len(whole) > 10 and not different and len(whole) == len(again), different
    other = velo.Context(threads=1)
    third = work("third")
    dataset.generate(recipe(frames=5000), third, writers=["bop", "exr"], frames=[4711], context=other)
    mine = {name: digest for name, digest in digests(alone).items() if os.path.basename(name).startswith("004711") and not name.startswith(("coco", "nerf"))}
    theirs = {name: digest for name, digest in digests(third).items() if os.path.basename(name).startswith("004711")}
    assert mine == theirs and mine


YAML = """
seed: 5
frames: 4
resolution: [64, 48]
spp: 1
models:
  - {path: ring.obj, scale: 0.001}
  - block.obj
placing: {kind: in_volume, low: [-0.3, 0.1, -0.3], high: [0.3, 0.4, 0.3]}
cameras:
  - kind: rig
    base: {kind: around, distance: 1.2, fov: 45}
    parts:
      - {name: left, pose: [[1, 0, 0, -0.03], [0, 1, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]]}
      - {name: right, pose: [[1, 0, 0, 0.03], [0, 1, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]]}
"""


def run(*arguments):
    return subprocess.run([sys.executable, "-m", "velo.dataset", *arguments], stdout=subprocess.PIPE, stderr=subprocess.PIPE,
                          text=True)


@case
def yaml_recipes_and_shards():
    try:
        import yaml
    except ImportError:
        raise cases.Skip("needs yaml")
    path = work("recipe.yaml")
    with open(path, "w") as file:
        file.write(YAML)
    one, parts = work("one"), work("parts")
    assert run(path, "-o", one, "--writers", "bop,coco").returncode == 0
    for part in ("2/2", "1/2"):
        done = run(path, "-o", parts, "--writers", "bop,coco", "--shard", part, "--threads", "1")
        assert done.returncode == 0, done.stderr
    assert digests(one) == digests(parts)
    assert os.path.exists(os.path.join(one, "bop/train_pbr/000001/scene_gt.json"))  # the right camera
    left, right = (json.load(open(os.path.join(one, "bop/train_pbr/00000%d/scene_camera.json" % i)))["0"] for i in (0, 1))
    assert left["cam_R_w2c"] == right["cam_R_w2c"]
    assert abs(left["cam_t_w2c"][0] - right["cam_t_w2c"][0] - 60) < 1e-9


@case
def a_sensor_is_exposed_to_each_frame():
    simple = recipe(frames=2, resolution=(32, 24), spp=1, render={"max_depth": 1},
                    sensor=dataset.Sensor("generic_rggb", numbers={"pattern": "GRBG", "bits": 12, "black_level": 64},
                                          exposure={"radiance": 0.02, "f_number": 4}, buckets=8))
    folders = work("sensor"), work("sensor_alone")
    dataset.generate(simple, folders[0], writers=["raw"])
    dataset.generate(simple, folders[1], writers=["raw"], frames=[1])
    names = [os.path.join(folder, "raw", "000001_camera.png") for folder in folders]
    first, alone = (open(name, "rb").read() for name in names)
    assert first == alone
    numbers = read_png(names[0])
    assert numbers.dtype == numpy.dtype(">u2") and numbers.shape == (24, 32)
    assert 70 < numbers.mean() < 4095 and numbers.max() <= 4095
    about = json.load(open(names[0][:-4] + ".json"))
    assert about["numbers"]["pattern"] == "GR/BG" and about["numbers"]["bits"] == 12 and about["exposure"]["f_number"] == 4
    other = read_png(os.path.join(folders[0], "raw", "000000_camera.png"))
    assert (other != numbers).any()
    developed = velo.read_image(names[0][:-4] + "_developed.png")
    assert developed.resolution == (32, 24) and developed.channels == ("R", "G", "B") and numpy.asarray(developed).std() > 0
    assert not os.path.exists(names[0][:-4] + ".dng")
    try:
        velo.Raw(numbers.astype("uint16"), pattern="GR/BG").write(os.path.join(work("tiff"), "a.dng"))
    except velo.Error:
        return  # built without libtiff
    simple.sensor.dng = True
    dataset.generate(simple, work("dng"), writers=["raw"], frames=[1])
    raw = velo.read_raw(os.path.join(work("dng"), "raw", "000001_camera.dng"))
    assert (raw.numbers == numbers).all() and raw.pattern == "GR/BG"
    again = os.path.join(work("again"), "again.png")
    raw.develop().write(again)
    assert abs(read_png(again).astype(int) - read_png(names[0][:-4] + "_developed.png").astype(int)).max() <= 1
    with raises(velo.UsageError, "the writer raw needs recipe.sensor"):
        dataset.generate(recipe(), work("none"), writers=["raw"])
    for settings, text in (({"name": "generic_rgb"}, "generic_rggb"), ({"numbers": {"full_well": 0}}, "full_well"), ({"exposure": {"iso": -1}}, "iso"),
                           ({"exposure": {"seed": 1}}, "recipe.sensor.exposure.seed"), ({"buckets": 1}, "recipe.sensor.buckets")):
        with raises(velo.UsageError, text):
            dataset.Stage(recipe(sensor=dataset.Sensor(**settings)))


@case
def writers_know_the_names_of_their_files():
    recipe = dataset.Recipe(seed=3, frames=3, resolution=(32, 24), spp=1, models=[
        dataset.Model(name=name, positions=MESHES[name][0], indices=MESHES[name][1], scale=SCALES[name], count=(0, 2)) for name in MESHES],
        cameras=[dataset.Around(distance=(1, 2), name="a"), dataset.Around(distance=(1, 2), name="b")])
    folder = work("names")
    recipe.sensor = dataset.Sensor(buckets=4, exposure={"radiance": 0.01})
    dataset.generate(recipe, folder, writers=sorted(dataset.generate.__globals__["WRITERS"]))
    stage = dataset.Stage(recipe)
    for writer in dataset.make_writers(stage, folder, ["bop", "coco", "exr", "nerfstudio", "raw"]):
        known = set(writer.tables(2))
        for frame in range(3):
            for scene, view in enumerate("ab"):
                known.update(writer.names(frame, view, scene))
        written = {os.path.relpath(path, writer.folder) for path in glob.glob(os.path.join(writer.folder, "**", "*.*"), recursive=True)}
        assert len(written) >= 12 and written <= known, (writer.folder, written - known)


@case
def outputs_are_checked_before_anything_is_written():
    """An input that the last file of all would replace."""
    write_obj(work("tile.obj"), MESHES["block"])
    for writer, name in (("coco", "images/000002_camera0.png"), ("bop", "train_pbr/000000/mask_visib/000002_000000.png"),
                         ("exr", "000002_camera0.exr"), ("nerfstudio", "depth/000002_camera0.png")):
        folder = work("early_" + writer)
        texture = os.path.join(folder, writer, name)
        os.makedirs(os.path.dirname(texture))
        velo.Image(numpy.ones((2, 2, 3), "float32")).write(texture)
        before = open(texture, "rb").read()
        for rule in ({"ground": {"materials": {"textures": [texture]}}}, {"environment": {"kind": "studio", "files": [texture]}}):
            with open(work("early.json"), "w") as file:
                json.dump({"models": ["tile.obj"], "frames": 3, "spp": 1, "resolution": [32, 24],
                           "cameras": [{"kind": "around", "distance": [1, 2], "name": "camera0"}], **rule}, file)
            done = run(work("early.json"), "-o", folder, "--writers", writer)
            assert done.returncode == 2 and os.path.basename(name) in done.stderr and "overwritten" in done.stderr, (writer, done.stderr)
            assert "frame 0" not in done.stdout, done.stdout
            files = [path for path in glob.glob(os.path.join(folder, "**", "*.*"), recursive=True)]
            assert files == [texture] and open(texture, "rb").read() == before, files
        # frames that do not write it are made
        done = run(work("early.json"), "-o", folder, "--writers", writer, "--frames", "0")
        assert done.returncode == 0, done.stderr


@case
def no_file_that_was_read_is_overwritten():
    folder = work("inputs")
    os.makedirs(os.path.join(folder, "coco"))
    write_obj(os.path.join(folder, "block.obj"), MESHES["block"])
    path = os.path.join(folder, "coco", "annotations.json")  # what the writer coco calls its table
    with open(path, "w") as file:
        json.dump({"models": ["../block.obj"], "frames": 1, "spp": 1, "resolution": [32, 24],
                   "cameras": [{"kind": "around", "distance": [1, 2]}]}, file)
    before = open(path).read()
    done = run(path, "-o", folder, "--writers", "coco")
    assert done.returncode == 2 and "annotations.json" in done.stderr and "overwritten" in done.stderr, done.stderr
    assert open(path).read() == before
    context = velo.Context(threads=1, keep_inputs=True)
    image = velo.read_image(glob.glob(os.path.join(OUT, "**", "*.png"), recursive=True)[0], context=context)
    copy = work("copy.png")
    image.write(copy)
    context.check_output(copy)
    context.note_input(copy)
    os.link(copy, work("link.png"))
    with raises(velo.UsageError, "link.png", "copy.png", "overwritten"):
        context.check_output(work("link.png"))
    with raises(velo.UsageError, "copy.png", "overwritten"):
        image.write(copy)


@case
def errors_of_recipes_name_the_place():
    path = work("wrong.json")
    with open(path, "w") as file:
        json.dump({"models": [{"path": "ring.obj", "colour": 3}]}, file)
    done = run(path, "-o", work("nothing"))
    assert done.returncode == 2 and "recipe.models[0]" in done.stderr and '"colour"' in done.stderr, done.stderr
    with open(path, "w") as file:
        json.dump({"models": ["nowhere.obj"]}, file)
    done = run(path, "-o", work("nothing"))
    assert done.returncode == 4 and "nowhere.obj" in done.stderr, done.stderr
    assert run(work("none.yaml"), "-o", work("nothing")).returncode == 4
    with raises(velo.UsageError, 'unknown writer "pob"'):
        dataset.generate(recipe(), work("nothing"), writers=["pob"])


@case
def given_poses_and_full_surfaces():
    pose = [[1, 0, 0, 0.1], [0, 1, 0, 0.2], [0, 0, 1, -0.1], [0, 0, 0, 1]]
    stage = dataset.Stage(recipe(placing=dataset.Poses([[("ring", pose)]])))
    frame = stage.render(7)[0]
    assert frame.instances[0].world_from_model == [[float(value) for value in row] for row in pose]
    crowded = dataset.Stage(recipe(models=[dataset.Model("block.obj", count=40)], distractors=None,
                                   placing=dataset.OnSurface(size=(0.5, 0.5), tries=20)))
    from velo.dataset.geometry import Box
    plan = crowded.plan(0)
    low, high = crowded.boxes[0]
    boxes = [Box(low, high, item.pose) for item in plan.objects]
    assert 4 < len(boxes) < 40
    assert not any(a.meets(b) for i, a in enumerate(boxes) for b in boxes[:i])
    for box in boxes:
        assert abs(box.center[1] - box.extent((0, 1, 0))) < 1e-12  # they stand on the surface


if __name__ == "__main__":
    cases.main()
