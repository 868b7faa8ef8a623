"""Cases of test_shaders.py: shaders and their sockets as artists wire them: emission that varies, normal maps, muted nodes, occlusion."""
import time

import bpy
import numpy

from inside import add, agrees, ball, case, colors, lamp, material, new_scene, notes, plane, render

GRAY = (0.6, 0.6, 0.6)


def floor():
    plane(material("ShaderNodeBsdfDiffuse", Color=GRAY)[0])


def image_of(color):
    image = bpy.data.images.new("image", 8, 8, float_buffer=True)
    image.colorspace_settings.name = "Non-Color"
    image.pixels.foreach_set(numpy.tile(numpy.array((*color, 1), dtype=numpy.float32), 64))
    return image


@case
def emission_whose_strength_varies():
    scene = new_scene()
    floor()
    made, node = material("ShaderNodeEmission", Color=(1, 0.5, 0.2))
    spread = add(made.node_tree, "ShaderNodeMapRange", node.inputs["Strength"], To_Max=8.0)
    add(made.node_tree, "ShaderNodeTexChecker", spread.inputs["Value"], 1, Scale=5.0)
    ball(made, (0, 0, 1.2), 0.7)
    agrees(scene)
    assert not notes(scene), notes(scene)


@case
def emission_that_a_texture_mixes():
    scene = new_scene()
    floor()
    made, node = material("ShaderNodeMixShader")
    add(made.node_tree, "ShaderNodeTexGradient", node.inputs[0], 1)
    add(made.node_tree, "ShaderNodeEmission", node.inputs[1], Color=(0.1, 0.8, 0.1, 1), Strength=4.0)
    add(made.node_tree, "ShaderNodeEmission", node.inputs[2], Color=(1, 0.1, 0.1, 1), Strength=1.0)
    ball(made, (0, 0, 1.2), 0.7)
    agrees(scene)
    assert not notes(scene), notes(scene)


@case
def emission_of_painted_vertices():
    scene = new_scene()
    floor()
    made, node = material("ShaderNodeBsdfPrincipled", Emission_Strength=3.0, Specular=0.0)
    add(made.node_tree, "ShaderNodeVertexColor", node.inputs["Emission"], layer_name="paint")
    item = plane(made, 1.5, (0, 0.5, 1))
    item.rotation_euler = (1.2, 0, 0)
    paint = item.data.color_attributes.new("paint", "FLOAT_COLOR", "CORNER")
    paint.data.foreach_set("color", numpy.array([[1, 0, 0, 1], [0, 1, 0, 1], [0, 0, 2, 1], [1, 1, 0, 1]], dtype=numpy.float32).ravel())
    agrees(scene)


@case
def normal_maps_have_the_strength_of_cycles():
    # Towards the light, where Cycles does not soften the shadows of bumps.
    for strength, color in ((1.0, (0.8, 0.5, 0.85)), (0.5, (0.95, 0.5, 0.7)), (0.5, (0.5, 0.05, 0.7)), (1.5, (0.75, 0.45, 0.85))):
        scene = new_scene(samples=16)
        made, node = material("ShaderNodeBsdfDiffuse", Color=GRAY)
        bend = add(made.node_tree, "ShaderNodeNormalMap", node.inputs["Normal"], Strength=strength)
        add(made.node_tree, "ShaderNodeTexImage", bend.inputs["Color"], image=image_of(color))
        plane(made, 8)
        lamp(scene, "SUN", 2, (2, -2, 3))
        agrees(scene, 0.02)


@case
def unlinked_inputs_of_muted_nodes_are_nothing():
    scene = new_scene(world=(0.5, 0.5, 0.5), samples=16)
    made, node = material("ShaderNodeBsdfDiffuse")
    add(made.node_tree, "ShaderNodeMixRGB", node.inputs["Color"], Color1=(0.1, 0.8, 0.3, 1)).mute = True
    ball(made)
    made, node = material("ShaderNodeBsdfDiffuse", Color=(0.9, 0.1, 0.1))
    muted = add(made.node_tree, "ShaderNodeInvert", node.inputs["Color"])
    muted.mute = True
    add(made.node_tree, "ShaderNodeRGB", muted.inputs["Color"]).outputs[0].default_value = (0.2, 0.7, 0.3, 1)
    ball(made, (2, 0, 1))
    agrees(scene, 0.005)


@case
def random_numbers_of_geometry_nodes():
    scene = new_scene(world=(1, 1, 1), samples=64)
    bpy.ops.mesh.primitive_cube_add(size=0.25, location=(50, 0, 0))
    kid = bpy.context.object
    made, node = material("ShaderNodeEmission")
    add(made.node_tree, "ShaderNodeObjectInfo", node.inputs["Strength"], 5)
    kid.data.materials.append(made)
    bpy.ops.mesh.primitive_grid_add(x_subdivisions=8, y_subdivisions=8, size=4)
    group = bpy.data.node_groups.new("scatter", "GeometryNodeTree")
    group.inputs.new("NodeSocketGeometry", "Geometry")
    group.outputs.new("NodeSocketGeometry", "Geometry")
    begin, end, known, placed = (group.nodes.new(kind) for kind in (
        "NodeGroupInput", "NodeGroupOutput", "GeometryNodeObjectInfo", "GeometryNodeInstanceOnPoints"))
    known.inputs[0].default_value = kid
    known.inputs["As Instance"].default_value = True
    for output, socket in ((begin.outputs[0], placed.inputs["Points"]), (known.outputs["Geometry"], placed.inputs["Instance"]),
                           (placed.outputs[0], end.inputs[0])):
        group.links.new(output, socket)
    bpy.context.object.modifiers.new("scatter", "NODES").node_group = group
    other, mine = (colors(render(scene, engine)) for engine in ("CYCLES", "VELO"))
    assert abs(other - mine).mean() < 0.01, abs(other - mine).mean()


@case
def occlusion_keeps_its_color():
    scene = new_scene(world=(0.5, 0.5, 0.5), samples=16)
    made, node = material("ShaderNodeBsdfDiffuse", Color=GRAY)
    add(made.node_tree, "ShaderNodeAmbientOcclusion", node.inputs["Color"], Color=(0.9, 0.2, 0.1, 1))
    ball(made)
    image = colors(render(scene))
    assert image[24, 24, 0] > 3 * image[24, 24, 1]
    assert any("nothing is occluded" in line for line in notes(scene)), notes(scene)


@case
def settings_of_film_and_view_layer():
    def scene_of(samples=64):
        scene = new_scene(world=(0.5, 0.5, 0.5), samples=samples)
        plane(material("ShaderNodeBsdfDiffuse", Color=GRAY)[0])
        ball(material("ShaderNodeBsdfDiffuse", Color=(0.8, 0.2, 0.1))[0])
        lamp(scene, "POINT", 100)
        return scene

    scene = scene_of()
    scene.cycles.film_exposure = 2.5
    bpy.context.view_layer.material_override = material("ShaderNodeBsdfDiffuse", Color=(0.1, 0.7, 0.2))[0]
    agrees(scene, 0.005)
    scene = scene_of()
    bpy.context.view_layer.use_sky = False
    agrees(scene, 0.01)
    scene = scene_of(256)
    scene.cycles.pixel_filter_type = "BOX"
    other, mine = (colors(render(scene, engine)) for engine in ("CYCLES", "VELO"))
    assert abs(other - mine).mean() < 0.01 * other.mean(), abs(other - mine).mean() / other.mean()
    assert not notes(scene), notes(scene)
    scene.cycles.pixel_filter_type = "GAUSSIAN"
    render(scene)
    assert any("Pixel filter: it is a Gaussian" in line for line in notes(scene)), notes(scene)


@case
def objects_whose_blur_is_off():
    scene = new_scene(world=(0.5, 0.5, 0.5))
    scene.render.use_motion_blur = True
    scene.frame_set(2)
    item = ball(material("ShaderNodeBsdfDiffuse", Color=(0.8, 0.2, 0.1))[0])
    for frame, x in ((1, -2.0), (3, 2.0)):
        item.location.x = x
        item.keyframe_insert("location", frame=frame)
    item.cycles.use_motion_blur = False
    scene.frame_set(2)
    other, mine = (colors(render(scene, engine)) for engine in ("CYCLES", "VELO"))
    assert abs(other - mine).mean() < 0.02 * other.mean(), abs(other - mine).mean() / other.mean()


@case
def lamps_do_not_stand_in_the_way_of_light():
    for kind, values in (("AREA", {"size": 3.0}), ("AREA", {"shape": "DISK", "size": 3.0}), ("POINT", {"shadow_soft_size": 1.0})):
        scene = new_scene(world=(1, 1, 1))
        floor()
        ball(material("ShaderNodeBsdfGlossy", Roughness=0.1)[0], (0, 1, 0.6), 0.6)
        lamp(scene, kind, 30, (0, -2, 4), **values)
        agrees(scene, 0.003)


@case
def images_on_boxes_and_by_other_objects():
    for projection, place in (("BOX", None), ("BOX", (0.3, 0.1, 0.2)), ("FLAT", (-0.5, 0.2, 0.4))):
        scene = new_scene(world=(0.5, 0.5, 0.5))
        floor()
        made, node = material("ShaderNodeBsdfDiffuse")
        image = bpy.data.images.new("checks", 8, 8)
        values = numpy.ones((8, 8, 4), dtype=numpy.float32)
        values[..., :3] = numpy.random.default_rng(1).random((8, 8, 3))
        image.pixels.foreach_set(values.ravel())
        picture = add(made.node_tree, "ShaderNodeTexImage", node.inputs["Color"], image=image, projection=projection, interpolation="Closest",
                      projection_blend=0.3)
        where = add(made.node_tree, "ShaderNodeTexCoord", picture.inputs["Vector"], 3)
        if place is not None:
            where.object = bpy.data.objects.new("empty", None)
            where.object.location, where.object.rotation_euler, where.object.scale = place, (0.3, 0.2, 0.5), (0.7, 0.7, 0.7)
            scene.collection.objects.link(where.object)
        bpy.ops.mesh.primitive_ico_sphere_add(subdivisions=2, location=(0, 0, 1))
        bpy.context.object.data.materials.append(made)
        other, mine = (colors(render(scene, engine)) for engine in ("CYCLES", "VELO"))
        assert abs(other - mine).mean() < 0.03 * other.mean(), (projection, place, abs(other - mine).mean() / other.mean())
        assert not notes(scene), notes(scene)


@case
def light_passes_tinted_panes():
    for tint, factor in (((0.9, 0.95, 0.8), 0.0), ((1.0, 0.7, 0.4), 0.4)):
        scene = new_scene(world=(0.3, 0.3, 0.3), samples=256)
        floor()
        made, node = material("ShaderNodeMixShader")
        node.inputs[0].default_value = factor
        add(made.node_tree, "ShaderNodeBsdfTransparent", node.inputs[1], Color=(*tint, 1))
        add(made.node_tree, "ShaderNodeBsdfDiffuse", node.inputs[2], Color=(0.2, 0.3, 0.8, 1))
        plane(made, 2.0, (0, 0, 1))
        lamp(scene, "SUN", 3, (0, -1, 4), angle=0.02)
        agrees(scene)
        assert [line.partition(", ")[2] for line in notes(scene)] == [
            "Transparent BSDF: the light of lamps without a size passes it without its tint"], notes(scene)


@case
def what_is_baked_by_triangles_is_not_blurred():
    scene = new_scene(world=(1, 1, 1), size=(12, 12), samples=256, bounces=0)
    made, node = material("ShaderNodeBsdfDiffuse")
    ramp = add(made.node_tree, "ShaderNodeValToRGB", node.inputs["Color"])
    ramp.color_ramp.elements[0].color, ramp.color_ramp.elements[1].color = (0.1, 0.1, 0.5, 1), (0.9, 0.9, 0.9, 1)
    parts = add(made.node_tree, "ShaderNodeSeparateXYZ", ramp.inputs[0], 2)
    add(made.node_tree, "ShaderNodeNewGeometry", parts.inputs[0], 1)
    ball(made, (0, 0, 0.5), 2.0)
    other, mine = (colors(render(scene, engine)) for engine in ("CYCLES", "VELO"))
    assert abs(mine - other).mean() < 0.015 * other.mean(), abs(mine - other).mean() / other.mean()


@case
def back_faces_are_listed():
    scene = new_scene(world=(0.5, 0.5, 0.5), samples=16)
    made, node = material("ShaderNodeBsdfDiffuse")
    mix = add(made.node_tree, "ShaderNodeMixRGB", node.inputs["Color"], Color1=(0.1, 0.8, 0.1, 1), Color2=(0.8, 0.1, 0.1, 1))
    add(made.node_tree, "ShaderNodeNewGeometry", mix.inputs[0], 6)
    ball(made)
    agrees(scene)
    assert notes(scene) == ["material, Geometry: back faces are as front faces"], notes(scene)


@case
def hair_of_an_emitter_that_is_not_shown():
    scene = new_scene(world=(0.5, 0.5, 0.5))
    floor()
    item = ball(material("ShaderNodeBsdfDiffuse", Color=(0.2, 0.5, 0.2))[0])
    options = item.modifiers.new("hair", "PARTICLE_SYSTEM").particle_system.settings
    options.type, options.count, options.hair_length, options.radius_scale = "HAIR", 300, 0.5, 0.05
    item.show_instancer_for_render = False
    other, mine = (colors(render(scene, engine)) for engine in ("CYCLES", "VELO"))
    assert abs(mine - other).mean() < 0.05 * other.mean(), abs(mine - other).mean() / other.mean()


@case
def baking_can_be_ended():
    from velo_blender import export
    scene = new_scene()
    scene.velo.bake_size = 2048
    made, node = material("ShaderNodeBsdfDiffuse")
    picture = add(made.node_tree, "ShaderNodeTexNoise", node.inputs["Color"], 1, Detail=15.0)
    add(made.node_tree, "ShaderNodeTexCoord", picture.inputs["Vector"], 2)
    plane(made)
    begin = time.monotonic()
    try:
        export.Export(bpy.context.evaluated_depsgraph_get(), (48, 48), lambda: time.monotonic() - begin > 0.2)
    except export.Cancelled:
        assert time.monotonic() - begin < 2, time.monotonic() - begin
        return
    raise AssertionError("the export was not ended")


@case
def reflections_have_the_tint_of_the_base():
    """The tint of blue is 2.9 in blue: its reflection was a third of Cycles', and the image 12 % darker."""
    for rough in (0.2, 0.6):
        scene = new_scene()
        ball(material("ShaderNodeBsdfPrincipled", Base_Color=(0.1, 0.2, 0.6), Specular_Tint=1.0, Specular=1.0, Roughness=rough)[0])
        lamp(scene, "AREA", 300, (3, -3, 4), size=2.0)
        agrees(scene, 0.06)
        assert not notes(scene), notes(scene)
