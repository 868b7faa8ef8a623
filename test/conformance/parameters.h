/* conformance/parameters.h: every parameter of every kind that files can name changes the
 * image, is written to pbrt files and read again, and is known to the doctor. It writes a scene
 * with one parameter that is not its default, reads it, renders a few pixels and compares the
 * bytes with those of the scene without the parameter. It fails where a reader, a compile
 * function or a kernel forgets a parameter, and where a kind or a parameter is added that the
 * test cannot give a value. */
#ifndef TEST_CONFORMANCE_PARAMETERS_H
#define TEST_CONFORMANCE_PARAMETERS_H

#include "conformance.h"
#include "edited.h"
#include "parameter_cases.h"
#include "unit.h"
#include "velo/check.h"
#include "velo/edit.h"
#include "velo/export.h"
#include "velo/filter_kinds.h"
#include "velo/material.h"
#include "velo/sampler.h"
#include "velo/tracer.h"

enum { VALUES = 3 };

/* ---- cases ------------------------------------------------------------------------------- */

static bool same_name(const char *a, const char *b) {
  return a == b || (a && b && strcmp(a, b) == 0);
}

/* The cases of parameters that are in the case of a kind; null: there are none. */
static const ParameterCase *cases_of_kind(const char *family, uint32_t kind) {
  if (strcmp(family, "textures") == 0)
    return texture_cases[kind]->parameters;
  if (strcmp(family, "lights") == 0)
    return light_cases[kind]->parameters;
  if (strcmp(family, "media") == 0)
    return medium_cases[kind]->parameters;
  if (strcmp(family, "shapes") == 0)
    return shape_cases[kind]->parameters;
  return NULL;
}

/* The case of a parameter that is in the case of its kind; null: there is none. */
static const ParameterCase *own_case(const char *family, const char *kind,
                                     const char *parameter) {
  const vlKindFamily *all = vl_kind_family_find(family);
  for (uint32_t k = 0; all && kind && k < all->kind_count; k++) {
    const ParameterCase *list = cases_of_kind(family, k);
    if (!list || !same_name(all->rows[k]->name, kind))
      continue;
    for (int i = 0; i < PARAMETER_CASES && (list[i].base || list[i].value || list[i].no_effect);
         i++)
      if (same_name(list[i].parameter, parameter))
        return &list[i];
  }
  return NULL;
}

/* The case of a parameter, or, for null, of the kind as a whole. A case of the kind comes
 * before one of the family. */
static const ParameterCase *find_case(const char *family, const char *kind,
                                      const char *parameter) {
  const ParameterCase *found = own_case(family, kind, parameter);
  if (found)
    return found;
  for (size_t i = 0; i < sizeof parameter_cases / sizeof *parameter_cases; i++) {
    const ParameterCase *c = &parameter_cases[i];
    if (strcmp(c->family, family) != 0 || !same_name(c->parameter, parameter))
      continue;
    if (same_name(c->kind, kind))
      return c;
    if (!c->kind)
      found = c;
  }
  return found;
}

/* ---- the text of a scene ----------------------------------------------------------------- */

/* Appends the parameters of `base`, which semicolons separate, except the one with that name
 * (null: all). */
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
  if (limited && value <= low)
    value = low + 0.3;
  if (limited && value >= high)
    value = low + 0.6 * (high - low);
  return value / factor;
}

/* Appends `"type name" value` as pbrt writes it. floats: for a float texture. False: the row
 * does not tell. */
static bool append_value(char text[TEXT], const vlParameter *p, bool floats, int which) {
  char value[400];
  double number = other_number(p, which);
  switch (p->type) {
    case VL_PARAMETER_BOOL:
      snprintf(value, sizeof value, "\"bool %s\" %s", p->name,
               p->value[0] != 0 ? "false" : "true");
      break;
    case VL_PARAMETER_COUNT:
      snprintf(value, sizeof value, "\"integer %s\" %d", p->name, (int)p->value[0] + 1 + which);
      if (p->high != 0 && p->value[0] + 1 + which > p->high)
        snprintf(value, sizeof value, "\"integer %s\" %d", p->name, (int)p->value[0] - 1);
      break;
    case VL_PARAMETER_FLOAT:
    case VL_PARAMETER_DOUBLE:
    case VL_PARAMETER_FLOAT_INPUT:
      snprintf(value, sizeof value, "\"float %s\" %.9g", p->name, number);
      break;
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
      snprintf(value, sizeof value, "\"%s %s\" [%g %g %g]",
               p->flags & VL_PARAMETER_VECTOR ? "vector3" : "point3", p->name,
               p->value[0] + 0.3, p->value[1] + 0.2, p->value[2] - 0.4);
      break;
    case VL_PARAMETER_CHOICE: {
      int count = 0;
      while (p->choices[count])
        count++;
      int choice = ((int)p->value[0] + 1 + which) % count;
      snprintf(value, sizeof value, "\"string %s\" \"%s\"", p->name, p->choices[choice]);
      break;
    }
    case VL_PARAMETER_STRING:
    case VL_PARAMETER_FILE:
    case VL_PARAMETER_TEXTURE:
    case VL_PARAMETER_BLOCK:
    default:
      return false;
  }
  strcat(text, value);
  return true;
}

/* ---- families ---------------------------------------------------------------------------- */

/* What tracers see: bounces of all kinds, and a rough metal in the light of a diffuse floor. */
#define TRACED                                                                          \
  LIGHTS GROUND                                                                         \
      "LightSource \"point\" \"point3 from\" [-1 2 1] "                                 \
      "Material \"conductor\" \"float roughness\" .02 " BALL                            \
      "Translate .9 0 .6 Material \"dielectric\" Shape \"sphere\" \"float radius\" .4 " \
      "Translate -1.6 0 .4 Material \"coateddiffuse\" Shape \"sphere\" \"float radius\" .3\n"

/* The form of a family's scenes: %s stands for `"kind" parameters`. */
typedef struct Family {
  const char *name, *form;
} Family;

static const Family families[] = {
    {"materials", HEAD "WorldBegin " LIGHTS NAMED GROUND "Material %s " BALL},
    {"textures", HEAD "WorldBegin " LIGHTS GROUND "Texture \"t\" \"spectrum\" %s "
                      "Material \"diffuse\" \"texture reflectance\" \"t\" " BALL},
    {"lights", HEAD "WorldBegin " GROUND "LightSource %s Material \"coateddiffuse\" " BALL},
    {"emission",
     HEAD "WorldBegin " GROUND "AttributeBegin Translate .3 .4 -.5 AreaLightSource %s "
          "Shape \"bilinearmesh\" \"point3 P\" [-1 -1 0 1 -1 0 -1 1 0 1 1 0] AttributeEnd\n"
          "Translate -1 0 .5 Scale .4 .4 .4 Material \"diffuse\" " BALL},
    {"media", HEAD "WorldBegin " LIGHTS GROUND
                   "AttributeBegin MakeNamedMedium \"m\" \"string type\" %s AttributeEnd\n"
                   "MediumInterface \"m\" \"\" Material \"interface\" " BALL},
    {"shapes",
     HEAD "WorldBegin " LIGHTS NAMED GROUND
          "Texture \"c\" \"spectrum\" \"checkerboard\" \"float uscale\" 5 \"float vscale\" 5\n"
          "Rotate 20 1 .3 .2 Material \"conductor\" \"float uroughness\" .4 "
          "\"float vroughness\" .1 Shape %s Translate .4 .2 .3 Material \"diffuse\" "
          "\"texture reflectance\" \"c\" Shape %s"},
    {"filters", HEAD "PixelFilter %s WorldBegin " LIGHTS GROUND "Material \"diffuse\" " BALL},
    {"tracers", HEAD "Integrator %s WorldBegin " TRACED},
};

static const char *const traced_in_media = HEAD
    "Integrator %s MakeNamedMedium \"fog\" \"string type\" \"homogeneous\" WorldBegin " TRACED
    "MediumInterface \"fog\" \"\" Translate 0 1 0 Material \"interface\" " BALL;

static const char *const lamps =
    HEAD "WorldBegin " GROUND
         "AttributeBegin Translate .2 2 .3 Rotate 80 1 .1 .2 "
         "LightSource %s AttributeEnd Material \"coateddiffuse\" " BALL;

static const char *const float_texture =
    HEAD "WorldBegin " LIGHTS NAMED GROUND
         "Texture \"t\" \"float\" %s Material \"mix\" \"string materials\" [\"grey\" \"red\"] "
         "\"texture amount\" \"t\" " BALL;

static bool is_float_texture(const Family *family, const vlKindRow *row) {
  return strcmp(family->name, "textures") == 0 && (row->traits & VL_TEXTURE_FLOAT_ONLY);
}

static const char *form_of(const Family *family, const vlKindRow *row) {
  if (is_float_texture(family, row))
    return float_texture;
  if (strcmp(family->name, "tracers") == 0 && strcmp(row->name, "volpath") == 0)
    return traced_in_media;
  bool lamp = strcmp(family->name, "lights") == 0 && (row->traits & VL_LIGHT_TRAIT_AT_POINT);
  return lamp ? lamps : family->form;
}

/* ---- written and read again -------------------------------------------------------------- */

/* Counts what a format cannot hold. */
static void count_loss(void *user, const char *what, uint64_t count) {
  (void)what;
  (void)count;
  ++*(int *)user;
}

/* Writes the scene of the text to a file and renders what is read from it. False: the format
 * loses a part of it. */
static bool render_written(const char *text, const char *file, float pixels[PIXELS],
                           vlError *error) {
  char path[100];
  int losses = 0;
  snprintf(path, sizeof path, "%s/%s", folder, file);
  vlScene *scene = load_text(context, text, error);
  assert_non_null(scene);
  vlSaveDef save = vl_default_save_def();
  save.lost = count_loss;
  save.lost_user = &losses;
  vlResult result = vl_scene_save(scene, path, &save, error);
  vl_scene_destroy(scene);
  if (result != VL_OK || losses)
    return losses > 0;
  assert_int_equal(vl_scene_create(context, &scene), VL_OK);
  if (vl_scene_load(scene, path, NULL, error) != VL_OK) {
    vl_scene_destroy(scene);
    return false;
  }
  vl_scene_defs(scene)->render.spp = SAMPLES;
  vlImage *image = render_scene(context, scene, error);
  if (!image)
    return false;
  memcpy(pixels, vl_image_const_pixels(image), PIXELS * sizeof *pixels);
  vl_image_destroy(image);
  return true;
}

/* glTF has only meshes: forms of scenes with meshes in place of patches and balls. */
static const char *const meshes[][2] = {
    {GROUND,
     "Material \"diffuse\" Shape \"trianglemesh\" \"integer indices\" [0 1 2 1 3 2] "
     "\"point3 P\" [-3 -.6 3 3 -.6 3 -3 -.6 -3 3 -.6 -3]\n"},
    {BALL,
     "Rotate 70 1 .3 .2 Shape \"trianglemesh\" "
     "\"integer indices\" [0 1 2 1 3 2 0 2 4 2 3 4 1 0 5 3 1 5 0 4 5 4 3 5] "
     "\"point3 P\" [.8 0 0 0 .8 0 0 0 .8 -.8 0 0 0 -.8 0 0 0 -.8] "
     "\"point2 uv\" [0 0 1 0 .5 1 0 1 .3 .6 .8 .4]\n"},
    {"Shape \"bilinearmesh\" \"point3 P\" [-1 -1 0 1 -1 0 -1 1 0 1 1 0]",
     "Shape \"trianglemesh\" \"integer indices\" [0 1 2 1 3 2] "
     "\"point3 P\" [-1 -1 0 1 -1 0 -1 1 0 1 1 0]"},
};

static void with_meshes(const char *text, char out[2 * TEXT]) {
  while (*text) {
    size_t k = 0;
    while (k < 3 && strncmp(text, meshes[k][0], strlen(meshes[k][0])) != 0)
      k++;
    size_t length = k < 3 ? strlen(meshes[k][1]) : 1;
    memcpy(out, k < 3 ? meshes[k][1] : text, length);
    out += length;
    text += k < 3 ? strlen(meshes[k][0]) : 1;
  }
  *out = 0;
}

/* The scenes that glTF holds, by the writer's own word, and the comparisons of quarters of
 * their images that would and would not find a mistake of a fifth. */
static int held_by_gltf;
static int quarters_seen;
static int quarters_blurred;

/* What a scene's text, or the glTF file that is written of it (suffix not null), looks like
 * with many samples. Null: glTF loses a part of it, or failed. */
enum { GLTF_SPP = 192 };

/* The last def of a family in a scene, if it is of this kind, else null. */
static const void *last_def(const vlScene *scene, const char *family, uint32_t kind) {
  const void *def = NULL;
  for (uint32_t i = 1;; i++) {
    const void *next = NULL;
    uint32_t k = kind;
    const vlMaterialDef *material = vl_scene_material(scene, (vlMaterialId){i});
    const vlTextureDef *texture = vl_scene_texture(scene, (vlTextureId){i});
    const vlLightDef *light = vl_scene_light(scene, (vlLightId){i});
    const vlMediumDef *medium = vl_scene_medium(scene, (vlMediumId){i});
    const vlShapeDef *shape = vl_scene_shape(scene, (vlShapeId){i});
    if (strcmp(family, "materials") == 0 && (next = material))
      k = (uint32_t)material->kind;
    else if (strcmp(family, "textures") == 0 && (next = texture))
      k = (uint32_t)texture->kind;
    else if (strcmp(family, "lights") == 0 && (next = light))
      k = (uint32_t)light->kind;
    else if (strcmp(family, "media") == 0 && (next = medium))
      k = (uint32_t)medium->kind;
    else if (strcmp(family, "shapes") == 0 && (next = shape))
      k = (uint32_t)shape->kind;
    else if (strcmp(family, "emission") == 0)
      next = vl_scene_emission(scene, (vlEmissionId){i});
    if (!next)
      return def;
    def = k == kind ? next : def;
  }
}

/* The number that the last of a kind in a scene has as a parameter. NaN: there is no such kind,
 * or the parameter is not a number. */
static double number_in(const vlScene *scene, const char *family, const char *kind,
                        const char *name) {
  const vlKindFamily *all = vl_kind_family_find(family);
  uint32_t k = 0;
  while (k < all->kind_count && !same_name(all->rows[k]->name, kind))
    k++;
  const vlParameter *p = NULL;
  for (size_t i = 0; k < all->kind_count && i < all->rows[k]->parameter_count; i++)
    if (same_name(all->rows[k]->parameters[i].name, name))
      p = &all->rows[k]->parameters[i];
  const char *def = p ? last_def(scene, family, k) : NULL;
  if (!def)
    return NAN;
  if (p->type == VL_PARAMETER_FLOAT)
    return (double)*(const float *)(def + p->offset);
  if (p->type == VL_PARAMETER_DOUBLE)
    return *(const double *)(const void *)(def + p->offset);
  if (p->type != VL_PARAMETER_FLOAT_INPUT)
    return NAN;
  const vlFloatInput *input = (const vlFloatInput *)(def + p->offset);
  return input->texture.index ? NAN : (double)input->value;
}

/* number: of the parameter `name` of the kind, in the scene that is rendered. */
static vlImage *image_by_gltf(const char *text, bool written, const char *family,
                              const char *kind, const char *name, double *number, int *losses,
                              vlError *error) {
  char path[100];
  vlScene *scene = load_text(context, text, error);
  if (!scene)
    return NULL;
  if (written) {
    snprintf(path, sizeof path, "%s/written.gltf", folder);
    vlSaveDef save = vl_default_save_def();
    save.lost = count_loss;
    save.lost_user = losses;
    vlResult result = vl_scene_save(scene, path, &save, error);
    vl_scene_destroy(scene);
    if (*losses || result != VL_OK)
      return NULL;
    assert_int_equal(vl_scene_create(context, &scene), VL_OK);
    if (vl_scene_load(scene, path, NULL, error) != VL_OK) {
      vl_scene_destroy(scene);
      return NULL;
    }
  }
  *number = number_in(scene, family, kind, name);
  vlSceneDefs *defs = vl_scene_defs(scene);
  defs->camera.width = defs->camera.height = WIDTH;
  defs->film = vl_default_film_def(WIDTH, WIDTH);
  defs->film.filter = vl_default_pixel_filter(VL_PIXEL_FILTER_BOX);
  defs->render.spp = GLTF_SPP;
  defs->render.sampler = VL_SAMPLER_INDEPENDENT;
  defs->render.tracer = VL_TRACER_VOLPATH;
  defs->render.max_depth = 6;
  return render_scene(context, scene, error);
}

/* A scene that glTF holds is the same scene when it is read again: the writer says what it
 * loses, or the parameter's number is the same, and the image has the same light in each of its
 * quarters, but for colours in bytes and skies as cube maps. */
static void check_gltf(const char *family, const char *kind, const char *name,
                       const char *text) {
  static char mesh_text[2 * TEXT];
  vlError error = {0};
  int losses = 0;
  with_meshes(text, mesh_text);
  double read_again = 0;
  double number = 0;
  vlImage *again =
      image_by_gltf(mesh_text, true, family, kind, name, &read_again, &losses, &error);
  if (losses)
    return;
  vlImage *plain =
      again ? image_by_gltf(mesh_text, false, family, kind, name, &number, &losses, &error)
            : NULL;
  if (!plain) {
    broken(family, kind, "\"%s\": as gltf: %s", name, error.message);
    vl_image_destroy(again);
    return;
  }
  held_by_gltf++;
  if (fabs(read_again - number) > 1e-3 * fabs(number))
    broken(family, kind, "\"%s\": as gltf: %g, not %g", name, read_again, number);
  for (int part = 0; part < 4; part++)
    for (int c = 0; c < 3; c++) {
      Mean off = {0};
      double whole = 0;
      const uint32_t half = WIDTH / 2;
      for (uint32_t i = 0; i < half * half; i++) {
        const uint32_t x = i % half + (part & 1 ? half : 0);
        const uint32_t y = i / half + (part & 2 ? half : 0);
        mean_add(&off, (double)vl_image_get(again, x, y, (uint32_t)c) -
                           (double)vl_image_get(plain, x, y, (uint32_t)c));
        whole += (double)vl_image_get(plain, x, y, (uint32_t)c) / (half * half);
      }
      const double deviation = sqrt(variance_of_mean(&off));
      if (fabs(mean_of(&off)) > 5 * deviation + 0.04 * whole)
        broken(family, kind,
               "\"%s\": as gltf, part %d, channel %d: off by %.4f +- %.4f of %.4f", name, part,
               c, mean_of(&off), deviation, whole);
      bool sees = 8.1 * deviation + 0.04 * whole <= 0.2 * whole;
      quarters_seen += sees;
      quarters_blurred += !sees;
    }
  vl_image_destroy(again);
  vl_image_destroy(plain);
}

/* The largest difference of two images, over the brightest pixel. */
static double difference(const float a[PIXELS], const float b[PIXELS]) {
  double max = 1e-9;
  double far = 0;
  for (int i = 0; i < PIXELS; i++) {
    max = fmax(max, fabs((double)a[i]));
    far = fmax(far, fabs((double)a[i] - (double)b[i]));
  }
  return far / max;
}

/* The scene with a changed parameter, as another instruction set renders it and as the pbrt
 * file that is written holds it. */
static void check_text(const char *family, const char *kind, const char *name, const char *text,
                       const float pixels[PIXELS]) {
  static float other[PIXELS];
  vlError error = {0};
  assert_true(render_in(contexts[0], text, other, &error));
  if (memcmp(other, pixels, sizeof other) != 0)
    broken(family, kind, "\"%s\": other bits in another instruction set", name);
  memcpy(other, pixels, sizeof other);
  if (!render_written(text, "written.pbrt", other, &error))
    broken(family, kind, "\"%s\": written, it cannot be read again: %s", name, error.message);
  else if (difference(pixels, other) >
           (strcmp(kind, "principled") == 0 ? 0.02 : 1e-4)) /* pbrt has it not */
    broken(family, kind, "\"%s\": written and read again, the image differs by %.2g", name,
           difference(pixels, other));
  if (strcmp(family, "filters") != 0 && strcmp(family, "tracers") != 0) /* not of the scene */
    check_gltf(family, kind, name, text);
}

/* ---- numbers of files -------------------------------------------------------------------- */

/* A unit of files other than that of the defs, and its factor. */
static const struct {
  const char *unit;
  double factor;
} file_units[] = {{"degrees", PI / 180}, {"mm", 1e-3}, {"um", 1e-6}};

/* The number of a file is that of the def, in the def's unit. number: as the file has it; NaN:
 * another value. */
static void check_arrives(const char *family, const char *kind, const vlParameter *p,
                          const char *text, double number) {
  vlError error = {0};
  double factor = 1;
  if (p->flags & VL_PARAMETER_RULE)
    return; /* no member of the def */
  for (size_t i = 0; p->factor != 0 && i < sizeof file_units / sizeof *file_units; i++)
    if (strcmp(p->unit, file_units[i].unit) == 0)
      factor = file_units[i].factor;
  vlScene *scene = load_text(context, text, &error);
  assert_non_null(scene);
  const double found = number_in(scene, family, kind, p->name);
  vl_scene_destroy(scene);
  if (fabs(found - number * factor) > 1e-6 * fabs(number * factor))
    broken(family, kind, "\"%s\": %g in the file is %g", p->name, number, found);
}

/* ---- losses ------------------------------------------------------------------------------ */

/* A file that is written, and what its writer says that it cannot hold. */
enum { WRITTEN_BYTES = 1 << 20, LOSSES = 2000 };
typedef struct Written {
  char bytes[WRITTEN_BYTES];
  size_t size;
  char losses[LOSSES];
} Written;

static void note_loss(void *user, const char *what, uint64_t count) {
  char *losses = user;
  const size_t length = strlen(losses);
  snprintf(losses + length, LOSSES - length, "%s (%u); ", what, (unsigned)count);
}

/* The bytes of a file. False: it cannot be read, or is too long. */
static bool read_written(const char *path, Written *w) {
  FILE *file = fopen(path, "rb");
  w->size = file ? fread(w->bytes, 1, WRITTEN_BYTES, file) : 0;
  return file && fclose(file) == 0 && w->size < WRITTEN_BYTES;
}

static bool write_scene_of(const char *text, const char *suffix, Written *w) {
  char path[100];
  vlError error = {0};
  vlScene *scene = load_text(context, text, &error);
  assert_non_null(scene);
  vlSaveDef save = vl_default_save_def();
  w->losses[0] = 0;
  save.lost = note_loss;
  save.lost_user = w->losses;
  snprintf(path, sizeof path, "%s/losses.%s", folder, suffix);
  const bool done = vl_scene_save(scene, path, &save, &error) == VL_OK;
  vl_scene_destroy(scene);
  return done && read_written(path, w);
}

/* Words of losses that cover much of what a kind of the family has, or one parameter. */
static const struct {
  const char *family, *words, *parameter;
} covering[] = {{"materials", "as a rough dielectric", NULL},
                {"materials", "its first alone", NULL},
                {"materials", "that glTF has not", NULL},
                {"materials", "as a metal with a clear coat", NULL},
                {"materials", "as diffuse of", NULL},
                {"materials", ": left out", NULL},
                {"textures", "its mean stands in", NULL},
                {"textures", "mapped other than by uv", NULL},
                {"textures", "its first alone", NULL},
                {"lights", "that glTF has not", NULL},
                {"media", "only part media", NULL},
                {"shapes", "of the kind curve", NULL},
                {"shapes", "displacement of meshes", "edgelength"},
                {"shapes", "differs by direction", "S"}};

static bool is_covered(const char *family, const char *parameter, const char *losses) {
  bool covered = false;
  for (size_t i = 0; i < sizeof covering / sizeof *covering; i++)
    covered =
        covered || (strcmp(covering[i].family, family) == 0 &&
                    (!covering[i].parameter || same_name(covering[i].parameter, parameter)) &&
                    strstr(losses, covering[i].words) != NULL);
  return covered;
}

/* What changes the image changes the file, too, or the writer says that it is lost. */
static void check_losses(const char *family, const char *kind, const char *name,
                         const char *plain, const char *changed, const char *suffix) {
  static Written written[2];
  static char mesh_text[2][2 * TEXT];
  with_meshes(plain, mesh_text[0]);
  with_meshes(changed, mesh_text[1]);
  for (int i = 0; i < 2; i++)
    if (!write_scene_of(mesh_text[i], suffix, &written[i]))
      return;
  if (written[0].size == written[1].size &&
      memcmp(written[0].bytes, written[1].bytes, written[0].size) == 0 &&
      strcmp(written[0].losses, written[1].losses) == 0 &&
      !is_covered(family, name, written[0].losses))
    broken(family, kind, "\"%s\": as .%s it is lost without a word: %s", name, suffix,
           written[0].losses);
}

/* ---- the effect of a parameter ----------------------------------------------------------- */

/* Whether the image changes with the parameter. */
static bool has_effect(const char *family, const char *form, const char *kind, const char *base,
                       const char *value, const vlParameter *p) {
  const char *name = p->name;
  static float plain[PIXELS];
  static float changed[PIXELS];
  static char parameters[TEXT];
  static char text[TEXT];
  static char plain_text[TEXT];
  vlError error = {0};
  parameters[0] = 0;
  append_base(parameters, base, name);
  /* A kind that cannot do without the parameter keeps it. */
  scene_text(text, form, kind, parameters);
  if (!render_text(text, plain, &error)) {
    parameters[0] = 0;
    append_base(parameters, base, NULL);
    scene_text(text, form, kind, parameters);
    if (!render_text(text, plain, &error))
      fail_msg("%s: %s\n%s", kind, error.message, text);
    parameters[0] = 0;
    append_base(parameters, base, name);
  }
  strcpy(plain_text, text);
  strcat(parameters, value);
  scene_text(text, form, kind, parameters);
  if (!render_text(text, changed, &error))
    fail_msg("%s %s: %s\n%s", kind, name, error.message, text);
  bool effect = memcmp(plain, changed, sizeof plain) != 0;
  if (effect)
    check_text(family, kind, name, text, changed);
  if (effect)
    check_edited(family, kind, name, plain_text, text, changed);
  if (effect && strcmp(family, "filters") != 0 && strcmp(family, "tracers") != 0) {
    check_losses(family, kind, name, plain_text, text, "glb");
    if (strcmp(kind, "principled") == 0) /* pbrt has all others */
      check_losses(family, kind, name, plain_text, text, "pbrt");
  }
  const char *number = strstr(value, "\"float ");
  number = number ? strchr(number + 1, '"') : NULL;
  if (effect && number)
    check_arrives(family, kind, p, text, strtod(number + 1, NULL));
  return effect;
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
    effect = has_effect(family->name, form, c && c->directive ? c->directive : row->name, base,
                        value, p);
  }
  bool ignored = strncmp(p->description, "ignored", 7) == 0;
  bool expected = !ignored && !(c && c->no_effect);
  if (effect != expected)
    broken(family->name, row->name, "\"%s\" %s", p->name,
           effect ? "has an effect after all" : "changes nothing");
}

/* ---- textures of parameters -------------------------------------------------------------- */

static bool takes_texture(const vlParameter *p) {
  bool input = p->type == VL_PARAMETER_FLOAT_INPUT || p->type == VL_PARAMETER_SPECTRUM_INPUT ||
               p->type == VL_PARAMETER_EITHER_INPUT;
  const uint32_t without = VL_PARAMETER_NO_TEXTURE | VL_PARAMETER_FILE_NUMBER |
                           VL_PARAMETER_RULE | VL_PARAMETER_SHORTHAND;
  return p->name && input && !(p->flags & without);
}

/* The statements of textures, one for each parameter that takes one (only >= 0: for that one
 * alone), and the parameters that name them. */
static void append_textures(const vlKindRow *row, bool floats, int only, char textures[TEXT],
                            char parameters[TEXT]) {
  char line[200];
  textures[0] = 0;
  for (uint32_t k = 0; k < row->parameter_count; k++) {
    const vlParameter *p = &row->parameters[k];
    if (!takes_texture(p) || (only >= 0 && (int)k != only))
      continue;
    bool number =
        p->type == VL_PARAMETER_FLOAT_INPUT || (p->type == VL_PARAMETER_EITHER_INPUT && floats);
    snprintf(line, sizeof line, "Texture \"used%u\" \"%s\" \"constant\" \"%s value\" %s\n", k,
             number ? "float" : "spectrum", number ? "float" : "rgb",
             number ? ".3" : "[.3 .3 .3]");
    strcat(textures, line);
    snprintf(line, sizeof line, " \"texture %s\" \"used%u\"", p->name, k);
    strcat(parameters, line);
  }
}

/* The doctor finds none of them unused. */
static void check_doctor(const Family *family, const vlKindRow *row, int only) {
  static char textures[TEXT];
  static char parameters[TEXT];
  static char text[2 * TEXT];
  static char form[2 * TEXT];
  vlError error = {0};
  const ParameterCase *kind_case = find_case(family->name, row->name, NULL);
  bool material = strcmp(family->name, "materials") == 0;
  parameters[0] = 0;
  append_base(parameters, kind_case ? kind_case->base : NULL, NULL);
  append_textures(row, is_float_texture(family, row), only, textures, parameters);
  if (!*textures)
    return;
  snprintf(form, sizeof form, "%s", form_of(family, row));
  const char *named = strstr(form, NAMED);
  const char *kept =
      "MakeNamedMaterial \"grey\" \"string type\" \"diffuse\"\n"
      "MakeNamedMaterial \"red\" \"string type\" \"diffuse\"\n";
  bool mixes = (material && strcmp(row->name, "mix") == 0) || is_float_texture(family, row);
  const char *start = strstr(form, "WorldBegin") + strlen("WorldBegin");
  int head = (int)((named ? named : start) - form);
  const char *rest = named ? named + strlen(NAMED) : start;
  snprintf(text, sizeof text, "%.*s\n%s%s%s", head, form, mixes ? kept : "", textures, rest);
  strcpy(form, text);
  scene_text(text, form, row->name, parameters);
  vlScene *scene = load_text(context, text, &error);
  if (!scene && only < 0) { /* some exclude each other */
    for (uint32_t k = 0; k < row->parameter_count && row->parameter_count > 1; k++)
      check_doctor(family, row, (int)k);
    return;
  }
  if (!scene)
    return; /* it needs another parameter, beside which the first attempt had it */
  vlCheckDef def = vl_default_check_def();
  vlCheck *check = NULL;
  def.names_only = true;
  assert_int_equal(vl_scene_check(scene, &def, &check, &error), VL_OK);
  for (uint32_t i = 0; i < vl_check_count(check); i++) {
    const vlFinding *finding = vl_check_finding(check, i);
    if (finding->kind == VL_FINDING_UNUSED)
      broken(family->name, row->name, "the doctor: %s", finding->message);
  }
  vl_check_destroy(check);
  vl_scene_destroy(scene);
}

static void textures_of_parameters(void **state) {
  (void)state;
  for (size_t f = 0; f < 2; f++) {
    const Family *family = &families[f];
    const vlKindFamily *rows = vl_kind_family_find(family->name);
    for (uint32_t i = 0; i < rows->kind_count; i++)
      if (rows->rows[i]->name)
        check_doctor(family, rows->rows[i], -1);
  }
  expect_no_failures();
}

static void parameters_of_all_families(void **state) {
  (void)state;
  for (size_t f = 0; f < sizeof families / sizeof *families; f++) {
    const Family *family = &families[f];
    const vlKindFamily *rows = vl_kind_family_find(family->name);
    for (uint32_t i = 0; i < rows->kind_count; i++) {
      const vlKindRow *row = rows->rows[i];
      for (uint32_t k = 0; row->name && k < row->parameter_count; k++)
        if (row->parameters[k].name)
          check_parameter(family, row, &row->parameters[k]);
    }
  }
  print_message("scenes that glTF holds: %d; quarters compared: %d, too noisy: %d\n",
                held_by_gltf, quarters_seen, quarters_blurred);
  assert_true(held_by_gltf > 20 && quarters_seen > 10 * quarters_blurred);
  expect_no_failures();
}

#endif
