"""camera.py: Blender's cameras as velo's: perspective, orthographic, panoramas; shift, sensor fit, clipping, depth of field.

Blender's camera looks along -z with y up; velo's x points right, y down, z forward."""
import math
from typing import Any, NamedTuple

import mathutils
import numpy
import velo

from . import panorama
from .report import Refused

FLIP = numpy.diag((1.0, -1.0, -1.0, 1.0))


class Eye(NamedTuple):
    """From where one of the views of a camera sees. item: the evaluated camera object; matrix: world from Blender's camera; shift_x:
    Blender's lens shift; name: of the view, empty where there is one."""
    item: Any
    matrix: Any
    shift_x: float
    name: str = ""


def eye_of(depsgraph):
    """The only eye of the scene's camera."""
    if depsgraph.scene.camera is None:
        raise Refused("the scene has no camera")
    item = depsgraph.scene.camera.evaluated_get(depsgraph)
    return Eye(item, item.matrix_world.copy(), item.data.shift_x)


def eyes_of(engine, depsgraph, names):
    """The eyes of the scene's camera for views by their names: of a stereo image Blender moves, turns and shifts the camera for each."""
    if list(names) == [""]:
        return [eye_of(depsgraph)]
    eyes = []
    for name in names:
        engine.active_view_set(name)
        item = _camera_for(depsgraph, name)
        eyes.append(Eye(item, mathutils.Matrix(engine.camera_model_matrix(item)), engine.camera_shift_x(item), name))
    return eyes


def _camera_for(depsgraph, name):
    """The camera object of a view: the scene's, or with several cameras that of the same name with the view's suffix."""
    scene, item = depsgraph.scene, eye_of(depsgraph).item
    views = scene.render.views
    if scene.render.views_format == "MULTIVIEW":
        for view in views:
            if view.camera_suffix and item.name.endswith(view.camera_suffix):
                wanted = item.name[:-len(view.camera_suffix)] + views[name].camera_suffix
                return scene.objects.get(wanted, item).evaluated_get(depsgraph)
    return item


def image_size(scene):
    """Width and height of the whole image, pixels."""
    render = scene.render
    scale = render.resolution_percentage / 100
    return max(1, int(render.resolution_x * scale)), max(1, int(render.resolution_y * scale))


def crop_window(scene, size):
    """x0, y0, x1, y1 of the region that is rendered, rows from the top, exclusive; None: all."""
    render = scene.render
    if not render.use_border:
        return None
    width, height = size
    x0, x1 = int(render.border_min_x * width), int(render.border_max_x * width)
    y0, y1 = int(render.border_min_y * height), int(render.border_max_y * height)
    if x1 <= x0 or y1 <= y0:
        raise Refused("the render region has no pixels (%d x %d)" % (max(0, x1 - x0), max(0, y1 - y0)))
    return x0, height - y1, x1, height - y0


def pose(matrix):
    """World from camera, 4 x 4, of velo; without the scale of Blender's object."""
    world = numpy.array(matrix.normalized(), dtype=float)
    if not numpy.isfinite(world).all():
        raise Refused("the camera's place is no number (NaN or infinite)")
    return world @ FLIP


def _lens(camera):
    """Depth of field, as Cycles has it: the lens's radius in Blender's units whatever the unit scale, the aperture's shape."""
    dof = camera.dof
    if not dof.use_dof or dof.aperture_fstop <= 0:
        return {}
    focal = 1.0 if camera.type == "ORTHO" else 1e-3 * camera.lens
    words = {"lens_radius": 0.5 * focal / dof.aperture_fstop}
    if dof.aperture_blades >= 3:
        words["blades"] = int(dof.aperture_blades)
        # The middle of Blender's first side is at the right and turns upwards; velo's first corner is at the top and turns the other way.
        words["rotation"] = 0.5 * math.pi - math.pi / dof.aperture_blades - dof.aperture_rotation
    if dof.aperture_ratio != 1:
        words["ratio"] = float(dof.aperture_ratio)
    return words


def focus_distance(camera, matrix):
    """Distance along the view axis to what is in focus."""
    if camera.dof.focus_object is None:
        return max(camera.dof.focus_distance, 1e-6)
    place = camera.dof.focus_object.matrix_world.translation
    axis = matrix.to_3x3().normalized().col[2]
    return max(abs((place - matrix.translation).dot(axis)), 1e-6)


def convert(depsgraph, size, eye):
    """velo's camera for an image of a size (width, height) from an eye of Blender's camera."""
    item, matrix = eye.item, eye.matrix
    camera = item.data
    words = {"world_from_camera": pose(matrix)}
    render = depsgraph.scene.render
    if camera.type == "PANO":
        return panorama.convert(camera, size, words)
    projection = numpy.array(item.calc_matrix_camera(depsgraph, x=size[0], y=size[1], scale_x=render.pixel_aspect_x,
                                                     scale_y=render.pixel_aspect_y), dtype=float)
    if not numpy.isfinite(projection).all() or projection[0, 0] == 0 or projection[1, 1] == 0:
        raise Refused("camera %s: its projection is degenerate" % item.name)
    words.update(near_plane=float(camera.clip_start), far_plane=float(camera.clip_end))
    shift_to(projection, eye.shift_x - camera.shift_x, camera, render, size)
    if camera.type == "ORTHO":
        words.update(orthographic_window(projection))
    else:
        words.update(pinhole_matrix(projection, size))
    lens = _lens(camera)
    if lens:
        words.update(lens, focus_distance=focus_distance(camera, matrix))
    return velo.Camera(*size, **words)


def shift_to(projection, shift, camera, render, size):
    """Moves the window of an OpenGL projection by a lens shift along x, in Blender's units: the longer side of the image, or that of the
    sensor's fit (BKE_camera_params_compute_viewplane)."""
    width, height = size[0] * render.pixel_aspect_x, size[1] * render.pixel_aspect_y
    horizontal = camera.sensor_fit == "HORIZONTAL" or (camera.sensor_fit == "AUTO" and width >= height)
    shares = 2 * shift * (1.0 if horizontal else height / width)  # of half of the width
    if camera.type == "ORTHO":
        projection[0, 3] -= shares
    else:
        projection[0, 2] += shares


def moving(still, matrices):
    """A camera that moves from the first pose to the last one; the same where they are equal."""
    first, last = pose(matrices[0]), pose(matrices[-1])
    if numpy.allclose(first, last, rtol=0, atol=1e-7):
        return still
    return still.replace(world_from_camera=first, world_from_camera_close=last)


def pinhole_matrix(projection, size):
    """fx, fy, cx, cy, pixels, from OpenGL's projection matrix: x_ndc = (P00 x + P02 z) / -z."""
    width, height = size
    return {"projection": "perspective", "fx": 0.5 * width * projection[0, 0], "fy": 0.5 * height * projection[1, 1],
            "cx": 0.5 * width * (1 - projection[0, 2]), "cy": 0.5 * height * (1 + projection[1, 2])}


def orthographic_window(projection):
    """The screen window of an orthographic camera, scene units."""
    left, right = ((side - projection[0, 3]) / projection[0, 0] for side in (-1, 1))
    low, high = ((side - projection[1, 3]) / projection[1, 1] for side in (-1, 1))
    return {"projection": "orthographic", "screen_min_x": left, "screen_max_x": right, "screen_min_y": low, "screen_max_y": high}
