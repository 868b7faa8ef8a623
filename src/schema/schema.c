/* schema/schema.c: the families of kinds; finds rows by name and applies their defaults; the
 * vl_default_*_def functions of scenes. Defaults of scenes are pbrt-v4's, since pbrt files
 * leave most parameters out. Also reads and writes the members of a def by their rows, and
 * tells whether a value fits its row. */
#include <float.h>
#include <math.h>
#include <string.h>

#include "base/cookie.h"
#include "base/text.h"
#include "base/unset.h"
#include "color/named.h"
#include "schema/schema.h"
#include "velo/setting.h"
#include "velo/texture.h"

static const vlKindFamily *const families[] = {
    &vl_material_family, &vl_texture_family, &vl_light_family,        &vl_emission_family,
    &vl_shape_family,    &vl_medium_family,  &vl_pixel_filter_family, &vl_sampler_family,
    &vl_tracer_family,   &vl_film_family,    &vl_camera_family,       &vl_setting_family};

const vlKindFamily *vl_kind_family(uint32_t index) {
  return index < VL_LENGTH(families) ? families[index] : NULL;
}

const vlKindFamily *vl_kind_family_find(const char *name) {
  for (size_t i = 0; i < VL_LENGTH(families); i++)
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

size_t vl_kind_names(const vlKindFamily *family, const char **names, size_t max) {
  size_t count = 0;
  for (uint32_t i = 0; i < family->kind_count && count < max; i++)
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

/* ---- how members are stored -------------------------------------------------------------- */

_Static_assert(sizeof(vlWrap) == sizeof(int), "choices are stored as int");

static double get_bool(const void *at, int i) {
  return ((const bool *)at)[i];
}
static void put_bool(void *at, int i, double number) {
  ((bool *)at)[i] = number != 0;
}
static double get_count(const void *at, int i) {
  return ((const uint32_t *)at)[i];
}
static void put_count(void *at, int i, double number) {
  ((uint32_t *)at)[i] = (uint32_t)number;
}
static double get_choice(const void *at, int i) {
  return ((const int *)at)[i];
}
static void put_choice(void *at, int i, double number) {
  ((int *)at)[i] = (int)number;
}
static double get_float(const void *at, int i) {
  return (double)((const float *)at)[i];
}
static void put_float(void *at, int i, double number) {
  ((float *)at)[i] = (float)number;
}
static double get_double(const void *at, int i) {
  return ((const double *)at)[i];
}
static void put_double(void *at, int i, double number) {
  ((double *)at)[i] = number;
}

#define NUMBERS(count, offset, get_function, put_function) \
  .numbers = (count), .number = (offset), .get = get_function, .put = put_function
const vlMemberType vl_member_types[] = {
    [VL_PARAMETER_BOOL] = {NUMBERS(1, 0, get_bool, put_bool), .rule = "true or false"},
    [VL_PARAMETER_COUNT] = {NUMBERS(1, 0, get_count, put_count)},
    [VL_PARAMETER_FLOAT] = {NUMBERS(1, 0, get_float, put_float)},
    [VL_PARAMETER_DOUBLE] = {NUMBERS(1, 0, get_double, put_double)},
    [VL_PARAMETER_FLOAT3] = {NUMBERS(3, 0, get_float, put_float)},
    [VL_PARAMETER_DOUBLE3] = {NUMBERS(3, 0, get_double, put_double)},
    [VL_PARAMETER_CHOICE] = {NUMBERS(1, 0, get_choice, put_choice)},
    [VL_PARAMETER_STRING] = {.text = true, .rule = "text"},
    [VL_PARAMETER_FILE] = {.text = true, .rule = "the path of a file"},
    [VL_PARAMETER_SPECTRUM] = {.spectral = true},
    [VL_PARAMETER_FLOAT_INPUT] = {NUMBERS(1, offsetof(vlFloatInput, value), get_float,
                                          put_float),
                                  .textured = true},
    [VL_PARAMETER_SPECTRUM_INPUT] = {.textured = true,
                                     .spectral = true,
                                     .spectrum = offsetof(vlSpectrumInput, value)},
    [VL_PARAMETER_EITHER_INPUT] = {NUMBERS(1, offsetof(vlFloatInput, value), get_float,
                                           put_float),
                                   .textured = true},
    [VL_PARAMETER_TEXTURE] = {.textured = true, .rule = "a texture"},
    [VL_PARAMETER_BLOCK] = {.rule = "what its file's format says"}};

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

/* The type of the member at `second`. */
static vlParameterType second_type(const vlParameter *p) {
  return p->type == VL_PARAMETER_EITHER_INPUT ? VL_PARAMETER_SPECTRUM_INPUT : p->type;
}

static void set_default(const vlParameter *p, vlParameterType type, void *at) {
  const vlMemberType *t = &vl_member_types[type];
  char *const bytes = at;
  if (t->textured)
    *(vlTextureId *)at = (vlTextureId){0};
  if (t->spectral)
    *(vlSpectrum *)(void *)(bytes + t->spectrum) = default_spectrum(p);
  if (t->text)
    *(const char **)at = p->text;
  for (int i = 0; i < t->numbers; i++)
    t->put(bytes + t->number, i, p->flags & VL_PARAMETER_UNSET ? VL_UNSET : p->value[i]);
}

/* ---- defaults of defs -------------------------------------------------------------------- */

void vl_row_set_defaults(const vlKindRow *row, void *def) {
  VL_EACH_PARAMETER(p, row) {
    if (p->flags & VL_PARAMETER_SHORTHAND)
      continue;
    set_default(p, p->type, (char *)def + p->offset);
    if (p->second)
      set_default(p, second_type(p), (char *)def + p->second);
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

/* ---- members ----------------------------------------------------------------------------- */

void vl_row_copy_members(const vlKindRow *row, const void *from, void *to) {
  VL_EACH_PARAMETER(p, row) {
    memcpy((char *)to + p->offset, (const char *)from + p->offset, p->size);
    if (p->second)
      memcpy((char *)to + p->second, (const char *)from + p->second,
             p->type == VL_PARAMETER_EITHER_INPUT ? sizeof(vlSpectrumInput) : p->size);
  }
}

void vl_given_put(const vlParameter *row, double number, void *def) {
  const vlMemberType *t = &vl_member_types[row->type];
  if (t->numbers != 1 || t->textured)
    return;
  t->put((char *)def + row->offset, 0, number);
  if (row->second)
    t->put((char *)def + row->second, 0, number);
}

bool vl_parameter_number(const vlParameter *p, const void *def, double *number) {
  const vlMemberType *t = &vl_member_types[p->type];
  const void *at = (const char *)def + p->offset;
  if (vl_member_texture(t, at))
    return false;
  if (t->spectral) {
    const vlSpectrum *s = vl_member_spectrum(t, at);
    *number = (double)(s->value * s->scale);
    return s->kind == VL_SPECTRUM_CONSTANT;
  }
  if (t->numbers == 1)
    *number = vl_member_number(t, at, 0);
  return t->numbers == 1;
}

/* ---- whether a value fits its row -------------------------------------------------------- */

static bool has_range(const vlParameter *p) {
  return (p->low != 0 || p->high != 0) && !(p->flags & VL_PARAMETER_CLAMPED);
}

double vl_parameter_low(const vlParameter *p) {
  if (p->type == VL_PARAMETER_COUNT && !(has_range(p) && p->low > 0))
    return 0;
  return has_range(p) ? p->low : (double)-INFINITY;
}

double vl_parameter_high(const vlParameter *p) {
  if (p->type == VL_PARAMETER_COUNT && !(has_range(p) && p->high < UINT32_MAX))
    return UINT32_MAX;
  return has_range(p) ? p->high : (double)INFINITY;
}

uint32_t vl_choice_count(const vlParameter *p) {
  uint32_t count = 0;
  while (p->choices && p->choices[count])
    count++;
  return count;
}

/* Whether the member that holds the number is a float. */
static bool is_single(const vlParameter *p) {
  return p->type != VL_PARAMETER_DOUBLE && p->type != VL_PARAMETER_DOUBLE3 &&
         p->type != VL_PARAMETER_COUNT;
}

bool vl_number_fits(const vlParameter *p, double x) {
  if (p->type == VL_PARAMETER_CHOICE)
    return x >= 0 && x < vl_choice_count(p);
  if ((p->flags & VL_PARAMETER_UNSET) && vl_is_unset(x))
    return true;
  if (isnan(x))
    return false;
  double low = vl_parameter_low(p);
  double high = vl_parameter_high(p);
  if (isinf(x))
    return p->flags & VL_PARAMETER_INFINITE && (x > 0 || isinf(low));
  if (is_single(p) && fabs(x) > (double)FLT_MAX)
    return false;
  if (p->type == VL_PARAMETER_COUNT && x != floor(x))
    return false;
  if (p->flags & VL_PARAMETER_ABOVE_LOW && has_range(p) ? !(x > low) : !(x >= low))
    return false;
  return p->flags & VL_PARAMETER_BELOW_HIGH && has_range(p) ? x < high : x <= high;
}

bool vl_parameter_fits(const vlParameter *p, const void *def, double *wrong) {
  const vlMemberType *t = &vl_member_types[p->type];
  const void *at = (const char *)def + p->offset;
  *wrong = 0;
  if (t->text)
    return !(p->flags & VL_PARAMETER_REQUIRED) || *(const char *const *)at;
  if (t->spectral)
    return !vl_parameter_number(p, def, wrong) || vl_number_fits(p, *wrong);
  for (int i = 0; i < t->numbers && !vl_member_texture(t, at); i++) {
    *wrong = vl_member_number(t, at, i);
    if (!vl_number_fits(p, *wrong))
      return false;
  }
  return true;
}

/* ---- defaults and textures of a def ------------------------------------------------------ */

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

static bool is_default_number(const vlParameter *p, double number, int i) {
  if (p->flags & VL_PARAMETER_UNSET)
    return isnan(number);
  if (p->type == VL_PARAMETER_DOUBLE3)
    return number == p->value[i];
  return (float)number == (float)p->value[i];
}

bool vl_parameter_is_default(const vlParameter *p, const void *def, bool spectrum) {
  const bool second = spectrum && p->type == VL_PARAMETER_EITHER_INPUT;
  const vlMemberType *t = &vl_member_types[second ? second_type(p) : p->type];
  const void *at = (const char *)def + (second ? p->second : p->offset);
  if (vl_member_texture(t, at) || p->type == VL_PARAMETER_BLOCK)
    return false;
  if (t->text) {
    const char *text = *(const char *const *)at;
    return text && p->text ? strcmp(text, p->text) == 0 : text == p->text;
  }
  if (t->spectral) {
    const vlSpectrum usual = default_spectrum(p);
    return same_spectrum(vl_member_spectrum(t, at), &usual);
  }
  bool same = true;
  for (int i = 0; i < t->numbers; i++)
    same = same && is_default_number(p, vl_member_number(t, at, i), i);
  return same;
}

uint32_t vl_row_textures(const vlKindRow *row, const void *def, vlTextureId *ids,
                         uint32_t max) {
  uint32_t n = 0;
  VL_EACH_PARAMETER(p, row) {
    const char *at = (const char *)def;
    if (p->flags & VL_PARAMETER_SHORTHAND)
      continue; /* other parameters have its members */
    const uint32_t read[2] = {
        vl_member_texture(&vl_member_types[p->type], at + p->offset),
        p->type == VL_PARAMETER_EITHER_INPUT
            ? vl_member_texture(&vl_member_types[second_type(p)], at + p->second)
            : 0};
    for (int k = 0; k < 2; k++)
      if (read[k] && n < max)
        ids[n++] = (vlTextureId){read[k]};
  }
  return n;
}
