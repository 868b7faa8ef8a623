/* scene/copy.c: copies what a def points at into the scene: blocks, texts, images. Every block
 * is recorded in scene->blocks and freed with the scene, also after a failure. */
#include <string.h>

#include "image/image.h"
#include "scene/scene.h"

/* Makes the scene the owner of a block. On failure the block is freed. */
bool vl_scene_own(vlScene *scene, void *block) {
  if (!block)
    return true;
  void **slot = VL_PUSH(scene->context, &scene->blocks);
  if (!slot) {
    vl_free(scene->context, block);
    return vl_scene_fail_memory(scene);
  }
  *slot = block;
  return true;
}

/* Copies bytes. result_pointer: address of the pointer that receives the copy. It receives null
 * if data is null or has zero bytes. */
bool vl_scene_copy_block(vlScene *scene, const void *data, size_t count, size_t size,
                         void *result_pointer) {
  void *copy = NULL;
  if (data && count) {
    copy = vl_alloc_array(scene->context, count, size);
    if (!copy)
      return vl_scene_fail_memory(scene);
    memcpy(copy, data, count * size);
    if (!vl_scene_own(scene, copy))
      return false;
  }
  memcpy(result_pointer, &copy, sizeof copy);
  return true;
}

bool vl_scene_copy_array(vlScene *scene, void *pointer, size_t count, size_t size) {
  const void *data;
  memcpy(&data, pointer, sizeof data);
  return vl_scene_copy_block(scene, data, count, size, pointer);
}

bool vl_scene_copy_string(vlScene *scene, const char **text) {
  return !*text || vl_scene_copy_block(scene, *text, strlen(*text) + 1, 1, text);
}

bool vl_scene_copy_label(vlScene *scene, vlLabel *label) {
  return vl_scene_copy_string(scene, &label->name) &&
         vl_scene_copy_string(scene, &label->path) &&
         vl_scene_copy_string(scene, &label->place);
}

/* File names repeat, so each is stored once. The search for a stored name starts with the most
 * recent ones. */
bool vl_scene_copy_source(vlScene *scene, vlSource *source) {
  if (!source->file)
    return true;
  for (size_t i = scene->files.count; i > 0 && i + 16 > scene->files.count; i--) {
    if (strcmp(scene->files.items[i - 1], source->file) == 0) {
      source->file = scene->files.items[i - 1];
      return true;
    }
  }
  for (size_t i = 0; i < scene->files.count; i++) /* a def of this scene */
    if (scene->files.items[i] == source->file)
      return true;
  if (!vl_scene_copy_string(scene, &source->file))
    return false;
  const char **slot = VL_PUSH(scene->context, &scene->files);
  if (!slot)
    return vl_scene_fail_memory(scene);
  *slot = source->file;
  return true;
}

/* Whether the scene owns an image: that of a def that is set again. */
static bool is_own(const vlScene *scene, const vlImage *image) {
  for (size_t i = 0; i < scene->images.count; i++)
    if (scene->images.items[i] == image)
      return true;
  for (size_t i = 0; i < scene->edits.count; i++)
    if (scene->edits.items[i].image == image)
      return true;
  return false;
}

bool vl_scene_copy_image(vlScene *scene, const vlImage **image) {
  if (!*image || is_own(scene, *image))
    return true;
  const vlImage *from = *image;
  uint32_t channels = vl_image_channels(from);
  vlImageDef def = vl_default_image_def(vl_image_width(from), vl_image_height(from), channels);
  const char **names = vl_alloc_array(scene->context, channels, sizeof *names);
  vlImage **slot = names ? VL_PUSH(scene->context, &scene->images) : NULL;
  vlResult result = VL_ERROR_MEMORY;
  if (slot) {
    for (uint32_t i = 0; i < channels; i++)
      names[i] = vl_image_channel_name(from, i);
    def.names = names;
    def.type = vl_image_type(from);
    def.encoding = from->encoding;
    def.gamma = from->gamma;
    result = vl_image_create(scene->context, &def, slot);
    if (result != VL_OK) {
      scene->images.count--;
    } else {
      memcpy((*slot)->pixels, from->pixels, vl_image_row_size(from) * from->height);
      *image = *slot;
      vlAttribute colors;
      if (vl_image_find_attribute(from, "chromaticities", &colors) == VL_OK)
        result = vl_image_set_attribute(*slot, &colors);
    }
  }
  vl_free(scene->context, names);
  if (result == VL_OK)
    return true;
  return vl_scene_fail(scene, result, (vlSource){0},
                       result == VL_ERROR_MEMORY ? "out of memory" : "image cannot be copied");
}
