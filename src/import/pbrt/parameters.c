/* import/pbrt/parameters.c: typed access to the parameters of a directive (param.h), and
 * reading them into the members of a def, by the row of its kind. */
#include "import/pbrt/param.h"

#include <assert.h>
#include <math.h>
#include <stdio.h>
#include <strings.h>

#include "base/free.h"
#include "base/text.h"
#include "import/pbrt/builder.h"
#include "velo/setting.h"

static const char *const type_names[VL_PARAM_TYPES] = {
    "integer", "float",  "bool",     "string", "point2",    "vector2", "point3",
    "vector3", "normal", "spectrum", "rgb",    "blackbody", "texture"};

const char *vl_param_type_name(vlParamType type) {
  return type_names[type];
}

bool vl_param_type_find(const char *text, size_t length, vlParamType *type) {
  static const char *const old_names[VL_PARAM_TYPES] = {[VL_PARAM_POINT3] = "point",
                                                        [VL_PARAM_VECTOR3] = "vector",
                                                        [VL_PARAM_RGB] = "color",
                                                        [VL_PARAM_NORMAL] = "normal3"};
  for (int i = 0; i < VL_PARAM_TYPES; i++) {
    const char *old = old_names[i] ? old_names[i] : "";
    if (!vl_has_word_of(type_names[i], text, length) && !vl_has_word_of(old, text, length))
      continue;
    *type = (vlParamType)i;
    return true;
  }
  return false;
}

const char *vl_param_type_nearest(const char *text) {
  return vl_nearest_name(text, type_names, VL_PARAM_TYPES);
}

void vl_param_free(vlContext *context, vlParam *param) {
  if (param->shared) {
    param->shared--;
    return;
  }
  for (size_t i = 0; i < param->strings.count; i++)
    vl_free(context, param->strings.items[i]);
  VL_FREE(context, (void *)param->strings.items, param->floats.items, param->integers.items,
          param->name, param);
}

void vl_param_list_free(vlContext *context, vlParamList *params) {
  for (size_t i = 0; i < params->list.count; i++)
    vl_param_free(context, params->list.items[i]);
  VL_ARRAY_FREE(context, &params->list);
}

size_t vl_param_count(const vlParam *param) {
  return param->floats.count + param->integers.count + param->strings.count;
}

/* ---- the parameters of a directive ------------------------------------------------------- */

vlDict vl_import_dict(vlImport *import, const char *what, vlSource source, vlColorSpace space,
                      const vlParamList *own, const vlParamList *attributes) {
  vlDict dict = {
      .import = import, .source = source, .space = space, .own = own, .attributes = attributes};
  snprintf(dict.what, sizeof dict.what, "%s", what);
  return dict;
}

void vl_dict_set_kind(vlDict *dict, const vlKindFamily *family, int kind) {
  dict->kind = kind;
  dict->row = vl_kind_row(family, kind);
  assert(!dict->row || dict->row->parameter_count <= VL_LENGTH(dict->given));
}

static vlDict kind_dict(vlImport *import, const char *directive, const vlKindFamily *family,
                        const char *kind, vlSource source, vlColorSpace space,
                        const vlParamList *own, const vlParamList *attributes) {
  char what[160];
  snprintf(what, sizeof what, "%s \"%s\"", directive, vl_import_kind_text(family, kind).text);
  vlDict dict = vl_import_dict(import, what, source, space, own, attributes);
  vl_dict_set_kind(&dict, family, vl_kind_find(family, kind));
  return dict;
}

vlDict vl_import_light_dict(vlImport *import, const char *directive, const vlKindFamily *family,
                            const vlStatement *s) {
  return kind_dict(import, directive, family, s->names[0], s->source, import->state.space,
                   s->params, &import->attributes[VL_ATTR_LIGHT]);
}

vlDict vl_import_choice_dict(vlImport *import, const char *directive,
                             const vlKindFamily *family, const vlChoice *choice,
                             const char *standard) {
  return kind_dict(import, directive, family, choice->given ? choice->kind : standard,
                   choice->source, choice->space, &choice->params, NULL);
}

/* ---- questions --------------------------------------------------------------------------- */

/* Accepted types as text: "float" or "float, texture". */
static const char *wanted_types(uint32_t bits, char *text, size_t size) {
  size_t n = 0;
  text[0] = 0;
  for (int i = 0; i < VL_PARAM_TYPES; i++) {
    if (!(bits & 1u << i))
      continue;
    int k = snprintf(text + n, size - n, "%s\"%s\"", n ? " or " : "", type_names[i]);
    if (k > 0 && (size_t)k < size - n)
      n += (size_t)k;
  }
  return text;
}

static vlParam *find_in(vlDict *dict, const vlParamList *params, const char *name,
                        uint32_t bits, vlParam *found) {
  for (size_t i = params->list.count; i > 0; i--) { /* the last of several values counts */
    vlParam *p = params->list.items[i - 1];
    if (!vl_text_is(p->name, name))
      continue;
    if (bits & 1u << p->type) {
      p->used = true; /* also marks earlier duplicates as used */
      if (!found)
        found = p;
    } else if (!p->optional && !found) {
      char types[160];
      p->used = true;
      vl_dict_fail_at(dict, p->source, "parameter \"%s\" must be of type %s, not \"%s\"", name,
                      wanted_types(bits, types, sizeof types), vl_param_type_name(p->type));
      return NULL;
    }
  }
  return found;
}

vlParam *vl_dict_find(vlDict *dict, const char *name, uint32_t bits) {
  bool known = false;
  for (uint32_t i = 0; i < dict->asked_count; i++)
    known = known || vl_text_is(dict->asked[i], name);
  if (!known && dict->asked_count < VL_LENGTH(dict->asked))
    dict->asked[dict->asked_count++] = name;
  vlParam *found = find_in(dict, dict->own, name, bits, NULL);
  if (dict->attributes && dict->import->scene->error.code == VL_OK)
    found = find_in(dict, dict->attributes, name, bits, found);
  if (found && vl_param_count(found) == 0) {
    vl_dict_fail_at(dict, found->source, "parameter \"%s\" has no value", name);
    return NULL;
  }
  return found;
}

vlParam *vl_dict_find_counted(vlDict *dict, const char *name, uint32_t bits, size_t count) {
  vlParam *p = vl_dict_find(dict, name, bits);
  if (p && vl_param_count(p) != count) {
    vl_dict_fail_at(dict, p->source, "parameter \"%s\" takes %zu value%s, found %zu", name,
                    count, count == 1 ? "" : "s", vl_param_count(p));
    return NULL;
  }
  return p;
}

bool vl_dict_double(vlDict *dict, const char *name, double *value) {
  vlParam *p = vl_dict_find_counted(dict, name, VL_BIT_FLOAT, 1);
  if (p)
    *value = p->exact[0];
  return p != NULL;
}

bool vl_dict_float(vlDict *dict, const char *name, float *value) {
  vlParam *p = vl_dict_find_counted(dict, name, VL_BIT_FLOAT, 1);
  if (p)
    *value = p->floats.items[0];
  return p != NULL;
}

bool vl_dict_integer(vlDict *dict, const char *name, int32_t *value) {
  vlParam *p = vl_dict_find_counted(dict, name, VL_BIT_INTEGER, 1);
  if (p)
    *value = p->integers.items[0];
  return p != NULL;
}

bool vl_dict_count(vlDict *dict, const char *name, int32_t min, uint32_t *value) {
  vlParam *p = vl_dict_find_counted(dict, name, VL_BIT_INTEGER, 1);
  if (!p)
    return false;
  const vlParameter row = {.type = VL_PARAMETER_COUNT, .low = min, .high = (double)INFINITY};
  const vlGiven given = {.kind = VL_GIVEN_NUMBER, .number = p->integers.items[0]};
  char what[200];
  char message[VL_GIVEN_MESSAGE];
  double number;
  snprintf(what, sizeof what, "%s: parameter \"%s\"", dict->what, name);
  if (!vl_given_check(&row, what, &given, &number, message))
    return vl_import_wrong(dict->import, p->source, "%s", message);
  *value = (uint32_t)number;
  return true;
}

bool vl_dict_bool(vlDict *dict, const char *name, bool *value) {
  vlParam *p = vl_dict_find_counted(dict, name, VL_BIT_BOOL, 1);
  if (p)
    *value = p->integers.items[0] != 0;
  return p != NULL;
}

bool vl_dict_string(vlDict *dict, const char *name, const char **value) {
  vlParam *p = vl_dict_find_counted(dict, name, VL_BIT_STRING, 1);
  if (p)
    *value = p->strings.items[0];
  return p != NULL;
}

bool vl_dict_type(vlDict *dict, const char **type) {
  return vl_dict_string(dict, "type", type) ||
         (vl_import_fine(dict->import) && vl_dict_fail(dict, "\"string type\" is missing"));
}

static bool read_vector(vlDict *dict, const char *name, vlParamType type, double value[3]) {
  vlParam *p = vl_dict_find_counted(dict, name, 1u << type, 3);
  for (int i = 0; p && i < 3; i++)
    value[i] = p->exact[i];
  return p != NULL;
}

bool vl_dict_floats(vlDict *dict, const char *name, size_t count, double *value) {
  vlParam *p = vl_dict_find_counted(dict, name, VL_BIT_FLOAT, count);
  for (size_t i = 0; p && i < count; i++)
    value[i] = p->exact[i];
  return p != NULL;
}

bool vl_dict_choice(vlDict *dict, const char *name, const char *const *names, size_t count,
                    int *value) {
  vlParam *p = vl_dict_find_counted(dict, name, VL_BIT_STRING, 1);
  if (!p)
    return false;
  const char *text = p->strings.items[0];
  const size_t found = vl_name_index(text, names, count);
  if (found < count) {
    *value = (int)found;
    return true;
  }
  const char *near = vl_nearest_name(text, names, count);
  if (near)
    return vl_dict_fail_at(dict, p->source, "\"%s\" cannot be \"%s\"%s", name,
                           vl_short_text(text).text, vl_hint(near).text);
  char all[256];
  size_t n = 0;
  all[0] = 0;
  for (size_t i = 0; i < count && n < sizeof all; i++)
    n += (size_t)snprintf(all + n, sizeof all - n, "%s%s", i ? ", " : "", names[i]);
  return vl_dict_fail_at(dict, p->source, "\"%s\" cannot be \"%s\" (known: %s)", name,
                         vl_short_text(text).text, all);
}

bool vl_dict_done(vlDict *dict) {
  vlImport *import = dict->import;
  if (import->scene->error.code != VL_OK)
    return false;
  for (size_t i = 0; i < dict->own->list.count; i++) {
    const vlParam *p = dict->own->list.items[i];
    if (p->used || p->optional)
      continue;
    const char *near = vl_nearest_name(p->name, dict->asked, dict->asked_count);
    return vl_dict_fail_at(dict, p->source, "unknown parameter \"%s\"%s",
                           vl_short_text(p->name).text, vl_hint(near).text);
  }
  return true;
}

bool vl_dict_missing(vlDict *dict, const char *what) {
  return vl_dict_done(dict) && vl_dict_fail(dict, "%s is missing", what);
}

void vl_dict_skip(vlDict *dict) {
  for (size_t i = 0; i < dict->own->list.count; i++)
    dict->own->list.items[i]->used = true;
}

/* ---- by the row of a kind ---------------------------------------------------------------- */

/* Reads a choice. Upper and lower case are not distinguished, as in pbrt. */
static bool read_choice(vlDict *dict, const char *name, const vlParameter *p, int *at) {
  const char *text;
  if (!vl_dict_string(dict, name, &text))
    return false;
  const uint32_t count = vl_choice_count(p);
  for (uint32_t i = 0; i < count; i++) {
    if (strcasecmp(text, p->choices[i]) != 0)
      continue;
    *at = (int)i;
    return true;
  }
  /* reports the accepted values */
  return vl_dict_choice(dict, name, p->choices, count, at);
}

static bool read_string(vlDict *dict, const char *name, const vlParameter *p, const char **at) {
  char path[4096];
  vlParam *param = vl_dict_find(dict, name, 1u << VL_PARAM_STRING);
  if (!param)
    return false;
  if (p->type == VL_PARAMETER_STRING)
    return vl_dict_string(dict, name, at);
  if (param->strings.items[0][0] == 0 && !(p->flags & VL_PARAMETER_REQUIRED))
    return false; /* an empty file name counts as not given */
  bool found = p->flags & VL_PARAMETER_REQUIRED
                   ? vl_import_path(dict->import, param, path, sizeof path)
                   : vl_import_image_path(dict->import, param, path, sizeof path);
  if (!found)
    return false;
  *at = vl_import_keep(dict->import, path);
  return *at != NULL;
}

/* Reads a number and converts it to the def's unit, with one rounding. */
static bool read_float(vlDict *dict, const char *name, const vlParameter *p, float *at) {
  double number;
  if (p->factor == 0)
    return vl_dict_float(dict, name, at);
  if (!vl_dict_double(dict, name, &number))
    return false;
  *at = (float)(number * p->factor);
  return true;
}

/* Reads a point, a vector or a normal. */
static bool read_float3(vlDict *dict, const char *name, float at[3]) {
  double v[3];
  vlParam *p = vl_dict_find(
      dict, name, 1u << VL_PARAM_POINT3 | 1u << VL_PARAM_VECTOR3 | 1u << VL_PARAM_NORMAL);
  if (!p || !read_vector(dict, name, p->type, v))
    return false;
  for (int i = 0; i < 3; i++)
    at[i] = (float)v[i];
  return true;
}

static bool read_spectrum(vlDict *dict, const char *name, vlSpectrum *at) {
  vlParam *p = vl_dict_find(dict, name, VL_BITS_SPECTRUM);
  return p && vl_import_spectrum(dict->import, p, at);
}

/* Reads a number that cannot be a texture. */
static bool read_number_input(vlDict *dict, const char *name, vlFloatInput *at) {
  float number;
  if (!vl_dict_float(dict, name, &number))
    return false;
  *at = vl_float_input(number);
  return true;
}

/* Reads a spectrum that cannot be a texture, or a number where the row allows one. */
static bool read_plain_spectrum(vlDict *dict, const char *name, const vlParameter *p,
                                vlSpectrumInput *at) {
  uint32_t bits = p->flags & VL_PARAMETER_ONE_NUMBER ? VL_BIT_FLOAT
                  : p->flags & VL_PARAMETER_NUMBER   ? VL_BIT_FLOAT | VL_BITS_SPECTRUM
                                                     : VL_BITS_SPECTRUM;
  vlParam *param = vl_dict_find(dict, name, bits);
  float number;
  if (!param)
    return false;
  if (param->type != VL_PARAM_FLOAT) {
    at->texture.index = 0;
    return vl_import_spectrum(dict->import, param, &at->value);
  }
  if (!vl_dict_float(dict, name, &number))
    return false;
  *at = vl_spectrum_input(vl_spectrum_constant(number));
  return true;
}

static bool read_spectrum_input(vlDict *dict, const char *name, const vlParameter *p,
                                vlSpectrumInput *at) {
  if (p->flags & VL_PARAMETER_NO_TEXTURE)
    return read_plain_spectrum(dict, name, p, at);
  return vl_import_spectrum_input(dict, name, at, p->role == VL_PARAMETER_ALBEDO);
}

/* Reports a number that does not fit, at the parameter's source. Returns false. */
static bool refuse(vlDict *dict, const vlParameter *p, double number) {
  char name[200];
  char message[VL_GIVEN_MESSAGE];
  snprintf(name, sizeof name, "%s: parameter \"%s\"", dict->what, vl_parameter_label(p));
  vl_parameter_complain(p, name, number, message);
  const vlParam *param = vl_dict_find(dict, p->name, ~0u);
  if (!param && p->alias)
    param = vl_dict_find(dict, p->alias, ~0u);
  return vl_import_wrong(dict->import, param ? param->source : dict->source, "%s", message);
}

/* Reads a whole number. The member holds none below 0; that it is in range is checked later. */
static bool read_count(vlDict *dict, const char *name, const vlParameter *p, uint32_t *at) {
  int32_t number;
  if (!vl_dict_integer(dict, name, &number))
    return false;
  if (number < 0)
    return refuse(dict, p, number);
  *at = (uint32_t)number;
  return true;
}

/* Reads one parameter. False when it is not given or after an error. */
static bool read_one(vlDict *dict, const char *name, const vlParameter *p, char *def,
                     bool spectrum) {
  void *at = def + p->offset;
  switch (p->type) {
    case VL_PARAMETER_BOOL:
      return vl_dict_bool(dict, name, at);
    case VL_PARAMETER_COUNT:
      return read_count(dict, name, p, at);
    case VL_PARAMETER_FLOAT:
      return read_float(dict, name, p, at);
    case VL_PARAMETER_DOUBLE:
      return vl_dict_double(dict, name, at);
    case VL_PARAMETER_FLOAT3:
      return read_float3(dict, name, at);
    case VL_PARAMETER_DOUBLE3:
      return read_vector(
          dict, name, p->flags & VL_PARAMETER_VECTOR ? VL_PARAM_VECTOR3 : VL_PARAM_POINT3, at);
    case VL_PARAMETER_CHOICE:
      return read_choice(dict, name, p, at);
    case VL_PARAMETER_STRING:
    case VL_PARAMETER_FILE:
      return read_string(dict, name, p, at);
    case VL_PARAMETER_SPECTRUM:
      return read_spectrum(dict, name, at);
    case VL_PARAMETER_FLOAT_INPUT:
      if (p->flags & (VL_PARAMETER_NO_TEXTURE | VL_PARAMETER_FILE_NUMBER))
        return read_number_input(dict, name, at);
      return vl_import_float_input(dict, name, at);
    case VL_PARAMETER_SPECTRUM_INPUT:
      return read_spectrum_input(dict, name, p, at);
    case VL_PARAMETER_EITHER_INPUT:
      if (spectrum)
        return read_spectrum_input(dict, name, p, (vlSpectrumInput *)(void *)(def + p->second));
      return vl_import_float_input(dict, name, at);
    case VL_PARAMETER_TEXTURE: /* files name textures only in place of a value */
    case VL_PARAMETER_BLOCK:
      return false;
  }
  return false;
}

/* Converts a member from the file's unit to the def's unit. */
static void convert(const vlParameter *p, char *def) {
  if (p->factor == 0)
    return;
  void *at = def + p->offset;
  if (p->type == VL_PARAMETER_DOUBLE)
    *(double *)at *= p->factor;
  if (p->type == VL_PARAMETER_FLOAT_INPUT)
    ((vlFloatInput *)at)->value *= (float)p->factor;
}

static void copy_to_second(const vlParameter *p, char *def) {
  if (p->type == VL_PARAMETER_FLOAT_INPUT)
    memcpy(def + p->second, def + p->offset, sizeof(vlFloatInput));
  if (p->type == VL_PARAMETER_FLOAT)
    memcpy(def + p->second, def + p->offset, sizeof(float));
}

/* Reports a parameter that is missing; one that is misspelt is reported first. */
static bool check_required(vlDict *dict, const vlParameter *p) {
  if (!p->name || !(p->flags & VL_PARAMETER_REQUIRED) || (p->flags & VL_PARAMETER_RULE) ||
      vl_dict_find(dict, p->name, ~0u))
    return true;
  const bool text = p->type == VL_PARAMETER_STRING || p->type == VL_PARAMETER_FILE;
  return vl_dict_done(dict) &&
         vl_dict_fail(dict, "\"%s %s\" is missing", text ? "string" : "float", p->name);
}

bool vl_import_parameters(vlDict *dict, void *def, bool spectrum) {
  const vlKindRow *row = dict->row;
  for (uint32_t i = 0; i < row->parameter_count; i++) {
    const vlParameter *p = &row->parameters[i];
    bool given = false;
    double wrong;
    dict->given[i] = false;
    if (!p->name || (p->flags & VL_PARAMETER_RULE))
      continue;
    if (p->alias)
      given = read_one(dict, p->alias, p, def, spectrum);
    given = read_one(dict, p->name, p, def, spectrum) || given;
    if (!vl_import_fine(dict->import))
      return false;
    dict->given[i] = given;
    if (!given)
      continue;
    convert(p, def);
    if (!vl_parameter_fits(p, def, &wrong))
      return refuse(dict, p, wrong);
    if (p->second)
      copy_to_second(p, def);
  }
  for (uint32_t i = 0; i < row->parameter_count; i++)
    if (!check_required(dict, &row->parameters[i]))
      return false;
  return true;
}

bool vl_import_given(const vlDict *dict, const char *name) {
  const vlParameter *p = vl_row_find(dict->row, name);
  assert(p);
  return dict->given[p - dict->row->parameters];
}

bool vl_dict_row_choice(vlDict *dict, const char *name, int *value) {
  const vlParameter *p = vl_row_find(dict->row, name);
  return p && vl_dict_choice(dict, name, p->choices, vl_choice_count(p), value);
}
