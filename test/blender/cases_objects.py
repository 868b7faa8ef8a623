"""Cases of test_objects.py: kinds of geometry, and what materials ask of objects and directions, agree with Cycles."""
import os

import bpy
import numpy

from inside import FOLDER, add, agrees, ball, case, colors, lamp, material, new_scene, notes, plane, render

GRAY = (0.8, 0.6, 0.4)


def output_of(made):
    return next(node for node in made.node_tree.nodes if node.type == "OUTPUT_MATERIAL")


def differs(scene):
    """Mean difference of the two images, as a part of the mean of Cycles'."""
    other, mine = (colors(render(scene, engine)) for engine in ("CYCLES", "VELO"))
    return abs(other - mine).mean() / other.mean()


def to_points(item, radius):
    """Geometry nodes that turn a mesh into points."""
    group = bpy.data.node_groups.new("points", "GeometryNodeTree")
    group.inputs.new("NodeSocketGeometry", "Geometry")
    group.outputs.new("NodeSocketGeometry", "Geometry")
    begin, end = (group.nodes.new("NodeGroup" + kind) for kind in ("Input", "Output"))
    points, painted = (group.nodes.new("GeometryNode" + kind) for kind in ("MeshToPoints", "SetMaterial"))
    points.inputs["Radius"].default_value = radius
    painted.inputs["Material"].default_value = item.data.materials[0]
    for one, other in ((begin, points), (points, painted), (painted, end)):
        group.links.new(one.outputs[0], other.inputs[0])
    item.modifiers.new("points", "NODES").node_group = group


@case
def points_are_spheres():
    scene = new_scene(world=(1, 1, 1))
    bpy.ops.mesh.primitive_ico_sphere_add(subdivisions=2, location=(0, 0, 1))
    item = bpy.context.object
    item.scale = (1.2, 1.2, 0.8)
    item.data.materials.append(material("ShaderNodeBsdfDiffuse", Color=GRAY)[0])
    to_points(item, 0.2)
    agrees(scene, 0.005)
    assert differs(scene) < 0.03 and not notes(scene), (differs(scene), notes(scene))


@case
def displacement_moves_vertices():
    for method in ("DISPLACEMENT", "BUMP"):
        scene = new_scene(world=(0.3, 0.3, 0.3))
        made, _ = material("ShaderNodeBsdfDiffuse", Color=GRAY)
        height = add(made.node_tree, "ShaderNodeDisplacement", output_of(made).inputs["Displacement"], Scale=0.5 if method != "BUMP" else 0.1)
        add(made.node_tree, "ShaderNodeTexNoise", height.inputs["Height"], Scale=3.0, Detail=1.0)
        made.cycles.displacement_method = method
        bpy.ops.mesh.primitive_ico_sphere_add(subdivisions=6, location=(0, 0, 1))
        bpy.ops.object.shade_smooth()
        bpy.context.object.data.materials.append(made)
        lamp(scene, "SUN", 3, (0, -4, 4))
        agrees(scene, 0.015)
        smooth = differs(scene)
        assert smooth < 0.06, (method, smooth)
        assert not notes(scene), notes(scene)


@case
def objects_have_random_numbers_places_and_properties():
    scene = new_scene(world=(1, 1, 1))
    made, node = material("ShaderNodeBsdfDiffuse")
    tree = made.node_tree
    mixed = add(tree, "ShaderNodeCombineRGB", node.inputs[0])
    asked = add(tree, "ShaderNodeObjectInfo", mixed.inputs[0], 5)
    assert asked.outputs[5].name == "Random"
    add(tree, "ShaderNodeAttribute", mixed.inputs[1], 2, attribute_type="OBJECT", attribute_name="green")
    place = add(tree, "ShaderNodeSeparateXYZ", mixed.inputs[2])
    tree.links.new(add(tree, "ShaderNodeNewGeometry").outputs["Position"], place.inputs[0])
    first = ball(made, (-1.6, 0, 1), 0.5)
    first["green"] = 0.25
    for k in range(2):
        other = first.copy()
        other.location = (k - 0.6, 0, 1)
        other["green"] = 0.5 + 0.3 * k
        scene.collection.objects.link(other)
    assert differs(scene) < 0.01, differs(scene)
    assert not notes(scene), notes(scene)


@case
def a_sun_has_a_disk_that_mirrors_show():
    scene = new_scene(world=(0.1, 0.1, 0.1))
    ball(material("ShaderNodeBsdfGlossy", Color=(1, 1, 1), distribution="SHARP")[0], (0, 0, 1), 1.5)
    lamp(scene, "SUN", 1, angle=0.2)
    agrees(scene, 0.02)
    scene = new_scene(world=(0.1, 0.1, 0.1))
    plane(material("ShaderNodeBsdfDiffuse", Color=GRAY)[0])
    lamp(scene, "SUN", 3, angle=0.00918)
    agrees(scene, 0.005)
    assert not notes(scene), notes(scene)


@case
def portals_light_nothing():
    scene = new_scene(world=(1, 1, 1))
    plane(material("ShaderNodeBsdfDiffuse", Color=GRAY)[0])
    lamp(scene, "AREA", 500).data.cycles.is_portal = True
    agrees(scene, 0.005)


@case
def tiles_of_an_image():
    scene = new_scene(world=(1, 1, 1))
    image = bpy.data.images.new("tiles", 16, 16, tiled=True)
    for number, color in ((1001, (1, 0, 0, 1)), (1002, (0, 1, 0, 1))):
        plain = bpy.data.images.new("one", 16, 16)
        plain.pixels[:] = color * 256
        plain.filepath_raw, plain.file_format = os.path.join(FOLDER, "tile.%d.png" % number), "PNG"
        plain.save()
        if number > 1001:
            image.tiles.new(number)
    image.source, image.filepath = "TILED", os.path.join(FOLDER, "tile.<UDIM>.png")
    made, node = material("ShaderNodeBsdfDiffuse")
    add(made.node_tree, "ShaderNodeTexImage", node.inputs[0], image=image)
    item = plane(made, 4.0, (0, 0, 0.5))
    for value in item.data.uv_layers[0].data:
        value.uv = (value.uv[0] * 2, value.uv[1])
    agrees(scene, 0.01)
    os.remove(os.path.join(FOLDER, "tile.1002.png"))
    render(scene)
    assert any("tile 1002" in line and "missing" in line for line in notes(scene)), notes(scene)


@case
def a_fresnel_node_mixes_as_paint_and_glass():
    for kind, share in (("ShaderNodeBsdfDiffuse", 0.01), ("ShaderNodeBsdfRefraction", 0.02)):
        scene = new_scene(world=(1, 1, 1))
        plane(material("ShaderNodeBsdfDiffuse", Color=GRAY)[0])
        made, node = material(kind, Color=(0.2, 0.5, 0.8) if share == 0.01 else (1, 1, 1))
        tree = made.node_tree
        if share == 0.02:
            node.distribution, node.inputs["IOR"].default_value = "SHARP", 1.5
        mix, glossy = tree.nodes.new("ShaderNodeMixShader"), add(tree, "ShaderNodeBsdfGlossy", Color=(1, 1, 1, 1), Roughness=0.1)
        add(tree, "ShaderNodeFresnel", mix.inputs[0], IOR=1.5)
        tree.links.new(node.outputs[0], mix.inputs[1])
        tree.links.new(glossy.outputs[0], mix.inputs[2])
        tree.links.new(mix.outputs[0], output_of(made).inputs[0])
        ball(made)
        agrees(scene, share)
        assert not any("Fresnel" in line for line in notes(scene)), notes(scene)


@case
def what_depends_on_rays_is_listed():
    scene = new_scene(world=(1, 1, 1))
    made, node = material("ShaderNodeBsdfDiffuse", Color=GRAY)
    tree = made.node_tree
    mix = tree.nodes.new("ShaderNodeMixShader")
    add(tree, "ShaderNodeLightPath", mix.inputs[0], 1)
    tree.links.new(node.outputs[0], mix.inputs[1])
    add(tree, "ShaderNodeBsdfTransparent", mix.inputs[2])
    tree.links.new(mix.outputs[0], output_of(made).inputs[0])
    ball(made)
    image = colors(render(scene))
    assert any("Light Path" in line for line in notes(scene)), notes(scene)
    assert numpy.isfinite(image).all() and image[24, 24, 2] < 0.7


@case
def highlights_run_as_in_cycles():
    for kind, values in (("ShaderNodeBsdfAnisotropic", {"Roughness": 0.4, "Anisotropy": 0.7}),
                         ("ShaderNodeBsdfPrincipled", {"Metallic": 1.0, "Roughness": 0.35, "Anisotropic": 0.8, "Anisotropic_Rotation": 0.1})):
        scene = new_scene(world=(0.05, 0.05, 0.05))
        ball(material(kind, **values)[0], (0, 0, 0.5), 1.7)
        lamp(scene, "AREA", 500, (3, -4, 5), size=1.0)
        agrees(scene, 0.02)
        assert differs(scene) < 0.08, (kind, differs(scene))


@case
def a_spot_with_a_radius_has_soft_shadows():
    scene = new_scene()
    plane(material("ShaderNodeBsdfDiffuse", Color=GRAY)[0])
    ball(material("ShaderNodeBsdfDiffuse", Color=GRAY)[0])
    lamp(scene, "SPOT", 800, spot_size=1.0, spot_blend=0.3, shadow_soft_size=0.25)
    agrees(scene, 0.01)
    assert differs(scene) < 0.05, differs(scene)


def changed_by(change):
    """What geometry.has_changed says after a change."""
    from velo_blender import geometry
    seen = []

    def look(_scene, depsgraph):
        seen.append(geometry.has_changed(depsgraph))

    bpy.app.handlers.depsgraph_update_post.append(look)
    try:
        change()
        bpy.context.view_layer.update()
    finally:
        bpy.app.handlers.depsgraph_update_post.remove(look)
    return any(seen)


@case
def meshes_are_read_again_where_a_shape_has_changed():
    from velo_blender import export, geometry

    scene = new_scene(world=(0.3, 0.3, 0.3))
    made, shader = material("ShaderNodeBsdfDiffuse", Color=GRAY)
    height = add(made.node_tree, "ShaderNodeDisplacement", output_of(made).inputs["Displacement"], Scale=0.3)
    add(made.node_tree, "ShaderNodeTexNoise", height.inputs["Height"], Scale=3.0, Detail=1.0)
    made.cycles.displacement_method = "DISPLACEMENT"
    bpy.ops.mesh.primitive_ico_sphere_add(subdivisions=4, location=(0, 0, 1))
    bpy.ops.object.shade_smooth()
    item = bpy.context.object
    item.data.materials.append(made)
    sun = lamp(scene, "SUN", 3, (0, -4, 4))
    graph = bpy.context.evaluated_depsgraph_get()

    def image(meshes):
        exported = export.Export(graph, (24, 16), meshes=meshes)
        return numpy.array(exported.scene.render(spp=2, resolution=(24, 16))).tobytes()

    first = geometry.Known()
    image(first)

    def paint():
        shader.inputs["Color"].default_value = (0.1, 0.7, 0.2, 1)

    def reshape():
        item.data.vertices[0].co.z += 0.5
        item.data.update()

    assert not changed_by(paint) and not changed_by(lambda: setattr(sun.data, "energy", 2))
    read, geometry.read = geometry.read, None  # a mesh that is read again is an error
    try:
        again = image(geometry.Known(first))
    finally:
        geometry.read = read
    assert again == image(None)
    assert changed_by(reshape)
