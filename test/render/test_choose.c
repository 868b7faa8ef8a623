/* test/render/test_choose.c: the choice of a tracer: by given numbers; the same for any number
 * of threads, crop and seed; no race where it would be too long; the mean of the chosen tracer
 * is that of the path tracer. */
#include "render/agreement.h"
#include "render/choose.h"
#include "velo/choose.h"
#include "velo/shape_kinds.h"
#include "velo/tracer.h"

enum { SIZE = 48 };

/* ---- given numbers ----------------------------------------------------------------------- */

typedef struct Given {
  double error[VL_MAX_TRIALS], cost[VL_MAX_TRIALS], missing[VL_MAX_TRIALS];
  double samples;
  int best; /* index of the trial */
} Given;

static void by_numbers(void **state) {
  (void)state;
  static const Given all[] = {
      {{1, 1, 1, 1}, {1, 1, 1, 1}, {0, 0, 0, 0}, 1, 0},       /* equal: the path tracer */
      {{1, 0.87, 1, 1}, {1, 1, 1, 1}, {0, 0, 0, 0}, 1, 0},    /* hardly better */
      {{1, 0.27, 0.45, 1}, {1, 3, 2, 4}, {0, 0, 0, 0}, 1, 1}, /* .81 and .9 */
      {{1, 0.3, 0.4, 1}, {1, 3, 2, 4}, {0, 0, 0, 0}, 1, 2},   /* .8 */
      {{1, 0.1, 0.3, 0.06},
       {1, 3, 2, 4},
       {0, 0, 0, 0},
       1,
       1}, /* .3 and .24: too little for a biased one */
      {{1, 0.1, 0.3, 0.04}, {1, 3, 2, 4}, {0, 0, 0, 0}, 1, 3}, /* .3 and .16 */
      {{0.01, 0.1, 0.1, 1},
       {1, 3, 2, 3},
       {0.5, 0, 0, 0},
       1,
       2}, /* the path tracer misses light */
      {{0.01, 0.1, 0.1, 1},
       {1, 3, 2, 3},
       {0.5, 0.2, 0.2, 0},
       100,
       3}, /* all unbiased ones do */
      {{0.01, 0.1, 0.1, 1},
       {1, 3, 2, 3},
       {0.5, 0.2, 0.2, 0},
       1,
       2},                                              /* the same with few samples */
      {{0, 0, 0, 0}, {1, 3, 2, 3}, {0, 0, 0, 0}, 1, 0}, /* a black image: 0 / 0 */
      {{1, NAN, NAN, 1}, {1, 1, 1, 1}, {0, 0, 0, 0}, 1, 0},
      {{NAN, 1, 1, 1}, {1, 1, 1, 1}, {0, 0, 0, 0}, 1, 0},
      {{INFINITY, 1, 1, 1}, {1, 1, 1, 1}, {0, 0, 0, 0}, 1, 1},
  };
  static const vlTracer tracers[VL_MAX_TRIALS] = {VL_TRACER_VOLPATH, VL_TRACER_BIDIRECTIONAL,
                                                  VL_TRACER_BIDIRECTIONAL, VL_TRACER_MERGING};
  for (size_t k = 0; k < sizeof all / sizeof *all; k++) {
    vlTracerChoice choice = {.count = VL_MAX_TRIALS};
    for (uint32_t i = 0; i < VL_MAX_TRIALS; i++)
      choice.trials[i] = (vlTracerTrial){.tracer = tracers[i],
                                         .light_paths = 100 + i,
                                         .error = all[k].error[i],
                                         .missing = all[k].missing[i],
                                         .cost = all[k].cost[i]};
    vl_choose_by_work(&choice, all[k].samples);
    if (choice.light_paths != 100 + (uint32_t)all[k].best)
      fail_msg("line %zu: trial %u is chosen", k, choice.light_paths - 100);
    assert_int_equal(choice.tracer, tracers[all[k].best]);
  }
}

/* ---- a room ------------------------------------------------------------------------------ */

/* A closed room, with a lamp in a tube that is open above. */
static Stage room(vlContext *context) {
  Stage s = stage_open_in(context, SIZE, SIZE);
  s.camera.fov = 1.2;
  s.render.max_depth = 4;
  s.render.spp = 512;
  vlMaterialId white = add_diffuse(&s, 0.7f, 0.6f, 0.5f),
               dark = add_diffuse(&s, 0.3f, 0.2f, 0.1f);
  for (int axis = 0; axis < 3; axis++)
    for (int side = -1; side <= 1; side += 2) {
      float at[3] = {0, 0, -2}, u[3] = {0}, v[3] = {0};
      at[axis] += 2.5f * (float)side;
      u[(axis + 1) % 3] = 2.5f;
      v[(axis + 2) % 3] = 2.5f;
      Quad q = quad_at(at[0], at[1], at[2], u[0], u[1], u[2], v[0], v[1], v[2]);
      q.material = white;
      add_quad(&s, &q);
    }
  vlShapeDef tube = vl_default_shape_def(VL_SHAPE_CYLINDER);
  tube.radius = 0.35f;
  tube.z_min = 0;
  tube.z_max = 0.5f;
  set_matrix(tube.group_from_shape, 1, 0, 0, 0.4, 0, 0, 1, 0.2, 0, -1, 0, -3); /* z up */
  tube.material = dark;
  assert_int_not_equal(vl_scene_add_shape(s.scene, &tube).index, 0);
  vlShapeDef lamp = vl_default_shape_def(VL_SHAPE_SPHERE);
  set_matrix(lamp.group_from_shape, 1, 0, 0, 0.4, 0, 1, 0, 0.4, 0, 0, 1, -3);
  lamp.radius = 0.15f;
  lamp.z_min = -0.15f;
  lamp.z_max = 0.15f;
  lamp.material = dark;
  lamp.emission = add_emission(&s, 40, false);
  assert_int_not_equal(vl_scene_add_shape(s.scene, &lamp).index, 0);
  return s;
}

/* A triangle behind the camera that rays pass through from one side. */
static void add_one_sided(Stage *s) {
  static const float positions[9] = {0, 0, 3, 1, 0, 3, 0, 1, 3};
  static const uint32_t indices[3] = {0, 1, 2};
  vlShapeDef sheet = vl_default_shape_def(VL_SHAPE_TRIANGLES);
  sheet.positions = positions;
  sheet.vertices = 3;
  sheet.indices = indices;
  sheet.faces = 1;
  sheet.one_sided = true;
  assert_int_not_equal(vl_scene_add_shape(s->scene, &sheet).index, 0);
}

typedef struct How {
  uint32_t threads, crop, seed, first, spp;
  bool one_sided;
} How;

static vlTracerChoice choice_of(How how) {
  vlContextDef def = vl_default_context_def();
  def.threads = how.threads;
  vlContext *context;
  assert_int_equal(vl_context_create(&def, &context), VL_OK);
  Stage s = room(context);
  if (how.one_sided)
    add_one_sided(&s);
  vlWorld *world = NULL;
  vlCamera camera;
  vlError error = {0};
  vlTracerChoice choice;
  assert_int_equal(vl_world_build(s.scene, &s.build, &world, &error), VL_OK);
  assert_int_equal(vl_camera_make(&s.camera, &camera, NULL, &error), VL_OK);
  if (how.crop)
    s.film.crop[0] = s.film.crop[1] = how.crop;
  if (how.spp)
    s.render.spp = how.spp;
  s.render.seed = how.seed;
  s.render.first_sample = how.first;
  assert_int_equal(vl_choose_tracer(world, &camera, &s.film, &s.render, true, &choice, &error),
                   VL_OK);
  vl_world_destroy(world);
  vl_scene_destroy(s.scene);
  vl_context_destroy(context);
  return choice;
}

static void the_same_choice(void **state) {
  (void)state;
  vlTracerChoice one = choice_of((How){.threads = 1});
  assert_int_equal(one.tracer, VL_TRACER_BIDIRECTIONAL);
  assert_int_equal(one.count, 3);         /* nothing smooth: no merging */
  assert_true(one.trials[1].work < 0.75); /* far from a tie */
  static const How others[] = {
      {.threads = 3}, {.threads = 1, .crop = 40}, {.threads = 2, .seed = 7, .first = 100}};
  for (size_t k = 0; k < sizeof others / sizeof *others; k++) {
    vlTracerChoice other = choice_of(others[k]);
    assert_memory_equal(&one, &other, sizeof one);
  }
}

static void too_short(void **state) {
  (void)state;
  vlTracerChoice choice = choice_of((How){.threads = 1, .spp = 16});
  assert_int_equal(choice.count, 0);
  assert_int_equal(choice.tracer, VL_TRACER_VOLPATH);
}

static Image with_sheet(vlTracer tracer) {
  Stage s = room(NULL);
  add_one_sided(&s);
  s.render.spp = 4;
  s.render.tracer = tracer;
  return stage_finish(&s);
}

/* Light paths would meet the other side of what camera paths meet: volpath renders such
 * worlds. */
static void one_sided_surfaces(void **state) {
  (void)state;
  vlTracerChoice choice = choice_of((How){.threads = 1, .one_sided = true});
  assert_true(choice.count == 0 && choice.tracer == VL_TRACER_VOLPATH);
  Image path = with_sheet(VL_TRACER_VOLPATH);
  static const vlTracer others[] = {VL_TRACER_BIDIRECTIONAL, VL_TRACER_LIGHT_PATH,
                                    VL_TRACER_MERGING, VL_TRACER_SPPM};
  for (size_t k = 0; k < sizeof others / sizeof *others; k++) {
    Image other = with_sheet(others[k]);
    assert_memory_equal(path.rgba, other.rgba,
                        (size_t)path.width * path.height * 4 * sizeof(float));
    image_free(&other);
  }
  image_free(&path);
}

static Stage chosen(const void *user, vlTracer tracer) {
  const vlTracerChoice *choice = user;
  Stage s = room(NULL);
  s.render.spp = tracer == VL_TRACER_VOLPATH ? 64 : 16;
  if (tracer == choice->tracer)
    s.render.light_paths = choice->light_paths;
  return s;
}

static void the_same_mean(void **state) {
  (void)state;
  vlTracerChoice choice = choice_of((How){.threads = 1});
  Measure path = measure(chosen, &choice, VL_TRACER_VOLPATH),
          best = measure(chosen, &choice, choice.tracer);
  assert_agree("room", "chosen", &best, &path, 0.002);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(by_numbers), cmocka_unit_test(the_same_choice),
      cmocka_unit_test(too_short), cmocka_unit_test(the_same_mean),
      cmocka_unit_test(one_sided_surfaces)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
