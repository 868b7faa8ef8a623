"""Cases of test_attributes.py: what geometry nodes and scripts store on meshes, read by materials."""
import bpy
import numpy

from inside import add, agrees, ball, case, colors, lamp, material, new_scene, notes, plane, render


def ball_with(kind, domain, values, output="Color"):
    """A ball whose colour is an attribute; values(number) gives one number, or as many as its kind has, for each element."""
    made, node = material("ShaderNodeBsdfDiffuse")
    add(made.node_tree, "ShaderNodeAttribute", node.inputs["Color"], ["Color", "Vector", "Fac"].index(output), attribute_name="tone")
    mesh = ball(made).data
    attribute = mesh.attributes.new("tone", kind, domain)
    member = "color" if kind.endswith("COLOR") else "vector" if kind == "FLOAT_VECTOR" else "value"
    attribute.data.foreach_set(member, numpy.ravel(values(numpy.arange(len(attribute.data)))))
    return made, mesh


def lit_scene():
    scene = new_scene(world=(0.5, 0.5, 0.5))
    lamp(scene, "SUN", 2.0)
    return scene


def waves(number):
    return 0.5 + 0.4 * numpy.sin(numpy.stack((number, 2.3 * number, 0.7 * number), axis=1))


def painted(number):
    return numpy.concatenate((waves(number), numpy.ones((len(number), 1))), axis=1)


@case
def attributes_of_points_corners_and_faces():
    for kind, domain, values, output in (
            ("FLOAT", "POINT", lambda n: 0.5 + 0.5 * numpy.sin(n / 40.0), "Fac"),
            ("FLOAT_VECTOR", "CORNER", waves, "Vector"),
            ("FLOAT_COLOR", "FACE", painted, "Color"),
            ("INT", "FACE", lambda n: (n % 3 == 0).astype(int), "Fac"),
            ("BOOLEAN", "POINT", lambda n: n % 4 == 0, "Fac")):
        scene = lit_scene()
        ball_with(kind, domain, values, output)
        agrees(scene)
        assert not notes(scene), (kind, domain, notes(scene))


@case
def attributes_that_geometry_nodes_store():
    scene = lit_scene()
    made, node = material("ShaderNodeBsdfDiffuse")
    ramp = add(made.node_tree, "ShaderNodeValToRGB", node.inputs["Color"])
    add(made.node_tree, "ShaderNodeAttribute", ramp.inputs[0], 2, attribute_name="height")
    item = plane(made, 4.0)
    tree = bpy.data.node_groups.new("store", "GeometryNodeTree")
    item.modifiers.new("nodes", "NODES").node_group = tree
    tree.inputs.new("NodeSocketGeometry", "Geometry")
    tree.outputs.new("NodeSocketGeometry", "Geometry")
    end = tree.nodes.new("NodeGroupOutput")
    store = add(tree, "GeometryNodeStoreNamedAttribute", end.inputs[0], data_type="FLOAT", Name="height")
    tree.links.new(tree.nodes.new("NodeGroupInput").outputs[0], store.inputs[0])
    value = next(socket for socket in store.inputs if socket.enabled and socket.name == "Value")
    parts = add(tree, "ShaderNodeSeparateXYZ", value)
    add(tree, "GeometryNodeInputPosition", parts.inputs[0])
    agrees(scene)
    assert not notes(scene), notes(scene)


@case
def two_colour_attributes_in_a_material():
    scene = lit_scene()
    made, mesh = ball_with("FLOAT_COLOR", "CORNER", painted)
    tree, node = made.node_tree, made.node_tree.nodes["Diffuse BSDF"]
    first = node.inputs["Color"].links[0].from_socket
    mixed = add(tree, "ShaderNodeMixRGB", node.inputs["Color"], Fac=0.5)
    tree.links.new(first, mixed.inputs[1])
    add(tree, "ShaderNodeVertexColor", mixed.inputs[2], layer_name="second")
    second = mesh.color_attributes.new("second", "BYTE_COLOR", "POINT")
    second.data.foreach_set("color", numpy.ravel(painted(numpy.arange(len(second.data)) / 9.0)))
    agrees(scene)
    assert not notes(scene), notes(scene)


@case
def missing_attributes_are_black():
    """Of two balls with a material one has the attribute."""
    scene = lit_scene()
    made, _ = ball_with("FLOAT_COLOR", "POINT", painted)
    bpy.context.object.location.x = -1.3
    ball(made, (1.3, 0, 1))
    scene.world.node_tree.nodes["Background"].inputs[0].default_value = (0, 0, 0, 1)
    agrees(scene)
    image = colors(render(scene))
    assert image[:, 24:].max() == 0 and image[:, :24].max() > 0.1
    assert any("no attribute tone" in line for line in notes(scene)), notes(scene)
