"""Data sets of BOP: what is in the files against Blender's matrices and camera, and Cycles' indices of objects."""
import json
import os
import shutil

import bpy
import mathutils
import numpy
from bpy_extras.object_utils import world_to_camera_view
from inside import FOLDER, case, channel, material, new_scene, plane, render

UNIT = 0.1  # metres of a unit of Blender
SIZE = 160, 120


def bop_scene():
    """Three cups, two of which share a mesh, and a mirrored and stretched dish behind one of them; they move in two frames."""
    scene = new_scene(world=(1, 1, 1), size=SIZE, samples=2)
    scene.unit_settings.scale_length = UNIT
    scene.frame_start, scene.frame_end = 1, 2
    scene.camera.data.shift_x, scene.camera.data.shift_y = 0.05, -0.08
    made = material("ShaderNodeBsdfDiffuse")[0]
    plane(made)
    bpy.ops.mesh.primitive_monkey_add(size=1, location=(-1.2, 0, 1), rotation=(0.3, 0.2, 0.5))
    first = bpy.context.object
    second = bpy.data.objects.new("second", first.data)
    scene.collection.objects.link(second)
    second.location, second.rotation_euler, second.scale = (1.3, 0.5, 1.2), (1.0, -2.0, 0.4), (1, 1, 1)
    bpy.ops.mesh.primitive_cube_add(size=1, location=(0.1, -1, 0.8), rotation=(0.1, 0.7, 0.2))
    third = bpy.context.object
    bpy.ops.mesh.primitive_cone_add(radius1=0.8, depth=1.5, location=(0.3, 0.6, 1), rotation=(0.4, 0.1, 0.3))
    dish = bpy.context.object
    dish.scale = (-1.2, 0.7, 1.1)
    for number, (item, kind) in enumerate(((first, "cup"), (second, "cup"), (third, "cup"), (dish, "dish")), 1):
        item["class"], item.pass_index = kind, number
        item.keyframe_insert("location", frame=1)
        item.keyframe_insert("rotation_euler", frame=1)
        item.location.z += 0.1 * number
        item.rotation_euler.x += 0.2
        item.keyframe_insert("location", frame=2)
        item.keyframe_insert("rotation_euler", frame=2)
    return scene, (first, second, third, dish)


def write(name, *words, **more):
    """Writes a data set into a folder of its own; returns the folder."""
    from velo_blender import datasets
    folder = os.path.join(FOLDER, name)
    shutil.rmtree(folder, ignore_errors=True)
    datasets.write(folder, *words, **more)
    return folder


def table(folder, name):
    with open(os.path.join(folder, "bop", name), encoding="utf-8") as file:
        return json.load(file)


def ply(folder, number):
    """(points n x 3, triangles m x 3) of a model."""
    with open(os.path.join(folder, "bop/models/obj_%06d.ply" % number), "rb") as file:
        head, body = file.read().split(b"end_header\n", 1)
    count, faces = (int(head.split(b"element %s " % name)[1].split()[0]) for name in (b"vertex", b"face"))
    points = numpy.frombuffer(body, "<f4", 3 * count).reshape(-1, 3).astype(float)
    rows = numpy.frombuffer(body[12 * count:], numpy.dtype([("count", "u1"), ("corners", "<i4", (3,))]), faces)
    assert (rows["count"] == 3).all()
    return points, rows["corners"]


def picture(folder, *names):
    """The grey values of a PNG as Blender reads it, height x width, rows from the top, 0 to 1."""
    image = bpy.data.images.load(os.path.join(folder, "bop/train_pbr/000000", *names))
    image.colorspace_settings.name = "Non-Color"
    width, height = image.size
    pixels = numpy.empty(width * height * image.channels, dtype=numpy.float32)
    image.pixels.foreach_get(pixels)
    bpy.data.images.remove(image)
    return pixels.reshape(height, width, -1)[::-1, :, 0].astype(float)


def mask(folder, kind, frame, number):
    """A mask, height x width, bool."""
    return picture(folder, kind, "%06d_%06d.png" % (frame, number)) > 0.5


def overlap(a, b):
    """Intersection over union."""
    return (a & b).sum() / max((a | b).sum(), 1)


def seen_in_cycles(scene, item):
    """The pixels where Cycles has the index of an object."""
    scene.view_layers[0].use_pass_object_index = True
    return channel(render(scene, "CYCLES"), "IndexOB.X") == item.pass_index


@case
def bop_has_blenders_poses_cameras_and_models():
    scene, items = bop_scene()
    folder = write("poses", ["bop"])
    truths, cameras = (table(folder, "train_pbr/000000/scene_%s.json" % name) for name in ("gt", "camera"))
    assert sorted(truths) == sorted(cameras) == ["1", "2"]
    for frame in (1, 2):
        scene.frame_set(frame)
        bpy.context.view_layer.update()
        k = numpy.array(cameras[str(frame)]["cam_K"]).reshape(3, 3)
        flip = mathutils.Matrix.Diagonal((1, -1, -1, 1))
        into = flip @ scene.camera.matrix_world.inverted()
        assert len(truths[str(frame)]) == len(items)
        for item, truth in zip(items, in_order(truths[str(frame)], items, into)):
            rotation = numpy.array(truth["cam_R_m2c"]).reshape(3, 3)
            assert abs(rotation @ rotation.T - numpy.eye(3)).max() < 1e-6 and numpy.linalg.det(rotation) > 0
            points, faces = ply(folder, truth["obj_id"])
            there = points @ rotation.T + truth["cam_t_m2c"]
            corners = points[faces]
            assert numpy.einsum("ni,ni->n", corners[:, 0], numpy.cross(corners[:, 1], corners[:, 2])).sum() > 0, "its triangles face inwards"
            for vertex in item.data.vertices:
                place = item.matrix_world @ vertex.co
                expected = numpy.array(into @ place) * UNIT * 1000
                nearest = there[((there - expected) ** 2).sum(axis=1).argmin()]
                assert abs(nearest - expected).max() < 1e-3, (item.name, nearest, expected)
                film = k @ nearest
                x, y, _ = world_to_camera_view(scene, scene.camera, place)
                pixel = numpy.array((x * SIZE[0] - 0.5, (1 - y) * SIZE[1] - 0.5))
                assert abs(film[:2] / film[2] - pixel).max() < 1e-2, (item.name, film, pixel)
            assert len(points) == len({tuple(vertex.co) for vertex in item.data.vertices}), "a vertex is there twice, or not"


def in_order(truths, items, into):
    """The truth of each object, by its place."""
    found = []
    for item in items:
        place = numpy.array(into @ item.matrix_world.translation) * UNIT * 1000
        mine = [truth for truth in truths if abs(numpy.array(truth["cam_t_m2c"]) - place).max() < 1e-3]
        assert len(mine) == 1, (item.name, place, truths)
        found += mine
    return found


@case
def bop_has_a_model_for_each_mesh_and_size():
    _, items = bop_scene()
    folder = write("models", ["bop"])
    truths = table(folder, "train_pbr/000000/scene_gt.json")
    info = table(folder, "models/models_info.json")
    assert sorted(entry["name"] for entry in info.values()) == ["cup", "cup", "dish"] and info["3"]["name"] == "dish"
    assert all(sorted(truth["obj_id"] for truth in truths[frame]) == sorted([1, 1, 2, 3]) or
               sorted(truth["obj_id"] for truth in truths[frame]) == [1, 2, 2, 3] for frame in truths), truths
    assert [truth["obj_id"] for truth in truths["1"]] == [truth["obj_id"] for truth in truths["2"]]
    cube = [entry for entry in info.values() if abs(entry["diameter"] - 3 ** 0.5 * 100) < 1e-3]
    assert len(cube) == 1 and all(abs(cube[0]["size_" + axis] - 100) < 1e-3 and abs(cube[0]["min_" + axis] + 50) < 1e-3 for axis in "xyz")
    for number, entry in info.items():
        points, _ = ply(folder, int(number))
        assert abs(points.min(axis=0) - [entry["min_" + axis] for axis in "xyz"]).max() < 1e-3
    items[2].scale = (2, 2, 2)  # no longer the cube of before: a data set of its own has its own model
    again = table(write("models", ["bop"], frames=[1]), "models/models_info.json")
    assert any(abs(entry["diameter"] - 3 ** 0.5 * 200) < 1e-3 for entry in again.values())


@case
def bop_masks_and_depths_are_those_of_ids():
    import velo
    scene, items = bop_scene()
    folder = write("masks", ["bop", "exr"], frames=[2])
    scene.frame_set(2)
    image = velo.read_image(os.path.join(folder, "exr/000002_camera.exr"))
    ids = numpy.asarray(image[[name for name in image.channels if name.startswith("id.instance")][0]]).astype(int)
    truths = table(folder, "train_pbr/000000/scene_gt.json")["2"]
    info = table(folder, "train_pbr/000000/scene_gt_info.json")["2"]
    into = mathutils.Matrix.Diagonal((1, -1, -1, 1)) @ scene.camera.matrix_world.inverted()
    ordered = in_order(truths, items, into)
    for item, truth in zip(items, ordered):
        number = truths.index(truth)
        seen, whole = mask(folder, "mask_visib", 2, number), mask(folder, "mask", 2, number)
        place = numpy.unique(ids[seen])
        assert len(place) == 1 and (seen == (ids == place[0])).all(), (item.name, place)
        assert not (seen & ~whole).any() and info[number]["px_count_visib"] == seen.sum() and info[number]["px_count_all"] == whole.sum()
        others = [other for other in scene.objects if other.type == "MESH" and other != item]
        assert overlap(seen, seen_in_cycles(scene, item)) > 0.93, item.name
        for other in others:
            other.hide_render = True
        assert overlap(whole, seen_in_cycles(scene, item)) > 0.93, item.name
        for other in others:
            other.hide_render = False
    assert 0 < info[truths.index(ordered[3])]["visib_fract"] < 0.95, "the dish is behind a cup"
    camera = table(folder, "train_pbr/000000/scene_camera.json")["2"]
    assert camera["depth_scale"] == 1.0 == table(folder, "camera.json")["depth_scale"]
    steps = numpy.rint(picture(folder, "depth/000002.png") * 65535)
    depth = numpy.asarray(image["Z"]).astype(float) * UNIT * 1000
    known = steps > 0
    assert known.mean() > 0.5 and abs(steps - depth)[known].max() < 0.501


@case
def bop_numbers_models_by_class_and_keeps_what_it_refuses():
    import velo
    from velo_blender import report

    def refusal(*words, **more):
        try:
            write("refused", *words, **more)
        except (velo.Error, report.Refused) as error:
            assert "\n" not in str(error)
            return str(error)
        raise AssertionError("nothing was refused")

    scene, items = bop_scene()
    items[2].keyframe_insert("scale", frame=1)
    items[2].scale = (1, 1, 1.5)
    items[2].keyframe_insert("scale", frame=2)
    assert items[2].name in refusal(["bop"])
    assert scene.frame_current == 1
    items[2].animation_data_clear()
    text = refusal(["bop"], depth_step=0.001)
    assert "larger step" in text and "frame 1" in text, text
    for step in (0, -1, float("nan"), float("inf")):
        assert "step of depth" in refusal(["bop"], depth_step=step)
    scene.camera.data.type = "ORTHO"
    assert "perspective" in refusal(["bop"])
    scene.camera = None
    assert "no camera" in refusal(["bop"])


@case
def panel_writes_bop():
    scene, _ = bop_scene()
    scene.camera.name = "../left/camera"  # no part of a file's name
    scene.velo.dataset_folder, scene.velo.dataset_formats, scene.velo.depth_step = os.path.join(FOLDER, "panel"), {"bop", "coco"}, 0.5
    assert bpy.ops.velo.write_dataset() == {"FINISHED"}
    assert table(os.path.join(FOLDER, "panel"), "camera.json")["depth_scale"] == 0.5
    names = [os.path.join(root, name) for root, _, names in os.walk(FOLDER) for name in names if "left" in name]
    assert names and all(name.startswith(os.path.join(FOLDER, "panel")) and not os.path.dirname(name).endswith("left") for name in names)
