/* scene/check_images.c: scene check: missing files, surfaces that reflect more light than they
 * receive, lights without power. It computes an upper bound of each texture's values: for a mix
 * the larger bound of its inputs, for a product the product of the bounds, for an image its
 * brightest texel. */
#include <math.h>

#include "base/file.h"
#include "base/free.h"
#include "base/text.h"
#include "color/color.h"
#include "image/image.h"
#include "scene/check.h"
#include "schema/schema.h"
#include "velo/light.h"
#include "velo/material.h"
#include "velo/medium.h"
#include "velo/texture.h"

/* ---- files ------------------------------------------------------------------------------- */

static bool file_is_there(vlCheck *c, const char *path, vlSource source) {
  vlError error = {0};
  const vlResult r = vl_file_check(c->context, path, &error);
  if (r != VL_OK)
    vl_check_add(c, r == VL_ERROR_MISSING ? VL_FINDING_MISSING_FILE : VL_FINDING_BROKEN_FILE,
                 VL_SEVERITY_ERROR, source, "%s", error.message);
  return r == VL_OK;
}

/* Checks that the files exist which the parameters of a def name. */
static void look_for_files_of(vlCheck *c, vlSceneFamily family, const void *def) {
  const vlKindRow *row = vl_scene_def_row(family, def);
  for (uint32_t i = 0; row && i < row->parameter_count; i++) {
    const vlParameter *p = &row->parameters[i];
    if (p->type != VL_PARAMETER_FILE)
      continue;
    const char *path = *(const char *const *)(const void *)((const char *)def + p->offset);
    if (path)
      file_is_there(c, path, vl_scene_def_source(family, def));
  }
}

static void look_for_files(vlCheck *c) {
  static const vlSceneFamily order[] = {VL_SCENE_TEXTURES, VL_SCENE_MATERIALS, VL_SCENE_LIGHTS,
                                        VL_SCENE_EMISSIONS, VL_SCENE_MEDIA};
  for (size_t k = 0; k < VL_LENGTH(order); k++)
    for (uint32_t i = 1; i <= vl_scene_highest(c->scene, order[k]); i++) {
      const void *def = vl_scene_item(c->scene, order[k], i);
      if (def)
        look_for_files_of(c, order[k], def);
    }
}

/* ---- greatest values --------------------------------------------------------------------- */

/* The largest value of a spectrum as a reflectance: over the RGB channels, or over all
 * wavelengths. 0: it cannot be computed, which the build of the world reports. */
static float spectrum_max(const vlSpectrum *s) {
  if (s->kind == VL_SPECTRUM_RGB) {
    float m = s->rgb[0] > s->rgb[1] ? s->rgb[0] : s->rgb[1];
    return s->scale * (m > s->rgb[2] ? m : s->rgb[2]);
  }
  if (s->kind == VL_SPECTRUM_CONSTANT)
    return s->scale * s->value;
  float dense[VL_LAMBDA_COUNT], max = 0;
  if (vl_spectrum_dense(s, VL_ROLE_ALBEDO, dense, NULL) != VL_OK)
    return 0;
  for (int i = 0; i < VL_LAMBDA_COUNT; i++)
    max = dense[i] > max ? dense[i] : max;
  return max;
}

/* Smallest and largest linear colour value of an image. False: it has no colours, or memory is
 * exhausted. */
static bool image_range(vlCheck *c, const vlImage *image, float range[2]) {
  uint32_t channel[4], n = vl_image_color(image, channel);
  if (n == 2 || n == 4)
    n--; /* alpha is not a colour */
  float *row = n ? vl_alloc_array(c->context, (size_t)image->width * n, sizeof *row) : NULL;
  if (!row)
    return false;
  range[0] = INFINITY;
  range[1] = -INFINITY;
  for (uint32_t y = 0; y < image->height; y++) {
    vl_image_row_to_float(image, y, channel, n, row);
    for (size_t i = 0; i < (size_t)image->width * n; i++) {
      range[0] = row[i] < range[0] ? row[i] : range[0];
      range[1] = row[i] > range[1] ? row[i] : range[1];
    }
  }
  vl_free(c->context, row);
  return true;
}

/* Upper bound of an image texture's values. An image that is not read, because it is missing or
 * broken, counts as one of values from 0 to 1. */
static float image_max(vlCheck *c, const vlTextureDef *t) {
  float tint = t->tint[0] > t->tint[1] ? t->tint[0] : t->tint[1], range[2] = {0, 1};
  tint = tint > t->tint[2] ? tint : t->tint[2];
  bool floats = t->image || t->data || !t->path || vl_ends_with(t->path, ".exr") ||
                vl_ends_with(t->path, ".hdr") || vl_ends_with(t->path, ".pfm");
  vlImage *image = NULL;
  /* Values of integer images are at most 1, so these are read only if a factor enlarges the
   * values. */
  if (c->def.images && !t->image && (floats || t->scale * tint > 1.0f || t->invert)) {
    vlError error;
    vlResult r = t->data   ? vl_image_read_memory(c->context, t->name ? t->name : "an image",
                                                  t->data, t->data_size, &image, &error)
                 : t->path ? vl_image_read_named(c->context, NULL, t->path, &image, &error)
                           : VL_ERROR_MISSING;
    if (r == VL_ERROR_MEMORY)
      c->no_memory = true;
    if (r == VL_ERROR_SCENE || r == VL_ERROR_UNSUPPORTED)
      vl_check_add(c, VL_FINDING_BROKEN_FILE, VL_SEVERITY_ERROR, t->source, "%s",
                   error.message);
  }
  if (image || t->image)
    if (!image_range(c, image ? image : t->image, range)) {
      range[0] = 0;
      range[1] = 1;
    }
  vl_image_destroy(image);
  /* as in pbrt, values are first scaled, then inverted */
  return (t->invert ? 1.0f - t->scale * range[0] : t->scale * range[1]) * tint;
}

/* The largest of the inputs that the kind has, for kinds that choose between or interpolate
 * them; 0 for kinds without inputs: the colours of noise textures are fixed. */
static float largest_input(const vlTextureDef *t, const float in[4]) {
  const vlKindRow *row = vl_kind_row(&vl_texture_family, (int)t->kind);
  const size_t offsets[4] = {offsetof(vlTextureDef, float_a), offsetof(vlTextureDef, float_b),
                             offsetof(vlTextureDef, float_c), offsetof(vlTextureDef, float_d)};
  float largest = 0;
  for (uint32_t i = 0; i < row->parameter_count; i++)
    for (int k = 0; k < 4; k++)
      if (row->parameters[i].type == VL_PARAMETER_EITHER_INPUT &&
          row->parameters[i].offset == offsets[k])
        largest = vl_max(largest, in[k]);
  return largest;
}

/* Upper bound of the values of a texture that a reflectance may read; 0 for other textures.
 * known: bounds of the textures added before. */
static float texture_max(vlCheck *c, const vlTextureDef *t, const float *known) {
  float in[4];
  const vlFloatInput *floats[4] = {&t->float_a, &t->float_b, &t->float_c, &t->float_d};
  const vlSpectrumInput *spectra[4] = {&t->spectrum_a, &t->spectrum_b, &t->spectrum_c,
                                       &t->spectrum_d};
  for (int i = 0; i < 4; i++) {
    uint32_t id = t->spectrum ? spectra[i]->texture.index : floats[i]->texture.index;
    in[i] = id            ? known[id - 1]
            : t->spectrum ? spectrum_max(&spectra[i]->value)
                          : floats[i]->value;
  }
  float amount = t->amount.texture.index ? known[t->amount.texture.index - 1] : t->amount.value;
  if (t->kind == VL_TEXTURE_IMAGE)
    return image_max(c, t);
  if (t->kind == VL_TEXTURE_SCALE)
    return in[0] * amount;
  if (t->kind == VL_TEXTURE_MIX && !t->amount.texture.index)
    return in[0] * (1 - amount) + in[1] * amount;
  return largest_input(t, in);
}

/* A reflectance or transmittance of a material. */
typedef struct Share {
  const char *what; /* its name in files */
  const vlSpectrumInput *input;
  float factor; /* by which the material multiplies it */
} Share;
enum { MAX_SHARES = 6 }; /* of one material; no row has as many */

/* Whether the material reads this input. Some kinds read their reflectance only if the def says
 * so. */
static bool is_read(const vlMaterialDef *m, uint32_t traits, const vlSpectrumInput *input) {
  if (input != &m->reflectance)
    return true;
  if (m->kind == VL_MATERIAL_SUBSURFACE)
    return m->subsurface.from_reflectance;
  if (m->kind == VL_MATERIAL_HAIR)
    return m->hair.color == VL_HAIR_REFLECTANCE;
  return !(traits & VL_MATERIAL_METAL) || m->use_reflectance;
}

/* The material's reflectances and transmittances: the parameters of its row with the role of an
 * albedo, as far as the def makes use of them. Returns their number. */
static uint32_t shares_of(const vlMaterialDef *m, Share list[MAX_SHARES]) {
  const vlKindRow *row = vl_kind_row(&vl_material_family, (int)m->kind);
  /* that of a subsurface material is a factor on lengths */
  const float factor = m->kind == VL_MATERIAL_DIFFUSE_TRANSMISSION ? m->scale : 1;
  uint32_t n = 0;
  for (uint32_t i = 0; i < row->parameter_count && n < MAX_SHARES; i++) {
    const vlParameter *p = &row->parameters[i];
    if (p->type != VL_PARAMETER_SPECTRUM_INPUT || p->role != VL_PARAMETER_ALBEDO)
      continue;
    const vlSpectrumInput *input = (const void *)((const char *)m + p->offset);
    if (is_read(m, row->traits, input))
      list[n++] = (Share){p->name, input, factor};
  }
  return n;
}

/* Marks the textures that reflectances read, by themselves or through others. needed: one entry
 * per texture, zero on entry. */
static void mark_needed(vlCheck *c, uint8_t *needed) {
  const vlScene *s = c->scene;
  Share list[MAX_SHARES];
  vlTextureId inputs[VL_CHECK_INPUTS];
  for (size_t i = 0; i < s->materials.count; i++) {
    uint32_t n = shares_of(&s->materials.items[i], list);
    for (uint32_t k = 0; k < n; k++)
      if (list[k].input->texture.index)
        needed[list[k].input->texture.index - 1] = 1;
  }
  for (size_t i = s->textures.count; i-- > 0;) {
    uint32_t n =
        needed[i] ? vl_check_inputs(VL_SCENE_TEXTURES, &s->textures.items[i], inputs) : 0;
    for (uint32_t k = 0; k < n; k++)
      needed[inputs[k].index - 1] = 1;
  }
}

static void check_albedo(vlCheck *c) {
  const vlScene *s = c->scene;
  /* largest value accepted; above 1 because scaled colours are rounded */
  const float max = 1.001f;
  uint8_t *needed = vl_alloc_zero(c->context, s->textures.count + 1, 1);
  float *known = vl_alloc_zero(c->context, s->textures.count + 1, sizeof *known);
  if (!needed || !known)
    c->no_memory = true;
  if (!c->no_memory)
    mark_needed(c, needed);
  for (size_t i = 0; i < s->textures.count && !c->no_memory; i++)
    if (needed[i])
      known[i] = texture_max(c, &s->textures.items[i], known);
  for (size_t i = 0; i < s->materials.count && !c->no_memory; i++) {
    const vlMaterialDef *m = &s->materials.items[i];
    Share list[MAX_SHARES];
    float sum = 0;
    uint32_t n = shares_of(m, list);
    for (uint32_t k = 0; k < n; k++) {
      uint32_t id = list[k].input->texture.index;
      float value = list[k].factor * (id ? known[id - 1] : spectrum_max(&list[k].input->value));
      if (m->kind == VL_MATERIAL_DIFFUSE_TRANSMISSION)
        sum += value;
      if (!(value > max))
        continue;
      if (id)
        vl_check_add(c, VL_FINDING_ALBEDO, VL_SEVERITY_WARNING,
                     s->textures.items[id - 1].source,
                     "%s reaches %.4g as the %s of %s: surfaces give back at most 1",
                     vl_check_texture_name(&s->textures.items[id - 1]).text, (double)value,
                     list[k].what, vl_check_material_name(m).text);
      else
        vl_check_add(c, VL_FINDING_ALBEDO, VL_SEVERITY_WARNING, m->source,
                     "%s: its %s is %.4g: surfaces give back at most 1",
                     vl_check_material_name(m).text, list[k].what, (double)value);
      sum = 0;
    }
    if (sum > max)
      vl_check_add(c, VL_FINDING_ALBEDO, VL_SEVERITY_WARNING, m->source,
                   "%s: reflectance and transmittance add up to %.4g: at most 1 is physical",
                   vl_check_material_name(m).text, (double)sum);
  }
  VL_FREE(c->context, needed, known);
}

/* ---- lights ------------------------------------------------------------------------------ */

static bool is_dark(const vlSpectrum *s, float scale, bool image) {
  return scale == 0.0f || (!image && !(spectrum_max(s) > 0.0f));
}

static void check_lights(vlCheck *c) {
  const vlScene *s = c->scene;
  for (size_t i = 0; i < s->lights.count; i++) {
    const vlLightDef *l = &s->lights.items[i];
    if (vl_scene_light_is_removed(s, i))
      continue;
    if (is_dark(&l->color, l->scale, l->path || l->image || l->lamp_data) || l->power == 0.0 ||
        l->illuminance == 0.0)
      vl_check_add(c, VL_FINDING_DARK_LIGHT, VL_SEVERITY_WARNING, l->source,
                   "this light gives no light: its power is 0");
  }
  for (size_t i = 0; i < s->emissions.count; i++) {
    const vlEmissionDef *e = &s->emissions.items[i];
    if (c->used[VL_SCENE_EMISSIONS][i] &&
        (is_dark(&e->radiance, e->scale, e->image || e->texture.index) || e->power == 0.0))
      vl_check_add(c, VL_FINDING_DARK_LIGHT, VL_SEVERITY_WARNING, e->source,
                   "this area light gives no light: its power is 0");
  }
}

void vl_check_images(vlCheck *c) {
  look_for_files(c);
  check_albedo(c);
  check_lights(c);
}
