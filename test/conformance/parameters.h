/* conformance/parameters.h: every parameter of every kind that files can name changes the image, is written to pbrt
 * files and read again, and is known to the doctor. It writes a scene with one parameter that is not its default, reads
 * it, renders a few pixels and compares the bytes with those of the scene without the parameter. It fails where a
 * reader, a compile function or a kernel forgets a parameter, and where a kind or a parameter is added that the test
 * cannot give a value. */
#ifndef TEST_CONFORMANCE_PARAMETERS_H
#define TEST_CONFORMANCE_PARAMETERS_H

#include "parameter_cases.h"
#include "conformance.h"

enum { VALUES = 3 };

/* ---- cases ------------------------------------------------------------------------------------------------------- */

static bool same_name(const char *a, const char *b) {
  return a == b || (a && b && strcmp(a, b) == 0);
}

/* The case of a parameter, or, for null, of the kind as a whole. A case of the kind comes before one of the family. */
static const ParameterCase *find_case(const char *family, const char *kind, const char *parameter) {
  const ParameterCase *found = NULL;
  for (size_t i = 0; i < sizeof parameter_cases / sizeof *parameter_cases; i++) {
    const ParameterCase *c = &parameter_cases[i];
    if (strcmp(c->family, family) != 0 || !same_name(c->parameter, parameter)) continue;
    if (same_name(c->kind, kind)) return c;
    if (!c->kind) found = c;
  }
  return found;
}

/* ---- the text of a scene ----------------------------------------------------------------------------------------- */

/* Appends the parameters of `base`, which semicolons separate, except the one with that name (null: all). */
static void append_base(char text[TEXT], const char *base, const char *name) {
  char quoted[80];
  snprintf(quoted, sizeof quoted, " %s\" ", name ? name : "/");
  while (base && *base) {
    size_t length = strcspn(base, ";");
    const char *found = strstr(base, quoted);
    if (!found || found > base + length) {
      strncat(text, base, length);
      strcat(text, " ");
    }
    base += length + (base[length] == ';');
  }
}

/* Another value than the default, in the unit of files; which: one of several. */
static double other_number(const vlParameter *p, int which) {
  double factor = p->factor != 0 ? p->factor : 1;
  double low = p->low;
  double high = p->high;
  bool limited = low != 0 || high != 0;
  double candidates[VALUES] = {0.5 * p->value[0] + 0.25, p->value[0] + 1, 0.2};
  double value = candidates[which];
  if (limited && value <= low) value = low + 0.3;
  if (limited && value >= high) value = low + 0.6 * (high - low);
  return value / factor;
}

/* Appends `"type name" value` as pbrt writes it. floats: for a float texture. False: the row does not tell. */
static bool append_value(char text[TEXT], const vlParameter *p, bool floats, int which) {
  char value[400];
  double number = other_number(p, which);
  switch (p->type) {
    case VL_PARAMETER_BOOL:
      snprintf(value, sizeof value, "\"bool %s\" %s", p->name, p->value[0] != 0 ? "false" : "true");
      break;
    case VL_PARAMETER_COUNT:
      snprintf(value, sizeof value, "\"integer %s\" %d", p->name, (int)p->value[0] + 1 + which);
      if (p->high != 0 && p->value[0] + 1 + which > p->high)
        snprintf(value, sizeof value, "\"integer %s\" %d", p->name, (int)p->value[0] - 1);
      break;
    case VL_PARAMETER_FLOAT:
    case VL_PARAMETER_DOUBLE:
    case VL_PARAMETER_FLOAT_INPUT: snprintf(value, sizeof value, "\"float %s\" %.9g", p->name, number); break;
    case VL_PARAMETER_EITHER_INPUT:
      if (floats)
        snprintf(value, sizeof value, "\"float %s\" 0.3", p->name);
      else
        snprintf(value, sizeof value, "\"rgb %s\" [.7 .4 .2]", p->name);
      break;
    case VL_PARAMETER_SPECTRUM:
    case VL_PARAMETER_SPECTRUM_INPUT:
      if (p->flags & (VL_PARAMETER_ONE_NUMBER | VL_PARAMETER_NUMBER))
        snprintf(value, sizeof value, "\"float %s\" %.9g", p->name, p->value[0] + 0.3);
      else
        snprintf(value, sizeof value, "\"rgb %s\" [.7 .4 .2]", p->name);
      break;
    case VL_PARAMETER_FLOAT3:
    case VL_PARAMETER_DOUBLE3:
      snprintf(value, sizeof value, "\"%s %s\" [%g %g %g]", p->flags & VL_PARAMETER_VECTOR ? "vector3" : "point3",
               p->name, p->value[0] + 0.3, p->value[1] + 0.2, p->value[2] - 0.4);
      break;
    case VL_PARAMETER_CHOICE: {
      int count = 0;
      while (p->choices[count]) count++;
      int choice = ((int)p->value[0] + 1 + which) % count;
      snprintf(value, sizeof value, "\"string %s\" \"%s\"", p->name, p->choices[choice]);
      break;
    }
    case VL_PARAMETER_STRING:
    case VL_PARAMETER_FILE:
    case VL_PARAMETER_TEXTURE:
    case VL_PARAMETER_BLOCK:
    default: return false;
  }
  strcat(text, value);
  return true;
}

/* ---- families ---------------------------------------------------------------------------------------------------- */

/* The form of a family's scenes: %s stands for `"kind" parameters`. */
typedef struct Family {
  const char *name, *form;
} Family;

static const Family families[] = {
    {"materials", HEAD "WorldBegin " LIGHTS NAMED GROUND "Material %s " BALL},
    {"textures", HEAD "WorldBegin " LIGHTS GROUND "Texture \"t\" \"spectrum\" %s "
                      "Material \"diffuse\" \"texture reflectance\" \"t\" " BALL},
    {"lights", HEAD "WorldBegin " GROUND "LightSource %s Material \"coateddiffuse\" " BALL},
    {"emission", HEAD "WorldBegin " GROUND "AttributeBegin Translate .3 .4 -.5 AreaLightSource %s "
                      "Shape \"bilinearmesh\" \"point3 P\" [-1 -1 0 1 -1 0 -1 1 0 1 1 0] AttributeEnd\n"
                      "Translate -1 0 .5 Scale .4 .4 .4 Material \"diffuse\" " BALL},
    {"media", HEAD "WorldBegin " LIGHTS GROUND "AttributeBegin MakeNamedMedium \"m\" \"string type\" %s AttributeEnd\n"
                   "MediumInterface \"m\" \"\" Material \"interface\" " BALL},
    {"shapes", HEAD "WorldBegin " LIGHTS NAMED GROUND
                    "Texture \"c\" \"spectrum\" \"checkerboard\" \"float uscale\" 5 \"float vscale\" 5\n"
                    "Rotate 20 1 .3 .2 Material \"conductor\" \"float uroughness\" .4 \"float vroughness\" .1 Shape %s "
                    "Translate .4 .2 .3 Material \"diffuse\" \"texture reflectance\" \"c\" Shape %s"},
    {"filters", HEAD "PixelFilter %s WorldBegin " LIGHTS GROUND "Material \"diffuse\" " BALL},
};

static const char *const lamps = HEAD "WorldBegin " GROUND
                                      "AttributeBegin Translate .2 2 .3 Rotate 80 1 .1 .2 "
                                      "LightSource %s AttributeEnd Material \"coateddiffuse\" " BALL;

static const char *const float_texture =
    HEAD "WorldBegin " LIGHTS NAMED GROUND
         "Texture \"t\" \"float\" %s "
         "Material \"mix\" \"string materials\" [\"grey\" \"red\"] \"texture amount\" "
         "\"t\" " BALL;

static bool is_float_texture(const Family *family, const vlKindRow *row) {
  return strcmp(family->name, "textures") == 0 && (row->traits & VL_TEXTURE_FLOAT_ONLY);
}

static const char *form_of(const Family *family, const vlKindRow *row) {
  if (is_float_texture(family, row)) return float_texture;
  bool lamp = strcmp(family->name, "lights") == 0 && (row->traits & VL_LIGHT_TRAIT_AT_POINT);
  return lamp ? lamps : family->form;
}

/* Whether the image changes with the parameter. */
static bool has_effect(const char *form, const char *kind, const char *base, const char *value, const char *name) {
  static float plain[PIXELS];
  static float changed[PIXELS];
  static char parameters[TEXT];
  static char text[TEXT];
  vlError error = {0};
  parameters[0] = 0;
  append_base(parameters, base, name);
  /* A kind that cannot do without the parameter keeps it. */
  scene_text(text, form, kind, parameters);
  if (!render_text(text, plain, &error)) {
    parameters[0] = 0;
    append_base(parameters, base, NULL);
    scene_text(text, form, kind, parameters);
    if (!render_text(text, plain, &error)) fail_msg("%s: %s\n%s", kind, error.message, text);
    parameters[0] = 0;
    append_base(parameters, base, name);
  }
  strcat(parameters, value);
  scene_text(text, form, kind, parameters);
  if (!render_text(text, changed, &error)) fail_msg("%s %s: %s\n%s", kind, name, error.message, text);
  return memcmp(plain, changed, sizeof plain) != 0;
}

static void check_parameter(const Family *family, const vlKindRow *row, const vlParameter *p) {
  const ParameterCase *kind_case = find_case(family->name, row->name, NULL);
  const ParameterCase *c = find_case(family->name, row->name, p->name);
  const char *base = c && c->base ? c->base : kind_case ? kind_case->base : NULL;
  const char *form = form_of(family, row);
  bool effect = false;
  for (int which = 0; which < VALUES && !effect; which++) {
    char value[TEXT] = "";
    if (c && c->value) {
      strcpy(value, c->value);
    } else if (!append_value(value, p, is_float_texture(family, row), which)) {
      broken(family->name, row->name, "\"%s\": the test has no value for it", p->name);
      return;
    }
    effect = has_effect(form, c && c->directive ? c->directive : row->name, base, value, p->name);
  }
  bool expected = !(c && c->no_effect);
  if (effect != expected)
    broken(family->name, row->name, "\"%s\" %s", p->name, effect ? "has an effect after all" : "changes nothing");
}

static void parameters_of_all_families(void **state) {
  (void)state;
  for (size_t f = 0; f < sizeof families / sizeof *families; f++) {
    const Family *family = &families[f];
    const vlKindFamily *rows = vl_kind_family_find(family->name);
    for (uint32_t i = 0; i < rows->kind_count; i++) {
      const vlKindRow *row = rows->rows[i];
      for (uint32_t k = 0; row->name && k < row->parameter_count; k++)
        if (row->parameters[k].name) check_parameter(family, row, &row->parameters[k]);
    }
  }
  expect_no_failures();
}

#endif
