"""ignored.py: settings of Blender and Cycles that change an image and that velo does not have: each gets a line in the list."""
import os

import bpy

from . import passes, settings

#: Passes of a view layer that are no passes of their own, or that velo has.
_KNOWN_PASSES = {"use_pass_combined", "use_pass_cryptomatte_accurate", "use_pass_cryptomatte_object", "use_pass_cryptomatte_material",
                 "use_pass_cryptomatte_asset"} | set(passes.SWITCHES)


def note_scene(depsgraph, notes):
    """The settings of the scene, its view layer and its world."""
    scene, layer = depsgraph.scene, depsgraph.view_layer
    _note_libraries(notes)
    cycles = getattr(scene, "cycles", None)
    if scene.render.use_freestyle and layer.use_freestyle:
        notes.add(scene.name, "Freestyle", "no lines are drawn")
    if cycles is not None:
        _note_light_paths(scene, cycles, notes)
        _note_film(scene, cycles, notes)
    if scene.render.use_multiview and scene.camera is not None and scene.camera.data.stereo.use_spherical_stereo:
        notes.add(scene.camera.name, "Spherical stereo", "both eyes are at one place of their own for all directions")
    _note_layer(layer, notes)
    if scene.world is not None and layer.use_sky:
        _note_world(scene, notes)


def _note_libraries(notes):
    """Files that the scene is linked to; what they had is not there."""
    for library in bpy.data.libraries:
        path = bpy.path.abspath(library.filepath, library=library.parent)
        if library.packed_file is None and not os.path.exists(path):
            notes.add(library.name, "", "the linked file %s is missing; what it had is left out" % path)


def _note_light_paths(scene, cycles, notes):
    for thing, is_on, text in (
            ("Clamp direct", cycles.sample_clamp_direct > 0, "light is not clamped"),
            ("Clamp indirect", cycles.sample_clamp_indirect > 0, "light is not clamped"),
            ("Filter glossy", cycles.blur_glossy > 0, "reflections are as sharp as their roughness says"),
            ("Reflective caustics", not cycles.caustics_reflective, "they are rendered"),
            ("Refractive caustics", not cycles.caustics_refractive, "they are rendered"),
            ("Fast GI", cycles.use_fast_gi, "light is traced to its last bounce")):
        if is_on:
            notes.add(scene.name, thing, text)


def _note_film(scene, cycles, notes):
    render = scene.render
    blurred = render.use_motion_blur
    for thing, is_on, text in (
            ("Pixel filter", _has_other_filter(cycles), "it is a Gaussian of half a pixel"),
            ("Transparent glass", render.film_transparent and cycles.film_transparent_glass, "glass covers the background"),
            ("Rolling shutter", blurred and cycles.rolling_shutter_type != "NONE", "all rows see the same time"),
            ("Shutter curve", blurred and not _is_flat(render.motion_blur_shutter_curve), "the shutter opens and closes at once"),
            ("Texture limit", render.use_simplify and cycles.texture_limit_render != "OFF", "images have all their pixels"),
            ("Culling", render.use_simplify and (cycles.use_camera_cull or cycles.use_distance_cull), "no objects are left out")):
        if is_on:
            notes.add(scene.name, thing, text)


def _has_other_filter(cycles):
    """Whether the filter is neither Cycles' default, which is almost velo's, nor a box, which velo takes over."""
    is_default = cycles.pixel_filter_type == "BLACKMAN_HARRIS" and abs(cycles.filter_width - 1.5) < 1e-6
    return not is_default and cycles.pixel_filter_type != "BOX"


def _is_flat(mapping):
    """Whether a curve is 1 between its ends."""
    mapping.initialize()
    curve = mapping.curves[0]
    return all(abs(mapping.evaluate(curve, 0.05 * step) - 1) < 1e-3 for step in range(1, 20))


def _note_layer(layer, notes):
    for known in layer.bl_rna.properties:
        name = known.identifier
        if name.startswith("use_pass_") and name not in _KNOWN_PASSES and getattr(layer, name):
            notes.add(layer.name, "Pass %s" % known.name, "velo has no such pass; it is empty")
    cycles = getattr(layer, "cycles", None)
    for name in ("use_pass_volume_direct", "use_pass_volume_indirect", "use_pass_shadow_catcher", "pass_debug_sample_count"):
        if cycles is not None and getattr(cycles, name, False):
            notes.add(layer.name, "Pass %s" % cycles.bl_rna.properties[name].name, "velo has no such pass; it is empty")
    for aov in layer.aovs:
        notes.add(layer.name, "Shader AOV %s" % aov.name, "velo has no such pass; it is empty")
    for group in getattr(layer, "lightgroups", ()):
        notes.add(layer.name, "Light group %s" % group.name, "velo has no such pass; it is empty")


def _note_world(scene, notes):
    world = scene.world
    seen = getattr(world, "cycles_visibility", None)
    if seen is not None and not all(getattr(seen, name) for name in ("diffuse", "glossy", "transmission", "scatter")):
        notes.add(world.name, "Ray visibility", "all rays but the camera's see it")
    if getattr(getattr(world, "cycles", None), "max_bounces", 1024) < settings.bounces(scene):
        notes.add(world.name, "Max bounces", "it lights at every bounce")


def note_light(item, scene, notes):
    """The settings of a light object."""
    cycles = getattr(item.data, "cycles", None)
    if not (item.visible_diffuse and item.visible_glossy and item.visible_transmission and item.visible_volume_scatter):
        notes.add(item.name, "Ray visibility", "it lights everything")
    if cycles is None:
        return
    if not getattr(cycles, "cast_shadow", True):
        notes.add(item.name, "Cast shadow", "it casts shadows")
    if getattr(cycles, "max_bounces", 1024) < settings.bounces(scene):
        notes.add(item.name, "Max bounces", "it lights at every bounce")


def note_object(item, scene, notes):
    """The settings of an object with a surface."""
    if not (item.visible_shadow and item.visible_diffuse and item.visible_glossy and item.visible_transmission and
            item.visible_volume_scatter):
        notes.add(item.name, "Ray visibility", "all rays see it but, where they are switched off, those of the camera")
    if item.is_shadow_catcher:
        notes.add(item.name, "Shadow catcher", "it is an object like others")
    cycles, of_scene = getattr(item, "cycles", None), getattr(scene, "cycles", None)
    if cycles is None or of_scene is None:
        return
    if of_scene.feature_set == "EXPERIMENTAL" and cycles.use_adaptive_subdivision:
        notes.add(item.name, "Adaptive subdivision", "it has the levels of its modifier")
    if cycles.shadow_terminator_offset > 0:
        notes.add(item.name, "Shadow terminator", "shadows begin where they do")


def note_shadow(material, notes):
    """A material that is partly transparent."""
    if not getattr(getattr(material, "cycles", None), "use_transparent_shadow", True):
        notes.add(material.name, "Transparent shadows", "its shadow is as transparent as it is")
