/* schema/schema.c: the families of kinds; finds rows by name and applies their defaults; the
 * vl_default_*_def functions of scenes and of an image's settings. Defaults of scenes are
 * pbrt-v4's, since pbrt files leave most parameters out. Also checks a value by the row of its
 * parameter or setting: one that somebody gave, or a member of a def; all messages about values
 * of rows are written here: the name, what it must be, the value, the nearest name. */
#include <float.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "base/cookie.h"
#include "base/text.h"
#include "base/unset.h"
#include "color/color.h"
#include "color/named.h"
#include "schema/schema.h"
#include "velo/filter_kinds.h"
#include "velo/load.h"
#include "velo/render.h"
#include "velo/sampler.h"
#include "velo/setting.h"
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

/* ---- the types of parameters ------------------------------------------------------------- */

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

/* How the value of a parameter is stored. Offsets are from the value's begin. */
typedef struct Type {
  int numbers;   /* 1 or 3; 0: it holds a spectrum, a text, or something else */
  size_t number; /* offset of the first one */
  double (*get)(const void *at, int i);
  void (*put)(void *at, int i, double number);
  bool textured;    /* it begins with the id of a texture, which stands for the rest */
  bool spectral;    /* it holds a spectrum */
  size_t spectrum;  /* offset of the spectrum */
  bool text;        /* it is a pointer to characters */
  const char *rule; /* what it must be; null: put_rule writes that */
} Type;

#define NUMBERS(count, offset, get_function, put_function) \
  .numbers = (count), .number = (offset), .get = get_function, .put = put_function
static const Type types[] = {
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

/* The type of the member at `second`. */
static vlParameterType second_type(const vlParameter *p) {
  return p->type == VL_PARAMETER_EITHER_INPUT ? VL_PARAMETER_SPECTRUM_INPUT : p->type;
}

static uint32_t texture_of(const Type *type, const void *at) {
  return type->textured ? ((const vlTextureId *)at)->index : 0;
}

static double number_of(const Type *type, const void *at, int i) {
  return type->get((const char *)at + type->number, i);
}

static const vlSpectrum *spectrum_of(const Type *type, const void *at) {
  return (const vlSpectrum *)(const void *)((const char *)at + type->spectrum);
}

static void set_default(const vlParameter *p, vlParameterType type, void *at) {
  const Type *t = &types[type];
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
  for (uint32_t i = 0; i < row->parameter_count; i++) {
    const vlParameter *p = &row->parameters[i];
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

void vl_row_copy_members(const vlKindRow *row, const void *from, void *to) {
  for (uint32_t i = 0; i < row->parameter_count; i++) {
    const vlParameter *p = &row->parameters[i];
    memcpy((char *)to + p->offset, (const char *)from + p->offset, p->size);
    if (p->second)
      memcpy((char *)to + p->second, (const char *)from + p->second,
             p->type == VL_PARAMETER_EITHER_INPUT ? sizeof(vlSpectrumInput) : p->size);
  }
}

bool vl_parameter_number(const vlParameter *p, const void *def, double *number) {
  const Type *t = &types[p->type];
  const void *at = (const char *)def + p->offset;
  if (texture_of(t, at))
    return false;
  if (t->spectral) {
    const vlSpectrum *s = spectrum_of(t, at);
    *number = (double)(s->value * s->scale);
    return s->kind == VL_SPECTRUM_CONSTANT;
  }
  if (t->numbers == 1)
    *number = number_of(t, at, 0);
  return t->numbers == 1;
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

static bool is_default_number(const vlParameter *p, double number, int i) {
  if (p->flags & VL_PARAMETER_UNSET)
    return isnan(number);
  if (p->type == VL_PARAMETER_DOUBLE3)
    return number == p->value[i];
  return (float)number == (float)p->value[i];
}

bool vl_parameter_is_default(const vlParameter *p, const void *def, bool spectrum) {
  const bool second = spectrum && p->type == VL_PARAMETER_EITHER_INPUT;
  const Type *t = &types[second ? second_type(p) : p->type];
  const void *at = (const char *)def + (second ? p->second : p->offset);
  if (texture_of(t, at) || p->type == VL_PARAMETER_BLOCK)
    return false;
  if (t->text) {
    const char *text = *(const char *const *)at;
    return text && p->text ? strcmp(text, p->text) == 0 : text == p->text;
  }
  if (t->spectral) {
    const vlSpectrum usual = default_spectrum(p);
    return same_spectrum(spectrum_of(t, at), &usual);
  }
  bool same = true;
  for (int i = 0; i < t->numbers; i++)
    same = same && is_default_number(p, number_of(t, at, i), i);
  return same;
}

uint32_t vl_row_textures(const vlKindRow *row, const void *def, vlTextureId *ids,
                         uint32_t most) {
  uint32_t n = 0;
  for (uint32_t i = 0; i < row->parameter_count; i++) {
    const vlParameter *p = &row->parameters[i];
    const char *at = (const char *)def;
    if (p->flags & VL_PARAMETER_SHORTHAND)
      continue; /* other parameters have its members */
    const uint32_t read[2] = {texture_of(&types[p->type], at + p->offset),
                              p->type == VL_PARAMETER_EITHER_INPUT
                                  ? texture_of(&types[second_type(p)], at + p->second)
                                  : 0};
    for (int k = 0; k < 2; k++)
      if (read[k] && n < most)
        ids[n++] = (vlTextureId){read[k]};
  }
  return n;
}

/* ---- what a value must be ---------------------------------------------------------------- */

static bool has_range(const vlParameter *row) {
  return (row->low != 0 || row->high != 0) && !(row->flags & VL_PARAMETER_CLAMPED);
}

static double low_of(const vlParameter *row) {
  if (row->type == VL_PARAMETER_COUNT && !(has_range(row) && row->low > 0))
    return 0;
  return has_range(row) ? row->low : (double)-INFINITY;
}

static double high_of(const vlParameter *row) {
  bool counts = row->type == VL_PARAMETER_COUNT;
  if (counts && !(has_range(row) && row->high < UINT32_MAX))
    return UINT32_MAX;
  return has_range(row) ? row->high : (double)INFINITY;
}

/* Whether the member that holds the number is a float. */
static bool is_single(const vlParameter *row) {
  return row->type != VL_PARAMETER_DOUBLE && row->type != VL_PARAMETER_DOUBLE3 &&
         row->type != VL_PARAMETER_COUNT;
}

/* Writes a whole number without an exponent, others with up to 6 digits: angles in degrees are
 * rounded. */
static const char *put_number(char text[40], double number) {
  bool whole = fabs(number) < 1e15 && number == floor(number);
  snprintf(text, 40, whole ? "%.0f" : "%.6g", number);
  return text;
}

/* Writes "a whole number from 1 to 64", "a number above 0, or infinity". factor: as in
 * vlGiven. */
static void put_number_rule(const vlParameter *row, double factor, char *rule, size_t size) {
  const char *const thing = row->type == VL_PARAMETER_COUNT ? "whole number" : "number";
  char low[40];
  char high[40];
  put_number(low, low_of(row) / factor);
  put_number(high, high_of(row) / factor);
  bool above = row->flags & VL_PARAMETER_ABOVE_LOW;
  bool below = row->flags & VL_PARAMETER_BELOW_HIGH;
  bool has_low = isfinite(low_of(row));
  bool has_high = isfinite(high_of(row));
  if (has_low && has_high && !above && !below)
    snprintf(rule, size, "a %s from %s to %s", thing, low, high);
  else if (has_low && has_high)
    snprintf(rule, size, "a %s %s %s and %s %s", thing, above ? "above" : "of at least", low,
             below ? "below" : "at most", high);
  else if (has_low)
    snprintf(rule, size, "a %s %s %s", thing, above ? "above" : "of at least", low);
  else if (has_high)
    snprintf(rule, size, "a %s %s %s", thing, below ? "below" : "of at most", high);
  else
    snprintf(rule, size, "a finite %s", thing);
  size_t used = strlen(rule);
  const bool in_radians =
      factor == 1 && row->factor != 0 && row->unit && strcmp(row->unit, "degrees") == 0;
  const char *unit = in_radians ? "radians" : factor != 1 ? row->unit : NULL;
  if (unit)
    used += (size_t)snprintf(rule + used, size - used, " %s", unit);
  if (row->flags & VL_PARAMETER_INFINITE)
    snprintf(rule + used, size - used, ", or infinity");
}

/* As many whole names as fit; "..." stands for the others. */
static void put_choices(const char *const *choices, char *rule, size_t size) {
  const char *const more = ", ...";
  size_t used = (size_t)snprintf(rule, size, "one of ");
  for (int i = 0; choices[i]; i++) {
    const size_t rest = choices[i + 1] ? strlen(more) : 0;
    if (used + 2 + strlen(choices[i]) + rest >= size) {
      snprintf(rule + used, size - used, "%s", more);
      return;
    }
    used += (size_t)snprintf(rule + used, size - used, "%s%s", i ? ", " : "", choices[i]);
  }
}

static void put_rule(const vlParameter *row, double factor, char *rule, size_t size) {
  const char *known = types[row->type].rule;
  if (known)
    snprintf(rule, size, "%s", known);
  else if (row->type == VL_PARAMETER_CHOICE)
    put_choices(row->choices, rule, size);
  else
    put_number_rule(row, factor, rule, size);
}

/* ---- whether it is that ------------------------------------------------------------------ */

/* Whether a number in the def's unit is finite (or may be infinite, or unset), whole if it must
 * be, and in range. */
static bool in_range(const vlParameter *row, double x) {
  if ((row->flags & VL_PARAMETER_UNSET) && vl_is_unset(x))
    return true;
  if (isnan(x))
    return false;
  if (isinf(x))
    return row->flags & VL_PARAMETER_INFINITE && (x > 0 || isinf(low_of(row)));
  if (is_single(row) && fabs(x) > (double)FLT_MAX)
    return false;
  if (row->type == VL_PARAMETER_COUNT && x != floor(x))
    return false;
  double low = low_of(row);
  double high = high_of(row);
  if (row->flags & VL_PARAMETER_ABOVE_LOW && has_range(row) ? !(x > low) : !(x >= low))
    return false;
  return row->flags & VL_PARAMETER_BELOW_HIGH && has_range(row) ? x < high : x <= high;
}

/* Compares letters and digits only, whatever their case: "off-axis" is "OFF_AXIS". */
static bool same_word(const char *a, const char *b) {
  for (;; a++, b++) {
    while (*a == '_' || *a == '-' || *a == ' ')
      a++;
    while (*b == '_' || *b == '-' || *b == ' ')
      b++;
    char x = *a >= 'A' && *a <= 'Z' ? (char)(*a + 32) : *a;
    char y = *b >= 'A' && *b <= 'Z' ? (char)(*b + 32) : *b;
    if (x != y)
      return false;
    if (!x)
      return true;
  }
}

static int find_word(const char *const *choices, const char *word) {
  for (int i = 0; choices[i]; i++)
    if (same_word(choices[i], word))
      return i;
  return -1;
}

static bool fits_text(const vlParameter *row, const vlGiven *given) {
  if (given->kind == VL_GIVEN_NOTHING)
    return !(row->flags & VL_PARAMETER_REQUIRED);
  return given->kind == VL_GIVEN_TEXT && (given->text[0] || row->type == VL_PARAMETER_STRING);
}

static bool fits_number(const vlParameter *row, const vlGiven *given, double number) {
  if (given->kind == VL_GIVEN_NOTHING)
    return row->flags & VL_PARAMETER_UNSET;
  /* A NaN that somebody gives is a wrong number, also if its bits are those of VL_UNSET. */
  return given->kind == VL_GIVEN_NUMBER && !isnan(given->number) && in_range(row, number);
}

static bool fits(const vlParameter *row, const vlGiven *given, double factor, double *number) {
  const Type *t = &types[row->type];
  *number = 0;
  if (row->type == VL_PARAMETER_BOOL) {
    *number = given->number != 0;
    return given->kind == VL_GIVEN_FLAG;
  }
  if (row->type == VL_PARAMETER_CHOICE) {
    *number = given->kind == VL_GIVEN_TEXT ? find_word(row->choices, given->text) : -1;
    return *number >= 0;
  }
  if (t->text)
    return fits_text(row, given);
  if (!t->numbers && !t->spectral) /* a texture or a block */
    return t->textured && given->kind == VL_GIVEN_NOTHING;
  *number = given->kind == VL_GIVEN_NOTHING ? VL_UNSET : factor * given->number;
  return fits_number(row, given, *number);
}

/* ---- messages ---------------------------------------------------------------------------- */

static void put_value(const vlParameter *row, const vlGiven *given, char *value, size_t size) {
  bool unit = given->factor != 0 && given->factor != 1 && row->unit;
  char number[40];
  switch (given->kind) {
    case VL_GIVEN_NOTHING:
      snprintf(value, size, "nothing");
      break;
    case VL_GIVEN_FLAG:
      snprintf(value, size, "%s", given->number != 0 ? "true" : "false");
      break;
    case VL_GIVEN_NUMBER:
      snprintf(value, size, "%s%s%s", put_number(number, given->number), unit ? " " : "",
               unit ? row->unit : "");
      break;
    case VL_GIVEN_TEXT:
      snprintf(value, size, "\"%s\"", vl_argument_text(given->text).text);
      break;
    case VL_GIVEN_OTHER:
      snprintf(value, size, "of another type");
      break;
  }
}

static void put_near(const char *name, const char *const *names, size_t count,
                     const char *prefix, char *text, size_t size) {
  const char *near = vl_near_name(name, names, count);
  text[0] = 0;
  if (near)
    snprintf(text, size, "; did you mean \"%s%s\"?", prefix, near);
}

/* Writes `NAME must be RULE; it is VALUE`. */
static void put_wrong(const vlParameter *row, const char *name, const vlGiven *given,
                      char *message, size_t size) {
  char rule[256];
  char value[270];
  char near[80] = "";
  double factor = given->factor != 0 ? given->factor : 1;
  put_rule(row, factor, rule, sizeof rule);
  if (row->flags & VL_PARAMETER_UNSET && given->kind == VL_GIVEN_NOTHING)
    snprintf(rule + strlen(rule), sizeof rule - strlen(rule), ", or nothing");
  put_value(row, given, value, sizeof value);
  if (row->type == VL_PARAMETER_CHOICE && given->kind == VL_GIVEN_TEXT) {
    size_t count = 0;
    while (row->choices[count])
      count++;
    put_near(given->text, row->choices, count, "", near, sizeof near);
  }
  snprintf(message, size, "%s must be %s; it is %s%s", name, rule,
           given->shown ? given->shown : value, near);
}

bool vl_given_check(const vlParameter *row, const char *name, const vlGiven *given,
                    double *number, char message[VL_GIVEN_MESSAGE]) {
  double unused;
  if (fits(row, given, given->factor != 0 ? given->factor : 1, number ? number : &unused))
    return true;
  put_wrong(row, name, given, message, VL_GIVEN_MESSAGE);
  return false;
}

void vl_given_put(const vlParameter *row, double number, void *def) {
  const Type *t = &types[row->type];
  if (t->numbers != 1 || t->textured)
    return;
  t->put((char *)def + row->offset, 0, number);
  if (row->second)
    t->put((char *)def + row->second, 0, number);
}

const char *vl_near_name(const char *name, const char *const *names, size_t count) {
  size_t length = strlen(name);
  const char *near = vl_nearest_name(name, names, count);
  for (size_t i = 0; i < count && !near && length >= 2; i++)
    if (strncmp(names[i], name, length) == 0)
      near = names[i]; /* an abbreviation */
  return near;
}

void vl_unknown_name(const char *thing, const char *prefix, const char *name,
                     const char *const *names, size_t count, char message[VL_GIVEN_MESSAGE]) {
  int used = snprintf(message, VL_GIVEN_MESSAGE, "unknown %s \"%s%s\"", thing, prefix,
                      vl_argument_text(name).text);
  size_t room = VL_GIVEN_MESSAGE - (size_t)used;
  put_near(name, names, count, prefix, message + used, room);
  if (message[used])
    return;
  char list[VL_GIVEN_MESSAGE] = "";
  for (size_t i = 0; i < count; i++)
    vl_list_name(list, room > 20 ? room - 20 : 0, names[i]);
  snprintf(message + used, room, "; known are%s", list + (list[0] == ':'));
}

/* ---- members of defs --------------------------------------------------------------------- */

static bool check_number(const vlParameter *p, double x, const char *name,
                         char message[VL_GIVEN_MESSAGE]) {
  if (in_range(p, x))
    return true;
  double factor = p->factor != 0 ? p->factor : 1;
  const vlGiven given = {.kind = VL_GIVEN_NUMBER, .number = x / factor, .factor = factor};
  put_wrong(p, name, &given, message, VL_GIVEN_MESSAGE);
  return false;
}

static uint32_t count_of(const char *const *choices) {
  uint32_t n = 0;
  while (choices && choices[n])
    n++;
  return n;
}

static bool check_choice(const vlParameter *p, int choice, const char *name,
                         char message[VL_GIVEN_MESSAGE]) {
  if (choice >= 0 && (uint32_t)choice < count_of(p->choices))
    return true;
  const vlGiven given = {.kind = VL_GIVEN_NUMBER, .number = choice};
  put_wrong(p, name, &given, message, VL_GIVEN_MESSAGE);
  return false;
}

bool vl_parameter_check(const vlParameter *p, const void *def, const char *name,
                        char message[VL_GIVEN_MESSAGE]) {
  const Type *t = &types[p->type];
  const void *at = (const char *)def + p->offset;
  double number;
  if (p->type == VL_PARAMETER_BOOL)
    return true;
  if (p->type == VL_PARAMETER_CHOICE)
    return check_choice(p, *(const int *)at, name, message);
  if (t->text) {
    if (!(p->flags & VL_PARAMETER_REQUIRED) || *(const char *const *)at)
      return true;
    snprintf(message, VL_GIVEN_MESSAGE, "%s is missing", name);
    return false;
  }
  if (t->spectral)
    return !vl_parameter_number(p, def, &number) || check_number(p, number, name, message);
  if (texture_of(t, at))
    return true;
  for (int i = 0; i < t->numbers; i++)
    if (!check_number(p, number_of(t, at, i), name, message))
      return false;
  return true;
}

bool vl_choices_check(vlSettingGroup group, size_t begin, size_t size, const void *part,
                      char message[VL_GIVEN_MESSAGE]) {
  const vlKindRow *row = vl_settings(group);
  for (uint32_t i = 0; i < row->parameter_count; i++) {
    vlParameter p = row->parameters[i];
    if (p.type != VL_PARAMETER_CHOICE || p.offset < begin || p.offset >= begin + size)
      continue;
    p.offset -= begin;
    if (!vl_parameter_check(&p, part, vl_setting_keyword(&row->parameters[i]), message))
      return false;
  }
  return true;
}
