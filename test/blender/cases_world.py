"""Cases of test_world.py: worlds that velo cannot evaluate."""
import bpy
import numpy

from inside import add, agrees, ball, case, colors, material, new_scene, notes, plane, render


def under_the_sky(kind, **values):
    """A floor and a ball, both diffuse, under a sky texture."""
    scene = new_scene()
    plane(material("ShaderNodeBsdfDiffuse", Color=(0.5, 0.5, 0.5))[0])
    ball(material("ShaderNodeBsdfDiffuse", Color=(0.7, 0.3, 0.2))[0])
    tree = scene.world.node_tree
    sky = tree.nodes.new("ShaderNodeTexSky")
    sky.sky_type = kind
    for name, value in values.items():
        setattr(sky, name, value)
    tree.nodes["Background"].inputs[1].default_value = 0.1
    tree.links.new(sky.outputs[0], tree.nodes["Background"].inputs[0])
    return scene


@case
def a_sky_with_a_sun_lights_as_in_cycles():
    scene = under_the_sky("NISHITA", sun_elevation=0.7, sun_rotation=2.0)
    agrees(scene, 0.02)
    other, mine = (colors(render(scene, engine)) for engine in ("CYCLES", "VELO"))
    assert abs(other - mine).mean() < 0.08 * other.mean(), abs(other - mine).mean() / other.mean()
    assert not notes(scene), notes(scene)


@case
def older_skies_and_what_else_cycles_knows():
    agrees(under_the_sky("PREETHAM"), 0.02)
    scene = under_the_sky("HOSEK_WILKIE")
    tree = scene.world.node_tree
    points = tree.nodes.new("ShaderNodeTexPointDensity")
    points.name = "unknown to velo"
    tree.links.new(points.outputs["Density"], tree.nodes["Background"].inputs[1])
    tree.nodes["Background"].inputs[1].default_value = 0
    assert colors(render(scene)).max() == 0


@case
def a_world_without_its_image_is_black_and_listed():
    scene = under_the_sky("HOSEK_WILKIE")
    tree = scene.world.node_tree
    picture = tree.nodes.new("ShaderNodeTexEnvironment")
    picture.image = bpy.data.images.new("lost", 4, 4)
    picture.image.source, picture.image.filepath = "FILE", "/nowhere/lost.exr"
    tree.links.new(picture.outputs[0], tree.nodes["Background"].inputs[0])
    assert numpy.asarray(colors(render(scene))).max() == 0
    assert any("lost.exr is missing" in line for line in notes(scene)), notes(scene)


@case
def a_world_that_the_camera_sees_otherwise_lights_as_in_cycles():
    scene = new_scene(world=(0.8, 0.8, 0.8))
    plane(material("ShaderNodeBsdfDiffuse", Color=(0.5, 0.5, 0.5))[0])
    tree = scene.world.node_tree
    seen, mix = tree.nodes.new("ShaderNodeBackground"), tree.nodes.new("ShaderNodeMixShader")
    seen.inputs[0].default_value = (0, 0.1, 0.5, 1)
    rays = tree.nodes.new("ShaderNodeLightPath")
    tree.links.new(rays.outputs["Is Camera Ray"], mix.inputs[0])
    tree.links.new(tree.nodes["Background"].outputs[0], mix.inputs[1])
    tree.links.new(seen.outputs[0], mix.inputs[2])
    tree.links.new(mix.outputs[0], next(node for node in tree.nodes if node.type == "OUTPUT_WORLD").inputs[0])
    other, mine = (colors(render(scene, engine)) for engine in ("CYCLES", "VELO"))
    assert abs(mine - other).mean() < 0.02 * other.mean(), abs(mine - other).mean() / other.mean()
    assert not notes(scene), notes(scene)
    tree.links.new(add(tree, "ShaderNodeTexSky", sky_type="PREETHAM").outputs[0], tree.nodes["Background"].inputs[0])
    agrees(scene, 0.02)


@case
def a_world_that_hides_from_the_camera():
    for use_nodes in (True, False):
        scene = new_scene(world=(0.8, 0.8, 0.8))
        scene.world.use_nodes, scene.world.color = use_nodes, (0.7, 0.8, 0.9)
        scene.world.cycles_visibility.camera = False
        ball(material("ShaderNodeBsdfGlass", Roughness=0.0)[0])
        agrees(scene, 0.01)
        assert not notes(scene), notes(scene)
