"""sky_render.py: run by sky.py in a Blender of its own: renders the world of world.blend by Cycles.

Usage: blender -b --factory-startup -P sky_render.py -- FOLDER WIDTH. Writes sky.exr, and for each sky with a sun's disk sunN_with.exr,
sunN_without.exr, sunN_angle; last `done`, with a line `x y z HALF` for each: the direction and half the angle of the disk."""
import math
import os
import sys

import addon_utils
import bpy
import mathutils
import numpy

SUN_SIDE = 96  # of the images of a sun, pixels
WIDER = 3.0  # angle of these images, in disks


def prepare(folder):
    addon_utils.enable("cycles")
    bpy.ops.wm.read_factory_settings(use_empty=True)
    addon_utils.enable("cycles")
    with bpy.data.libraries.load(os.path.join(folder, "world.blend")) as (source, loaded):
        loaded.worlds = source.worlds
    scene = bpy.context.scene
    scene.world = loaded.worlds[0]
    if getattr(scene.world, "cycles_visibility", None) is not None:
        scene.world.cycles_visibility.camera = True
    see_as_light(scene.world.node_tree, ())
    scene.render.engine = "CYCLES"
    scene.cycles.device = "CPU"
    scene.cycles.samples, scene.cycles.use_adaptive_sampling, scene.cycles.use_denoising = 4, False, False
    scene.cycles.sample_clamp_direct = scene.cycles.sample_clamp_indirect = 0
    settings = scene.render.image_settings
    settings.file_format, settings.color_mode, settings.color_depth = "OPEN_EXR", "RGB", "32"
    lens = bpy.data.cameras.new("camera")
    scene.camera = bpy.data.objects.new("camera", lens)
    scene.collection.objects.link(scene.camera)
    return scene


def see_as_light(tree, seen):
    """Makes nodes that ask for camera rays say that there are none."""
    for link in [link for link in tree.links if link.from_node.type == "LIGHT_PATH" and link.from_socket.name == "Is Camera Ray"]:
        nothing, socket = tree.nodes.new("ShaderNodeValue"), link.to_socket
        nothing.outputs[0].default_value = 0.0
        tree.links.new(nothing.outputs[0], socket)
    for node in tree.nodes:
        if node.type == "GROUP" and node.node_tree is not None and node.node_tree not in seen:
            see_as_light(node.node_tree, seen + (node.node_tree,))


def render(scene, size, path):
    scene.render.resolution_x, scene.render.resolution_y = size
    scene.render.resolution_percentage = 100
    scene.render.filepath = path
    bpy.ops.render.render(write_still=True)


def look_around(scene):
    """An equirectangular view whose texels lie as those of Cycles' environment textures."""
    lens = scene.camera.data
    lens.type = "PANO"
    settings = lens.cycles if hasattr(lens.cycles, "panorama_type") else lens
    settings.panorama_type = "EQUIRECTANGULAR"
    scene.camera.matrix_world = mathutils.Matrix(((0, 0, -1, 0), (-1, 0, 0, 0), (0, 1, 0, 0), (0, 0, 0, 1)))


def look_at(scene, axis, angle):
    lens = scene.camera.data
    lens.type, lens.sensor_fit, lens.angle = "PERSP", "AUTO", angle
    scene.camera.matrix_world = mathutils.Vector([-x for x in axis]).to_track_quat("Z", "Y").to_matrix().to_4x4()


def pixels(path):
    image = bpy.data.images.load(path)
    values = numpy.empty(len(image.pixels), dtype=numpy.float32)
    image.pixels.foreach_get(values)
    values = values.reshape(image.size[1], image.size[0], image.channels)[::-1, :, :3].astype(float)
    bpy.data.images.remove(image)
    return values


def skies(tree, seen=()):
    """The sky nodes of a tree that show a sun."""
    found = [node for node in tree.nodes if node.type == "TEX_SKY" and getattr(node, "sun_disc", False) and
             node.sky_type not in ("PREETHAM", "HOSEK_WILKIE")]
    for node in tree.nodes:
        if node.type == "GROUP" and node.node_tree is not None and node.node_tree.name not in seen:
            found += skies(node.node_tree, seen + (node.node_tree.name,))
    return found


def direction_of(difference):
    """The mean direction of what an equirectangular image has more than another, weighted; None: nothing."""
    height, width = difference.shape[:2]
    weights = numpy.maximum(difference.sum(axis=2), 0)
    theta = (numpy.arange(height) + 0.5) / height * math.pi
    phi = math.pi - (numpy.arange(width) + 0.5) / width * 2 * math.pi
    weights = numpy.where(weights > 0.05 * weights.max(), weights, 0) * numpy.sin(theta)[:, None]
    if weights.sum() <= 0:
        return None
    axis = [(weights * numpy.sin(theta)[:, None] * numpy.cos(phi)).sum(), (weights * numpy.sin(theta)[:, None] * numpy.sin(phi)).sum(),
            (weights * numpy.cos(theta)[:, None]).sum()]
    return numpy.array(axis) / numpy.linalg.norm(axis)


def main():
    folder, width = sys.argv[sys.argv.index("--") + 1:][:2]
    width = int(width)
    scene = prepare(folder)
    nodes = skies(scene.world.node_tree)
    for node in nodes:
        node.sun_disc = False
    look_around(scene)
    render(scene, (width, width // 2), os.path.join(folder, "sky.exr"))
    lines = []
    plain = pixels(os.path.join(folder, "sky.exr")) if nodes else None
    for node in nodes:
        node.sun_disc = True
        look_around(scene)
        render(scene, (width, width // 2), os.path.join(folder, "other.exr"))
        axis = direction_of(pixels(os.path.join(folder, "other.exr")) - plain)
        if axis is not None:
            angle, name = WIDER * max(node.sun_size, 1e-3), os.path.join(folder, "sun%d_" % len(lines))
            look_at(scene, axis, angle)
            render(scene, (SUN_SIDE, SUN_SIDE), name + "with.exr")
            node.sun_disc = False
            render(scene, (SUN_SIDE, SUN_SIDE), name + "without.exr")
            with open(name + "angle", "w", encoding="ascii") as file:
                file.write("%r" % angle)
            lines.append("%r %r %r %r\n" % (*(float(x) for x in axis), 0.5 * node.sun_size))
        node.sun_disc = False
    with open(os.path.join(folder, "done"), "w", encoding="ascii") as file:
        file.writelines(lines)


main()
