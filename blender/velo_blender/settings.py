"""settings.py: the settings of a render by velo, as properties of the scene: scene.velo."""
import bpy


class VeloSettings(bpy.types.PropertyGroup):
    """The settings of a final render and of the viewport."""
    samples: bpy.props.IntProperty(name="Samples", default=128, min=1, max=65536, description="Samples per pixel")
    preview_samples: bpy.props.IntProperty(name="Viewport samples", default=32, min=1, max=65536,
                                           description="Samples per pixel of the viewport")
    noise: bpy.props.FloatProperty(name="Noise", default=0.0, min=0.0, max=1.0, precision=4,
                                   description="The render ends where the image's error is below this; 0: after all samples")
    denoise: bpy.props.BoolProperty(name="Denoise", default=False, description="Denoise the colours by velo's denoiser")
    bounces_of_cycles: bpy.props.BoolProperty(name="Bounces of Cycles", default=True,
                                              description="Take the largest number of bounces from the settings of Cycles")
    bounces: bpy.props.IntProperty(name="Bounces", default=12, min=0, max=1024, description="Largest number of bounces")
    seed: bpy.props.IntProperty(name="Seed", default=0, min=0, description="Another seed gives other noise")
    spectral: bpy.props.BoolProperty(name="Spectral", default=False,
                                     description="Compute with wavelengths; off: with red, green and blue, as Cycles does")
    bake_size: bpy.props.IntProperty(name="Baked size", default=1024, min=16, max=8192,
                                     description="Pixels along a side of baked textures that have no image")
    dataset_folder: bpy.props.StringProperty(name="Folder", default="//dataset", subtype="DIR_PATH", description="Where the data set is written")
    dataset_formats: bpy.props.EnumProperty(name="Formats", options={"ENUM_FLAG"}, default={"coco"}, items=[
        ("coco", "COCO", "Instances, boxes, masks"), ("nerfstudio", "nerfstudio", "transforms.json, images, depths"),
        ("exr", "OpenEXR", "Linear colours, depth, normals, ids"), ("bop", "BOP", "Poses, masks and depths of rigid models")])
    depth_step: bpy.props.FloatProperty(name="Step of depth", default=1.0, min=0.001, max=1000.0,
                                        description="BOP: millimetres of a step of the depth; an image holds 65535 steps")


class VeloLayerSettings(bpy.types.PropertyGroup):
    """The settings of a view layer."""
    denoising_data: bpy.props.BoolProperty(name="Denoising data", default=False,
                                           description="Passes of albedo, normal and depth, means over the samples, for denoisers")


def bounces(scene):
    """The largest number of bounces: 0 is direct light alone, as in Cycles."""
    cycles = getattr(scene, "cycles", None)
    if scene.velo.bounces_of_cycles and cycles is not None:
        return int(cycles.max_bounces)
    return int(scene.velo.bounces)


def limits(scene):
    """Keywords of the limits of one kind of bounces that Cycles has, where they are below the number of all bounces."""
    cycles = getattr(scene, "cycles", None)
    if not scene.velo.bounces_of_cycles or cycles is None:
        return {}
    kinds = {"diffuse": cycles.diffuse_bounces, "glossy": cycles.glossy_bounces, "transmission": cycles.transmission_bounces,
             "volume": cycles.volume_bounces}
    return {f"max_{kind}_depth": count + 1 for kind, count in kinds.items() if count < bounces(scene)}


def exposure(scene):
    """The factor of Cycles' film on colours."""
    return float(getattr(getattr(scene, "cycles", None), "film_exposure", 1.0))


def pixel_filter(scene):
    """Keywords of velo's pixel filter: a box where Cycles has it, else velo's own."""
    if getattr(getattr(scene, "cycles", None), "pixel_filter_type", "") != "BOX":
        return {}
    return {"filter": "box", "filter_radius_x": 0.5, "filter_radius_y": 0.5}


def tracing(scene, samples):
    """Keywords of velo's render: samples, bounces, seed, colours."""
    words = {"spp": samples, "tracer": "volpath", "max_depth": bounces(scene) + 1, **limits(scene), "seed": scene.velo.seed,
             **pixel_filter(scene), "sharp_textures": True, **world_words(scene)}
    if scene.render.film_transparent:
        words["transparent"] = True
    if scene.velo.noise > 0:
        words["noise"] = scene.velo.noise
    return words


def world_words(scene):
    """Keywords of velo's world."""
    return {"color": "spectral" if scene.velo.spectral else "rgb"}


def register():
    bpy.utils.register_class(VeloSettings)
    bpy.utils.register_class(VeloLayerSettings)
    bpy.types.Scene.velo = bpy.props.PointerProperty(type=VeloSettings)
    bpy.types.ViewLayer.velo = bpy.props.PointerProperty(type=VeloLayerSettings)


def unregister():
    del bpy.types.ViewLayer.velo
    del bpy.types.Scene.velo
    bpy.utils.unregister_class(VeloLayerSettings)
    bpy.utils.unregister_class(VeloSettings)
