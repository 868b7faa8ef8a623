/* conformance/hostile.h: every parameter of every row has hostile values: in the defs of the
 * library (NaN, infinities, -1) and in the text of files (those, 2^32 + 8, nothing, a million
 * numbers). A call may succeed or fail with a message; NaN fails, an infinity where the row
 * does not allow it, and what is out of the row's range, unless it is clamped. */
#ifndef TEST_CONFORMANCE_HOSTILE_H
#define TEST_CONFORMANCE_HOSTILE_H

#include "parameters.h"
#include "unit.h"
#include "velo/filter_kinds.h"
#include "velo/light.h"
#include "velo/material.h"
#include "velo/medium.h"
#include "velo/setting.h"
#include "velo/shape_kinds.h"

/* ---- defs -------------------------------------------------------------------------------- */

typedef union AnyDef {
  vlMaterialDef material;
  vlTextureDef texture;
  vlLightDef light;
  vlEmissionDef emission;
  vlShapeDef shape;
  vlMediumDef medium;
  vlPixelFilter filter;
  vlSceneDefs scene;
  vlCameraDef camera;
} AnyDef;

/* A def that the library accepts, but for what the kind requires. */
static void usual_def(const char *family, int kind, AnyDef *def) {
  memset(def, 0, sizeof *def);
  if (strcmp(family, "materials") == 0)
    def->material = vl_default_material_def((vlMaterialKind)kind);
  if (strcmp(family, "textures") == 0)
    def->texture = vl_default_texture_def((vlTextureKind)kind, false);
  if (strcmp(family, "lights") == 0)
    def->light = vl_default_light_def((vlLightKind)kind);
  if (strcmp(family, "emission") == 0)
    def->emission = vl_default_emission_def();
  if (strcmp(family, "shapes") == 0)
    def->shape = vl_default_shape_def((vlShapeKind)kind);
  if (strcmp(family, "media") == 0)
    def->medium = vl_default_medium_def((vlMediumKind)kind);
  if (strcmp(family, "filters") == 0)
    def->filter = vl_default_pixel_filter((vlPixelFilterKind)kind);
  if (strcmp(family, "cameras") == 0)
    def->camera = vl_default_camera_def(8, 8);
}

/* What the library says to the def. */
static vlResult offer(const char *family, AnyDef *def, vlError *error) {
  vlScene *scene;
  vlResult result;
  assert_int_equal(vl_scene_create(context, &scene), VL_OK);
  if (strcmp(family, "materials") == 0)
    vl_scene_add_material(scene, &def->material);
  if (strcmp(family, "textures") == 0)
    vl_scene_add_texture(scene, &def->texture);
  if (strcmp(family, "lights") == 0)
    vl_scene_add_light(scene, &def->light);
  if (strcmp(family, "emission") == 0)
    vl_scene_add_emission(scene, &def->emission);
  if (strcmp(family, "shapes") == 0)
    vl_scene_add_shape(scene, &def->shape);
  if (strcmp(family, "media") == 0)
    vl_scene_add_medium(scene, &def->medium);
  result = vl_scene_result(scene, error);
  if (strcmp(family, "filters") == 0) {
    vlFilmDef film_def = vl_default_film_def(8, 8);
    vlFilm *film = NULL;
    film_def.filter = def->filter;
    result = vl_film_create(context, &film_def, &film);
    vl_film_destroy(film);
  }
  if (strcmp(family, "cameras") == 0) {
    vlCamera camera;
    result = vl_camera_make(&def->camera, &camera, NULL, error);
  }
  vl_scene_destroy(scene);
  return result;
}

/* Puts the number into the member. False: it holds no number, or not this one. */
static bool put_number(const vlParameter *p, char *def, double number) {
  char *at = def + p->offset;
  if (p->type == VL_PARAMETER_COUNT && number == floor(number) && number >= 0 &&
      number <= UINT32_MAX) {
    uint32_t count = (uint32_t)number;
    memcpy(at, &count, sizeof count);
    return true;
  }
  float single = (float)number;
  switch (p->type) {
    case VL_PARAMETER_FLOAT:
    case VL_PARAMETER_FLOAT3:
      memcpy(at, &single, sizeof single);
      return true;
    case VL_PARAMETER_DOUBLE:
    case VL_PARAMETER_DOUBLE3:
      memcpy(at, &number, sizeof number);
      return true;
    case VL_PARAMETER_EITHER_INPUT:
    case VL_PARAMETER_FLOAT_INPUT: {
      vlFloatInput input = vl_float_input(single);
      memcpy(at, &input, sizeof input);
      return true;
    }
    case VL_PARAMETER_SPECTRUM: {
      vlSpectrum spectrum = vl_spectrum_constant(single);
      memcpy(at, &spectrum, sizeof spectrum);
      return true;
    }
    case VL_PARAMETER_SPECTRUM_INPUT: {
      vlSpectrumInput input = vl_spectrum_input(vl_spectrum_constant(single));
      memcpy(at, &input, sizeof input);
      return true;
    }
    case VL_PARAMETER_BOOL:
    case VL_PARAMETER_COUNT:
    case VL_PARAMETER_CHOICE:
    case VL_PARAMETER_STRING:
    case VL_PARAMETER_FILE:
    case VL_PARAMETER_TEXTURE:
    case VL_PARAMETER_BLOCK:
      return false;
  }
  return false;
}

static bool must_fail(const vlParameter *p, double x) {
  if (isinf(x) && x > 0 && p->flags & VL_PARAMETER_INFINITE)
    return false;
  bool limited = (p->low != 0 || p->high != 0) && !(p->flags & VL_PARAMETER_CLAMPED);
  bool low = limited && (p->flags & VL_PARAMETER_ABOVE_LOW ? x <= p->low : x < p->low);
  bool high = limited && (p->flags & VL_PARAMETER_BELOW_HIGH ? x >= p->high : x > p->high);
  bool infinite = isinf(x) && !(p->flags & VL_PARAMETER_INFINITE);
  return isnan(x) || infinite || low || high;
}

static void check_def(const vlKindFamily *family, int kind, const vlParameter *p) {
  const double hostile[] = {NAN,        -NAN,        INFINITY,   -INFINITY,   -1,
                            4294967304, p->high + 1, 4294967295, 4000000000.0};
  AnyDef def;
  vlError error;
  for (size_t i = 0; i < sizeof hostile / sizeof *hostile; i++) {
    memset(&error, 0, sizeof error);
    usual_def(family->name, kind, &def);
    if (!put_number(p, (char *)&def, hostile[i]))
      continue;
    vlResult result = offer(family->name, &def, &error);
    if (result == VL_OK && must_fail(p, hostile[i]))
      broken(family->name, family->words[kind], "%s = %g is accepted", p->member, hostile[i]);
    if (result != VL_OK && result != VL_ERROR_SCENE && result != VL_ERROR_ARGUMENT)
      broken(family->name, family->words[kind], "%s = %g: result %d", p->member, hostile[i],
             (int)result);
  }
}

/* A float near the end of a range that is within it. */
static double within(const vlParameter *p, double end) {
  const float middle = (float)(0.5 * (p->low + p->high));
  const float single = (float)end;
  const bool outside = (double)single < p->low || (double)single > p->high;
  return (double)(outside ? nextafterf(single, middle) : single);
}

/* The ends of a range, which the row allows unless it says otherwise, are accepted. */
static void check_ends(const vlKindFamily *family, int kind, const vlParameter *p) {
  const double ends[2] = {within(p, p->low), within(p, p->high)};
  AnyDef def;
  vlError error;
  for (int i = 0; i < 2 && (p->low != 0 || p->high != 0); i++) {
    memset(&error, 0, sizeof error);
    usual_def(family->name, kind, &def);
    if (must_fail(p, ends[i]) || offer(family->name, &def, &error) != VL_OK ||
        !put_number(p, (char *)&def, ends[i]))
      continue;
    if (offer(family->name, &def, &error) != VL_OK)
      broken(family->name, family->words[kind], "%s = %g, which its row allows: %s", p->member,
             ends[i], error.message);
  }
}

/* Enough triangles for a tree (few are tried one by one). */
#define STRIP                                                                                     \
  "Translate 0 .1 0 Shape \"trianglemesh\" \"point3 P\" [-1 0 0 0 0 0 1 0 0 -1 1 0 0 1 0 1 1 0] " \
  "\"integer indices\" [0 1 3 1 4 3 1 2 4 2 5 4]\n"
#define STRIPS STRIP STRIP STRIP STRIP STRIP STRIP STRIP STRIP
#define ROWS STRIPS STRIPS STRIPS STRIPS

/* What the library accepts of a camera, it renders: rays that are not finite hit nothing, with
 * each accelerator. */
static void render_camera(const vlParameter *p, double number) {
  static const vlAccelerator accelerators[] = {VL_ACCELERATOR_EMBREE, VL_ACCELERATOR_BVH};
  for (size_t i = 0; i < sizeof accelerators / sizeof *accelerators; i++) {
    vlError error = {0};
    vlScene *scene =
        load_text(context, HEAD "WorldBegin " LIGHTS " Material \"diffuse\" " ROWS, &error);
    assert_non_null(scene);
    vlSceneDefs *defs = vl_scene_defs(scene);
    defs->build.accelerator = accelerators[i];
    defs->camera = vl_default_camera_def(WIDTH, WIDTH);
    defs->camera.eye[2] = 4;
    defs->camera.focus_distance = 3;
    put_number(p, (char *)&defs->camera, number);
    vlImage *image = render_scene(context, scene, &error);
    for (uint32_t k = 0; image && k < WIDTH * WIDTH; k++)
      if (!isfinite(vl_image_get(image, k % WIDTH, k / WIDTH, 1)))
        broken("cameras", p->member, "%g: pixel %u is not finite", number, k);
    if (!image && !error.message[0])
      broken("cameras", p->member, "%g: no image and no message", number);
    vl_image_destroy(image);
  }
}

static void hostile_cameras(void **state) {
  (void)state;
  static const double numbers[] = {1e300, -1e300, 1e160, 1e39, -1e19, 1e-300, 5e-324};
  const vlKindRow *camera = vl_settings(VL_SETTING_CAMERA);
  for (uint32_t k = 0; k < camera->parameter_count; k++)
    for (size_t i = 0; i < sizeof numbers / sizeof *numbers; i++) {
      const vlParameter *p = &camera->parameters[k];
      if (p->type == VL_PARAMETER_DOUBLE || p->type == VL_PARAMETER_DOUBLE3)
        render_camera(p, numbers[i]);
    }
  expect_no_failures();
}

static void hostile_defs(void **state) {
  (void)state;
  static const char *const of_defs[] = {"materials", "textures", "lights",  "emission",
                                        "shapes",    "media",    "filters", "cameras"};
  for (size_t f = 0; f < sizeof of_defs / sizeof *of_defs; f++) {
    const vlKindFamily *family = vl_kind_family_find(of_defs[f]);
    for (uint32_t i = 0; i < family->kind_count; i++)
      for (uint32_t k = 0; k < family->rows[i]->parameter_count; k++) {
        const vlParameter *p = &family->rows[i]->parameters[k];
        if (p->flags & VL_PARAMETER_SHORTHAND)
          continue;
        check_def(family, (int)i, p);
        if (strcmp(family->name, "cameras") != 0) /* which need others, too */
          check_ends(family, (int)i, p);
      }
  }
  const vlKindRow *camera = vl_settings(VL_SETTING_CAMERA);
  for (uint32_t k = 0; k < camera->parameter_count; k++)
    if (!(camera->parameters[k].flags & VL_PARAMETER_SHORTHAND))
      check_def(vl_kind_family_find("cameras"), 0, &camera->parameters[k]);
  expect_no_failures();
}

/* ---- files ------------------------------------------------------------------------------- */

enum { LONG = 1000000 };

/* The type of a parameter in pbrt files. */
static const char *type_in_files(const vlParameter *p) {
  switch (p->type) {
    case VL_PARAMETER_BOOL:
      return "bool";
    case VL_PARAMETER_COUNT:
      return "integer";
    case VL_PARAMETER_FLOAT3:
    case VL_PARAMETER_DOUBLE3:
      return p->flags & VL_PARAMETER_VECTOR ? "vector3" : "point3";
    case VL_PARAMETER_CHOICE:
    case VL_PARAMETER_STRING:
    case VL_PARAMETER_FILE:
      return "string";
    case VL_PARAMETER_SPECTRUM:
    case VL_PARAMETER_SPECTRUM_INPUT:
      return p->flags & (VL_PARAMETER_NUMBER | VL_PARAMETER_ONE_NUMBER) ? "float" : "rgb";
    case VL_PARAMETER_FLOAT:
    case VL_PARAMETER_DOUBLE:
    case VL_PARAMETER_FLOAT_INPUT:
    case VL_PARAMETER_EITHER_INPUT:
    case VL_PARAMETER_TEXTURE:
    case VL_PARAMETER_BLOCK:
      break;
  }
  if (p->text && strstr(p->text, "normal"))
    return "normal";
  return p->text && strstr(p->text, "point") ? "point3" : "float";
}

/* Loads the scene and builds its world. */
static vlResult build_text(const char *text, vlError *error) {
  vlScene *scene = load_text(context, text, error);
  if (!scene)
    return error->code ? error->code : VL_ERROR_SCENE;
  vlWorld *world = NULL;
  vlResult result = vl_world_build(scene, &vl_scene_defs(scene)->build, &world, error);
  vl_world_destroy(world);
  vl_scene_destroy(scene);
  return result;
}

static char *long_value(void) {
  char *text = malloc(2 * LONG + 3);
  assert_non_null(text);
  text[0] = '[';
  for (int i = 0; i < LONG; i++)
    memcpy(text + 1 + 2 * i, "1 ", 2);
  strcpy(text + 1 + 2 * LONG, "]");
  return text;
}

static void check_file_value(const Family *family, const vlKindRow *row, const vlParameter *p,
                             const char *value, bool refused) {
  const ParameterCase *kind_case = find_case(family->name, row->name, NULL);
  const ParameterCase *c = find_case(family->name, row->name, p->name);
  const char *form = form_of(family, row);
  vlError error = {0};
  char parameters[TEXT] = "";
  const char *directive = c && c->directive ? c->directive : row->name;
  append_base(parameters, c && c->base ? c->base : kind_case ? kind_case->base : NULL, p->name);
  size_t room = strlen(form) + 2 * (strlen(parameters) + strlen(value) + 200);
  char *text = malloc(room);
  assert_non_null(text);
  text[0] = 0;
  char *end = text;
  for (const char *at = form;;) {
    const char *next = strstr(at, "%s");
    size_t length = next ? (size_t)(next - at) : strlen(at);
    memcpy(end, at, length);
    end += length;
    *end = 0;
    if (!next)
      break;
    end += snprintf(end, room - (size_t)(end - text), "\"%s\" %s \"%s %s\" %s", directive,
                    parameters, type_in_files(p), p->name, value);
    at = next + 2;
  }
  vlResult result = build_text(text, &error);
  free(text);
  if (result == VL_OK && refused)
    broken(family->name, row->name, "\"%s\" %.40s is accepted", p->name, value);
  if (result != VL_OK && !error.message[0])
    broken(family->name, row->name, "\"%s\" %.40s: no message", p->name, value);
}

/* Two values, each of which is right alone, in place of one; an empty text: none is known. */
static void twice(const Family *family, const vlKindRow *row, const vlParameter *p,
                  char text[TEXT]) {
  const char *type = type_in_files(p);
  const ParameterCase *kind_case = find_case(family->name, row->name, NULL);
  const ParameterCase *c = find_case(family->name, row->name, p->name);
  const char *known[3] = {c ? c->value : NULL, c ? c->base : NULL,
                          kind_case ? kind_case->base : NULL};
  char name[80];
  text[0] = 0;
  snprintf(name, sizeof name, "%s %s\" ", type, p->name);
  for (int i = 0; i < 3 && !text[0]; i++) {
    const char *at = known[i] ? strstr(known[i], name) : NULL;
    const char *value = at ? at + strlen(name) : NULL;
    if (value && value[0] != '[')
      snprintf(text, TEXT, "[%.*s %.*s]", (int)strcspn(value, "; "), value,
               (int)strcspn(value, "; "), value);
  }
  if (text[0])
    return;
  if (p->type == VL_PARAMETER_CHOICE)
    snprintf(text, TEXT, "[\"%s\" \"%s\"]", p->choices[0], p->choices[0]);
  else if (p->type == VL_PARAMETER_BOOL)
    snprintf(text, TEXT, "[true true]");
  else if (strcmp(type, "float") == 0 || strcmp(type, "integer") == 0)
    snprintf(text, TEXT, "[1 1]");
}

static void hostile_files(void **state) {
  (void)state;
  char *many = long_value();
  for (size_t f = 0; f < sizeof families / sizeof *families; f++) {
    const Family *family = &families[f];
    const vlKindFamily *rows = vl_kind_family_find(family->name);
    for (uint32_t i = 0; i < rows->kind_count; i++) {
      const vlKindRow *row = rows->rows[i];
      for (uint32_t k = 0; row->name && k < row->parameter_count; k++) {
        const vlParameter *p = &row->parameters[k];
        if (!p->name)
          continue;
        bool number =
            strcmp(type_in_files(p), "bool") != 0 && strcmp(type_in_files(p), "string") != 0;
        bool three = strcmp(type_in_files(p), "rgb") == 0 || strstr(type_in_files(p), "3") ||
                     strcmp(type_in_files(p), "normal") == 0;
        check_file_value(family, row, p,
                         number ? three ? "[nan nan nan]" : "[nan]" : "[\"nan\"]", number);
        check_file_value(family, row, p, number ? three ? "[1e999 0 0]" : "[1e999]" : "[\"\"]",
                         number);
        check_file_value(family, row, p,
                         number ? three ? "[-1 -1 -1]" : "[-1]" : "[\"a\" \"b\"]", false);
        check_file_value(family, row, p,
                         number ? three ? "[4294967304 0 0]" : "[4294967304]" : "[7]", false);
        check_file_value(family, row, p, "[]", false);
        char pair[TEXT];
        twice(family, row, p, pair);
        const ParameterCase *c = find_case(family->name, row->name, p->name);
        const bool ignored = strncmp(p->description, "ignored", 7) == 0 || (c && c->no_effect);
        if (pair[0] && !ignored)
          check_file_value(family, row, p, pair, true);
        if (k % 5 == 0)
          check_file_value(family, row, p, many, false);
      }
    }
  }
  free(many);
  expect_no_failures();
}

#endif
