"""Runs inside a Blender with windows: looks at screenshots of a view with rendered shading until it shows what it must."""
import os
import sys
import time

import addon_utils
import bpy
import numpy

FOLDER = sys.argv[-1]
PATIENCE = 100.0  # seconds for each state
begun = time.monotonic()


def view():
    """(window, area, region) of the 3D view."""
    window = bpy.context.window_manager.windows[0]
    area = next(area for area in window.screen.areas if area.type == "VIEW_3D")
    return window, area, next(region for region in area.regions if region.type == "WINDOW")


def middle():
    """The colour in the middle of the view, 0 to 1."""
    path = os.path.join(FOLDER, "view.png")
    bpy.ops.screen.screenshot(filepath=path)
    image = bpy.data.images.load(path, check_existing=False)
    pixels = numpy.array(image.pixels[:]).reshape(image.size[1], image.size[0], 4)
    bpy.data.images.remove(image)
    _, _, region = view()
    return pixels[region.y + region.height // 2, region.x + region.width // 2, :3]


def prepare():
    addon_utils.enable("velo_blender")
    scene = bpy.context.scene
    scene.render.engine = "VELO"
    scene.velo.preview_samples = 4
    scene.view_settings.view_transform = "Standard"
    scene.world.node_tree.nodes["Background"].inputs[0].default_value = (0, 0, 1, 1)
    scene.world.node_tree.nodes["Background"].inputs[1].default_value = 1.0
    cube = bpy.data.objects["Cube"]
    shader = bpy.data.materials["Material"].node_tree.nodes["Principled BSDF"]
    shader.inputs["Base Color"].default_value = (0, 0, 0, 1)
    shader.inputs["Specular"].default_value = 0
    shader.inputs["Emission"].default_value = (1, 0, 0, 1)
    _, area, _ = view()
    area.spaces[0].overlay.show_overlays = False
    area.spaces[0].show_gizmo = False
    area.spaces[0].shading.type = "RENDERED"
    return cube


def states():
    """(name, the colour that the middle must have); between them the cube is moved away."""
    cube = prepare()
    yield "the_view_shows_a_red_cube", (1, 0, 0)
    cube.location.z += 30
    yield "the_cube_has_moved_away", (0, 0, 1)


steps, state = states(), None


def tick():
    """Called by Blender's timer."""
    global state, begun
    try:
        if state is None:
            state, begun = next(steps), time.monotonic()
            return 2.0
        seen = middle()
        fine = abs(seen - numpy.array(state[1])).max() < 0.1
        if not fine and time.monotonic() - begun < PATIENCE:
            return 2.0
        print("\n%s %s" % ("ok" if fine else "not ok", state[0]), "" if fine else seen, flush=True)
        state = None
        return 0.1
    except StopIteration:
        os._exit(0)
    except BaseException as error:  # pylint: disable=broad-except; without this Blender stays open
        print("\nnot ok view: %r" % error, flush=True)
        os._exit(1)


bpy.context.preferences.view.show_splash = False
bpy.app.timers.register(tick, first_interval=2.0)
