/* scene/copy.c: deep copies of what a def points at. Every block is recorded in scene->blocks
 * and freed with the scene, also after a failure. */
#include <math.h>
#include <string.h>

#include "base/text.h"
#include "color/named.h"
#include "image/image.h"
#include "scene/scene.h"

static const vlSource nowhere = {NULL, 0, 0};

/* Makes the scene the owner of a block. On failure the block is freed. */
bool vl_scene_own(vlScene *scene, void *block) {
  if (!block)
    return true;
  void **slot = VL_PUSH(scene->context, &scene->blocks);
  if (!slot) {
    vl_free(scene->context, block);
    vl_scene_fail(scene, VL_ERROR_MEMORY, nowhere, "out of memory");
    return false;
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
    if (!copy) {
      vl_scene_fail(scene, VL_ERROR_MEMORY, nowhere, "out of memory");
      return false;
    }
    memcpy(copy, data, count * size);
    if (!vl_scene_own(scene, copy))
      return false;
  }
  memcpy(result_pointer, &copy, sizeof copy);
  return true;
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
  if (!slot) {
    vl_scene_fail(scene, VL_ERROR_MEMORY, nowhere, "out of memory");
    return false;
  }
  *slot = source->file;
  return true;
}

static bool check_name(vlScene *scene, const char *name, vlSource source, const char *what) {
  const char *names[512];
  unsigned count = 0;
  for (const char *known; count < 512 && (known = vl_named_spectrum_name(count)); count++) {
    if (strcmp(known, name) == 0)
      return true;
    names[count] = known;
  }
  const char *near = vl_nearest_name(name, names, count);
  vl_scene_fail(scene, VL_ERROR_SCENE, source,
                near ? "%s: no spectrum is named \"%s\" (did you mean \"%s\"?)"
                     : "%s: no spectrum is named \"%s\"",
                what, vl_argument_text(name).text, near);
  return false;
}

bool vl_scene_copy_spectrum(vlScene *scene, vlSpectrum *s, vlSource source, const char *what) {
  const char *bad = NULL;
  if (!isfinite(s->scale))
    bad = "scale is not finite";
  switch (s->kind) {
    case VL_SPECTRUM_CONSTANT:
      if (!isfinite(s->value))
        bad = "value is not finite";
      break;
    case VL_SPECTRUM_RGB:
      for (int i = 0; i < 3; i++)
        if (!isfinite(s->rgb[i]))
          bad = "rgb value is not finite";
      for (int i = 0; i < 3 && !bad; i++)
        if (s->rgb[i] < 0.0f)
          bad = "rgb value is negative";
      break;
    case VL_SPECTRUM_BLACKBODY:
      if (!(s->kelvin > 0.0f) || !isfinite(s->kelvin))
        bad = "blackbody temperature must be above 0 kelvin";
      break;
    case VL_SPECTRUM_SAMPLED:
      if (s->count == 0 || !s->wavelengths || !s->values)
        bad = "sampled spectrum has no samples";
      for (uint32_t i = 0; i < s->count && !bad; i++) {
        if (!isfinite(s->wavelengths[i]) || !isfinite(s->values[i]))
          bad = "sampled spectrum has a value that is not finite";
        else if (i && !(s->wavelengths[i] > s->wavelengths[i - 1]))
          bad = "wavelengths of the sampled spectrum are not ascending";
      }
      break;
    case VL_SPECTRUM_NAMED:
      if (!s->name)
        bad = "spectrum has no name";
      else if (!check_name(scene, s->name, source, what))
        return false;
      break;
    default:
      bad = "unknown kind of spectrum";
      break;
  }
  if (bad) {
    vl_scene_fail(scene, VL_ERROR_SCENE, source, "%s: %s", what, bad);
    return false;
  }
  if (s->kind == VL_SPECTRUM_SAMPLED)
    return vl_scene_copy_block(scene, s->wavelengths, s->count, sizeof(float),
                               &s->wavelengths) &&
           vl_scene_copy_block(scene, s->values, s->count, sizeof(float), &s->values);
  s->wavelengths = s->values = NULL;
  s->count = 0;
  if (s->kind != VL_SPECTRUM_NAMED)
    s->name = NULL;
  return vl_scene_copy_string(scene, &s->name);
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
  vl_scene_fail(scene, result, nowhere,
                result == VL_ERROR_MEMORY ? "out of memory" : "image cannot be copied");
  return false;
}
