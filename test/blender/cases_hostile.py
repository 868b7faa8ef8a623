"""Cases of test_hostile.py: each scene is rendered to finite numbers and says what it left out, or ends with one line."""
import os

import bpy
import numpy

from inside import FOLDER, add, add_object, ball, case, colors, lamp, material, new_scene, notes, plane, render

NAN, HUGE = float("nan"), 1e30


def small():
    scene = new_scene(world=(0.5, 0.5, 0.5), size=(16, 16), samples=4)
    scene.velo.bake_size = 128
    return scene


def said(scene, *texts):
    """The image is finite, and the list has these texts."""
    assert numpy.isfinite(colors(render(scene))).all()
    lines = "\n".join(notes(scene))
    for text in texts:
        assert text in lines, "%r is not in: %s" % (text, lines)


def output_of(tree, name):
    return next(node for node in tree.nodes if node.type == "OUTPUT_MATERIAL").inputs[name]


@case
def numbers_of_subsurface_scattering():
    scene = small()
    made, node = material("ShaderNodeBsdfPrincipled", Subsurface=1.0)
    node.inputs["Subsurface Radius"].default_value = (NAN, HUGE, -1)
    ball(made)
    said(scene, "Subsurface Radius is no finite number")


@case
def numbers_of_volumes():
    for name, value, text in (("Density", NAN, "Density is no finite number"), ("Density", HUGE, ""), ("Anisotropy", 7.0, ""),
                              ("Emission Strength", HUGE, ""), ("Color", (NAN, 2, -3, 1), "Color is no finite number")):
        scene = small()
        made, node = material("ShaderNodeBsdfDiffuse")
        made.node_tree.nodes.remove(node)
        volume = add(made.node_tree, "ShaderNodeVolumePrincipled", output_of(made.node_tree, "Volume"))
        volume.inputs[name].default_value = value
        ball(made)
        said(scene, text)


@case
def numbers_of_displacement():
    for scale, text in ((NAN, "Scale is no finite number"), (1e38, "huge are 0")):
        scene = small()
        made, _ = material("ShaderNodeBsdfDiffuse")
        moved = add(made.node_tree, "ShaderNodeDisplacement", output_of(made.node_tree, "Displacement"), Scale=scale)
        add(made.node_tree, "ShaderNodeTexNoise", moved.inputs["Height"], Scale=3.0)
        made.cycles.displacement_method = "DISPLACEMENT"
        ball(made)
        said(scene, text)
    scene = small()
    made, _ = material("ShaderNodeBsdfDiffuse")
    add(made.node_tree, "ShaderNodeVectorDisplacement", output_of(made.node_tree, "Displacement"))
    ball(made)
    said(scene, "Vector Displacement: displacement by this node is not rendered")


@case
def numbers_of_textures():
    scene = small()
    for kind, values in (("TexVoronoi", {"Scale": HUGE, "distance": "MINKOWSKI", "Exponent": 0.0}), ("TexVoronoi", {"Randomness": NAN}),
                         ("TexBrick", {"Brick_Width": 0.0, "Row_Height": 0.0, "squash": 0.0}),
                         ("TexMusgrave", {"Lacunarity": 0.0, "Dimension": HUGE, "Detail": 1e9, "Offset": HUGE}),
                         ("TexNoise", {"noise_dimensions": "4D", "Detail": 1e9, "Distortion": HUGE, "W": HUGE}),
                         ("TexMagic", {"turbulence_depth": 10, "Distortion": HUGE}), ("TexWave", {"Scale": NAN, "Detail_Scale": HUGE})):
        made, node = material("ShaderNodeBsdfDiffuse")
        add(made.node_tree, "ShaderNode" + kind, node.inputs[0], **values)
        plane(made, 1.0, (0, 0, 1))
    said(scene, "Voronoi Texture: Randomness is no finite number", "Wave Texture: Scale is no finite number")


@case
def lamps_and_objects_that_are_too_large():
    scene = small()
    ball(material("ShaderNodeBsdfDiffuse")[0])
    lamp(scene, "POINT", 10, shadow_soft_size=HUGE).name = "large"
    lamp(scene, "AREA", 10, size=NAN).name = "none"
    lamp(scene, "SUN", NAN).name = "sun"
    lamp(scene, "SUN", 1).data.angle = NAN
    far = ball(material("ShaderNodeBsdfDiffuse")[0])
    far.name, far.location.x = "far", HUGE
    said(scene, "large: its radius is huge", "none: its size is huge", "sun: its colour or power", "far: it is too large or too far away")


@case
def points_curves_and_tiles_that_are_nothing():
    scene = small()
    for name, data in (("hair", bpy.data.hair_curves.new("hair")), ("curve", bpy.data.curves.new("curve", "CURVE"))):
        add_object(scene, name, data)
    made, node = material("ShaderNodeBsdfDiffuse")
    image = bpy.data.images.new("tiles", 8, 8, tiled=True)
    image.source, image.filepath = "TILED", "/nowhere/x.<UDIM>.png"
    add(made.node_tree, "ShaderNodeTexImage", node.inputs[0], image=image)
    plane(made, 1.0)
    made, node = material("ShaderNodeBsdfDiffuse")
    plane(made, 1.0)["green"] = "text"
    add(made.node_tree, "ShaderNodeAttribute", node.inputs[0], 2, attribute_type="OBJECT", attribute_name="green")
    said(scene, "x.1001.png is missing", "none of the image's tiles", "no property green of numbers")


@case
def shaders_that_velo_has_not_keep_their_color():
    scene = small()
    ball(material("ShaderNodeBsdfToon", Color=(0.9, 0.1, 0.1))[0], (0, 0, 0.5), 1.7)
    said(scene, "Toon BSDF); it is diffuse")
    image = colors(render(scene))
    assert image[8, 8, 0] > 0.3 and image[8, 8, 1] < 0.1, image[8, 8]


@case
def settings_that_velo_does_not_have():
    scene = small()
    c = scene.cycles
    c.sample_clamp_direct, c.sample_clamp_indirect, c.blur_glossy, c.caustics_reflective, c.use_fast_gi = 1.0, 10.0, 1.0, False, True
    c.rolling_shutter_type, scene.render.use_motion_blur = "TOP", True
    scene.render.use_simplify, c.texture_limit_render, c.use_camera_cull = True, "128", True
    scene.render.motion_blur_shutter_curve.curves[0].points[0].location.y = 0
    scene.render.use_freestyle = False
    c.feature_set = "EXPERIMENTAL"
    scene.world.cycles_visibility.glossy = False
    scene.world.cycles.max_bounces = 1
    layer = bpy.context.view_layer
    layer.use_pass_mist = layer.use_pass_diffuse_direct = layer.cycles.use_pass_shadow_catcher = True
    layer.aovs.add().name = "mask"
    item = ball(material("ShaderNodeBsdfDiffuse")[0])
    held = bpy.data.collections.new("held")
    scene.collection.children.link(held)
    held.objects.link(item)
    scene.collection.objects.unlink(item)
    layer.layer_collection.children["held"].holdout = True
    item.visible_volume_scatter, item.cycles.use_adaptive_subdivision, item.cycles.shadow_terminator_offset = False, True, 0.5
    light = lamp(scene, "POINT", 10)
    light.visible_glossy, light.data.cycles.cast_shadow, light.data.cycles.max_bounces = False, False, 0
    made, node = material("ShaderNodeBsdfPrincipled", Alpha=0.5)
    made.name, made.cycles.use_transparent_shadow = "pane", False
    plane(made, 1.0)
    said(scene, "Clamp direct: ", "Clamp indirect: ", "Filter glossy: ", "Reflective caustics: ", "Fast GI: ", "Rolling shutter: ",
         "Shutter curve: ", "Texture limit: ", "Culling: ", "world, Ray visibility: ", "world, Max bounces: ", "Pass Mist: ",
         "Pass Diffuse Direct: ", "Pass Shadow Catcher: ", "Shader AOV mask: ", "Sphere, Holdout: ",
         "Sphere, Ray visibility: ", "Adaptive subdivision: ", "Shadow terminator: ", "lamp, Ray visibility: ", "lamp, Cast shadow: ",
         "lamp, Max bounces: ", "pane, Transparent shadows: ")


@case
def colors_and_indices_beyond_what_velo_has():
    scene = small()
    ball(material("ShaderNodeBsdfDiffuse", Color=(3.0, 0.5, 0.5))[0])
    ball(material("ShaderNodeBsdfGlass", IOR=0.7)[0], (2, 0, 1))
    made, node = material("ShaderNodeBsdfPrincipled", Metallic=7.0, Roughness=-1.0, Alpha=2.0, Transmission=-3.0)
    scaled = add(made.node_tree, "ShaderNodeVectorMath", node.inputs["Base Color"], operation="SCALE", Scale=4.0)
    add(made.node_tree, "ShaderNodeTexNoise", scaled.inputs[0], 1)
    plane(made, 1.0, (-2, 0, 1))
    said(scene, "Diffuse BSDF: Color has values above 1, up to 3; they are 1", "an index of refraction of 0.7 is 1",
         "Principled BSDF: Base Color has values above 1")


@case
def a_sky_whose_strength_is_no_number():
    scene = small()
    tree = scene.world.node_tree
    add(tree, "ShaderNodeTexSky", tree.nodes["Background"].inputs["Color"], sky_type="PREETHAM")
    tree.nodes["Background"].inputs["Strength"].default_value = NAN
    ball(material("ShaderNodeBsdfDiffuse")[0])
    said(scene, "Background: Strength is no finite number; the world is black")


@case
def missing_libraries_and_circles():
    folder = os.path.join(FOLDER, "linked")
    os.makedirs(folder, exist_ok=True)
    scene = small()
    item, kept = ball(material("ShaderNodeBsdfDiffuse")[0]), bpy.data.collections.new("kept")
    kept.objects.link(item)
    library, file = os.path.join(folder, "library.blend"), os.path.join(folder, "file.blend")
    bpy.data.libraries.write(library, {kept})
    scene = small()
    with bpy.data.libraries.load(library, link=True) as (_, loaded):
        loaded.collections = ["kept"]
    scene.collection.children.link(loaded.collections[0])
    bpy.ops.wm.save_as_mainfile(filepath=file)
    os.remove(library)
    bpy.ops.wm.open_mainfile(filepath=file)
    said(bpy.context.scene, "library.blend is missing")
    scene = small()
    made, node = material("ShaderNodeBsdfPrincipled")
    first = add(made.node_tree, "ShaderNodeMath", node.inputs["Roughness"])
    second = add(made.node_tree, "ShaderNodeMath", first.inputs[0])
    made.node_tree.links.new(first.outputs[0], second.inputs[0])
    ball(made)
    said(scene, "closes a circle of nodes")


@case
def a_hundred_groups_of_shaders():
    """Each mixes the one in it with blue."""
    scene = small()
    inner = None
    for number in range(100):
        tree = bpy.data.node_groups.new("group", "ShaderNodeTree")
        tree.outputs.new("NodeSocketShader", "Shader")
        mixed = add(tree, "ShaderNodeMixShader", tree.nodes.new("NodeGroupOutput").inputs[0], Fac=0.02)
        add(tree, "ShaderNodeBsdfDiffuse", mixed.inputs[2], Color=(0.1, 0.1, 0.8, 1))
        if inner is None:
            add(tree, "ShaderNodeBsdfDiffuse", mixed.inputs[1], Color=(0.8, 0.1, 0.1, 1))
        else:
            tree.links.new(add(tree, "ShaderNodeGroup", node_tree=inner).outputs[0], mixed.inputs[1])
        inner = tree
    made, node = material("ShaderNodeBsdfDiffuse")
    made.node_tree.links.new(add(made.node_tree, "ShaderNodeGroup", node_tree=inner).outputs[0], output_of(made.node_tree, "Surface"))
    ball(made)
    said(scene)
    assert not notes(scene), notes(scene)
