"""Cases of test_camera.py: points are where world_to_camera_view has them, panoramas see what Cycles sees."""
import os
import random

import bpy
import mathutils
import numpy
from bpy_extras.object_utils import world_to_camera_view

from inside import FOLDER, ball, case, channel, colors, material, new_scene, refused, render


def camera_of(scene):
    """velo's camera."""
    from velo_blender import camera
    bpy.context.view_layer.update()
    graph = bpy.context.evaluated_depsgraph_get()
    return camera.convert(graph, camera.image_size(scene), camera.eye_of(graph))


@case
def points_are_where_blender_sees_them():
    rng, worst = random.Random(1), 0.0
    for _ in range(40):
        scene = new_scene(size=(rng.randint(30, 900), rng.randint(30, 900)))
        scene.render.pixel_aspect_x, scene.render.pixel_aspect_y = rng.choice((1, 1.3)), rng.choice((1, 1.7))
        item, lens = scene.camera, scene.camera.data
        lens.type, lens.sensor_fit = rng.choice(("PERSP", "ORTHO")), rng.choice(("AUTO", "HORIZONTAL", "VERTICAL"))
        lens.lens, lens.sensor_width, lens.sensor_height = rng.uniform(10, 120), rng.uniform(10, 50), rng.uniform(10, 50)
        lens.shift_x, lens.shift_y, lens.ortho_scale = rng.uniform(-0.4, 0.4), rng.uniform(-0.4, 0.4), rng.uniform(1, 10)
        item.location, item.rotation_euler = ([rng.uniform(-3, 3) for _ in range(3)] for _ in range(2))
        item.scale = [rng.uniform(0.5, 2)] * 3
        camera = camera_of(scene)
        for _ in range(10):
            point = item.matrix_world.normalized() @ mathutils.Vector((rng.uniform(-2, 2), rng.uniform(-2, 2), -rng.uniform(1, 20)))
            seen = world_to_camera_view(scene, item, point)
            expected = numpy.array((seen.x * camera.width, (1 - seen.y) * camera.height))
            got = camera.project([list(point)])
            assert got.valid[0]
            worst = max(worst, float(abs(got.pixels[0] - expected).max()))
    assert worst < 0.01, worst


@case
def panoramas_see_what_cycles_sees():
    for words in ({"panorama_type": "EQUIRECTANGULAR"}, {"panorama_type": "EQUIRECTANGULAR", "latitude_min": -0.5, "longitude_max": 1.0},
                  {"panorama_type": "FISHEYE_EQUIDISTANT", "fisheye_fov": 3.0, "shift_x": 0.1, "shift_y": 0.05},
                  {"panorama_type": "FISHEYE_EQUISOLID", "fisheye_fov": 2.5, "fisheye_lens": 10.0},
                  {"panorama_type": "FISHEYE_LENS_POLYNOMIAL", "fisheye_fov": 2.5}, {"panorama_type": "MIRRORBALL"}):
        scene = new_scene(world=(1, 1, 1), size=(64, 40), samples=1)
        ball(material("ShaderNodeBsdfDiffuse")[0], (0, 0, 0), 100.0)
        scene.camera.location, scene.camera.rotation_euler = (0.1, 0.2, 0.3), (1.2, 0.3, 0.5)
        lens = scene.camera.data
        lens.type, lens.clip_start = "PANO", 0.01
        for name, value in words.items():
            setattr(lens.cycles if hasattr(lens.cycles, name) else lens, name, value)
        scene.view_layers[0].use_pass_position = True
        scene.cycles.pixel_filter_type, scene.cycles.filter_width = "BOX", 0.01
        image = render(scene, "CYCLES")
        points = numpy.stack([channel(image, "Position." + axis) for axis in "XYZ"], axis=2)
        seen = numpy.linalg.norm(points, axis=2) > 50
        y, x = numpy.mgrid[0:40, 0:64] + 0.5
        got = camera_of(scene).project(points[seen])
        error = numpy.linalg.norm(got.pixels - numpy.stack((x, y), axis=2)[seen], axis=1)[got.valid]
        assert got.valid.mean() > 0.99 and numpy.percentile(error, 99) < 0.01, (words, got.valid.mean(), error.max())


@case
def camera_files_are_rendered_exactly():
    import velo
    lens = velo.Camera(64, 48, K=[[60, 0, 30], [0, 60, 26], [0, 0, 1]], distortion="opencv",
                       distortion_coefficients=[-0.2, 0.05, 0.001, -0.002], eye=(0, -6, 3), lookat=(0, 0, 0.5), up=(0, 0, 1))
    path = os.path.join(FOLDER, "lens.json")
    lens.write(path)
    scene = new_scene(world=(1, 1, 1), samples=4)
    ball(material("ShaderNodeBsdfDiffuse", Color=(0.8, 0.3, 0.2))[0])
    scene.camera.data.velo.file = path
    bpy.ops.velo.load_camera()
    bpy.context.view_layer.update()
    plain = camera_of(scene)  # Blender's own camera: without the distortion
    points = numpy.random.default_rng(1).uniform(-1, 1, (50, 3))
    assert (plain.resolution, scene.render.resolution_x) == ((64, 48), 64)
    straight = lens.replace(distortion="none", distortion_coefficients=[])
    assert abs(plain.project(points).pixels - straight.project(points).pixels).max() < 0.01
    from velo_blender import camera as eyes
    from velo_blender import camera_files
    exact = camera_files.convert(eyes.eye_of(bpy.context.evaluated_depsgraph_get()), (64, 48))
    assert abs(exact.project(points).pixels - lens.project(points).pixels).max() < 1e-3
    distorted = colors(render(scene))
    scene.camera.data.velo.file = ""
    assert abs(distorted - colors(render(scene))).max() > 0.1
    scene.camera.data.velo.file = "/nowhere/lens.json"
    refused(scene, "/nowhere/lens.json")


@case
def regions_are_parts_of_the_image():
    scene = new_scene(world=(1, 1, 1), samples=4)
    ball(material("ShaderNodeBsdfDiffuse", Color=(0.8, 0.6, 0.4))[0])
    whole = colors(render(scene))
    scene.render.use_border, scene.render.use_crop_to_border = True, True
    scene.render.border_min_x, scene.render.border_max_x = 0.25, 0.75
    scene.render.border_min_y, scene.render.border_max_y = 0.5, 1.0
    part = colors(render(scene))
    assert part.shape == (24, 24, 3), part.shape
    assert abs(part - whole[:24, 12:36]).max() < 1e-6


@case
def a_region_without_pixels_is_one_line():
    scene = new_scene()
    scene.render.use_border = True
    scene.render.border_min_x = scene.render.border_max_x = 0.5
    refused(scene, "too small")


@case
def a_camera_at_no_place_is_one_line():
    scene = new_scene()
    scene.camera.location.x = float("nan")
    refused(scene, "NaN")


def moved(item, first, last):
    """Moves an object from frame 4 to frame 6."""
    for frame, place in ((4, first), (6, last)):
        item.location = place
        item.keyframe_insert("location", frame=frame)
    for curve in item.animation_data.action.fcurves:
        for point in curve.keyframe_points:
            point.interpolation = "LINEAR"


@case
def blurs_of_motion_are_those_of_cycles():
    for moves in ("object", "camera"):
        scene = new_scene(world=(1, 1, 1))
        scene.render.use_motion_blur, scene.render.motion_blur_shutter = True, 0.8
        item = ball(material("ShaderNodeBsdfDiffuse", Color=(0.8, 0.3, 0.2))[0])
        if moves == "object":
            moved(item, (-1.5, 0, 1), (1.5, 0, 1.4))
        else:
            moved(scene.camera, (-1, -6, 3), (1, -6, 3))
        scene.frame_set(5)
        other, mine = colors(render(scene, "CYCLES")), colors(render(scene))
        assert abs(other - mine).mean() < 0.006, (moves, abs(other - mine).mean())


@case
def apertures_have_the_shape_of_cycles():
    for blades, rotation, ratio in ((5, 0.0, 1.0), (5, 0.3, 1.0), (4, 0.2, 1.0), (5, 0.3, 1.8)):
        scene = new_scene(samples=300)
        ball(material("ShaderNodeEmission", Strength=50.0)[0], (0, 6, 1), 0.25)
        scene.camera.rotation_euler.x = 1.396
        dof = scene.camera.data.dof
        dof.use_dof, dof.focus_distance, dof.aperture_fstop = True, 4.0, 0.012
        dof.aperture_blades, dof.aperture_rotation, dof.aperture_ratio = blades, rotation, ratio
        other, mine = (colors(render(scene, engine))[..., 0] for engine in ("CYCLES", "VELO"))
        turn = numpy.angle(corners(mine, blades) / corners(other, blades))
        assert abs(turn) < 0.3, (blades, turn)
        assert abs(mine.mean() / other.mean() - 1) < 0.05
        wide = [image.max(axis=0).nonzero()[0].ptp() / image.max(axis=1).nonzero()[0].ptp() for image in (other, mine)]
        assert abs(wide[0] / wide[1] - 1) < 0.2, (blades, wide)


def corners(image, count):
    """The moment of an image about its centre that turns once from corner to corner of a polygon."""
    y, x = numpy.mgrid[0:image.shape[0], 0:image.shape[1]]
    place = x + 1j * y
    centre = (image * place).sum() / image.sum()
    return (image * ((place - centre) / image.shape[0]) ** count).sum()


@case
def passes_of_indices_and_places():
    scene = new_scene(world=(1, 1, 1), samples=1)
    item = ball(material("ShaderNodeBsdfDiffuse")[0])
    item.pass_index, item.data.materials[0].pass_index = 7, 3
    layer = scene.view_layers[0]
    layer.use_pass_object_index = layer.use_pass_material_index = layer.use_pass_uv = layer.use_pass_position = True
    image, other = render(scene), render(scene, "CYCLES")
    for name in ("IndexOB.X", "IndexMA.X", "UV.U", "UV.V", "Position.X", "Position.Z"):
        inner = channel(other, "IndexOB.X") == 7
        difference = abs(channel(image, name) - channel(other, name))[inner]
        assert numpy.median(difference) < 0.02, (name, numpy.median(difference))
    assert set(numpy.unique(channel(image, "IndexOB.X"))) == {0.0, 7.0}


@case
def data_sets_have_the_masks_of_classes():
    import json

    import velo
    from velo_blender import datasets, report
    scene = new_scene(world=(1, 1, 1), samples=2)
    scene.frame_start, scene.frame_end = 1, 2
    made = material("ShaderNodeBsdfDiffuse")[0]
    for name, place in (("cup", (-1, 0, 1)), ("cup", (1, 0, 1)), ("dish", (0, 0, 2.5))):
        ball(made, place, 0.5)["class"] = name
    ball(made, (0, 3, 1), 0.5)
    folder = os.path.join(FOLDER, "dataset")
    datasets.write(folder, ["coco", "nerfstudio", "exr"])
    tables = [os.path.join(root, name) for root, _, names in os.walk(os.path.join(folder, "coco")) for name in names if name.endswith(".json")]
    found = [table for table in (json.load(open(path)) for path in tables) if isinstance(table, dict) and "annotations" in table][0]
    assert [entry["name"] for entry in found["categories"]] == ["cup", "dish"]
    assert len(found["images"]) == 2 and len(found["annotations"]) == 6
    with open(os.path.join(folder, "nerfstudio/transforms.json")) as file:
        assert len(json.load(file)["frames"]) == 2
    for formats in (["nothing"], []):
        try:
            datasets.write(folder, formats)
        except report.Refused:
            continue
        raise AssertionError("a format that is not there was accepted")
