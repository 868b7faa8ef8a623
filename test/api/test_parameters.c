/* test/api/test_parameters.c: every parameter of every kind that files can name changes the image. The test goes over
 * the rows: it writes a scene with one parameter that is not its default, reads it, renders a few pixels and compares
 * the bytes with those of the scene without the parameter. It fails where a reader, a compile function or a kernel
 * forgets a parameter, and where a kind or a parameter is added that the test cannot give a value. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include <cmocka.h>

#include "../trace/measured_file.h"
#include "../world/nanovdb_file.h"
#include "parameter_cases.h"
#include "velo/schema.h"
#include "velo/velo.h"

enum { WIDTH = 12, SAMPLES = 4, PIXELS = 3 * WIDTH * WIDTH, TEXT = 8192, VALUES = 3 };

static vlContext *context;
static char folder[40] = "/tmp/velo_parameters_XXXXXX";

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

/* The whole scene: each `%s` of the family's form stands for `"kind" parameters`. */
static void scene_text(char text[TEXT], const char *form, const char *kind, const char *parameters) {
  size_t needed = strlen(form) + 2 * (strlen(kind) + strlen(parameters) + 8);
  assert_true(needed < TEXT);
  text[0] = 0;
  for (const char *at; (at = strstr(form, "%s")); form = at + 2) {
    strncat(text, form, (size_t)(at - form));
    strcat(text, "\"");
    strcat(text, kind);
    strcat(text, "\" ");
    strcat(text, parameters);
  }
  strcat(text, form);
}

/* ---- images ------------------------------------------------------------------------------------------------------ */

/* Renders the scene. False, and the reason: it cannot be read. */
static bool render_text(const char *text, float pixels[PIXELS], vlError *error) {
  vlScene *scene = NULL;
  assert_int_equal(vl_scene_create(context, &scene), VL_OK);
  char name[100]; /* relative paths are relative to its folder */
  snprintf(name, sizeof name, "%s/parameters.pbrt", folder);
  vlResult result = vl_scene_load_memory(scene, name, text, strlen(text), NULL, error);
  vlWorld *world = NULL;
  vlFilm *film = NULL;
  vlImage *image = NULL;
  if (result == VL_OK) {
    vlSceneDefs *defs = vl_scene_defs(scene);
    vlCamera camera;
    defs->render.spp = SAMPLES;
    result = vl_world_build(scene, &defs->build, &world, error);
    if (result == VL_OK) result = vl_camera_make(&defs->camera, &camera, NULL, error);
    if (result == VL_OK) result = vl_film_create(context, &defs->film, &film);
    if (result == VL_OK) result = vl_render(world, &camera, film, &defs->render, NULL, error);
    if (result == VL_OK) result = vl_film_develop(film, NULL, &image);
    if (result == VL_OK) memcpy(pixels, vl_image_const_pixels(image), PIXELS * sizeof *pixels);
  }
  vl_image_destroy(image);
  vl_film_destroy(film);
  vl_world_destroy(world);
  vl_scene_destroy(scene);
  return result == VL_OK;
}

/* ---- families ---------------------------------------------------------------------------------------------------- */

#define HEAD                                                                                           \
  "LookAt 0 1.5 4 0 .4 0 0 1 0 Camera \"perspective\" \"float fov\" 40\n"                              \
  "Film \"rgb\" \"integer xresolution\" 12 \"integer yresolution\" 12 \"string filename\" \"x.pfm\"\n" \
  "Sampler \"independent\" Integrator \"volpath\" \"integer maxdepth\" 6\n"
#define LIGHTS                                       \
  "LightSource \"infinite\" \"rgb L\" [.3 .35 .4]\n" \
  "LightSource \"distant\" \"point3 from\" [2 3 1.5] \"rgb L\" [2 1.9 1.7]\n"
#define NAMED                                                                                              \
  "Texture \"bumps\" \"float\" \"checkerboard\" \"float uscale\" 5 \"float vscale\" 5 \"float tex1\" .1\n" \
  "MakeNamedMaterial \"grey\" \"string type\" \"diffuse\"\n"                                               \
  "MakeNamedMaterial \"red\" \"string type\" \"diffuse\" \"rgb reflectance\" [.8 .1 .1]\n"
#define GROUND "Material \"diffuse\" Shape \"bilinearmesh\" \"point3 P\" [-3 -.6 3 3 -.6 3 -3 -.6 -3 3 -.6 -3]\n"
#define BALL "Rotate 70 1 .3 .2 Shape \"sphere\" \"float radius\" .8\n"

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

/* Returns the number of failures. */
static int check_parameter(const Family *family, const vlKindRow *row, const vlParameter *p) {
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
      print_error("%s %s %s: the test has no value for it\n", family->name, row->name, p->name);
      return 1;
    }
    effect = has_effect(form, c && c->directive ? c->directive : row->name, base, value, p->name);
  }
  bool expected = !(c && c->no_effect);
  if (effect == expected) return 0;
  print_error("%s %s \"%s\": %s\n", family->name, row->name, p->name,
              effect ? "has an effect after all" : "changes nothing");
  return 1;
}

static void check_family(const char *name) {
  const vlKindFamily *rows = vl_kind_family_find(name);
  const Family *family = families;
  while (strcmp(family->name, name) != 0) family++;
  int failures = 0;
  for (uint32_t i = 0; i < rows->kind_count; i++) {
    const vlKindRow *row = rows->rows[i];
    for (uint32_t k = 0; row->name && k < row->parameter_count; k++)
      if (row->parameters[k].name) failures += check_parameter(family, row, &row->parameters[k]);
  }
  assert_int_equal(failures, 0);
}

static void test_materials(void **state) {
  (void)state;
  check_family("materials");
}
static void test_textures(void **state) {
  (void)state;
  check_family("textures");
}
static void test_lights(void **state) {
  (void)state;
  check_family("lights");
}
static void test_emission(void **state) {
  (void)state;
  check_family("emission");
}
static void test_media(void **state) {
  (void)state;
  check_family("media");
}
static void test_shapes(void **state) {
  (void)state;
  check_family("shapes");
}
static void test_filters(void **state) {
  (void)state;
  check_family("filters");
}

/* ---- files ------------------------------------------------------------------------------------------------------- */

static void path_of(char path[100], const char *name) {
  snprintf(path, 100, "%s/%s", folder, name);
}

static bool write_bytes(const char *name, const void *bytes, size_t size) {
  char path[100];
  path_of(path, name);
  FILE *file = fopen(path, "wb");
  bool done = file && fwrite(bytes, 1, size, file) == size;
  return file && fclose(file) == 0 && done;
}

/* An image of 8 x 8 pixels in the format that the name says. */
static bool write_image(const char *name, float phase) {
  vlImageDef def = vl_default_image_def(8, 8, 3);
  vlImage *image;
  char path[100];
  path_of(path, name);
  if (vl_image_create(context, &def, &image) != VL_OK) return false;
  float *pixels = vl_image_pixels(image);
  for (int i = 0; i < 3 * 64; i++) pixels[i] = 0.5f + 0.4f * (float)((i * 37 + (int)phase * 11) % 64 - 32) / 32;
  bool done = vl_image_write(image, path, NULL, NULL) == VL_OK;
  vl_image_destroy(image);
  return done;
}

static bool write_measured(const char *name, double alpha) {
  char path[100];
  mfSurface metal = mf_surface(alpha, alpha);
  metal.nodes = metal.samples = 16;
  mfFile file = mf_measure(&metal);
  path_of(path, name);
  bool done = mf_write(path, &file);
  free(file.bytes);
  return done;
}

/* A file of densities whose first voxels surround the origin. */
static bool write_nanovdb(const char *name, float last) {
  unsigned char *grid = make_grid();
  const double low[3] = {-2, -2 + 0.1 * last, -2};
  const double high[3] = {126, 62, 62};
  for (size_t i = 0; i < 3; i++) {
    put_d(grid + 296 + 232 + 8 * i, low[i]); /* the map's translation */
    put_d(grid + 560 + 8 * i, low[i]);       /* the bounding box in world space */
    put_d(grid + 584 + 8 * i, high[i]);
  }
  size_t size;
  unsigned char *file = make_file(grid, 0, &size);
  bool done = write_bytes(name, file, size);
  free(file);
  free(grid);
  return done;
}

static const char ply[] =
    "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\n"
    "property float u\nproperty float v\nelement face 2\nproperty list uchar int vertex_indices\n"
    "end_header\n-1 -1 0 0 0\n1 -1 0 1 0\n-1 1 0 0 1\n1 1 0 1 1\n3 0 1 2\n3 1 3 2\n";

static int setup(void **state) {
  (void)state;
  if (!mkdtemp(folder) || vl_context_create(NULL, &context) != VL_OK) return 1;
  bool done = write_image("a.pfm", 0) && write_image("b.pfm", 1) && write_image("sky.pfm", 2) &&
              write_image("other.pfm", 3) && write_image("normals.pfm", 4) && write_image("a.tga", 5);
  done = done && write_bytes("a.ply", ply, sizeof ply - 1);
  done = done && write_measured("a.bsdf", 0.3) && write_measured("b.bsdf", 0.1) && write_nanovdb("a.nvdb", 0) &&
         write_nanovdb("b.nvdb", 1);
  return !done;
}

static int teardown(void **state) {
  (void)state;
  static const char *const files[] = {"a.pfm",  "b.pfm",  "sky.pfm", "other.pfm", "normals.pfm", "a.tga",
                                      "a.bsdf", "b.bsdf", "a.nvdb",  "b.nvdb",    "a.ply"};
  for (size_t i = 0; i < sizeof files / sizeof *files; i++) {
    char path[100];
    path_of(path, files[i]);
    remove(path);
  }
  vl_context_destroy(context);
  return remove(folder);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(test_materials), cmocka_unit_test(test_textures), cmocka_unit_test(test_lights),
      cmocka_unit_test(test_emission),  cmocka_unit_test(test_media),    cmocka_unit_test(test_shapes),
      cmocka_unit_test(test_filters),
  };
  return cmocka_run_group_tests(tests, setup, teardown);
}
