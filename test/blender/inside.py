"""Runs inside Blender: scenes made by bpy, rendered by velo and, where it says so, by Cycles. Prints `ok NAME`, `not ok NAME`
and, where something is not installed, `skip NAME: why`.

Usage: blender -b --factory-startup -P inside.py -- FILE_OF_CASES FOLDER"""
import importlib.util
import math
import os
import sys
import traceback

import addon_utils
import bpy
import mathutils
import numpy

CASES_FILE, FOLDER = sys.argv[sys.argv.index("--") + 1:][:2]
cases = []


def case(function):
    """A function that is a case: it fails by an exception."""
    cases.append(function)
    return function


class Missing(Exception):
    """Something that a case needs is not installed; the text says what. The case is skipped."""


# ---- scenes --------------------------------------------------------------------------------------------------------------

def new_scene(world=(0.0, 0.0, 0.0), size=(48, 48), samples=64, bounces=8):
    """An empty scene with a camera at (0, -6, 3) that looks at (0, 0, .5), the same settings for velo and Cycles."""
    bpy.ops.wm.read_factory_settings(use_empty=True)
    addon_utils.enable("cycles")
    addon_utils.enable("velo_blender")
    scene = bpy.context.scene
    c = scene.cycles
    c.samples, c.use_adaptive_sampling, c.use_denoising = samples, False, False
    c.sample_clamp_indirect = c.blur_glossy = 0
    c.max_bounces = c.diffuse_bounces = c.glossy_bounces = c.transmission_bounces = bounces
    scene.velo.samples = samples
    scene.render.engine = "VELO"
    scene.render.resolution_x, scene.render.resolution_y = size
    scene.render.image_settings.file_format = "OPEN_EXR_MULTILAYER"
    scene.render.image_settings.color_depth = "32"
    lens = bpy.data.cameras.new("camera")
    lens.lens = 40
    scene.camera = add_object(scene, "camera", lens, (0, -6, 3))
    scene.camera.rotation_euler = (math.atan2(6, 2.5), 0, 0)
    scene.world = bpy.data.worlds.new("world")
    scene.world.use_nodes = True
    scene.world.node_tree.nodes["Background"].inputs[0].default_value = (*world, 1)
    return scene


def add_object(scene, name, data, place=(0, 0, 0)):
    item = bpy.data.objects.new(name, data)
    item.location = place
    scene.collection.objects.link(item)
    return item


def material(kind, **values):
    """A material of one shader node: (material, node). Values: names of inputs with _ for blanks, or properties."""
    made = bpy.data.materials.new("material")
    made.use_nodes = True
    tree = made.node_tree
    tree.nodes.clear()
    node = tree.nodes.new(kind)
    tree.links.new(node.outputs[0], tree.nodes.new("ShaderNodeOutputMaterial").inputs[0])
    for name, value in values.items():
        socket = node.inputs.get(name.replace("_", " "))
        if socket is None:
            setattr(node, name, value)
        else:
            socket.default_value = (*value, 1) if socket.type == "RGBA" else value
    return made, node


def add(tree, kind, to=None, output=0, **values):
    """A node whose sockets, or else members, have these values ("_" stands for a space in a socket's name); linked to a socket."""
    node = tree.nodes.new(kind)
    for name, value in values.items():
        socket = node.inputs.get(name.replace("_", " "))
        if socket is None:
            setattr(node, name, value)
        else:
            socket.default_value = value
    if to is not None:
        tree.links.new(node.outputs[output], to)
    return node


def plane(made, size=20.0, place=(0, 0, 0)):
    bpy.ops.mesh.primitive_plane_add(size=size, location=place)
    if made is not None:
        bpy.context.object.data.materials.append(made)
    return bpy.context.object


def ball(made, place=(0, 0, 1), radius=1.0):
    bpy.ops.mesh.primitive_uv_sphere_add(segments=48, ring_count=24, radius=radius, location=place)
    bpy.ops.object.shade_smooth()
    bpy.context.object.data.materials.append(made)
    return bpy.context.object


def lamp(scene, kind, energy, place=(2, -2, 4), **values):
    light = bpy.data.lights.new("lamp", kind)
    light.energy = energy
    for name, value in values.items():
        setattr(light, name, value)
    item = add_object(scene, "lamp", light, place)
    item.rotation_euler = (mathutils.Vector(place) - mathutils.Vector((0, 0, 0.5))).to_track_quat("Z", "Y").to_euler()
    return item


# ---- images --------------------------------------------------------------------------------------------------------------

def render(scene, engine="VELO"):
    """velo.Image of the file that Blender writes."""
    import velo
    scene.render.engine = engine
    scene.render.filepath = os.path.join(FOLDER, "%s.exr" % engine.lower())
    bpy.ops.render.render(write_still=True)
    return velo.read_image(scene.render.filepath)


def channel(image, name):
    """height x width, by the end of its name, such as Depth.Z."""
    full = [known for known in image.channels if known.endswith("." + name) or known == name]
    assert full, "no channel %s in %s" % (name, image.channels)
    return numpy.asarray(image[full[0]]).astype(float)


def colors(image):
    """height x width x 3."""
    return numpy.stack([channel(image, "Combined." + letter) for letter in "RGB"], axis=2)


def means(scene):
    """(Cycles' mean colour, velo's)."""
    return tuple(colors(render(scene, engine)).mean(axis=(0, 1)) for engine in ("CYCLES", "VELO"))


def agrees(scene, share=0.02):
    """The means of Cycles and velo agree."""
    cycles, mine = means(scene)
    assert (abs(mine / numpy.maximum(cycles, 1e-6) - 1) < share).all(), "Cycles %s, velo %s" % (cycles, mine)


def refused(scene, text):
    """The render ends with Blender's report, which has this text."""
    try:
        render(scene)
    except RuntimeError as error:
        assert text in str(error), "%r is not in %r" % (text, str(error))
        assert str(error).count("\n") <= 1, "the report has more than one line: %s" % error
        return
    raise AssertionError("nothing was reported, %r was expected" % text)


def notes(scene):
    """The lines of what the last render did otherwise."""
    from velo_blender import report
    return report.last[scene.name]


def main():
    spec = importlib.util.spec_from_file_location("cases_of_blender", CASES_FILE)
    sys.modules["inside"] = sys.modules["__main__"]
    spec.loader.exec_module(importlib.util.module_from_spec(spec))
    for function in cases:
        try:
            function()
            print("\nok %s" % function.__name__, flush=True)
        except Missing as reason:
            print("\nskip %s: %s" % (function.__name__, reason), flush=True)
        except BaseException:  # pylint: disable=broad-except; the other cases go on
            traceback.print_exc()
            print("\nnot ok %s" % function.__name__, flush=True)
    sys.stdout.flush()
    os._exit(0)  # Blender 3.4 crashes while it frees a script's module that other modules have imported


main()
