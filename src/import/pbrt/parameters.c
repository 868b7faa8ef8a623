/* import/pbrt/parameters.c: reads the parameters of a directive into the members of a def, by
 * the row of its kind. */
#include <assert.h>
#include <strings.h>

#include "base/text.h"
#include "import/pbrt/builder.h"

/* Reads a choice. Upper and lower case are not distinguished, as in pbrt. */
static bool read_choice(vlDict *dict, const char *name, const vlParameter *p, int *at) {
  const char *text;
  int count = 0;
  if (!vl_dict_string(dict, name, &text))
    return false;
  for (; p->choices[count]; count++) {
    if (strcasecmp(text, p->choices[count]) != 0)
      continue;
    *at = count;
    return true;
  }
  return vl_dict_choice(dict, name, p->choices, (size_t)count,
                        at); /* reports the accepted values */
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
  if (!p || !vl_dict_vector(dict, name, p->type, v))
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
  bool given;
  if (p->flags & VL_PARAMETER_NO_TEXTURE)
    return read_plain_spectrum(dict, name, p, at);
  return vl_import_spectrum_input(dict, name, at, p->role == VL_PARAMETER_ALBEDO, &given) &&
         given;
}

/* Reads one parameter. False when it is not given or after an error. */
static bool read_one(vlDict *dict, const char *name, const vlParameter *p, char *def,
                     bool spectrum) {
  void *at = def + p->offset;
  bool given;
  switch (p->type) {
    case VL_PARAMETER_BOOL:
      return vl_dict_bool(dict, name, at);
    case VL_PARAMETER_COUNT:
      return vl_dict_count(dict, name, (int32_t)p->low, at);
    case VL_PARAMETER_FLOAT:
      return read_float(dict, name, p, at);
    case VL_PARAMETER_DOUBLE:
      return vl_dict_double(dict, name, at);
    case VL_PARAMETER_FLOAT3:
      return read_float3(dict, name, at);
    case VL_PARAMETER_DOUBLE3:
      return vl_dict_vector(
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
      return vl_import_float_input(dict, name, at, &given) && given;
    case VL_PARAMETER_SPECTRUM_INPUT:
      return read_spectrum_input(dict, name, p, at);
    case VL_PARAMETER_EITHER_INPUT:
      if (spectrum)
        return read_spectrum_input(dict, name, p, (vlSpectrumInput *)(void *)(def + p->second));
      return vl_import_float_input(dict, name, at, &given) && given;
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

/* Reports an error at the parameter's source. */
static bool check(vlDict *dict, const vlParameter *p, const void *def) {
  char name[200];
  char message[VL_GIVEN_MESSAGE];
  snprintf(name, sizeof name, "%s: parameter \"%s\"", dict->what, vl_parameter_label(p));
  if (vl_parameter_check(p, def, name, message))
    return true;
  const vlParam *param = vl_dict_find(dict, p->name, ~0u);
  if (!param && p->alias)
    param = vl_dict_find(dict, p->alias, ~0u);
  return vl_import_fail(dict->import, VL_ERROR_SCENE, param ? param->source : dict->source,
                        "%s", message);
}

bool vl_import_parameters(vlDict *dict, const vlKindRow *row, void *def, bool spectrum,
                          bool *given) {
  const vlError *error = &dict->import->scene->error;
  for (uint32_t i = 0; i < row->parameter_count; i++) {
    const vlParameter *p = &row->parameters[i];
    bool is_given = false;
    if (given)
      given[i] = false;
    if (!p->name || (p->flags & VL_PARAMETER_RULE))
      continue;
    if (p->alias)
      is_given = read_one(dict, p->alias, p, def, spectrum);
    is_given = read_one(dict, p->name, p, def, spectrum) || is_given;
    if (error->code != VL_OK)
      return false;
    if (given)
      given[i] = is_given;
    if (is_given)
      convert(p, def);
    if (is_given && !check(dict, p, def))
      return false;
    if (is_given && p->second)
      copy_to_second(p, def);
  }
  for (uint32_t i = 0; i < row->parameter_count; i++) {
    const vlParameter *p = &row->parameters[i];
    if (!p->name || !(p->flags & VL_PARAMETER_REQUIRED) || (p->flags & VL_PARAMETER_RULE))
      continue;
    if (vl_dict_find(dict, p->name, ~0u))
      continue;
    if (!vl_dict_done(dict))
      return false; /* a misspelt parameter is reported first */
    return vl_import_fail(
        dict->import, VL_ERROR_SCENE, dict->source, "%s: \"%s %s\" is missing", dict->what,
        p->type == VL_PARAMETER_STRING || p->type == VL_PARAMETER_FILE ? "string" : "float",
        p->name);
  }
  return true;
}

bool vl_import_given(const vlKindRow *row, const bool *given, const char *name) {
  for (uint32_t i = 0; i < row->parameter_count; i++)
    if (vl_text_is(row->parameters[i].name, name))
      return given[i];
  assert(!"a parameter of the row");
  return false;
}
