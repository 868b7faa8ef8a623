"""Cases of test_visibility.py: hidden objects and holdouts are those of Cycles."""
import bpy
import numpy

from inside import agrees, ball, case, channel, colors, lamp, material, new_scene, notes, plane, render


def diffuse(color):
    return material("ShaderNodeBsdfDiffuse", Color=color)[0]


def stage(**words):
    """A floor, a mirror, and a red ball beside it."""
    scene = new_scene(world=(0.5, 0.5, 0.5), samples=128, **words)
    plane(diffuse((0.5, 0.5, 0.5)))
    ball(material("ShaderNodeBsdfGlossy", Roughness=0.0, distribution="SHARP")[0], (1, 0, 0.7), 0.7)
    lamp(scene, "SUN", 2, angle=0.1)
    return scene, ball(diffuse((0.8, 0.1, 0.1)), (-0.8, -0.3, 0.7), 0.7)


def same_images(scene, share=0.02):
    agrees(scene, share)
    other, mine = (colors(render(scene, engine)) for engine in ("CYCLES", "VELO"))
    assert abs(other - mine).mean() < 0.04 * other.mean(), abs(other - mine).mean() / other.mean()
    return mine


@case
def objects_that_the_camera_does_not_see():
    for way in ("object", "collection", "copies"):
        scene, item = stage()
        seen = colors(render(scene))
        if way == "object":
            item.visible_camera = False
        else:
            inner = bpy.data.collections.new("inner")
            scene.collection.objects.unlink(item)
            inner.objects.link(item)
            if way == "collection":
                scene.collection.children.link(inner)
                bpy.context.view_layer.layer_collection.children["inner"].indirect_only = True
            else:
                empty = bpy.data.objects.new("copies", None)
                empty.instance_type, empty.instance_collection, empty.visible_camera = "COLLECTION", inner, False
                scene.collection.objects.link(empty)
        mine = same_images(scene)
        reddish = (seen[..., 0] > 2 * seen[..., 1]).sum(), (mine[..., 0] > 2 * mine[..., 1]).sum()
        assert 0 < reddish[1] < 0.5 * reddish[0], (way, reddish)  # in the mirror alone
        assert not notes(scene), notes(scene)


@case
def one_mesh_is_seen_and_hidden():
    scene, item = stage()
    other = item.copy()
    other.location, other.visible_camera = (-0.8, 1.6, 0.7), False
    scene.collection.objects.link(other)
    same_images(scene)


@case
def holdouts_are_holes():
    for way in ("object", "collection", "shader", "fog"):
        scene, item = stage()
        scene.render.film_transparent = True
        if way == "collection":
            inner = bpy.data.collections.new("inner")
            scene.collection.children.link(inner)
            scene.collection.objects.unlink(item)
            inner.objects.link(item)
            bpy.context.view_layer.layer_collection.children["inner"].holdout = True
        elif way == "shader":
            item.data.materials[0] = material("ShaderNodeHoldout")[0]
        else:
            item.is_holdout = True
        if way == "fog":
            bpy.ops.mesh.primitive_cube_add(size=0.3, location=(3, 3, 1))
            made = bpy.data.materials.new("fog")
            made.use_nodes = True
            made.node_tree.nodes.clear()
            node = made.node_tree.nodes.new("ShaderNodeVolumeScatter")
            made.node_tree.links.new(node.outputs[0], made.node_tree.nodes.new("ShaderNodeOutputMaterial").inputs["Volume"])
            bpy.context.object.data.materials.append(made)
        same_images(scene)
        alpha, other = (channel(render(scene, engine), "Combined.A") for engine in ("VELO", "CYCLES"))
        assert abs(alpha - other).mean() < 0.01 and (alpha == 0).sum() > 50, (way, abs(alpha - other).mean())
        assert not notes(scene), notes(scene)


@case
def holdouts_of_an_opaque_film_are_listed():
    scene, item = stage()
    item.is_holdout = True
    image = colors(render(scene))
    assert numpy.isfinite(image).all() and any("Holdout" in line for line in notes(scene)), notes(scene)


@case
def what_is_hidden_from_other_rays_is_listed():
    scene, item = stage()
    item.visible_shadow = False
    render(scene)
    assert any("Ray visibility" in line for line in notes(scene)), notes(scene)
