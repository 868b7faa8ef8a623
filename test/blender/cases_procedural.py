"""Cases of test_procedural.py: a plane that emits a texture is the same image in Cycles and in velo."""
import bpy

from inside import case, colors, material, new_scene, notes, plane, render


def shown(kind, output="Color", inputs=None, coordinate="Object", fed="Vector", scale=1.0, prepare=None, **properties):
    """A plane across the view that emits an output of a node: mean difference of the images as a part of the mean, and the scene. fed: the
    input that coordinates times scale feed; prepare: a function of the node."""
    scene = new_scene(samples=32, size=(32, 32))
    scene.velo.bake_size = 256
    made, node = material("ShaderNodeEmission")
    tree = made.node_tree
    texture = tree.nodes.new(kind)
    for name, value in properties.items():
        setattr(texture, name, value)
    for name, value in (inputs or {}).items():
        texture.inputs[name].default_value = value
    if prepare is not None:
        prepare(texture)
    into = next((socket for socket in texture.inputs if socket.enabled and socket.name == fed), None)
    if into is not None and coordinate is not None:
        mapping = tree.nodes.new("ShaderNodeMapping")
        mapping.inputs["Location"].default_value = (0.31, 0.17, 0.43)
        mapping.inputs["Scale"].default_value = (scale, scale, scale)
        tree.links.new(tree.nodes.new("ShaderNodeTexCoord").outputs[coordinate], mapping.inputs["Vector"])
        tree.links.new(mapping.outputs[0], into)
    raised = tree.nodes.new("ShaderNodeMixRGB")  # emission has no negative colours
    raised.blend_type, raised.inputs[0].default_value, raised.inputs[2].default_value = "ADD", 1.0, (2, 2, 2, 1)
    tree.links.new(next(socket for socket in texture.outputs if socket.enabled and socket.name == output), raised.inputs[1])
    tree.links.new(raised.outputs[0], node.inputs["Color"])
    plane(made, 8.0, (0, 0, 0.5)).rotation_euler = scene.camera.rotation_euler
    other, mine = (colors(render(scene, engine)) for engine in ("CYCLES", "VELO"))
    return abs(other - mine).mean() / max(other.mean(), 1e-3), scene


def same(kind, share=0.01, **words):
    difference, scene = shown(kind, **words)
    assert not notes(scene), notes(scene)
    assert difference < share, "%s %s: %.4f" % (kind, words, difference)


@case
def voronoi_of_each_feature_and_metric():
    for feature in ("F1", "F2", "SMOOTH_F1"):
        for output in ("Distance", "Color"):
            same("ShaderNodeTexVoronoi", 0.01, output=output, feature=feature, inputs={"Scale": 0.8, "Randomness": 0.9})
    same("ShaderNodeTexVoronoi", output="Distance", feature="DISTANCE_TO_EDGE", inputs={"Scale": 0.8})
    same("ShaderNodeTexVoronoi", 0.01, output="Radius", feature="N_SPHERE_RADIUS", inputs={"Scale": 0.8})
    for metric in ("MANHATTAN", "CHEBYCHEV", "MINKOWSKI"):
        same("ShaderNodeTexVoronoi", output="Distance", distance=metric, inputs={"Scale": 0.8, "Exponent": 0.7})


@case
def voronoi_and_noise_of_each_dimension():
    for count in ("1D", "2D", "4D"):
        words = {"W": 0.7, "Scale": 0.8} if count != "2D" else {"Scale": 0.8}
        same("ShaderNodeTexVoronoi", 0.01, output="Color", voronoi_dimensions=count, inputs=words)
        same("ShaderNodeTexNoise", noise_dimensions=count, inputs={**words, "Distortion": 0.5})
        same("ShaderNodeTexMusgrave", 0.01, output="Fac", musgrave_dimensions=count, inputs=words)


@case
def musgrave_of_each_kind():
    for kind in ("MULTIFRACTAL", "RIDGED_MULTIFRACTAL", "HYBRID_MULTIFRACTAL", "FBM", "HETERO_TERRAIN"):
        same("ShaderNodeTexMusgrave", 0.01, output="Fac", musgrave_type=kind, inputs={"Scale": 0.6, "Detail": 2.5, "Offset": 0.4})


@case
def waves_bricks_and_magic():
    same("ShaderNodeTexWave", 0.02, inputs={"Scale": 0.2, "Distortion": 2.0})
    same("ShaderNodeTexWave", wave_type="RINGS", rings_direction="Z", wave_profile="TRI", inputs={"Scale": 0.2})
    same("ShaderNodeTexWave", bands_direction="DIAGONAL", wave_profile="SAW", output="Fac", inputs={"Scale": 0.1})
    same("ShaderNodeTexBrick", 0.02, inputs={"Scale": 0.5, "Mortar Smooth": 0.4, "Color2": (0.1, 0.3, 0.8, 1)}, squash=0.7)
    same("ShaderNodeTexMagic", inputs={"Scale": 0.3})
    same("ShaderNodeTexMagic", turbulence_depth=10, inputs={"Scale": 0.3, "Distortion": 1.4})


@case
def white_noise_of_each_dimension():
    for count in ("2D", "3D", "4D"):
        difference, scene = shown("ShaderNodeTexWhiteNoise", noise_dimensions=count)
        assert difference < 0.1 and not notes(scene), (difference, notes(scene))


@case
def black_bodies_and_hues():
    for kelvin in (1500.0, 3000.0, 6500.0, 11000.0):
        same("ShaderNodeBlackbody", 0.02, inputs={"Temperature": kelvin}, coordinate=None)
    same("ShaderNodeCombineColor", mode="HSV", inputs={"Red": 0.6, "Green": 0.7, "Blue": 0.9}, coordinate=None)
    for channel in ("Red", "Green", "Blue"):
        same("ShaderNodeSeparateColor", output=channel, mode="HSV", inputs={"Color": (0.2, 0.7, 0.4, 1)}, coordinate=None)


@case
def vectors_that_are_turned():
    turn = {"Center": (0.1, 0.2, 0.3), "Axis": (1, 1, 0.3), "Angle": 0.8}
    for kind in ("AXIS_ANGLE", "X_AXIS", "Y_AXIS", "Z_AXIS"):
        same("ShaderNodeVectorRotate", scale=0.2, output="Vector", rotation_type=kind, inputs=turn)
    same("ShaderNodeVectorRotate", scale=0.2, output="Vector", invert=True, inputs=turn)
    same("ShaderNodeVectorRotate", scale=0.2, output="Vector", inputs={**turn, "Axis": (0, 0, 0)})
    for invert in (False, True):
        same("ShaderNodeVectorRotate", scale=0.2, output="Vector", rotation_type="EULER_XYZ", invert=invert, inputs={"Rotation": (0.3, 0.5, 0.9)})
    for kind in ("POINT", "VECTOR", "NORMAL"):
        for spaces in (("OBJECT", "WORLD"), ("WORLD", "OBJECT"), ("WORLD", "WORLD")):
            same("ShaderNodeVectorTransform", scale=0.2, output="Vector", vector_type=kind, convert_from=spaces[0], convert_to=spaces[1])
    same("ShaderNodeNormal", output="Dot", fed="Normal")


@case
def vector_math_of_light():
    def others(node):
        for socket, value in zip([socket for socket in node.inputs if socket.type == "VECTOR"][1:], ((0.3, 0.5, 0.7), (0.1, -0.9, 0.4))):
            socket.default_value = value

    for ratio in (0.7, 1.7):
        same("ShaderNodeVectorMath", 0.02, scale=0.2, output="Vector", operation="REFRACT", prepare=others, inputs={"Scale": ratio})
    same("ShaderNodeVectorMath", scale=0.2, output="Vector", operation="FACEFORWARD", prepare=others)


@case
def map_range_of_vectors():
    def ranges(node):
        for socket in node.inputs:
            if socket.enabled and socket.type == "VECTOR" and socket.name != "Vector":
                socket.default_value = {"From Min": (-0.4, -0.3, -0.5), "From Max": (0.5, 0.3, 0.8), "To Max": (1, 0.7, 0.4),
                                        "Steps": (3, 5, 2)}.get(socket.name, (0.1, 0, 0))

    for kind in ("LINEAR", "STEPPED", "SMOOTHSTEP", "SMOOTHERSTEP"):
        same("ShaderNodeMapRange", output="Vector", data_type="FLOAT_VECTOR", interpolation_type=kind, prepare=ranges)


@case
def curves_of_colors_vectors_and_numbers():
    def bend(node):
        for curve in list(node.mapping.curves)[-2:]:
            curve.points.new(0.3, 0.6)
        node.mapping.update()

    def bend_flat(node):
        bend(node)
        node.mapping.extend = "HORIZONTAL"

    for prepare in (bend, bend_flat):
        same("ShaderNodeRGBCurve", scale=0.2, fed="Color", prepare=prepare)
        same("ShaderNodeVectorCurve", scale=0.2, output="Vector", prepare=prepare)
        same("ShaderNodeFloatCurve", scale=0.2, output="Value", fed="Value", prepare=prepare, inputs={"Factor": 0.8})


@case
def lightness_and_wavelengths():
    for channel in ("Red", "Green", "Blue"):
        same("ShaderNodeSeparateColor", output=channel, mode="HSL", inputs={"Color": (0.9, 0.7, 0.4, 1)}, coordinate=None)
    same("ShaderNodeCombineColor", mode="HSL", inputs={"Red": 0.6, "Green": 0.7, "Blue": 0.6}, coordinate=None)
    for length in (420.0, 480.0, 560.0, 650.0):
        same("ShaderNodeWavelength", 0.02, inputs={"Wavelength": length}, coordinate=None)


@case
def mixes_of_each_kind():
    """Of coordinates from 0 to 1, which vary, and a colour, by a factor that is not 1; and of a colour by a factor that varies."""
    kinds = bpy.types.ShaderNodeMixRGB.bl_rna.properties["blend_type"].enum_items.keys()
    assert len(kinds) >= 18
    for kind in kinds:
        same("ShaderNodeMixRGB", scale=0.1, fed="Color1", blend_type=kind, inputs={"Fac": 0.7, "Color2": (0.7, 0.4, 0.2, 1)})
    for kind in ("HUE", "SATURATION", "VALUE", "COLOR", "BURN", "DODGE"):
        colors_of = {"Color1": (0.2, 0.5, 0.9, 1), "Color2": (0.7, 0.4, 0.2, 1)}
        same("ShaderNodeMixRGB", scale=0.1, fed="Fac", blend_type=kind, inputs=colors_of)
