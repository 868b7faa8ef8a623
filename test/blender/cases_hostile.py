"""Cases of test_hostile.py: each scene is rendered to finite numbers and says what it left out, or ends with one line."""
import bpy
import numpy

from inside import add, add_object, ball, case, colors, lamp, material, new_scene, notes, plane, render

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
