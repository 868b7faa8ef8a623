"""Cases of test_volumes.py: what lies below surfaces agrees with Cycles."""
import bpy

from inside import add, agrees, ball, case, colors, lamp, material, new_scene, notes, plane, render


def filled(surface, kind, **values):
    """A ball with a volume before a floor: (scene, tree, volume's node). surface: a shader's kind, None: no surface."""
    scene = new_scene(world=(0.5, 0.5, 0.6))
    scene.cycles.volume_bounces = 8
    plane(material("ShaderNodeBsdfDiffuse", Color=(0.6, 0.6, 0.6))[0])
    made, node = material(surface or "ShaderNodeBsdfDiffuse")
    tree = made.node_tree
    output = next(known for known in tree.nodes if known.type == "OUTPUT_MATERIAL")
    if surface is None:
        tree.nodes.remove(node)
    else:
        node.distribution = "SHARP"
    volume = add(tree, kind, output.inputs["Volume"], **values)
    ball(made, (0, 0, 1.2), 1.2)
    return scene, tree, volume


@case
def fog_and_tinted_glass():
    for surface, kind, values in ((None, "ShaderNodeVolumePrincipled", {"Color": (0.6, 0.7, 0.9, 1), "Density": 1.0}),
                                  (None, "ShaderNodeVolumeScatter", {"Color": (0.9, 0.6, 0.4, 1), "Density": 0.7, "Anisotropy": 0.5}),
                                  ("ShaderNodeBsdfGlass", "ShaderNodeVolumeAbsorption", {"Color": (0.9, 0.4, 0.2, 1), "Density": 0.8})):
        scene, _, _ = filled(surface, kind, **values)
        if surface is None:
            lamp(scene, "AREA", 200, size=2)
        agrees(scene, 0.01)
        assert not notes(scene), notes(scene)


@case
def a_density_of_noise():
    scene, tree, volume = filled(None, "ShaderNodeVolumePrincipled", Color=(0.8, 0.8, 0.8, 1))
    noise = add(tree, "ShaderNodeTexNoise", Scale=1.5, Detail=0.0)
    steep = tree.nodes.new("ShaderNodeMath")
    steep.operation, steep.inputs[1].default_value, steep.inputs[2].default_value = "MULTIPLY_ADD", 12.0, -5.0
    tree.links.new(tree.nodes.new("ShaderNodeTexCoord").outputs["Object"], noise.inputs["Vector"])
    tree.links.new(noise.outputs[0], steep.inputs[0])
    tree.links.new(steep.outputs[0], volume.inputs["Density"])
    agrees(scene, 0.02)
    assert not notes(scene), notes(scene)


@case
def a_volume_that_glows():
    scene, _, _ = filled(None, "ShaderNodeVolumePrincipled", Color=(0.2, 0.2, 0.2, 1), Density=1.0, Emission_Strength=0.5,
                         Emission_Color=(1.0, 0.5, 0.1, 1))
    agrees(scene, 0.02)


@case
def light_scatters_below_surfaces():
    for kind, values in (("ShaderNodeBsdfPrincipled", {"Subsurface": 1.0, "Subsurface_Radius": (0.1, 0.05, 0.03)}),
                         ("ShaderNodeSubsurfaceScattering", {"Scale": 0.05, "Color": (0.8, 0.5, 0.3)})):
        scene = new_scene(world=(1, 1, 1))
        made, node = material(kind, **values)
        if kind.endswith("Principled"):
            node.inputs["Base Color"].default_value = node.inputs["Subsurface Color"].default_value = (0.8, 0.5, 0.3, 1)
        ball(made, (0, 0, 0.5), 1.7)
        agrees(scene, 0.05)
        assert not notes(scene), notes(scene)


@case
def volumes_that_velo_has_not_are_listed():
    scene, tree, volume = filled(None, "ShaderNodeVolumePrincipled")
    tree.links.new(add(tree, "ShaderNodeHairInfo").outputs["Random"], volume.inputs["Density"])
    render(scene)
    assert any("volume is not rendered" in line for line in notes(scene)), notes(scene)
    scene = new_scene(world=(1, 1, 1))
    tree = scene.world.node_tree
    add(tree, "ShaderNodeVolumeScatter", next(node for node in tree.nodes if node.type == "OUTPUT_WORLD").inputs["Volume"])
    item = bpy.data.objects.new("cloud", bpy.data.volumes.new("cloud"))
    scene.collection.objects.link(item)
    assert colors(render(scene)).min() > 0.9
    assert any("world's volume" in line for line in notes(scene)) and any("type volume" in line for line in notes(scene)), notes(scene)
