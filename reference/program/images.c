/* program/images.c: images of textures. The library reads the files, and gives their values as linear numbers. */
#include <stdlib.h>
#include <string.h>

#include "world.h"

static image_map make_image_map(const vlImage *image) {
  image_map map = {.image = image, .width = vl_image_width(image), .height = vl_image_height(image)};
  map.channels = vl_image_shown(image, map.channel);
  return map;
}

/* The same image, whose integers mean what the texture says instead of the file. */
static image_map decode_otherwise(vlContext *context, const vlImage *image, const vlTextureDef *texture) {
  static const size_t size[] = {
      [VL_PIXEL_U8] = 1, [VL_PIXEL_U16] = 2, [VL_PIXEL_F16] = 2, [VL_PIXEL_F32] = 4, [VL_PIXEL_U32] = 4};
  vlImageDef def = vl_default_image_def(vl_image_width(image), vl_image_height(image), vl_image_channels(image));
  const char **names = resize(NULL, def.channels, sizeof *names);
  for (uint32_t i = 0; i < def.channels; i++) names[i] = vl_image_channel_name(image, i);
  def.names = names;
  def.type = vl_image_type(image);
  def.encoding = texture->encoding;
  def.gamma = texture->gamma;
  vlImage *copy = NULL;
  vl_image_create(context, &def, &copy);
  free(names);
  memcpy(vl_image_pixels(copy), vl_image_const_pixels(image),
         (size_t)def.width * def.height * def.channels * size[def.type]);
  return make_image_map(copy);
}

static bool read_image_map(vlContext *context, const vlTextureDef *def, image_map *map, vlError *error) {
  vlImage *image = NULL;
  if (def->path && vl_image_read(context, def->path, &image, error) != VL_OK) return false;
  if (def->data && vl_image_read_memory(context, "image", def->data, def->data_size, &image, error) != VL_OK)
    return false;
  *map = make_image_map(image ? image : def->image);
  if (def->encoding_given) {
    *map = decode_otherwise(context, map->image, def);
    vl_image_destroy(image);
  }
  return true;
}

/* The primitives of a shape that emits an image share it. */
bool read_light_image(const world *w, light *l, vlError *error) {
  const light *before = l > w->lights && l->emission && l[-1].emission == l->emission ? l - 1 : NULL;
  const char *path = l->def ? l->def->path : l->emission->image;
  vlImage *image = NULL;
  if (before) l->map = before->map;
  if (before || (!path && !(l->def && l->def->image))) return true;
  if (path && vl_image_read(w->context, path, &image, error) != VL_OK) return false;
  l->map = make_image_map(image ? image : l->def->image);
  return true;
}

bool read_images(world *w, vlError *error) {
  const vlTextureDef *def;
  for (uint32_t i = 0; (def = vl_scene_texture(w->scene, (vlTextureId){i + 1})); i++) {
    w->images = resize(w->images, i + 1, sizeof *w->images);
    if (def->kind == VL_TEXTURE_IMAGE && !read_image_map(w->context, def, &w->images[i], error)) return false;
  }
  const vlMaterialDef *m;
  for (uint32_t i = 0; (m = vl_scene_material(w->scene, (vlMaterialId){i + 1})); i++) {
    vlTextureDef linear = {.path = m->normal_map, .encoding_given = true, .encoding = VL_ENCODING_LINEAR};
    w->normal_maps = resize(w->normal_maps, i + 1, sizeof *w->normal_maps);
    if (m->normal_map && !read_image_map(w->context, &linear, &w->normal_maps[i], error)) return false;
  }
  return true;
}
