"""datasets.py: data sets of velo's formats from a scene and its animation: COCO, nerfstudio, OpenEXR channels.

An object's class is its custom property `class`; objects without it are background. Headless:
blender -b file.blend --addons velo_blender --python-expr "import velo_blender.datasets as d; d.write('out', ['coco'])"."""
from types import SimpleNamespace

import bpy
import numpy
import velo
from velo.dataset.coco import CocoWriter
from velo.dataset.exr import ExrWriter
from velo.dataset.nerfstudio import NerfstudioWriter
from velo.dataset.stage import Frame, Instance

from . import camera, export, settings
from .report import Refused

WRITERS = {"coco": CocoWriter, "nerfstudio": NerfstudioWriter, "exr": ExrWriter}
CHANNELS = ["Z", "N", "id.instance"]


def classes_of(scene):
    """The names of all classes of a scene, in alphabetical order."""
    return sorted({str(item["class"]) for item in scene.objects if "class" in item})


def _stage(names):
    """What velo's writers ask of a recipe."""
    models = [SimpleNamespace(keypoints={}, scale=1.0) for _ in names]
    return SimpleNamespace(names=names, recipe=SimpleNamespace(occluded=False, models=models), context=velo.Scene().context)


def _rigid(matrix):
    """(pose without scale, its mean scale)."""
    scale = numpy.linalg.norm(matrix[:3, :3], axis=0)
    pose = matrix.copy()
    pose[:3, :3] = matrix[:3, :3] / scale
    return pose.tolist(), float(scale.mean())


def render_frame(depsgraph, names, number):
    """An annotated image of the depsgraph's frame."""
    scene = depsgraph.scene
    made = export.Export(depsgraph, camera.image_size(scene))
    image = made.scene.render(channels=CHANNELS, **settings.tracing(scene, scene.velo.samples))
    ids, instances = numpy.asarray(image["id.instance"]), []
    for place, placed in enumerate(made.instances, 1):
        name = placed.kind
        if name not in names:
            continue
        pose, scale = _rigid(placed.matrix)
        mask = ids == place
        instances.append(Instance(names.index(name), name, pose, scale, mask, mask))
    return Frame(number, scene.camera.name, made.camera, image, instances)


def write(folder, formats=("coco",), frames=None, context=None):
    """Writes the frames of the current scene (default: all of its animation) in these formats into a folder."""
    unknown = [name for name in formats if name not in WRITERS]
    if unknown or not formats:
        raise Refused("there is no data set %s (known: %s)" % (", ".join(unknown) or "without a format", ", ".join(sorted(WRITERS))))
    context = context or bpy.context
    scene = context.scene
    if scene.camera is None:
        raise Refused("the scene has no camera")
    names = classes_of(scene)
    stage = _stage(names)
    writers = [WRITERS[name](stage, folder) for name in formats]
    for writer in writers:
        writer.begin()
    before = scene.frame_current
    try:
        for number in range(scene.frame_start, scene.frame_end + 1) if frames is None else frames:
            scene.frame_set(number)
            frame = render_frame(context.evaluated_depsgraph_get(), names, number)
            for writer in writers:
                writer.check_camera(frame.camera)
                writer.write(frame, 0)
    finally:
        scene.frame_set(before)
    for writer in writers:
        writer.finish()


class VELO_OT_write_dataset(bpy.types.Operator):
    """Writes a data set from the scene and its animation; the class of an object is its custom property "class"."""
    bl_idname = "velo.write_dataset"
    bl_label = "Write data set"

    def execute(self, context):
        options = context.scene.velo
        try:
            write(bpy.path.abspath(options.dataset_folder), sorted(options.dataset_formats), context=context)
        except (Refused, velo.Error, OSError, MemoryError) as error:
            self.report({"ERROR"}, "velo: %s" % " ".join(str(error).split()))
            return {"CANCELLED"}
        self.report({"INFO"}, "velo: the data set is in %s" % options.dataset_folder)
        return {"FINISHED"}


class VELO_PT_dataset(bpy.types.Panel):
    """The data set of a scene."""
    bl_label = "Data set"
    bl_space_type = "PROPERTIES"
    bl_region_type = "WINDOW"
    bl_context = "output"

    @classmethod
    def poll(cls, context):
        return context.engine == "VELO"

    def draw(self, context):
        layout, options = self.layout, context.scene.velo
        layout.prop(options, "dataset_folder")
        layout.prop(options, "dataset_formats")
        layout.label(text="Classes: %s" % (", ".join(classes_of(context.scene)) or "none (custom property class)"))
        layout.operator("velo.write_dataset")


CLASSES = (VELO_OT_write_dataset, VELO_PT_dataset)


def register():
    for item in CLASSES:
        bpy.utils.register_class(item)


def unregister():
    for item in reversed(CLASSES):
        bpy.utils.unregister_class(item)
