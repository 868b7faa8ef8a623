/* schema/schema.c: the families of kinds; finds rows by name and applies their defaults; the
 * vl_default_*_def functions of scenes and of an image's settings. Defaults of scenes are
 * pbrt-v4's, since pbrt files leave most parameters out. */
#include <math.h>
#include <string.h>

#include "base/cookie.h"
#include "color/color.h"
#include "color/named.h"
#include "schema/schema.h"
#include "velo/filter_kinds.h"
#include "velo/load.h"
#include "velo/render.h"
#include "velo/sampler.h"
#include "velo/texture.h"
#include "velo/tracer.h"

static const vlKindFamily *const families[] = {
    &vl_material_family, &vl_texture_family, &vl_light_family,        &vl_emission_family,
    &vl_shape_family,    &vl_medium_family,  &vl_pixel_filter_family, &vl_sampler_family,
    &vl_tracer_family,   &vl_film_family,    &vl_camera_family,       &vl_setting_family};

const vlKindFamily *vl_kind_family(uint32_t index) {
  return index < sizeof families / sizeof *families ? families[index] : NULL;
}

const vlKindFamily *vl_kind_family_find(const char *name) {
  for (size_t i = 0; i < sizeof families / sizeof *families; i++)
    if (strcmp(families[i]->name, name) == 0)
      return families[i];
  return NULL;
}

const vlKindRow *vl_kind_row(const vlKindFamily *family, int kind) {
  return kind >= 0 && (uint32_t)kind < family->kind_count ? family->rows[kind] : NULL;
}

static bool is_named(const char *name, const char *alias, const char *text) {
  return (name && strcmp(name, text) == 0) || (alias && strcmp(alias, text) == 0);
}

int vl_kind_find(const vlKindFamily *family, const char *name) {
  for (uint32_t i = 0; i < family->kind_count; i++)
    if (is_named(family->rows[i]->name, family->rows[i]->alias, name))
      return (int)i;
  return -1;
}

size_t vl_kind_names(const vlKindFamily *family, const char **names, size_t most) {
  size_t count = 0;
  for (uint32_t i = 0; i < family->kind_count && count < most; i++)
    if (family->rows[i]->name)
      names[count++] = family->rows[i]->name;
  return count;
}

const vlParameter *vl_row_find(const vlKindRow *row, const char *name) {
  for (uint32_t i = 0; i < row->parameter_count; i++)
    if (is_named(row->parameters[i].name, row->parameters[i].alias, name))
      return &row->parameters[i];
  return NULL;
}

const char *vl_parameter_label(const vlParameter *p) {
  return p->name ? p->name : vl_setting_keyword(p);
}

/* ---- values ------------------------------------------------------------------------------ */

vlSpectrum vl_spectrum_constant(float value) {
  return (vlSpectrum){.kind = VL_SPECTRUM_CONSTANT, .scale = 1.0f, .value = value};
}
vlSpectrum vl_spectrum_rgb(float r, float g, float b) {
  return (vlSpectrum){.kind = VL_SPECTRUM_RGB, .scale = 1.0f, .rgb = {r, g, b}};
}
vlSpectrum vl_spectrum_blackbody(float kelvin) {
  return (vlSpectrum){.kind = VL_SPECTRUM_BLACKBODY, .scale = 1.0f, .kelvin = kelvin};
}
vlSpectrum vl_spectrum_named(const char *name) {
  return (vlSpectrum){.kind = VL_SPECTRUM_NAMED, .scale = 1.0f, .name = name};
}
const char *vl_spectrum_name(uint32_t index) {
  return vl_named_spectrum_name(index);
}

vlFloatInput vl_float_input(float value) {
  return (vlFloatInput){{0}, value};
}
vlSpectrumInput vl_spectrum_input(vlSpectrum value) {
  return (vlSpectrumInput){{0}, value};
}

/* ---- defaults ---------------------------------------------------------------------------- */

static vlSpectrum default_spectrum(const vlParameter *p) {
  if (p->text)
    return vl_spectrum_named(p->text);
  if (p->flags & VL_PARAMETER_RGB)
    return vl_spectrum_rgb((float)p->value[0], (float)p->value[1], (float)p->value[2]);
  return vl_spectrum_constant((float)p->value[0]);
}

void vl_parameter_put(const vlParameter *p, double number, void *at) {
  if (p->type == VL_PARAMETER_BOOL)
    *(bool *)at = number != 0;
  else if (p->type == VL_PARAMETER_COUNT)
    *(uint32_t *)at = (uint32_t)number;
  else if (p->type == VL_PARAMETER_CHOICE)
    *(int *)at = (int)number;
  else if (p->type == VL_PARAMETER_FLOAT)
    *(float *)at = (float)number;
  else if (p->type == VL_PARAMETER_DOUBLE)
    *(double *)at = number;
}

static void set_default(const vlParameter *p, void *at) {
  double number = p->value[0];
  switch (p->type) {
    case VL_PARAMETER_BOOL:
    case VL_PARAMETER_COUNT:
    case VL_PARAMETER_FLOAT:
    case VL_PARAMETER_CHOICE:
    case VL_PARAMETER_DOUBLE:
      if (p->type == VL_PARAMETER_DOUBLE && p->flags & VL_PARAMETER_UNSET)
        number = VL_UNSET;
      vl_parameter_put(p, number, at);
      break;
    case VL_PARAMETER_FLOAT3:
      for (int i = 0; i < 3; i++)
        ((float *)at)[i] = (float)p->value[i];
      break;
    case VL_PARAMETER_DOUBLE3:
      for (int i = 0; i < 3; i++)
        ((double *)at)[i] = p->flags & VL_PARAMETER_UNSET ? VL_UNSET : p->value[i];
      break;
    case VL_PARAMETER_STRING:
    case VL_PARAMETER_FILE:
      *(const char **)at = p->text;
      break;
    case VL_PARAMETER_SPECTRUM:
      *(vlSpectrum *)at = default_spectrum(p);
      break;
    case VL_PARAMETER_EITHER_INPUT:
    case VL_PARAMETER_FLOAT_INPUT:
      *(vlFloatInput *)at = vl_float_input((float)number);
      break;
    case VL_PARAMETER_SPECTRUM_INPUT:
      *(vlSpectrumInput *)at = vl_spectrum_input(default_spectrum(p));
      break;
    case VL_PARAMETER_TEXTURE:
      *(vlTextureId *)at = (vlTextureId){0};
      break;
    case VL_PARAMETER_BLOCK:
      break;
  }
}

void vl_row_set_defaults(const vlKindRow *row, void *def) {
  for (uint32_t i = 0; i < row->parameter_count; i++) {
    const vlParameter *p = &row->parameters[i];
    if (p->flags & VL_PARAMETER_SHORTHAND)
      continue;
    set_default(p, (char *)def + p->offset);
    if (!p->second)
      continue;
    void *second = (char *)def + p->second;
    if (p->type == VL_PARAMETER_EITHER_INPUT)
      *(vlSpectrumInput *)second = vl_spectrum_input(default_spectrum(p));
    else
      set_default(p, second);
  }
}

void vl_kind_set_defaults(const vlKindFamily *family, int kind, void *def) {
  const vlKindRow *row = vl_kind_row(family, kind);
  if (row)
    vl_row_set_defaults(row, def);
}

void vl_family_set_defaults(const vlKindFamily *family, int kind, void *def) {
  for (uint32_t i = 0; i < family->kind_count; i++)
    vl_row_set_defaults(family->rows[i], def);
  vl_kind_set_defaults(family, kind, def);
}

vlTextureDef vl_default_texture_def(vlTextureKind kind, bool spectrum) {
  vlTextureDef def = {.cookie = VL_COOKIE_TEXTURE,
                      .kind = kind,
                      .spectrum = spectrum,
                      .tint = {1, 1, 1, 1},
                      .channel = -1,
                      .cutoff = VL_UNSET};
  vl_kind_set_defaults(&vl_texture_family, (int)kind, &def);
  for (int i = 0; i < 4; i++)
    def.texture_from_world[5 * i] = 1;
  return def;
}

vlLoadDef vl_default_load_def(void) {
  return (vlLoadDef){
      .cookie = VL_COOKIE_LOAD, .time = VL_UNSET, .time_close = VL_UNSET, .unit = VL_UNSET};
}

/* ---- the settings of an image ------------------------------------------------------------ */

vlBuildDef vl_default_build_def(void) {
  return (vlBuildDef){.cookie = VL_COOKIE_BUILD,
                      .color = VL_COLOR_SPECTRAL,
                      .light_sampler = VL_LIGHT_SAMPLER_BVH};
}

vlFilmDef vl_default_film_def(uint32_t width, uint32_t height) {
  return (vlFilmDef){.cookie = VL_COOKIE_FILM,
                     .width = width,
                     .height = height,
                     .crop = {0, 0, width, height},
                     .filter = vl_default_pixel_filter(VL_PIXEL_FILTER_GAUSSIAN),
                     .space = (vlColorSpace)0,
                     .max_component = INFINITY,
                     .lambda_min = VL_LAMBDA_MIN,
                     .lambda_max = VL_LAMBDA_MIN + VL_LAMBDA_COUNT - 1};
}

vlDevelopDef vl_default_develop_def(void) {
  return (vlDevelopDef){.cookie = VL_COOKIE_DEVELOP, .exposure = 1.0f};
}

vlRenderDef vl_default_render_def(void) {
  return (vlRenderDef){.cookie = VL_COOKIE_RENDER,
                       .tracer = VL_TRACER_VOLPATH,
                       .sampler = VL_SAMPLER_ZSOBOL,
                       .spp = 16,
                       .max_depth = 5,
                       .ao_distance = INFINITY,
                       .merge_radius = VL_UNSET,
                       .light_paths = VL_AS_MANY_AS_PIXELS,
                       .noise_scale = 1.0f,
                       .share_samples = true,
                       .ao_cosine = true};
}

/* ---- members ----------------------------------------------------------------------------- */

_Static_assert(sizeof(vlWrap) == sizeof(int), "choices are stored as int");

void vl_row_copy_members(const vlKindRow *row, const void *from, void *to) {
  for (uint32_t i = 0; i < row->parameter_count; i++) {
    const vlParameter *p = &row->parameters[i];
    memcpy((char *)to + p->offset, (const char *)from + p->offset, p->size);
    if (p->second)
      memcpy((char *)to + p->second, (const char *)from + p->second,
             p->type == VL_PARAMETER_EITHER_INPUT ? sizeof(vlSpectrumInput) : p->size);
  }
}

static bool spectrum_number(const vlSpectrum *s, double *number) {
  *number = (double)(s->value * s->scale);
  return s->kind == VL_SPECTRUM_CONSTANT;
}

bool vl_parameter_number(const vlParameter *p, const void *def, double *number) {
  const void *at = (const char *)def + p->offset;
  switch (p->type) {
    case VL_PARAMETER_BOOL:
      *number = *(const bool *)at;
      return true;
    case VL_PARAMETER_COUNT:
      *number = *(const uint32_t *)at;
      return true;
    case VL_PARAMETER_FLOAT:
      *number = (double)*(const float *)at;
      return true;
    case VL_PARAMETER_DOUBLE:
      *number = *(const double *)at;
      return true;
    case VL_PARAMETER_CHOICE:
      *number = *(const int *)at;
      return true;
    case VL_PARAMETER_SPECTRUM:
      return spectrum_number(at, number);
    case VL_PARAMETER_EITHER_INPUT:
    case VL_PARAMETER_FLOAT_INPUT:
      *number = (double)((const vlFloatInput *)at)->value;
      return !((const vlFloatInput *)at)->texture.index;
    case VL_PARAMETER_SPECTRUM_INPUT: {
      const vlSpectrumInput *input = at;
      return !input->texture.index && spectrum_number(&input->value, number);
    }
    case VL_PARAMETER_FLOAT3:
    case VL_PARAMETER_DOUBLE3:
    case VL_PARAMETER_STRING:
    case VL_PARAMETER_FILE:
    case VL_PARAMETER_TEXTURE:
    case VL_PARAMETER_BLOCK:
      return false;
  }
  return false;
}

static bool same_spectrum(const vlSpectrum *a, const vlSpectrum *b) {
  if (a->kind != b->kind || a->scale != b->scale)
    return false;
  switch (a->kind) {
    case VL_SPECTRUM_CONSTANT:
      return a->value == b->value;
    case VL_SPECTRUM_RGB:
      return a->space == b->space && memcmp(a->rgb, b->rgb, sizeof a->rgb) == 0;
    case VL_SPECTRUM_BLACKBODY:
      return a->kelvin == b->kelvin;
    case VL_SPECTRUM_SAMPLED:
      return false; /* no default is a sampled spectrum */
    case VL_SPECTRUM_NAMED:
      return strcmp(a->name, b->name) == 0;
  }
  return false;
}

bool vl_parameter_is_default(const vlParameter *p, const void *def, bool spectrum) {
  const void *at = (const char *)def +
                   (spectrum && p->type == VL_PARAMETER_EITHER_INPUT ? p->second : p->offset);
  const vlSpectrum usual = default_spectrum(p);
  double number;
  if ((p->type == VL_PARAMETER_EITHER_INPUT && spectrum) ||
      p->type == VL_PARAMETER_SPECTRUM_INPUT)
    return !((const vlSpectrumInput *)at)->texture.index &&
           same_spectrum(&((const vlSpectrumInput *)at)->value, &usual);
  if (p->type == VL_PARAMETER_SPECTRUM)
    return same_spectrum(at, &usual);
  if (p->type == VL_PARAMETER_FLOAT3) {
    const float *v = at;
    return v[0] == (float)p->value[0] && v[1] == (float)p->value[1] &&
           v[2] == (float)p->value[2];
  }
  if (p->type == VL_PARAMETER_DOUBLE3) {
    const double *v = at;
    if (p->flags & VL_PARAMETER_UNSET)
      return v[0] != v[0] && v[1] != v[1] && v[2] != v[2];
    return v[0] == p->value[0] && v[1] == p->value[1] && v[2] == p->value[2];
  }
  if (p->type == VL_PARAMETER_STRING || p->type == VL_PARAMETER_FILE) {
    const char *text = *(const char *const *)at;
    return text && p->text ? strcmp(text, p->text) == 0 : text == p->text;
  }
  if (p->type == VL_PARAMETER_TEXTURE)
    return !((const vlTextureId *)at)->index;
  if (!vl_parameter_number(p, def, &number))
    return false;
  if (p->flags & VL_PARAMETER_UNSET)
    return number != number;
  return (float)number == (float)p->value[0];
}

uint32_t vl_row_textures(const vlKindRow *row, const void *def, vlTextureId *ids,
                         uint32_t most) {
  uint32_t n = 0;
  for (uint32_t i = 0; i < row->parameter_count; i++) {
    const vlParameter *p = &row->parameters[i];
    const char *at = (const char *)def + p->offset;
    vlTextureId read[2] = {{0}, {0}};
    if (p->flags & VL_PARAMETER_SHORTHAND)
      continue; /* other parameters have its members */
    if (p->type == VL_PARAMETER_FLOAT_INPUT || p->type == VL_PARAMETER_EITHER_INPUT)
      read[0] = ((const vlFloatInput *)(const void *)at)->texture;
    if (p->type == VL_PARAMETER_SPECTRUM_INPUT)
      read[0] = ((const vlSpectrumInput *)(const void *)at)->texture;
    if (p->type == VL_PARAMETER_TEXTURE)
      read[0] = *(const vlTextureId *)(const void *)at;
    if (p->type == VL_PARAMETER_EITHER_INPUT)
      read[1] =
          ((const vlSpectrumInput *)(const void *)((const char *)def + p->second))->texture;
    for (int k = 0; k < 2; k++)
      if (read[k].index && n < most)
        ids[n++] = read[k];
  }
  return n;
}
