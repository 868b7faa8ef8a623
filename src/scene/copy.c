/* scene/copy.c: a def is checked by its row, and what it points at is copied into the scene.
 * Every block is recorded in scene->blocks and freed with the scene, also after a failure. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "base/text.h"
#include "color/named.h"
#include "image/image.h"
#include "scene/scene.h"
#include "schema/schema.h"
#include "velo/edit.h"
#include "velo/texture.h"

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

static bool copy_spectrum(vlScene *scene, vlSpectrum *s, vlSource source, const char *what) {
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

/* ---- what a row describes ---------------------------------------------------------------- */

typedef struct Take {
  vlScene *scene;
  vlSource source;
  const char *what;
} Take;

static bool bad(const Take *t, const vlParameter *p, const char *why) {
  vl_scene_fail(t->scene, VL_ERROR_SCENE, t->source, "%s: parameter \"%s\" %s", t->what,
                vl_parameter_label(p), why);
  return false;
}

static bool take_texture(const Take *t, const vlParameter *p, vlTextureId id, bool spectrum) {
  if (!id.index)
    return true;
  if (p->flags & VL_PARAMETER_NO_TEXTURE)
    return bad(t, p, "cannot be textured");
  if (!vl_scene_has(t->scene, VL_SCENE_TEXTURES, id.index))
    return bad(t, p, "names a texture that does not exist (add it first)");
  if (t->scene->textures.items[id.index - 1].spectrum == spectrum)
    return true;
  return bad(t, p,
             spectrum ? "needs a spectrum texture, this is a float texture"
                      : "needs a float texture, this is a spectrum texture");
}

static bool take_spectrum(const Take *t, const vlParameter *p, vlSpectrum *s) {
  char what[160];
  snprintf(what, sizeof what, "%s: parameter \"%s\"", t->what, vl_parameter_label(p));
  if (!copy_spectrum(t->scene, s, t->source, what))
    return false;
  return !(p->flags & VL_PARAMETER_ONE_NUMBER) || s->kind == VL_SPECTRUM_CONSTANT ||
         bad(t, p, "must be one number");
}

static bool take_spectrum_input(const Take *t, const vlParameter *p, vlSpectrumInput *input) {
  if (!take_texture(t, p, input->texture, true))
    return false;
  if (!input->texture.index)
    return take_spectrum(t, p, &input->value);
  input->value = vl_spectrum_constant(1.0f);
  return true;
}

static bool take_member(const Take *t, const vlParameter *p, void *at) {
  switch (p->type) {
    case VL_PARAMETER_STRING:
    case VL_PARAMETER_FILE:
      return vl_scene_copy_string(t->scene, at);
    case VL_PARAMETER_SPECTRUM:
      return take_spectrum(t, p, at);
    case VL_PARAMETER_EITHER_INPUT:
    case VL_PARAMETER_FLOAT_INPUT:
      return take_texture(t, p, ((vlFloatInput *)at)->texture, false);
    case VL_PARAMETER_SPECTRUM_INPUT:
      return take_spectrum_input(t, p, at);
    case VL_PARAMETER_TEXTURE:
      return take_texture(t, p, *(vlTextureId *)at, true);
    case VL_PARAMETER_BOOL:
    case VL_PARAMETER_COUNT:
    case VL_PARAMETER_FLOAT:
    case VL_PARAMETER_DOUBLE:
    case VL_PARAMETER_FLOAT3:
    case VL_PARAMETER_DOUBLE3:
    case VL_PARAMETER_CHOICE:
    case VL_PARAMETER_BLOCK:
      return true;
  }
  return true;
}

static bool take_parameter(const Take *t, const vlParameter *p, char *def, bool spectrum) {
  if (p->type == VL_PARAMETER_EITHER_INPUT) { /* only the number or the spectrum is read; the
                                                 other is set to 0 */
    if (!spectrum) {
      *(vlSpectrumInput *)(void *)(def + p->second) = (vlSpectrumInput){0};
    } else {
      *(vlFloatInput *)(void *)(def + p->offset) = (vlFloatInput){0};
      return take_spectrum_input(t, p, (vlSpectrumInput *)(void *)(def + p->second));
    }
  } else if (p->second && !take_member(t, p, def + p->second)) {
    return false;
  }
  return take_member(t, p, def + p->offset);
}

bool vl_row_take(vlScene *scene, const vlKindRow *row, void *def, bool spectrum,
                 vlSource source, const char *what) {
  const Take t = {scene, source, what};
  char name[200];
  char message[VL_GIVEN_MESSAGE];
  for (uint32_t i = 0; i < row->parameter_count; i++) {
    const vlParameter *p = &row->parameters[i];
    if (p->flags & VL_PARAMETER_SHORTHAND)
      continue;
    if (!take_parameter(&t, p, def, spectrum))
      return false;
    snprintf(name, sizeof name, "%s: parameter \"%s\"", what, vl_parameter_label(p));
    if (vl_parameter_check(p, def, name, message))
      continue;
    vl_scene_fail(scene, VL_ERROR_SCENE, source, "%s", message);
    return false;
  }
  return true;
}
