"""camera_files.py: velo's camera files, of every dialect that velo reads, in a Blender camera: camera.velo.

The file's calibration, distortion, sensor and shutter are rendered exactly; the pose is the object's, which the file's pose sets when it
is loaded. Blender's own lens and shift show the frustum without distortion."""
import os

import bpy
import mathutils
import numpy
import velo

from . import camera
from .report import Refused


class VeloCameraSettings(bpy.types.PropertyGroup):
    """The camera file of a camera."""
    file: bpy.props.StringProperty(name="Camera file", subtype="FILE_PATH", description="A camera of velo, OpenCV, COLMAP, Kalibr, ...; empty: none")
    frame: bpy.props.StringProperty(name="Camera in the file", description="Name or number of one of several cameras; empty: the only one")


def read(data):
    """velo's camera of a Blender camera's file; None: it has none. Refused: it cannot be read."""
    if not data.velo.file:
        return None
    path = bpy.path.abspath(data.velo.file, library=data.library)
    frame = data.velo.frame or None
    try:
        return velo.read_camera(path, frame=int(frame) if frame is not None and frame.isdigit() else frame)
    except velo.Error as error:
        raise Refused("camera %s: %s" % (data.name, error)) from None


def convert(eye, size):
    """velo's camera for an image of a size at the place of a camera.Eye; None: the camera has no file."""
    found = read(eye.item.data)
    return None if found is None else found.resize(*size).move(camera.pose(eye.matrix))


def show_frustum(scene, item, found):
    """Sets lens, shift and pose of a camera object and the scene's resolution to those of velo's camera."""
    width, height = found.resolution
    matrix, data = numpy.asarray(found.K), item.data
    item.matrix_world = mathutils.Matrix((numpy.asarray(found.world_from_camera) @ camera.FLIP).tolist())
    scene.render.resolution_x, scene.render.resolution_y, scene.render.resolution_percentage = width, height, 100
    data.type, data.sensor_fit = "PERSP", "HORIZONTAL"
    if found.projection != "perspective":
        return
    data.lens = matrix[0, 0] * data.sensor_width / width
    data.shift_x, data.shift_y = 0.5 - matrix[0, 2] / width, (matrix[1, 2] - 0.5 * height) / width
    scene.render.pixel_aspect_x, scene.render.pixel_aspect_y = max(1.0, matrix[1, 1] / matrix[0, 0]), max(1.0, matrix[0, 0] / matrix[1, 1])


class VELO_OT_load_camera(bpy.types.Operator):
    """Loads the camera file into this camera: pose, frustum, resolution."""
    bl_idname = "velo.load_camera"
    bl_label = "Load pose and frustum"
    bl_options = {"REGISTER", "UNDO"}

    def execute(self, context):
        item = context.object if context.object is not None and context.object.type == "CAMERA" else context.scene.camera
        if item is None or not item.data.velo.file:
            self.report({"ERROR"}, "velo: there is no camera with a camera file")
            return {"CANCELLED"}
        try:
            show_frustum(context.scene, item, read(item.data))
        except Refused as error:
            self.report({"ERROR"}, "velo: %s" % " ".join(str(error).split()))
            return {"CANCELLED"}
        return {"FINISHED"}


class VELO_PT_camera_file(bpy.types.Panel):
    """The camera file of a camera."""
    bl_label = "Camera file"
    bl_space_type = "PROPERTIES"
    bl_region_type = "WINDOW"
    bl_context = "data"

    @classmethod
    def poll(cls, context):
        return context.engine == "VELO" and context.camera is not None

    def draw(self, context):
        self.layout.use_property_split = True
        self.layout.prop(context.camera.velo, "file")
        self.layout.prop(context.camera.velo, "frame")
        if context.camera.velo.file:
            self.layout.operator("velo.load_camera", text="Load %s" % os.path.basename(context.camera.velo.file))


CLASSES = (VeloCameraSettings, VELO_OT_load_camera, VELO_PT_camera_file)


def register():
    for item in CLASSES:
        bpy.utils.register_class(item)
    bpy.types.Camera.velo = bpy.props.PointerProperty(type=VeloCameraSettings)


def unregister():
    del bpy.types.Camera.velo
    for item in reversed(CLASSES):
        bpy.utils.unregister_class(item)
