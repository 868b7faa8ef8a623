"""panels.py: the settings of velo in Blender's properties editor, and the list of what velo renders otherwise."""
import bpy

from . import cryptomatte, passes, report, versions

#: Panels of Blender that a renderer has to ask for and velo does not read.
EXCLUDED = {"RENDER_PT_freestyle", "VIEWLAYER_PT_filter"}


class _Panel:
    bl_space_type = "PROPERTIES"
    bl_region_type = "WINDOW"
    bl_context = "render"
    COMPAT_ENGINES = {"VELO"}

    @classmethod
    def poll(cls, context):
        return context.engine == "VELO"


class VELO_PT_sampling(_Panel, bpy.types.Panel):
    """Samples, noise, bounces."""
    bl_label = "Sampling"

    def draw(self, context):
        layout, options = self.layout, context.scene.velo
        layout.use_property_split = True
        for name in ("samples", "preview_samples", "noise", "denoise", "seed", "spectral", "bake_size", "bounces_of_cycles"):
            layout.prop(options, name)
        layout.prop(context.scene.render, "use_persistent_data")
        row = layout.row()
        row.enabled = not (options.bounces_of_cycles and hasattr(context.scene, "cycles"))
        row.prop(options, "bounces")


class VELO_PT_passes(_Panel, bpy.types.Panel):
    """The passes of a view layer."""
    bl_label = "Passes"
    bl_context = "view_layer"

    def draw(self, context):
        layout, layer = self.layout, context.view_layer
        layout.use_property_split = True
        for name in passes.SWITCHES:
            layout.prop(layer, name)
        layout.prop(layer.velo, "denoising_data")
        for name in cryptomatte.KINDS.values():
            layout.prop(layer, name)
        layout.prop(layer, "pass_cryptomatte_depth")


class VELO_PT_notes(_Panel, bpy.types.Panel):
    """What velo cannot render, by material and node."""
    bl_label = "Rendered otherwise"

    def draw(self, context):
        lines = report.last.get(context.scene.name)
        if lines is None:
            self.layout.label(text="Known after a render")
        elif not lines:
            self.layout.label(text="Everything is rendered", icon="CHECKMARK")
        for line in lines or ():
            self.layout.label(text=line, icon="ERROR")


CLASSES = (VELO_PT_sampling, VELO_PT_passes, VELO_PT_notes)


def _shared():
    """Blender's own panels that velo's scenes need, too: cameras, lights, materials, output."""
    for panel in bpy.types.Panel.__subclasses__():
        engines = getattr(panel, "COMPAT_ENGINES", None)
        if engines is not None and engines & versions.eevee_or_cycles_panels() and panel.__name__ not in EXCLUDED:
            if not panel.__name__.startswith("EEVEE"):
                yield panel


def register():
    for item in CLASSES:
        bpy.utils.register_class(item)
    for panel in _shared():
        panel.COMPAT_ENGINES.add("VELO")


def unregister():
    for panel in _shared():
        panel.COMPAT_ENGINES.discard("VELO")
    for item in reversed(CLASSES):
        bpy.utils.unregister_class(item)
