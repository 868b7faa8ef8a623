"""Cases of test_textures.py: textures and nodes agree with Cycles."""
import bpy
import numpy

from inside import add, agrees, ball, case, colors, lamp, material, new_scene, notes, plane, render

COORDINATES = ("UV", "Object", "Generated")


def painted(build, kind="ShaderNodeBsdfDiffuse", world=(1, 1, 1), shape=plane):
    """A plane or a ball whose material build(tree, node, object) completes."""
    scene = new_scene(world=world)
    made, node = material(kind)
    item = plane(made, 4.0, (0, 0, 0.5)) if shape is plane else ball(made)
    build(made.node_tree, node, item)
    return scene


def coordinates(tree, node, name):
    tree.links.new(add(tree, "ShaderNodeTexCoord").outputs[name], node.inputs["Vector"])


def grid():
    image = bpy.data.images.new("grid", 128, 128)
    image.generated_type = "COLOR_GRID"
    return image


@case
def images_with_each_extension():
    for extension in ("REPEAT", "EXTEND", "CLIP"):
        def build(tree, node, item, extension=extension):
            picture = add(tree, "ShaderNodeTexImage", node.inputs[0], image=grid(), extension=extension)
            mapping = add(tree, "ShaderNodeMapping", picture.inputs["Vector"], Scale=(2, 3, 1), Location=(0.3, -0.2, 0), Rotation=(0, 0, 0.4))
            coordinates(tree, mapping, "UV")
        agrees(painted(build), 0.005)


@case
def an_image_that_emits():
    agrees(painted(lambda tree, node, item: add(tree, "ShaderNodeTexImage", node.inputs[0], image=grid()), "ShaderNodeEmission"), 0.01)


@case
def noise_and_checker_on_each_coordinate():
    for name in COORDINATES:
        def build(tree, node, item, name=name):
            mix = add(tree, "ShaderNodeMixRGB", node.inputs[0], blend_type="MULTIPLY", Fac=0.7)
            noise = add(tree, "ShaderNodeTexNoise", mix.inputs[1], 1, Scale=3.0, Detail=2.5, Distortion=0.5)
            checker = add(tree, "ShaderNodeTexChecker", mix.inputs[2], Scale=4.0)
            coordinates(tree, noise, name)
            coordinates(tree, checker, name)
        scene = painted(build)
        agrees(scene, 0.003)
        assert not notes(scene), notes(scene)


@case
def a_ramp_of_a_gradient_on_a_ball():
    def build(tree, node, item):
        ramp = add(tree, "ShaderNodeValToRGB", node.inputs[0])
        ramp.color_ramp.elements[0].color = (1, 0, 0, 1)
        add(tree, "ShaderNodeTexGradient", ramp.inputs[0])
    agrees(painted(build, shape=ball), 0.003)


@case
def vertex_colors():
    def build(tree, node, item):
        colors = item.data.color_attributes.new("paint", "FLOAT_COLOR", "CORNER")
        for i, value in enumerate(colors.data):
            value.color = (i / 4, 1 - i / 4, 0.5, 1)
        add(tree, "ShaderNodeVertexColor", node.inputs[0], layer_name="paint")
    agrees(painted(build), 0.003)


@case
def a_second_uv_map():
    def build(tree, node, item):
        other = item.data.uv_layers.new(name="other")
        for value in other.data:
            value.uv = (value.uv[0] * 0.3, value.uv[1] * 0.3)
        picture = add(tree, "ShaderNodeTexImage", node.inputs[0], image=grid())
        add(tree, "ShaderNodeUVMap", picture.inputs["Vector"], uv_map="other")
    agrees(painted(build), 0.005)


@case
def small_bumps():
    def build(tree, node, item):
        bump = add(tree, "ShaderNodeBump", node.inputs["Normal"], Distance=0.3)
        noise = add(tree, "ShaderNodeTexNoise", bump.inputs["Height"], Scale=3.0, Detail=0.0)
        coordinates(tree, noise, "UV")
    scene = painted(build, world=(0, 0, 0))
    lamp(scene, "SUN", 3, (3, 0, 3.5))
    agrees(scene, 0.015)


@case
def transparency_by_a_texture():
    def build(tree, node, item):
        checker = add(tree, "ShaderNodeTexChecker", node.inputs["Alpha"], 1, Scale=4.0)
        coordinates(tree, checker, "UV")
    scene = painted(build, "ShaderNodeBsdfPrincipled", world=(0.7, 0.7, 0.7))
    agrees(scene, 0.01)


@case
def the_world_of_an_image():
    scene = painted(lambda tree, node, item: None, shape=ball)
    image = bpy.data.images.new("sky", 128, 64, float_buffer=True)
    y, x = numpy.mgrid[0:64, 0:128]
    pixels = numpy.stack((x / 64, y / 64, 3.0 * ((x > 50) & (y > 30)), numpy.ones_like(x)), axis=2)
    image.pixels.foreach_set(pixels.astype(numpy.float32).ravel())
    tree = scene.world.node_tree
    picture = add(tree, "ShaderNodeTexEnvironment", tree.nodes["Background"].inputs[0], image=image)
    mapping = add(tree, "ShaderNodeMapping", picture.inputs["Vector"], Rotation=(0, 0, 1))
    coordinates(tree, mapping, "Generated")
    agrees(scene, 0.01)


@case
def what_depends_on_the_view_is_listed():
    def build(tree, node, item):
        add(tree, "ShaderNodeFresnel", node.inputs[0])
    scene = painted(build)
    render(scene)
    assert any("Fresnel" in line for line in notes(scene)), notes(scene)


@case
def magnified_images_keep_their_mean():
    """Black and white squares of 8 bits in sRGB, seen large: half of white, as of an image of 32 bits in Cycles."""
    for floats, share in ((True, 0.01), (False, None)):
        scene = new_scene(samples=16)
        image = bpy.data.images.new("squares", 4, 4, float_buffer=floats)
        pixels = numpy.ones((4, 4, 4), dtype=numpy.float32)
        pixels[..., :3] = (numpy.indices((4, 4)).sum(axis=0) % 2)[..., None]
        image.pixels.foreach_set(pixels.ravel())
        image.pack()
        made, node = material("ShaderNodeEmission")
        picture = made.node_tree.nodes.new("ShaderNodeTexImage")
        picture.image = image
        made.node_tree.links.new(picture.outputs[0], node.inputs[0])
        plane(made, size=3)
        scene.camera.location, scene.camera.rotation_euler = (0, 0, 6), (0, 0, 0)
        scene.camera.data.lens = 75
        assert abs(colors(render(scene))[4:44, 4:44].mean() - 0.5) < 0.02
        if share is not None:
            agrees(scene, share)


@case
def clipped_images_are_not_there_beyond_their_edges():
    """A decal: an image without alpha, smaller than its plane, whose output Alpha is the material's."""
    scene = new_scene(world=(0.6, 0.6, 0.6))
    image = bpy.data.images.new("decal", 8, 8)
    image.pixels.foreach_set(numpy.tile(numpy.array((0.8, 0.2, 0.1, 1), dtype=numpy.float32), 64))
    made, node = material("ShaderNodeBsdfPrincipled", Roughness=0.8)
    tree = made.node_tree
    picture = tree.nodes.new("ShaderNodeTexImage")
    picture.image, picture.extension = image, "CLIP"
    mapping = tree.nodes.new("ShaderNodeMapping")
    mapping.inputs["Scale"].default_value = (2, 2, 1)
    tree.links.new(tree.nodes.new("ShaderNodeTexCoord").outputs["UV"], mapping.inputs[0])
    tree.links.new(mapping.outputs[0], picture.inputs[0])
    tree.links.new(picture.outputs["Color"], node.inputs["Base Color"])
    tree.links.new(picture.outputs["Alpha"], node.inputs["Alpha"])
    plane(made, 3.0, (0, 0, 0.5))
    agrees(scene, 0.01)
    assert not notes(scene), notes(scene)
