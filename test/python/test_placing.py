#!/usr/bin/python3
"""Things on the surfaces of a scene (placing on_scene), against boxes of our own; folders of images for randomisation."""
import math
import os

import cases
from cases import case, raises, work

numpy = cases.need("numpy")
import velo
from velo import dataset
from velo.dataset.random import Random

CORNERS = numpy.array([[x, y, z] for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)], dtype=float)
FACES = [(0, 1, 3), (0, 3, 2), (4, 6, 7), (4, 7, 5), (0, 4, 5), (0, 5, 1), (2, 3, 7), (2, 7, 6), (0, 2, 6), (0, 6, 4), (1, 5, 7), (1, 7, 3)]
HALF = numpy.array([0.06, 0.04, 0.03])
# Of the scene: a floor, a table, a box on the table, a wall.
FLOOR = (numpy.array([-2, -0.1, -2]), numpy.array([2, 0.0, 2]))
TABLE = (numpy.array([-0.6, 0.45, -0.4]), numpy.array([0.6, 0.5, 0.4]))
BLOCK = (numpy.array([-0.2, 0.5, -0.2]), numpy.array([0.0, 0.8, 0.1]))
WALL = (numpy.array([0.3, 0.0, -2]), numpy.array([0.32, 2, 2]))
SOLIDS = (FLOOR, TABLE, BLOCK, WALL)


def room(path="room.gltf", tilt=0.0):
    scene = velo.Scene()
    for low, high in SOLIDS:
        scene.add_box(low, high)
    if tilt:
        c, s = math.cos(tilt), math.sin(tilt)
        scene = velo.Scene()
        scene.add_plane((0, 0, 0), (s, c, 0), 4, 4)
    scene.camera = velo.Camera(8, 8, eye=(0, 1, 3), lookat=(0, 0, 0))
    scene.save(work(path))
    return path


def recipe(**more):
    placing = dict(low=(-1, -0.01, -1), high=(1, 1.0, 1), gap=0.005)
    placing.update(more.pop("placing", {}))
    count = more.pop("count", 12)
    keywords = dict(models=[dataset.Model(name="brick", positions=CORNERS * HALF, indices=FACES, count=count)], scene=room(), folder=cases.WORK,
                    placing=dataset.OnScene(**placing), resolution=(8, 8), spp=1)
    keywords.update(more)
    return dataset.Recipe(**keywords)


def corners(pose):
    return (numpy.array(pose) @ numpy.c_[CORNERS * HALF, numpy.ones(8)].T).T[:, :3]


def apart(a, b):
    """The largest gap between two boxes, given by their corners, along any axis that may separate them; below 0: they overlap."""
    def axes(box):
        edges = numpy.array([box[4] - box[0], box[2] - box[0], box[1] - box[0]])
        return edges / numpy.linalg.norm(edges, axis=1)[:, None]

    first, second = axes(a), axes(b)
    best = -numpy.inf
    for axis in [*first, *second, *(numpy.cross(p, q) for p in first for q in second)]:
        length = numpy.linalg.norm(axis)
        if length > 1e-9:
            p, q = a @ (axis / length), b @ (axis / length)
            best = max(best, p.min() - q.max(), q.min() - p.max())
    return best


def solid(low, high):
    return numpy.array([[(low, high)[(i >> 2) & 1][0], (low, high)[(i >> 1) & 1][1], (low, high)[i & 1][2]] for i in range(8)])


@case
def random_counts_reach_both_bounds():
    draw = Random(1, 0, "count")
    counts = [draw.count((2, 4)) for _ in range(600)]
    assert set(counts) == {2, 3, 4} and min(map(counts.count, (2, 3, 4))) > 140, counts
    assert {draw.count((3, 3)) for _ in range(20)} == {3} and draw.count(5) == 5


@case
def things_stand_on_surfaces_and_meet_nothing():
    stage = dataset.Stage(recipe())
    heights = []
    for frame in range(6):
        plan = stage.plan(frame)
        boxes = [corners(item.pose) for item in plan.objects]
        assert len(boxes) >= 8, len(boxes)
        for i, box in enumerate(boxes):
            assert all(apart(box, other) > 0.0049 for other in boxes[:i])
            bottom = box[:, 1].min()
            heights.append(bottom)
            ground = [high[1] for low, high in SOLIDS if abs(high[1] - bottom) < 1e-6]
            assert ground, bottom  # it stands on a top
            for low, high in SOLIDS:
                gap = apart(box, solid(low, high))
                assert gap > -0.025 * HALF.min() * 2, (frame, i, gap)  # rays end 2 % before the box's faces
    heights = numpy.round(heights, 6)
    assert {0.0, 0.5} <= set(heights.tolist()), sorted(set(heights.tolist()))  # also under the table
    assert dataset.Stage(recipe()).plan(4).objects == stage.plan(4).objects  # alone, the same bits


@case
def under_the_table_is_found_too():
    """Rays start at random heights, so the floor below the table is a surface like others."""
    stage = dataset.Stage(recipe(placing=dict(low=(-0.5, -0.01, -0.35), high=(0.2, 0.44, 0.35)), count=3))
    places = [corners(item.pose) for frame in range(4) for item in stage.plan(frame).objects]
    assert places and all(abs(box[:, 1].min()) < 1e-6 and box[:, 1].max() < 0.45 for box in places)


@case
def tumbled_things_touch_what_they_stand_on():
    stage = dataset.Stage(recipe(placing=dict(tumble=True)))
    for frame in range(3):
        for item in stage.plan(frame).objects:
            box = corners(item.pose)
            assert min(abs(high[1] - box[:, 1].min()) for low, high in SOLIDS) < 1e-6
            assert all(apart(box, solid(*other)) > -0.004 for other in SOLIDS)


@case
def steep_surfaces_are_left_out():
    slope = math.radians(20)
    shared = dict(scene=room("slope.gltf", slope), count=4, placing=dict(low=(-1, -1, -1), high=(1, 1, 1)))
    assert not dataset.Stage(recipe(**shared)).plan(0).objects
    shared["placing"]["slope"] = 25.0
    placed = [corners(item.pose) for item in dataset.Stage(recipe(**shared)).plan(0).objects]
    assert placed
    for box in placed:  # above the plane, and not far
        height = box @ numpy.array([math.sin(slope), math.cos(slope), 0])
        assert -1e-2 < height.min() < 0.02, height.min()


@case
def recipes_need_something_to_stand_on():
    with raises(velo.UsageError, "nothing to stand on"):
        dataset.Stage(recipe(scene=""))
    assert dataset.Stage(recipe(scene="", ground=dataset.Ground())).plan(0).objects
    for wrong, text in ((dict(slope=90), "slope"), (dict(low=(0, 0, 0), high=(-1, 1, 1)), "above high"), (dict(up=(0, 0, 0)), "up"), (dict(tries=0), "tries")):
        with raises(velo.UsageError, text):
            dataset.Stage(recipe(placing=wrong))
    made = dataset.recipe_from({"models": [{"name": "a", "positions": CORNERS.tolist(), "indices": FACES}], "ground": {},
                                "placing": {"kind": "on_scene", "low": [-1, -1, -1], "high": [1, 1, 1]}})
    assert isinstance(made.placing, dataset.OnScene)


@case
def folders_stand_for_their_images():
    os.makedirs(work("skies"), exist_ok=True)
    os.makedirs(work("empty"), exist_ok=True)
    for name in ("b.pfm", "a.exr", "c.EXR"):
        velo.Image(numpy.ones((2, 4, 3), dtype="float32")).write(work("skies/") + name.lower())
    with open(work("skies/readme.txt"), "w") as file:
        file.write("no image")
    looks = dataset.Materials(textures=["skies"])
    shared = dict(environment=dataset.Environment(files=["skies"]), ground=dataset.Ground(materials=looks))
    stage = dataset.Stage(recipe(**shared))
    assert stage.recipe.environment.files == ["skies/a.exr", "skies/b.pfm", "skies/c.exr"] == list(stage.recipe.ground.materials.textures)
    chosen = {os.path.basename(stage.plan(frame).environment["environment"]) for frame in range(20)}
    assert chosen == {"a.exr", "b.pfm", "c.exr"}
    assert stage.plan(7).environment == dataset.Stage(recipe(**shared)).plan(7).environment
    listed = dataset.Stage(recipe(environment=dataset.Environment(files=["skies/a.exr", "skies/b.pfm", "skies/c.exr"])))
    assert listed.plan(3).environment == stage.plan(3).environment
    with raises(velo.UsageError, "recipe.environment.files", "empty has no images"):
        dataset.Stage(recipe(environment=dataset.Environment(files=["empty"])))


if __name__ == "__main__":
    cases.main()
