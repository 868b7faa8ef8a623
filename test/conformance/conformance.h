/* conformance/conformance.h: what the laws of all families share: scenes as text, their images,
 * a tracer that asks the world about rays of the test's own, and estimates with their standard
 * errors.
 *
 * A law goes over the rows of its family. What it must know of a kind beyond the row is the
 * kind's case, in a table that the list of kinds makes: a kind without a case does not
 * compile. */
#ifndef TEST_CONFORMANCE_CONFORMANCE_H
#define TEST_CONFORMANCE_CONFORMANCE_H

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "failing_allocator.h"
#include "unit.h"
#include "velo/edit.h"
#include "velo/export.h"
#include "velo/filter_kinds.h"
#include "velo/light.h"
#include "velo/load.h"
#include "velo/material.h"
#include "velo/render.h"
#include "velo/sampler.h"
#include "velo/schema.h"
#include "velo/shape_kinds.h"
#include "velo/texture.h"
#include "velo/trace.h"
#include "velo/tracer.h"

#define PI 3.14159265358979323846

enum { WIDTH = 12, SAMPLES = 4, PIXELS = 3 * WIDTH * WIDTH, TEXT = 8192 };

static vlContext *context;
/* Contexts of the lowest and of the best instruction set; the same where the machine has
 * one. */
static vlContext *contexts[2];
static char folder[40] = "/tmp/velo_conformance_XXXXXX";

/* ---- failures ---------------------------------------------------------------------------- */

/* Counts and prints the laws that a kind breaks, so that one run names them all. */
static int failures;

__attribute__((format(printf, 3, 4))) static void broken(const char *family, const char *kind,
                                                         const char *format, ...) {
  char text[400];
  va_list arguments;
  va_start(arguments, format);
  vsnprintf(text, sizeof text, format, arguments);
  va_end(arguments);
  print_error("%s %s: %s\n", family, kind, text);
  failures++;
}

static void expect_no_failures(void) {
  int found = failures;
  failures = 0;
  assert_int_equal(found, 0);
}

/* ---- text -------------------------------------------------------------------------------- */

/* The whole scene: each `%s` of the form stands for `"kind" parameters`. */
static void scene_text(char text[TEXT], const char *form, const char *kind,
                       const char *parameters) {
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

/* ---- images ------------------------------------------------------------------------------ */

/* Changes the first light of each scene that is loaded, while a law sets it. */
static void (*change_light)(vlLightDef *def);

/* The same of the texture "t" of its second directive. */
static void (*change_texture)(vlTextureDef *def);

/* The same of its first emission; it may add textures to the scene. */
static void (*change_emission)(vlScene *scene, vlEmissionDef *def);

static vlScene *load_text(vlContext *in, const char *text, vlError *error) {
  vlScene *scene = NULL;
  assert_int_equal(vl_scene_create(in, &scene), VL_OK);
  char name[100]; /* relative paths are relative to its folder */
  snprintf(name, sizeof name, "%s/scene.pbrt", folder);
  if (vl_scene_load_memory(scene, name, text, strlen(text), NULL, error) != VL_OK) {
    vl_scene_destroy(scene);
    return NULL;
  }
  if (change_light) {
    const vlLightId first = {1};
    vlLightDef light = *vl_scene_light(scene, first);
    change_light(&light);
    assert_int_equal(vl_scene_set_light(scene, first, &light, error), VL_OK);
  }
  if (change_texture) {
    const vlTextureId second = {2};
    vlTextureDef texture = *vl_scene_texture(scene, second);
    change_texture(&texture);
    assert_int_equal(vl_scene_set_texture(scene, second, &texture, error), VL_OK);
  }
  if (change_emission) {
    const vlEmissionId first = {1};
    vlEmissionDef emission = *vl_scene_emission(scene, first);
    change_emission(scene, &emission);
    assert_int_equal(vl_scene_set_emission(scene, first, &emission, error), VL_OK);
  }
  return scene;
}

/* Renders a scene by its settings and destroys it. previous: a world that ends as soon as the
 * scene's world is built; may be null. Null, and the reason: it cannot be rendered. */
static vlImage *render_after(vlContext *in, vlScene *scene, vlWorld *previous, vlError *error) {
  vlWorld *world = NULL;
  vlFilm *film = NULL;
  vlImage *image = NULL;
  vlCamera camera;
  vlSceneDefs *defs = vl_scene_defs(scene);
  vlResult result = vl_world_build(scene, &defs->build, &world, error);
  vl_world_destroy(previous);
  if (result == VL_OK)
    result = vl_camera_make(&defs->camera, &camera, NULL, error);
  if (result == VL_OK)
    result = vl_film_create(in, &defs->film, &film);
  const char *lack = result == VL_OK
                         ? vl_tracer_lacks(world, &camera, &defs->film, defs->render.tracer)
                         : NULL;
  if (lack)
    fail_msg("the path tracer stands in for the tracer of this scene, which lacks %s", lack);
  if (result == VL_OK)
    result = vl_render(world, &camera, film, &defs->render, NULL, error);
  if (result == VL_OK)
    result = vl_film_develop(film, NULL, &image);
  vl_film_destroy(film);
  vl_world_destroy(world);
  vl_scene_destroy(scene);
  return image;
}
static vlImage *render_scene(vlContext *in, vlScene *scene, vlError *error) {
  return render_after(in, scene, NULL, error);
}

/* The scene of a text, and the image of a scene made from it, both of which must be. */
static vlScene *need_scene(const char *text) {
  vlError error = {0};
  vlScene *scene = load_text(context, text, &error);
  if (!scene)
    fail_msg("%s\n%s", error.message, text);
  return scene;
}
/* What velo reads of the file to which it writes the scene. */
static vlScene *read_again(vlScene *scene, const char *file) {
  char path[100];
  vlError error = {0};
  vlScene *read;
  snprintf(path, sizeof path, "%s/%s", folder, file);
  assert_int_equal(vl_scene_create(context, &read), VL_OK);
  if (vl_scene_save(scene, path, NULL, &error) != VL_OK ||
      vl_scene_load(read, path, NULL, &error) != VL_OK)
    fail_msg("%s", error.message);
  return read;
}
static vlImage *need_image(vlScene *scene, const char *text) {
  vlError error = {0};
  vlImage *image = render_scene(context, scene, &error);
  if (!image)
    fail_msg("%s\n%s", error.message, text);
  return image;
}

/* Renders the text in a context. False, and the reason: it cannot be read. */
static bool render_in(vlContext *in, const char *text, float pixels[PIXELS], vlError *error) {
  vlScene *scene = load_text(in, text, error);
  if (!scene)
    return false;
  vl_scene_defs(scene)->render.spp = SAMPLES;
  vlImage *image = render_scene(in, scene, error);
  if (image)
    memcpy(pixels, vl_image_const_pixels(image), PIXELS * sizeof *pixels);
  vl_image_destroy(image);
  return image != NULL;
}
static bool render_text(const char *text, float pixels[PIXELS], vlError *error) {
  return render_in(context, text, pixels, error);
}

/* ---- estimates --------------------------------------------------------------------------- */

/* A mean with its standard error. */
typedef struct Mean {
  double sum, squares, count;
} Mean;
static void mean_add(Mean *m, double x) {
  m->sum += x;
  m->squares += x * x;
  m->count++;
}
static double mean_of(const Mean *m) {
  return m->count > 0 ? m->sum / m->count : 0;
}
static double variance_of_mean(const Mean *m) {
  double mean = mean_of(m);
  double variance = m->count > 1 ? (m->squares / m->count - mean * mean) / (m->count - 1) : 0;
  return variance > 0 ? variance : 0;
}
/* How far a law looks, in the unit of what it compares. */
typedef struct Sight {
  double slack; /* what is not exact in the comparison itself */
  double min;   /* the least mistake that must be found */
} Sight;

/* A value with its standard error against what it must be. It is broken if they differ by more
 * than 5 standard errors and the slack. The law itself is broken where it would miss the least
 * mistake in more than one of a thousand runs: 5 + 3.1 standard errors and the slack exceed it.
 */
static void check_value(const char *family, const char *kind, const char *what, double value,
                        double error, double known, Sight sight) {
  const double by_chance = 5;
  const double power = 3.1;
  if (!(fabs(value - known) <= by_chance * error + sight.slack))
    broken(family, kind, "%s: %.4f +- %.4f, not %.4f", what, value, error, known);
  if (!((by_chance + power) * error + sight.slack <= sight.min))
    broken(family, kind, "%s: %.4f +- %.4f is too noisy to find a mistake of %.4f", what, value,
           error, sight.min);
}
static void check_mean(const char *family, const char *kind, const char *what, const Mean *mean,
                       double known, Sight sight) {
  check_value(family, kind, what, mean_of(mean), sqrt(variance_of_mean(mean)), known, sight);
}
static void check_same_mean(const char *family, const char *kind, const char *what,
                            const Mean *mean, const Mean *other, Sight sight) {
  check_value(family, kind, what, mean_of(mean),
              sqrt(variance_of_mean(mean) + variance_of_mean(other)), mean_of(other), sight);
}

/* ---- asking the world -------------------------------------------------------------------- */

/* A function that asks the world through the functions of velo/trace.h. Called once for each
 * batch of 1024 paths, on one thread; `batch` counts them. */
typedef struct Probe {
  void (*ask)(struct Probe *probe, vlTrace *trace, const vlOwnPaths *paths);
  void *user;
  uint32_t batch, batches;
  bool spectral; /* in wavelengths, not in RGB */
} Probe;

static void probe_radiance(void *user, vlTrace *trace, const vlOwnPaths *paths) {
  Probe *probe = user;
  if (paths->count < VL_OWN_BATCH || probe->batch == probe->batches)
    return;
  probe->ask(probe, trace, paths);
  probe->batch++;
}

/* Builds the world of a scene, asks it `batches` times, and destroys the scene. text:
 * for messages. */
static void probe_scene(vlScene *scene, const char *text, Probe *probe, uint32_t batches) {
  vlSceneDefs *defs = vl_scene_defs(scene);
  const vlOwnTracer tracer = {.name = "probe", .radiance = probe_radiance, .user = probe};
  defs->build.color = probe->spectral ? VL_COLOR_SPECTRAL : VL_COLOR_RGB;
  defs->camera = vl_default_camera_def(32, 32);
  defs->camera.fx = defs->camera.fy = 1e6; /* rays as narrow as can be: textures are sharp */
  defs->film = vl_default_film_def(32, 32);
  defs->film.filter = vl_default_pixel_filter(VL_PIXEL_FILTER_BOX);
  /* batches of the first passes are not full, and others are not where a slow machine makes
   * passes of few samples */
  defs->render.spp = 3 * batches + 4;
  defs->render.sampler = VL_SAMPLER_INDEPENDENT;
  defs->render.share_samples = false;
  defs->render.own_tracer = &tracer;
  probe->batch = 0;
  probe->batches = batches;
  vlImage *image = need_image(scene, text);
  vl_image_destroy(image);
  assert_int_equal(probe->batch, batches);
}

static void probe_world(const char *text, Probe *probe, uint32_t batches) {
  probe_scene(need_scene(text), text, probe, batches);
}

/* The square from -1 to 1 in the plane z = 0, of two triangles. */
static vlShapeDef square_def(void) {
  static const float corners[12] = {-1, -1, 0, 1, -1, 0, 1, 1, 0, -1, 1, 0};
  static const uint32_t indices[6] = {0, 1, 2, 0, 2, 3};
  vlShapeDef square = vl_default_shape_def(VL_SHAPE_TRIANGLES);
  square.vertices = 4;
  square.faces = 2;
  square.positions = corners;
  square.indices = indices;
  return square;
}

/* Adds the square from -1 to 1 with this material, or, if it is null, with none; its texture
 * coordinates are 0 to 1, of `mirrored` squares u is 1 to 0. Its second set of coordinates is
 * the other one of these. */
static void add_square_of(vlScene *scene, const vlMaterialDef *material, bool mirrored) {
  static const float upright[8] = {0, 0, 1, 0, 1, 1, 0, 1};
  static const float turned[8] = {1, 0, 0, 0, 0, 1, 1, 1};
  vlShapeDef square = square_def();
  square.uvs = mirrored ? turned : upright;
  square.more_uvs[0] = mirrored ? upright : turned;
  if (material)
    square.material = vl_scene_add_material(scene, material);
  vl_scene_add_shape(scene, &square);
}
static void add_square(vlScene *scene, const vlMaterialDef *material) {
  add_square_of(scene, material, false);
}

static vlTraceRays *new_rays(void) {
  vlTraceRays *rays = calloc(1, sizeof *rays);
  assert_non_null(rays);
  rays->count = VL_OWN_BATCH;
  return rays;
}
static void set_ray(vlTraceRays *rays, uint32_t i, const double origin[3],
                    const double direction[3]) {
  double length = sqrt(direction[0] * direction[0] + direction[1] * direction[1] +
                       direction[2] * direction[2]);
  for (int k = 0; k < 3; k++) {
    rays->origin[k][i] = (float)origin[k];
    rays->direction[k][i] = (float)(direction[k] / length);
  }
  rays->t_min[i] = 0;
  rays->t_max[i] = INFINITY;
  rays->width[i] = 0;
}
/* Rays straight down from points at the height 1, evenly over the square from -1 to 1
 * (Roberts's sequence R2). */
static void set_rays_down(vlTraceRays *rays) {
  static const double down[3] = {0, 0, -1};
  for (uint32_t i = 0; i < VL_OWN_BATCH; i++) {
    const double origin[3] = {2 * fmod(0.5 + i * 0.7548776662466927, 1.0) - 1,
                              2 * fmod(0.5 + i * 0.5698402909980532, 1.0) - 1, 1};
    set_ray(rays, i, origin, down);
  }
}
/* A direction of a set of `count` that fills the sphere evenly (Fibonacci's spiral, turned by
 * `turn`). */
static void even_direction(uint32_t i, uint32_t count, double turn, double d[3]) {
  double z = 1 - (2 * i + 1.0) / count;
  double phi = 2 * PI * (i * 0.6180339887498949 + turn);
  double r = sqrt(1 - z * z);
  d[0] = r * cos(phi);
  d[1] = r * sin(phi);
  d[2] = z;
}

/* A camera close above the floor y = 0 that sees the square of this size around (x, z). Light
 * paths find it: it is a perspective one. All pixels see the same area. */
static void look_down(vlCameraDef *def, double x, double z, double size) {
  *def = vl_default_camera_def(WIDTH, WIDTH);
  const double height = 0.04 + 0.1 * size;
  def->fx = def->fy = WIDTH / size * height;
  def->eye[0] = def->lookat[0] = x;
  def->eye[1] = height;
  def->lookat[1] = 0;
  def->eye[2] = def->lookat[2] = z;
  def->up[0] = def->up[1] = 0;
  def->up[2] = -1;
}

/* The image of a square of the floor, `size` wide, around (x, 0, z), with the box filter, by
 * light that comes straight from the lights; in RGB unless told otherwise. */
static vlImage *image_of_floor_in(vlColorMode color, const char *text, vlTracer tracer,
                                  uint32_t spp, double x, double z, double size) {
  vlScene *scene = need_scene(text);
  vlSceneDefs *defs = vl_scene_defs(scene);
  defs->build.color = color;
  defs->film.filter = vl_default_pixel_filter(VL_PIXEL_FILTER_BOX);
  defs->render.tracer = tracer;
  defs->render.max_depth = 1;
  defs->render.spp = spp;
  look_down(&defs->camera, x, z, size);
  return need_image(scene, text);
}
static vlImage *image_of_floor(const char *text, vlTracer tracer, uint32_t spp, double x,
                               double z, double size) {
  return image_of_floor_in(VL_COLOR_RGB, text, tracer, spp, x, z, size);
}

/* The mean of a channel over the image, each pixel a number of its own. */
static Mean mean_of_channel(const vlImage *image, uint32_t channel) {
  Mean mean = {0};
  for (uint32_t y = 0; y < vl_image_height(image); y++)
    for (uint32_t x = 0; x < vl_image_width(image); x++)
      mean_add(&mean, (double)vl_image_get(image, x, y, channel));
  return mean;
}
static Mean mean_of_image(const vlImage *image) { /* of green */
  return mean_of_channel(image, 1);
}

static double mean_of_green(const vlImage *image) {
  Mean mean = mean_of_image(image);
  return mean_of(&mean);
}

/* ---- forms of scenes --------------------------------------------------------------------- */

#define HEAD                                                                                \
  "LookAt 0 1.5 4 0 .4 0 0 1 0 Camera \"perspective\" \"float fov\" 40\n"                   \
  "Film \"rgb\" \"integer xresolution\" 12 \"integer yresolution\" 12 \"string filename\" " \
  "\"x.pfm\"\n"                                                                             \
  "Sampler \"independent\" Integrator \"volpath\" \"integer maxdepth\" 6\n"
#define LIGHTS                                       \
  "LightSource \"infinite\" \"rgb L\" [.3 .35 .4]\n" \
  "LightSource \"distant\" \"point3 from\" [2 3 1.5] \"rgb L\" [2 1.9 1.7]\n"
#define NAMED                                                                           \
  "Texture \"bumps\" \"float\" \"checkerboard\" \"float uscale\" 5 \"float vscale\" 5 " \
  "\"float tex1\" .1\n"                                                                 \
  "MakeNamedMaterial \"grey\" \"string type\" \"diffuse\"\n"                            \
  "MakeNamedMaterial \"red\" \"string type\" \"diffuse\" \"rgb reflectance\" [.8 .1 .1]\n"
#define GROUND                                                                     \
  "Material \"diffuse\" Shape \"trianglemesh\" \"integer indices\" [0 1 2 2 1 3] " \
  "\"point3 P\" [-3 -.6 3 3 -.6 3 -3 -.6 -3 3 -.6 -3]\n"
#define BALL "Rotate 70 1 .3 .2 Shape \"sphere\" \"float radius\" .8\n"

#endif
