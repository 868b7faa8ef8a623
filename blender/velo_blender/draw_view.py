"""draw_view.py: an image in a 3D view, by Blender's module gpu. Its display transform is Blender's."""
import gpu
from gpu_extras.presets import draw_texture_2d


def draw(engine, context, scene, image):
    """Draws an image, height x width x 4, float32, rows from the bottom, over the whole region."""
    height, width = image.shape[:2]
    buffer = gpu.types.Buffer("FLOAT", width * height * 4, image.ravel())
    texture = gpu.types.GPUTexture((width, height), format="RGBA16F", data=buffer)
    gpu.state.blend_set("ALPHA_PREMULT")
    engine.bind_display_space_shader(scene)
    draw_texture_2d(texture, (0, 0), context.region.width, context.region.height)
    engine.unbind_display_space_shader()
    gpu.state.blend_set("NONE")
