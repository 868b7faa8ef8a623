"""Cases of test_lights.py: lights agree with Cycles."""
import math

import bpy
import numpy

from inside import ball, case, colors, agrees, lamp, material, new_scene, notes, plane, render

GRAY = (0.8, 0.6, 0.4)


def floor(**words):
    scene = new_scene(**words)
    plane(material("ShaderNodeBsdfDiffuse", Color=GRAY)[0])
    return scene


@case
def area_lights_have_a_spread():
    """Up to where few of the points of the lamp send light to a point of the floor."""
    for spread, shape in ((180, "SQUARE"), (150, "DISK"), (90, "SQUARE"), (45, "RECTANGLE"), (20, "ELLIPSE"), (10, "SQUARE")):
        scene = floor(samples=500)
        item = lamp(scene, "AREA", 100, (0.6, -0.6, 2), shape=shape, size=1.5, size_y=1.0, spread=math.radians(spread))
        item.visible_camera = False
        agrees(scene, 0.02 if spread > 15 else 0.04)  # of the noise
        assert not notes(scene), notes(scene)


@case
def a_spread_is_seen_in_mirrors_and_fog():
    scene = floor(samples=256)
    ball(material("ShaderNodeBsdfGlossy", Roughness=0.2)[0], (0, 0, 1), 1)
    lamp(scene, "AREA", 100, (0, -1, 4), size=1.5, spread=math.radians(60))
    agrees(scene, 0.02)
    scene = floor(samples=256)
    lamp(scene, "AREA", 100, (0, 0, 3), size=0.5, spread=math.radians(40))
    bpy.ops.mesh.primitive_cube_add(size=1.8, location=(0, 0, 1))
    made = bpy.data.materials.new("fog")
    made.use_nodes = True
    tree = made.node_tree
    tree.nodes.clear()
    node = tree.nodes.new("ShaderNodeVolumeScatter")
    node.inputs["Density"].default_value = 0.5
    tree.links.new(node.outputs[0], tree.nodes.new("ShaderNodeOutputMaterial").inputs["Volume"])
    bpy.context.object.data.materials.append(made)
    agrees(scene, 0.02)


@case
def narrow_lamps_make_sharp_spots():
    scene = floor(samples=64)
    lamp(scene, "AREA", 100, (0, 0, 2), size=0.1, spread=math.radians(30))
    other, mine = (colors(render(scene, engine))[..., 1] for engine in ("CYCLES", "VELO"))
    assert abs(other - mine).mean() < 0.05 * other.mean(), abs(other - mine).mean() / other.mean()
    assert (mine[:4] == 0).all() and numpy.isfinite(mine).all()


@case
def lamps_that_the_camera_does_not_see_are_seen_in_mirrors():
    scene = floor()
    ball(material("ShaderNodeBsdfGlossy", Roughness=0.0, distribution="SHARP")[0], (0, 0, 1), 1)
    for kind, words in (("AREA", {"size": 1.5}), ("POINT", {"shadow_soft_size": 0.4})):
        item = lamp(scene, kind, 300, (0, 1.5, 2.5), **words)
        item.visible_camera = False
    agrees(scene, 0.02)
    other, mine = (colors(render(scene, engine)) for engine in ("CYCLES", "VELO"))
    there = mine[8:20, 14:34], other[8:20, 14:34]
    assert there[0].max() > 10 and abs(there[0].mean() / there[1].mean() - 1) < 0.05
    assert not notes(scene), notes(scene)


@case
def suns_have_no_noise_of_their_disk():
    """A sun with a disk gives an open floor the same light in each sample, and that of Cycles."""
    for angle in (0.004, 0.01, 0.05):
        scene = floor(samples=1, bounces=0)
        scene.cycles.pixel_filter_type = "BOX"
        lamp(scene, "SUN", 3, (2, -2, 4), angle=angle)
        other, mine = (colors(render(scene, engine))[16:] for engine in ("CYCLES", "VELO"))
        assert (mine.std(axis=(0, 1)) < 0.02 * mine.mean(axis=(0, 1))).all(), (angle, mine.std(axis=(0, 1)) / mine.mean(axis=(0, 1)))
        assert (abs(mine.mean(axis=(0, 1)) / other.mean(axis=(0, 1)) - 1) < 0.005).all(), (angle, mine.mean(axis=(0, 1)), other.mean(axis=(0, 1)))
