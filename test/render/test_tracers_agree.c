/* test_tracers_agree.c: a table of features by tracers. Every tracer with light paths renders a
 * room with the feature and must have volpath's mean, in the whole image and in each of its
 * quarters; or vl_tracer_lacks names the feature, and then the image has volpath's bits and the
 * race of the tracers leaves it out.
 *
 * Each tracer has SEEDS images. The standard error of a mean of the whole image is below POWER
 * of it, which is checked, except in rows that are `weak`. A difference of 11 POWER (9 %) is
 * then at least 7.8 standard errors, of which 5 are allowed, and is found with a probability of
 * 0.99. In most rows the standard error is a third of that, and 3 % are found. Seeds are
 * fixed. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "unit.h"
#include "velo/choose.h"
#include "velo/edit.h"
#include "velo/load.h"
#include "velo/tracer.h"

enum { SIZE = 12, SEEDS = 12, SAMPLES = 16, PARTS = 5, CHANNELS = 3 };
static const double POWER = 0.008, BLUR = 0.01; /* BLUR: of merging */

typedef struct Row {
  const char *name;
  const char *lacking; /* what vl_tracer_lacks says; null: all tracers render it */
  const char *head;    /* statements before WorldBegin; null: CAMERA */
  const char *world;
  bool smooth; /* a smooth surface, which lightpath does not see */
  bool unseen; /* a camera or light that light paths do not find: vl_tracer_lacks names it for
                  lightpath */
  bool weak;   /* so much noise that POWER is not reached */
  bool passes; /* the last shape, an interface, emits, which pbrt files cannot say */
} Row;

#define CAMERA "LookAt 0 -.9 1  0 1 .8  0 0 1 Camera \"perspective\" \"float fov\" 80 "
#define QUAD(P) "Shape \"bilinearmesh\" \"point3 P\" [" P "] "
#define FLOOR QUAD("-1 -1 0 1 -1 0 -1 1 0 1 1 0")
#define GREY "Material \"diffuse\" \"rgb reflectance\" [.6 .5 .4] "
/* The panel of light hangs below the ceiling. Its back is dark. */
#define PANEL                                                                      \
  "AttributeBegin Material \"diffuse\" \"rgb reflectance\" [0 0 0] "               \
  "AreaLightSource \"diffuse\" \"rgb L\" [6 5 4] "                                 \
  "Shape \"bilinearmesh\" \"point3 P\" [-.4 0 1.8 -.4 .6 1.8 .4 0 1.8 .4 .6 1.8] " \
  "AttributeEnd "
#define WALLS                                                                      \
  GREY FLOOR QUAD("-1 -1 2 1 -1 2 -1 1 2 1 1 2") QUAD("-1 1 0 1 1 0 -1 1 2 1 1 2") \
      QUAD("-1 -1 0 -1 1 0 -1 -1 2 -1 1 2") QUAD("1 -1 0 1 1 0 1 -1 2 1 1 2")      \
          QUAD("-1 -1 0 1 -1 0 -1 -1 2 1 -1 2")
#define ROOM WALLS PANEL
#define BALL \
  "AttributeBegin Translate 0 .3 .45 Shape \"sphere\" \"float radius\" .4 AttributeEnd "

static const Row rows[] = {
#include "render/agreeing.h"
};

/* ---- rendering --------------------------------------------------------------------------- */

typedef struct Scene {
  vlContext *context;
  vlWorld *world;
  vlCamera camera;
  vlSceneDefs defs;
} Scene;

/* The last shape, an interface, gets the last emission. */
static void let_light_pass(vlScene *scene) {
  vlError error = {0};
  const vlShapeId shape = {vl_scene_highest(scene, VL_SCENE_SHAPES)};
  const vlEmissionId emission = {vl_scene_highest(scene, VL_SCENE_EMISSIONS)};
  if (vl_scene_set_shape_emission(scene, shape, emission, &error) != VL_OK)
    fail_msg("%s", error.message);
}

static Scene open_scene(const Row *row) {
  Scene s = {.context = NULL};
  vlContextDef def = vl_default_context_def();
  def.threads = 2;
  assert_int_equal(vl_context_create(&def, &s.context), VL_OK);
  vlScene *scene = NULL;
  assert_int_equal(vl_scene_create(s.context, &scene), VL_OK);
  static char text[20000];
  int n = snprintf(
      text, sizeof text,
      "Film \"rgb\" \"integer xresolution\" %d \"integer yresolution\" %d PixelFilter \"box\" "
      "Integrator \"volpath\" \"integer maxdepth\" 4\n%s\nWorldBegin\n%s\n",
      SIZE, SIZE, row->head ? row->head : CAMERA, row->world);
  assert_true(n > 0 && (size_t)n < sizeof text);
  vlError error = {0};
  if (vl_scene_load_memory(scene, row->name, text, (size_t)n, NULL, &error) != VL_OK)
    fail_msg("%s: %s", row->name, error.message);
  if (row->passes)
    let_light_pass(scene);
  s.defs = *vl_scene_defs(scene);
  if (vl_world_build(scene, &s.defs.build, &s.world, &error) != VL_OK)
    fail_msg("%s: %s", row->name, error.message);
  if (vl_camera_make(&s.defs.camera, &s.camera, NULL, &error) != VL_OK)
    fail_msg("%s: %s", row->name, error.message);
  vl_scene_destroy(scene);
  return s;
}

static void close_scene(Scene *s) {
  vl_world_destroy(s->world);
  vl_context_destroy(s->context);
}

static vlImage *render(const Scene *s, vlTracer tracer, uint32_t spp, uint32_t seed) {
  vlFilm *film = NULL;
  vlImage *image = NULL;
  vlError error = {0};
  vlRenderDef def = s->defs.render;
  def.tracer = tracer;
  def.spp = spp;
  def.seed = seed;
  def.merge_radius = 0.04;
  assert_int_equal(vl_film_create(s->context, &s->defs.film, &film), VL_OK);
  if (vl_render(s->world, &s->camera, film, &def, NULL, &error) != VL_OK)
    fail_msg("%s", error.message);
  assert_int_equal(vl_film_develop(film, NULL, &image), VL_OK);
  vl_film_destroy(film);
  return image;
}

/* ---- comparing --------------------------------------------------------------------------- */

typedef struct Means {
  /* the image's quarters, then the whole of it */
  double mean[PARTS][CHANNELS], error[PARTS][CHANNELS];
} Means;

static void add_means(const vlImage *image, Means *m) {
  uint32_t width = vl_image_width(image), height = vl_image_height(image);
  for (uint32_t c = 0; c < CHANNELS; c++) {
    double sum[PARTS] = {0};
    for (uint32_t y = 0; y < height; y++)
      for (uint32_t x = 0; x < width; x++) {
        double value = (double)vl_image_get(image, x, y, c);
        sum[2 * (2 * y / height) + 2 * x / width] += 4 * value;
        sum[PARTS - 1] += value;
      }
    for (int k = 0; k < PARTS; k++) {
      double mean = sum[k] / (width * height);
      m->mean[k][c] += mean / SEEDS;
      m->error[k][c] += mean * mean / SEEDS;
    }
  }
}

static Means means_of(const Scene *s, vlTracer tracer) {
  Means m = {{{0}}, {{0}}};
  for (uint32_t seed = 1; seed <= SEEDS; seed++) {
    vlImage *image = render(s, tracer, SAMPLES, seed + 100 * (uint32_t)tracer);
    add_means(image, &m);
    vl_image_destroy(image);
  }
  for (int k = 0; k < PARTS; k++)
    for (int c = 0; c < CHANNELS; c++)
      m.error[k][c] = sqrt(fmax(0, m.error[k][c] - m.mean[k][c] * m.mean[k][c]) / (SEEDS - 1));
  return m;
}

/* Prints what differs. Returns the number of differences. */
static int differences(const char *what, const char *how, const Means *a, const Means *b,
                       double blur, bool power) {
  int found = 0;
  for (int k = 0; k < PARTS; k++)
    for (int c = 0; c < CHANNELS; c++) {
      double x = a->mean[k][c], y = b->mean[k][c],
             error = hypot(a->error[k][c], b->error[k][c]);
      bool weak =
          power && k == PARTS - 1 && !(fmax(a->error[k][c], b->error[k][c]) < POWER * y);
      if (fabs(x - y) <= 5 * error + blur * y && !weak)
        continue;
      found++;
      print_error(
          "%s, %s, part %d, channel %d: %.5f (%.5f), volpath %.5f (%.5f): %.4f, %.1f standard "
          "errors%s\n",
          what, how, k, c, x, a->error[k][c], y, b->error[k][c], x / y, (x - y) / error,
          weak ? ": no power" : "");
    }
  return found;
}

static const vlTracer tracers[] = {VL_TRACER_BIDIRECTIONAL, VL_TRACER_LIGHT_PATH,
                                   VL_TRACER_MERGING};
static const char *const names[] = {"bidirectional", "lightpath", "merging"};

static void all_features(void **state) {
  (void)state;
  int found = 0;
  for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
    Scene s = open_scene(&rows[i]);
    Means path = {{{0}}, {{0}}};
    if (!rows[i].lacking)
      path = means_of(&s, VL_TRACER_VOLPATH);
    for (size_t k = 0; k < sizeof tracers / sizeof *tracers; k++) {
      const char *lack = vl_tracer_lacks(s.world, &s.camera, &s.defs.film, tracers[k]);
      if (rows[i].lacking) {
        if (!lack || strcmp(lack, rows[i].lacking) != 0)
          fail_msg("%s: lacks %s", rows[i].name, lack ? lack : "nothing");
        continue;
      }
      bool light_only = tracers[k] == VL_TRACER_LIGHT_PATH;
      if ((lack != NULL) != (rows[i].unseen && light_only))
        fail_msg("%s, %s: lacks %s", rows[i].name, names[k], lack ? lack : "nothing");
      if ((rows[i].smooth || rows[i].unseen) && light_only)
        continue;
      Means m = means_of(&s, tracers[k]);
      found += differences(rows[i].name, names[k], &m, &path,
                           tracers[k] == VL_TRACER_MERGING ? BLUR : 0, !rows[i].weak);
    }
    close_scene(&s);
  }
  if (found)
    fail_msg("%d differences", found);
}

/* Where a tracer lacks something, the image has volpath's bits, and there is no race. */
static void replaced(void **state) {
  (void)state;
  for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
    if (!rows[i].lacking)
      continue;
    Scene s = open_scene(&rows[i]);
    vlImage *path = render(&s, VL_TRACER_VOLPATH, 2, 1);
    for (size_t k = 0; k < sizeof tracers / sizeof *tracers; k++) {
      vlImage *image = render(&s, tracers[k], 2, 1);
      for (uint32_t c = 0; c < CHANNELS; c++)
        for (uint32_t p = 0; p < SIZE * SIZE; p++)
          if (vl_image_get(image, p % SIZE, p / SIZE, c) !=
              vl_image_get(path, p % SIZE, p / SIZE, c))
            fail_msg("%s, %s: not volpath's bits", rows[i].name, names[k]);
      vl_image_destroy(image);
    }
    vl_image_destroy(path);
    vlTracerChoice choice;
    vlFilmDef film = s.defs.film;
    vlRenderDef def = s.defs.render;
    def.spp = 1 << 16;
    assert_int_equal(vl_choose_tracer(s.world, &s.camera, &film, &def, true, &choice, NULL),
                     VL_OK);
    if (choice.count || choice.tracer != VL_TRACER_VOLPATH)
      fail_msg("%s: has a race", rows[i].name);
    close_scene(&s);
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(all_features),
                                     cmocka_unit_test(replaced)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
