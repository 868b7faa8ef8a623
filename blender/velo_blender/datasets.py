"""datasets.py: data sets of velo's formats from a scene and its animation: BOP, COCO, nerfstudio, OpenEXR channels.

An object's class is its custom property `class`; objects without it are background. Headless:
blender -b file.blend --addons velo_blender --python-expr "import velo_blender.datasets as d; d.write('out', ['coco'])"."""
from types import SimpleNamespace

import bpy
import numpy
import velo
from velo.dataset.bop import BopWriter
from velo.dataset.coco import CocoWriter
from velo.dataset.exr import ExrWriter
from velo.dataset.nerfstudio import NerfstudioWriter
from velo.dataset.stage import Frame, Instance

from . import camera, export, rigid, settings
from .report import Refused

WRITERS = {"bop": BopWriter, "coco": CocoWriter, "nerfstudio": NerfstudioWriter, "exr": ExrWriter}
CHANNELS = ["Z", "N", "id.instance"]


def classes_of(scene):
    """The names of all classes of a scene, in alphabetical order."""
    return sorted({str(item["class"]) for item in scene.objects if "class" in item})


def _stage(names):
    """What velo's writers ask of a recipe."""
    models = [SimpleNamespace(keypoints={}, scale=1.0) for _ in names]
    return SimpleNamespace(names=names, recipe=SimpleNamespace(occluded=False, models=models), context=velo.Scene().context)


def _metres(scene):
    """The length of a unit of Blender."""
    units = scene.unit_settings
    return 1.0 if units.system == "NONE" else float(units.scale_length)


def _annotated(made, names, number):
    """The image of an export with its annotations: (frame, for each of its instances which of the export's it is, from 0)."""
    scene = made.depsgraph.scene
    image = made.scene.render(channels=CHANNELS, **settings.tracing(scene, scene.velo.samples))
    ids, instances, places = numpy.asarray(image["id.instance"]), [], []
    for place, placed in enumerate(made.instances):
        name = placed.kind
        if name not in names:
            continue
        pose, stretch = rigid.pose_of(placed.matrix)
        mask = ids == place + 1
        instances.append(Instance(names.index(name), name, pose.tolist(), float(numpy.trace(stretch)) / 3, mask, mask))
        places.append(place)
    return Frame(number, bpy.path.clean_name(scene.camera.name), made.camera, image, instances), places


def _write_frame(depsgraph, number, names, writers, models):
    """Renders the depsgraph's frame and writes it in all formats. writers: {format: writer}; models: those of BOP."""
    made = export.Export(depsgraph, camera.image_size(depsgraph.scene))
    for writer in writers.values():
        writer.check_camera(made.camera)
    frame, places = _annotated(made, names, number)
    for name, writer in writers.items():
        writer.write(models.frame(frame, places, made) if name == "bop" else frame, 0)


def write(folder, formats=("coco",), frames=None, context=None, depth_step=None):
    """Writes the frames of the current scene (default: all of its animation) in these formats into a folder. depth_step: millimetres of a
    step of BOP's depth, default the panel's."""
    unknown = [name for name in formats if name not in WRITERS]
    if unknown or not formats:
        raise Refused("there is no data set %s (known: %s)" % (", ".join(unknown) or "without a format", ", ".join(sorted(WRITERS))))
    context = context or bpy.context
    scene = context.scene
    if scene.camera is None:
        raise Refused("the scene has no camera")
    step = scene.velo.depth_step if depth_step is None else float(depth_step)
    if not 1e-6 <= step <= 1e6:
        raise Refused("a step of depth is from 1e-6 to 1e6 mm; it is %g" % step)
    names, models = classes_of(scene), rigid.Models(_metres(scene), step)
    stage = _stage(names)
    writers = {name: WRITERS[name](models if name == "bop" else stage, folder) for name in formats}
    before = scene.frame_current
    try:
        for number in range(scene.frame_start, scene.frame_end + 1) if frames is None else frames:
            scene.frame_set(number)
            _write_frame(context.evaluated_depsgraph_get(), number, names, writers, models)
    finally:
        scene.frame_set(before)
    for writer in writers.values():
        writer.begin()  # the models are known when all frames are
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
        if "bop" in options.dataset_formats:
            layout.prop(options, "depth_step")
        layout.label(text="Classes: %s" % (", ".join(classes_of(context.scene)) or "none (custom property class)"))
        layout.operator("velo.write_dataset")


CLASSES = (VELO_OT_write_dataset, VELO_PT_dataset)


def register():
    for item in CLASSES:
        bpy.utils.register_class(item)


def unregister():
    for item in reversed(CLASSES):
        bpy.utils.unregister_class(item)
