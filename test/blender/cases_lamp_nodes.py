"""Cases of test_lamp_nodes.py: lamps whose nodes differ between directions or places light as in Cycles."""
import bpy

from inside import add, case, colors, lamp, material, new_scene, notes, plane, render

HEAD = "IESNA:LM-63-1995\nTILT=NONE\n1 1000 %g %d %d 1 2 0 0 0 %g 1.0 10\n"
ROUND = HEAD % (1.5, 7, 1, 0.5) + "0 15 30 45 60 75 90\n0\n1000 900 600 300 500 100 0\n"
#: Symmetric about two planes, about one, and not at all.
QUARTER = HEAD % (1, 5, 3, 1) + "0 20 45 70 90\n0 45 90\n1000 900 700 90 0 1000 600 300 60 0 1000 400 100 30 0\n"
HALF = HEAD % (1, 4, 3, 1) + "0 30 60 90\n0 90 180\n800 700 100 0 800 300 80 0 800 100 0 0\n"
WHOLE = HEAD % (1, 3, 5, 1) + "0 40 80\n0 90 180 270 360\n900 800 100 900 100 0 900 300 50 900 600 20 900 800 100\n"


def lit_floor(kind, place=(0.3, 0, 2), energy=30.0, **words):
    """A floor lit by a lamp that is turned: (scene, the lamp's nodes, its emission)."""
    scene = new_scene(samples=200)
    plane(material("ShaderNodeBsdfDiffuse", Color=(0.7, 0.7, 0.7))[0])
    item = lamp(scene, kind, energy, place, **{"shadow_soft_size": 0.0, **words} if kind != "AREA" else words)
    item.rotation_euler = (0.3, 0.2, 0.7)
    item.data.use_nodes = True
    return scene, item.data.node_tree, item.data.node_tree.nodes["Emission"]


def same(scene, share=0.02):
    other, mine = (colors(render(scene, engine)) for engine in ("CYCLES", "VELO"))
    difference = abs(other - mine).mean() / other.mean()
    assert difference < share, "%.4f, means %s and %s" % (difference, other.mean(axis=(0, 1)), mine.mean(axis=(0, 1)))
    assert other.mean() > 0.001


def lamp_file(text):
    made = bpy.data.texts.new("lamp.ies")
    made.write(text)
    return made


@case
def lamp_files_of_each_symmetry():
    for text in (ROUND, QUARTER, HALF, WHOLE):
        for kind in ("POINT", "SPOT"):
            scene, tree, emission = lit_floor(kind)
            add(tree, "ShaderNodeTexIES", emission.inputs["Strength"], ies=lamp_file(text), Strength=0.4)
            same(scene, 0.03)  # of the noise at a spot's edge
            assert not notes(scene), notes(scene)


@case
def files_that_are_no_lamp_files_are_listed():
    for text in ("", "TILT=NONE", "TILT=NONE\n1 1 1 nan 1 1 1 1 1 1", "TILT=NONE\n" + "-1 " * 40, "TILT=NONE\n1 2 three",
                 HEAD % (1, 3, 1, 1) + "0 0 0\n0\n1 1 1", HEAD % (1, 3, 1, 1) + "0 40 80\n0\n1 nan 1", HEAD % (1, 99999, 99999, 1) + "0 1"):
        scene, tree, emission = lit_floor("POINT")
        add(tree, "ShaderNodeTexIES", emission.inputs["Strength"], ies=lamp_file(text))
        assert (colors(render(scene)) >= 0).all()
        assert len(notes(scene)) == 1 and "IES Texture" in notes(scene)[0], (text, notes(scene))
    scene, tree, emission = lit_floor("POINT")
    add(tree, "ShaderNodeTexIES", emission.inputs["Strength"], mode="EXTERNAL", filepath="/missing.ies")
    render(scene)
    assert "/missing.ies is missing" in notes(scene)[0], notes(scene)


@case
def spots_that_project_a_texture():
    """The direction from the lamp, divided by its z, as artists do it."""
    scene, tree, emission = lit_floor("SPOT", spot_size=1.2)
    checker = add(tree, "ShaderNodeTexChecker", emission.inputs["Color"], Scale=3.0, Color1=(1, 0.2, 0.1, 1), Color2=(0.1, 0.3, 1, 1))
    over = add(tree, "ShaderNodeVectorMath", checker.inputs["Vector"], operation="DIVIDE")
    parts = add(tree, "ShaderNodeSeparateXYZ")
    coordinates = add(tree, "ShaderNodeTexCoord", over.inputs[0], 1)
    tree.links.new(coordinates.outputs["Normal"], parts.inputs[0])
    joined = add(tree, "ShaderNodeCombineXYZ", over.inputs[1])
    for socket in joined.inputs:
        tree.links.new(parts.outputs["Z"], socket)
    same(scene, 0.06)  # of the noise at the edges of its squares
    assert not notes(scene), notes(scene)


@case
def area_lights_with_textures():
    for shape in ("RECTANGLE", "ELLIPSE", "DISK"):
        scene, tree, emission = lit_floor("AREA", (0.3, 0, 0.5), shape=shape, size=1.6, size_y=0.9)
        ramp = add(tree, "ShaderNodeTexGradient", emission.inputs["Strength"], 1)
        add(tree, "ShaderNodeNewGeometry", ramp.inputs["Vector"], 5)
        parts = add(tree, "ShaderNodeCombineXYZ", emission.inputs["Color"], X=1.0, Z=0.2)
        split = add(tree, "ShaderNodeSeparateXYZ", parts.inputs["Y"], 1)
        add(tree, "ShaderNodeNewGeometry", split.inputs[0], 5)
        same(scene, 0.05)  # of the noise
        assert not notes(scene), notes(scene)


@case
def wide_spots_and_points_have_colours():
    """Wide spots were gray: their images are the means of the colours."""
    scene, _, emission = lit_floor("SPOT", spot_size=2.9)
    emission.inputs["Color"].default_value = (1, 0.3, 0.1, 1)
    same(scene)
    scene, tree, emission = lit_floor("POINT")
    parts = add(tree, "ShaderNodeVectorMath", emission.inputs["Color"], operation="ABSOLUTE")
    add(tree, "ShaderNodeTexCoord", parts.inputs[0], 1)
    same(scene)
    assert not notes(scene), notes(scene)


@case
def falloff_is_quadratic_or_listed():
    scene, tree, emission = lit_floor("POINT")
    node = add(tree, "ShaderNodeLightFalloff", emission.inputs["Strength"], Strength=2.0)
    same(scene)
    assert not notes(scene), notes(scene)
    tree.links.new(node.outputs["Linear"], emission.inputs["Strength"])
    render(scene)
    assert "square of the distance" in notes(scene)[0], notes(scene)
