#!/usr/bin/python3
"""Keypoints and who hides them, against geometry of its own: spheres, boxes and rays in NumPy; COCO's format; occlusion of
objects; flow that is written and read again."""
import json
import math
import os
import struct

import cases
from cases import case, raises, work

numpy = cases.need("numpy")
import velo
from velo import dataset
from velo.dataset import flow as flow_files

RANDOM = numpy.random.default_rng(5)
BALLS = [((0, 0, 0), 0.5), ((0.9, 0.2, 0.3), 0.35), ((-0.6, 0.5, 0.7), 0.25)]
BOX = (numpy.array([-0.3, -0.9, 0.5]), numpy.array([0.5, -0.2, 0.9]))


def stage():
    scene = velo.Scene()
    group = scene.add_group("ball")
    scene.add_sphere((0, 0, 0), 1, group=group)
    for center, radius in BALLS:
        pose = numpy.diag([radius, radius, radius, 1.0])
        pose[:3, 3] = center
        scene.add_instance(group, pose=pose)
    scene.add_box(*BOX)
    scene.add_light("infinite", color=1)
    return scene


def ball_entry(eye, way, center, radius):
    """Where segments eye + t way enter a ball: t, inf where they do not."""
    to = eye - center
    a, b, c = (way * way).sum(1), (way * to).sum(1), (to * to).sum() - radius * radius
    root = b * b - a * c
    t = (-b - numpy.sqrt(numpy.maximum(root, 0))) / a
    return numpy.where((root > 0) & (t > 0), t, numpy.inf)


def box_entry(eye, way, low, high):
    with numpy.errstate(divide="ignore"):
        a, b = (low - eye) / way, (high - eye) / way
    first, last = numpy.minimum(a, b).max(1), numpy.maximum(a, b).min(1)
    return numpy.where((first <= last) & (first > 0), first, numpy.inf)


def surface_points(count):
    """Points on the balls, evenly at random."""
    normals = RANDOM.normal(size=(count, 3))
    normals /= numpy.linalg.norm(normals, axis=1)[:, None]
    which = RANDOM.integers(len(BALLS), size=count)
    centers, radii = (numpy.array([BALLS[i][k] for i in which]) for k in (0, 1))
    return centers + radii[:, None] * normals


@case
def visibility_is_that_of_rays_in_numpy():
    scene = stage()
    world = scene.world()
    compared = seen = 0
    for number in range(6):
        eye = RANDOM.normal(size=3)
        eye *= 3 / numpy.linalg.norm(eye)
        more = [dict(fov=0.5), dict(projection="equidistant", fov=2.5), dict(fov=0.8, distortion="opencv", distortion_coefficients=[-0.1, 0.01, 0, 0])][number % 3]
        camera = velo.Camera(64, 48, eye=eye, lookat=(0, 0, 0.2), **more)
        points = surface_points(2000)
        found = dataset.project_keypoints(world, camera, points)
        way = points - eye
        entries = numpy.stack([ball_entry(eye, way, numpy.array(center), radius) for center, radius in BALLS] + [box_entry(eye, way, *BOX)], 1)
        nearest = entries.min(1)
        sure = numpy.abs(nearest - 1) > 1e-4  # of the others the point itself is the hit, or grazes an edge
        shown = nearest > 1 - 1e-4
        pixels = camera.project(points)
        x, y = pixels.pixels.T
        inside = pixels.valid & (x >= 0) & (x < 64) & (y >= 0) & (y < 48)
        expected = numpy.where(inside, numpy.where(shown, 2, 1), 0)
        grazing = numpy.abs(((points - numpy.array([c for c, _ in BALLS])[entries[:, :3].argmin(1)]) * way).sum(1)) < 1e-3
        agree = (found.visibility == expected) | grazing
        assert agree.mean() > 0.999 and (found.visibility == expected)[sure & ~grazing].all(), (number, agree.mean())
        hider = numpy.where(entries.argmin(1) < 3, entries.argmin(1) + 1, 0)
        both = (found.visibility == 1) & (expected == 1)
        assert (found.hidden_by == hider)[both].mean() > 0.999 and not found.hidden_by[found.visibility != 1].any()
        assert numpy.allclose(found.points, (camera.camera_from_world @ numpy.c_[points, numpy.ones(2000)].T).T[:, :3], atol=1e-12)
        assert numpy.array_equal(found.pixels[inside], pixels.pixels[inside])
        compared, seen = compared + int(inside.sum()), seen + int((expected == 2).sum())
    assert compared > 5000 and 0.2 < seen / compared < 0.8, (compared, seen)


@case
def points_inside_count_as_seen_up_to_a_depth():
    scene = stage()
    camera = velo.Camera(64, 48, eye=(0, 0, 5), lookat=(0, 0, 0), fov=0.6)
    below = [(0, 0, 0.5 - 0.02)]
    assert dataset.project_keypoints(scene.world(), camera, below).visibility.tolist() == [1]
    assert dataset.project_keypoints(scene.world(), camera, below, depth=0.03).visibility.tolist() == [2]
    assert dataset.project_keypoints(scene.world(), camera, below, depth=100).visibility.tolist() == [2]


@case
def a_rolling_shutter_has_the_time_of_each_row():
    """Pixels, points in camera space and what hides them, by formulas: the camera moves along x with 2 units per second, a
    shutter passes from left to right between it and the points."""
    height, readout, speed = 48, 0.5, 2.0
    camera = velo.Camera(64, height, eye=(0, 0, 5), lookat=(0, 0, 0), eye_close=(speed * readout, 0, 5), lookat_close=(speed * readout, 0, 0),
                         fov=0.8, shutter_open=0, shutter_close=0, readout=readout, readout_direction="down", pose_times=(0, readout))
    assert numpy.allclose(camera.film_times([[3, 0.5], [60, height - 0.5], [1, -9], [1, 99]]),
                          [0, readout * (height - 1) / height, -readout / 2 / height, readout * (1 - 0.5 / height)])
    scene = velo.Scene()
    group = scene.add_group("shutter")
    scene.add_box((-4, -4, 1), (0, 4, 1.1), group=group)
    poses = numpy.tile(numpy.eye(4), (2, 1, 1))
    poses[:, 0, 3] = -1.5, 2.5
    scene.add_instance(group, poses, [0, readout])
    world = scene.world()
    points = RANDOM.uniform((-1, -1, -0.5), (2, 1, 0.5), size=(400, 3))
    found, seen = dataset.project_keypoints(world, camera, points), camera.project(points)
    rows = seen.pixels[:, 1]
    inside = seen.valid & (seen.pixels >= 0).all(1) & (seen.pixels < (64, height)).all(1)
    times = (rows - 0.5) / height * readout
    eyes = numpy.stack([speed * times, 0 * times, 0 * times + 5], 1)
    to = points - eyes
    assert inside.sum() > 200 and numpy.allclose(found.points[inside], (to * (1, -1, -1))[inside], atol=1e-9)
    assert numpy.allclose(found.points[inside][:, 2], seen.z[inside], atol=1e-9)
    edge = -1.5 + 4 * times / readout
    across = eyes[:, 0] + to[:, 0] * (5 - 1.1) / (5 - points[:, 2])
    sure = inside & (numpy.abs(across - edge) > 0.1)
    assert 50 < (found.visibility[sure] == 1).sum() < sure.sum() - 50
    assert ((found.visibility == 1) == (across < edge))[sure].all()


@case
def points_without_a_place_in_the_image_are_outside():
    camera = velo.Camera(64, 48, eye=(0, 0, 5), lookat=(0, 0, 0), fov=0.6)
    found = dataset.project_keypoints(stage().world(), camera, [(0, 0, 9), (50, 0, 0), (math.nan, 0, 0), (math.inf, 0, 0), (0, 0, 0.5)])
    assert found.visibility.tolist() == [0, 0, 0, 0, 2] and numpy.isfinite(found.pixels).all() and numpy.isfinite(found.points).all()
    assert dataset.project_keypoints(stage().world(), camera, []).pixels.shape == (0, 2)
    for wrong in ("abc", [[1, 2]], [1, 2, 3], None, {}, numpy.zeros((2, 2, 3))):
        with raises(velo.UsageError, "points"):
            dataset.project_keypoints(stage().world(), camera, wrong)
    for depth in (-1, math.nan, "x"):
        with raises(velo.UsageError, "depth"):
            dataset.project_keypoints(stage().world(), camera, [(0, 0, 0)], depth=depth)
    with raises(velo.UsageError, "world"):
        dataset.project_keypoints(stage(), camera, [(0, 0, 0)])
    with raises(velo.UsageError, "camera"):
        dataset.project_keypoints(stage().world(), None, [(0, 0, 0)])


# ---- datasets ----

CUBE = numpy.array([[x, y, z] for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)], dtype=float) * 0.1
FACES = [(0, 1, 3), (0, 3, 2), (4, 6, 7), (4, 7, 5), (0, 4, 5), (0, 5, 1), (2, 3, 7), (2, 7, 6), (0, 2, 6), (0, 6, 4), (1, 5, 7), (1, 7, 3)]


def recipe(**more):
    """A cube behind another one; its corners and its middle are keypoints."""
    keypoints = {"c%d" % i: tuple(corner) for i, corner in enumerate(CUBE)}
    keypoints["middle"] = (0, 0, 0)
    poses = [[("back", numpy.eye(4)), ("front", [[1, 0, 0, 0.1], [0, 1, 0, 0.0], [0, 0, 1, 0.4], [0, 0, 0, 1]])]]
    return dataset.Recipe(models=[dataset.Model(name="back", positions=CUBE, indices=FACES, keypoints=keypoints, skeleton=[(1, 2)], **more),
                                  dataset.Model(name="front", positions=CUBE, indices=FACES)],
                          placing=dataset.Poses(poses), resolution=(96, 72), spp=1, environment=dataset.Environment("white"),
                          cameras=[dataset.Fixed(fov=35, keywords=dict(eye=(0.25, 0.3, 1.5), lookat=(0, 0, 0)))])


@case
def datasets_have_keypoints_and_who_hides_what():
    folder = work("keypoints")
    dataset.generate(recipe(), folder, writers=["coco", "exr"])
    table = json.load(open(os.path.join(folder, "coco/annotations.json")))
    back = next(item for item in table["annotations"] if item["category_id"] == 1)
    category = table["categories"][0]
    assert category["keypoints"] == ["c%d" % i for i in range(8)] + ["middle"] and category["skeleton"] == [[1, 2]]
    flags = numpy.array(back["keypoints"]).reshape(-1, 3)[:, 2]
    # The corners by boxes of our own: hidden by the cube itself or by the one in front.
    eye = numpy.array([0.25, 0.3, 1.5])
    points = numpy.concatenate([CUBE, [[0, 0, 0]]])
    way = points - eye
    own = box_entry(eye, way, CUBE.min(0), CUBE.max(0))
    other = box_entry(eye, way, CUBE.min(0) + [0.1, 0, 0.4], CUBE.max(0) + [0.1, 0, 0.4])
    lengths = numpy.linalg.norm(way, axis=1)
    slack = 0.01 * math.sqrt(3) * 0.2  # metres
    shown = (numpy.minimum(own, other) * lengths >= lengths - slack)
    assert flags.tolist() == numpy.where(shown, 2, 1).tolist() and {1, 2} == set(flags.tolist()), flags
    assert back["num_keypoints"] == 9
    solid = numpy.array(back["keypoints_3d"]).reshape(-1, 4)
    camera = dataset.Stage(recipe()).plan(0).views[0].camera
    local = numpy.linalg.solve(camera.world_from_camera, numpy.c_[points, numpy.ones(9)].T).T[:, :3]
    assert numpy.allclose(solid[:, :3], local, atol=1e-12) and solid[:, 3].tolist() == flags.tolist()
    k = camera.K
    flat = numpy.array(back["keypoints"]).reshape(-1, 3)
    assert numpy.allclose(flat[:, 0], k[0, 0] * local[:, 0] / local[:, 2] + k[0, 2]) and numpy.allclose(flat[:, 1], k[1, 1] * local[:, 1] / local[:, 2] + k[1, 2])
    beside = json.load(open(os.path.join(folder, "exr/000000_camera.json")))["instances"]
    assert beside[0]["visibility"] == flags.tolist() and "keypoints" not in beside[1]
    assert list(beside[0]["hidden_by"]) == ["1"] and beside[1]["hidden_by"] == {} and beside[1]["visible_fraction"] == 1
    assert beside[0]["hidden_by"]["1"] == beside[0]["pixels_whole"] - beside[0]["pixels"] > 0
    frame = dataset.Stage(recipe()).render(0)[0]
    assert frame.instances[0].visible_fraction == back["visible_fraction"] < 1
    assert frame.instances[0].keypoints.hidden_by.max() == 2  # the second instance
    deep = dataset.Stage(recipe(keypoint_depth=1.0)).render(0)[0].instances[0].keypoints
    assert deep.visibility[8] == 2  # its middle


@case
def depths_that_steps_cannot_hold_are_errors():
    coarse = recipe()
    coarse.depth_scale = 5000.0  # steps of 5 m: everything would be 0, unknown
    with raises(velo.UnsupportedError, "in steps of 5000 mm is 0"):
        dataset.generate(coarse, work("coarse"), writers=["bop"])
    fine = recipe()
    fine.depth_scale = 0.01
    with raises(velo.UnsupportedError, "16 bits hold up to"):
        dataset.generate(fine, work("fine"), writers=["bop"])


@case
def flow_is_read_as_it_was_written():
    scene = stage()
    scene.camera = velo.Camera(48, 32, eye=(0, 0.5, 4), lookat=(0, 0, 0), fov=0.7)
    image = scene.ground_truth(["forward"], forward=scene.camera.replace(eye=(0.1, 0.5, 4)))
    wanted = numpy.stack([image["forward.U"], image["forward.V"]], -1)
    known = numpy.asarray(image["forward.hidden"]) != 3
    for name, error in (("a.flo", 0), ("a.png", 0.5 / 64 + 1e-6)):
        dataset.write_flow(image, work(name))
        found = dataset.read_flow(work(name))
        assert found.flow.shape == (32, 48, 2) and numpy.array_equal(found.known, known), name
        assert numpy.abs(found.flow - wanted)[known].max() <= error and not found.flow[~known].any(), name
    with open(work("wrong.flo"), "wb") as file:
        file.write(flow_files.TAG + struct.pack("<ii", 2**30, 2**30))
    velo.Image(numpy.zeros((2, 2, 3), dtype="uint8")).write(work("eight.png"))
    for name, kind, text in (("wrong.flo", velo.SceneError, "the file has 12"), ("none.flo", velo.MissingFileError, "no such file"),
                             ("eight.png", velo.SceneError, "16 bits"), ("a.txt", velo.UsageError, ".flo")):
        with raises(kind, text):
            dataset.read_flow(work(name))
    with open(work("text.flo"), "w") as file:
        file.write("this is no flow")
    with raises(velo.SceneError, "PIEH"):
        dataset.read_flow(work("text.flo"))


if __name__ == "__main__":
    cases.main()
