/* test/render/test_cast.c: rays of the caller (velo/rays.h) in C: arrays of any step and type,
 * Embree and velo's own tree alike, wrong arguments, statistics, and calls that end early.
 * test/python/test_rays.py compares the hits with formulas. */
#include "render/shots.h"

#include "api/small_world.h"
#include "failing_allocator.h"
#include "velo/rays.h"

enum { COUNT = 3000 };

typedef struct Work {
  vlScene *scene;
  vlWorld *world;
} Work;

static vlResult open_work(vlContext *context, vlAccelerator accelerator, Work *w) {
  vlError error;
  memset(w, 0, sizeof *w);
  vlBuildDef build = vl_default_build_def();
  build.accelerator = accelerator;
  vlResult r = vl_scene_create(context, &w->scene);
  if (r != VL_OK)
    return r;
  small_scene(w->scene);
  r = vl_scene_result(w->scene, &error);
  return r == VL_OK ? vl_world_build(w->scene, &build, &w->world, &error) : r;
}

static void close_work(Work *w) {
  vl_world_destroy(w->world);
  vl_scene_destroy(w->scene);
}

static vlContext *new_context(uint32_t threads) {
  vlContext *context = NULL;
  vlContextDef def = vl_default_context_def();
  def.threads = threads;
  assert_int_equal(vl_context_create(&def, &context), VL_OK);
  return context;
}

/* Rows of origin and direction, towards the objects of small_world.h. */
static void fill(double rows[COUNT][6]) {
  uint32_t seed = 5;
  for (int i = 0; i < COUNT; i++)
    for (int k = 0; k < 6; k++) {
      seed = seed * 1664525u + 1013904223u;
      double u = (seed >> 8) * 0x1p-24;
      rows[i][k] = k < 3 ? 4 * u - 2 + (k == 1 ? 3 : 0) : 2 * u - 1 - (k == 4 ? 0.7 : 0);
    }
}

static vlCastRays rays_of(double rows[COUNT][6]) {
  return (vlCastRays){.count = COUNT,
                      .origins = {rows, sizeof *rows, true},
                      .directions = {&rows[0][3], sizeof *rows, true}};
}

/* The results of both accelerators, and of rays in reverse order, are the same. */
static void the_same_hits(void **state) {
  (void)state;
  static double rows[COUNT][6], t[3][2 * COUNT];
  static uint32_t object[3][2 * COUNT], primitive[3][2 * COUNT];
  static float normal[3][6 * COUNT];
  static uint8_t blocked[3][COUNT];
  vlContext *context = new_context(2);
  fill(rows);
  for (int k = 0; k < 3; k++) {
    Work w;
    vlError error;
    vlCastStats stats, other;
    assert_int_equal(open_work(context, k == 1 ? VL_ACCELERATOR_BVH : VL_ACCELERATOR_AUTO, &w),
                     VL_OK);
    vlCastRays rays = rays_of(rows);
    if (k == 2) {
      rays.origins = (vlRayArray){rows[COUNT - 1], -(int64_t)sizeof *rows, true};
      rays.directions = (vlRayArray){&rows[COUNT - 1][3], -(int64_t)sizeof *rows, true};
    }
    vlCastDef def = vl_default_cast_def();
    def.hits = 2;
    vlCastHits hits = {
        .t = t[k], .object = object[k], .primitive = primitive[k], .normal = normal[k]};
    assert_int_equal(vl_world_cast(w.world, &rays, &def, &hits, &stats, &error), VL_OK);
    assert_int_equal(vl_world_cast_occluded(w.world, &rays, &def, blocked[k], &other, &error),
                     VL_OK);
    assert_int_equal(stats.rays, COUNT);
    assert_true(stats.met > COUNT / 2 && stats.met < COUNT && stats.met == other.met);
    close_work(&w);
  }
  assert_memory_equal(t[0], t[1], sizeof t[0]);
  assert_memory_equal(object[0], object[1], sizeof object[0]);
  assert_memory_equal(primitive[0], primitive[1], sizeof primitive[0]);
  assert_memory_equal(normal[0], normal[1], sizeof normal[0]);
  assert_memory_equal(blocked[0], blocked[1], sizeof blocked[0]);
  for (size_t i = 0; i < COUNT; i++) {
    assert_memory_equal(&t[0][2 * i], &t[2][2 * (COUNT - 1 - i)], 2 * sizeof(double));
    assert_int_equal(blocked[0][i], t[0][2 * i] < (double)INFINITY);
    assert_true(t[0][2 * i] <= t[0][2 * i + 1]);
    assert_int_equal(object[0][2 * i] != 0, blocked[0][i]);
    const float *n = &normal[0][6 * i];
    if (blocked[0][i])
      assert_true(fabsf(n[0] * n[0] + n[1] * n[1] + n[2] * n[2] - 1) < 1e-5f);
  }
  vl_context_destroy(context);
}

static void refused(const vlWorld *world, const vlCastRays *rays, const vlCastDef *def,
                    const char *text) {
  vlError error = {0};
  double t[8];
  vlCastHits hits = {.t = t};
  assert_int_equal(vl_world_cast(world, rays, def, &hits, NULL, &error), VL_ERROR_ARGUMENT);
  if (!strstr(error.message, text))
    fail_msg("%s is not in: %s", text, error.message);
}

static void wrong_arguments(void **state) {
  (void)state;
  static double rows[COUNT][6];
  vlContext *context = new_context(1);
  Work w;
  fill(rows);
  assert_int_equal(open_work(context, VL_ACCELERATOR_AUTO, &w), VL_OK);
  vlCastRays rays = rays_of(rows), none = {0};
  vlCastDef def = vl_default_cast_def(), empty = {0};
  rays.count = 1;
  refused(NULL, &rays, &def, "null");
  refused(w.world, NULL, &def, "null");
  refused(w.world, &rays, NULL, "null");
  refused(w.world, &rays, &empty, "cookie");
  def.hits = 0;
  refused(w.world, &rays, &def, "1 to 256");
  def.hits = VL_MAX_CAST_HITS + 1;
  refused(w.world, &rays, &def, "257");
  def.hits = 1;
  rays.directions.data = NULL;
  refused(w.world, &rays, &def, "directions");
  rays = rays_of(rows);
  rays.count = UINT64_MAX;
  refused(w.world, &rays, &def, "too many");
  vlError error;
  assert_int_equal(vl_world_cast(w.world, &rays, &def, NULL, NULL, &error), VL_ERROR_ARGUMENT);
  rays.count = 1;
  assert_int_equal(vl_world_cast_occluded(w.world, &rays, &def, NULL, NULL, NULL),
                   VL_ERROR_ARGUMENT);
  vlCastHits nothing = {0};
  vlCastStats stats;
  assert_int_equal(vl_world_cast(w.world, &none, &def, &nothing, &stats, NULL), VL_OK);
  assert_int_equal(stats.rays + stats.met, 0);
  assert_int_equal(vl_world_cast(w.world, &rays, &def, &nothing, &stats, NULL), VL_OK);
  close_work(&w);
  vl_context_destroy(context);
}

/* Floats that are not aligned, one origin for all rays, and rays that are none. */
static void statistics(void **state) {
  (void)state;
  float direction[5][3] = {{0, -1, 0}, {0, 0, 0}, {0, NAN, 0}, {0, INFINITY, 0}, {0, -3, 0}};
  char bytes[sizeof direction + 1];
  double origin[3] = {3, 2, 0}, t[5], distance[5], position[5][3];
  uint8_t valid[5];
  memcpy(bytes + 1, direction, sizeof direction);
  vlContext *context = new_context(1);
  Work w;
  vlCastStats stats;
  assert_int_equal(open_work(context, VL_ACCELERATOR_AUTO, &w), VL_OK);
  vlCastRays rays = {.count = 5,
                     .origins = {origin, 0, true},
                     .directions = {bytes + 1, 3 * sizeof(float), false}};
  vlCastDef def = vl_default_cast_def();
  vlCastHits hits = {.valid = valid, .t = t, .distance = distance, .position = &position[0][0]};
  assert_int_equal(vl_world_cast(w.world, &rays, &def, &hits, &stats, NULL), VL_OK);
  assert_int_equal(stats.met, 2);
  assert_int_equal(stats.not_finite, 2);
  assert_int_equal(stats.zero_directions, 1);
  for (int i = 0; i < 5; i++) {
    assert_int_equal(valid[i], i == 0 || i == 4);
    assert_true(valid[i] || (isinf(t[i]) && isinf(distance[i]) && position[i][1] == 0));
  }
  assert_true(t[0] == 2 && fabs(t[4] * 3 - 2) < 1e-15);
  assert_true(distance[0] == 2 && distance[4] == 2);
  assert_true(position[4][0] == 3 && position[4][1] == 0 && position[4][2] == 0);
  origin[0] = -1e19;
  assert_int_equal(vl_world_cast(w.world, &rays, &def, &hits, &stats, NULL), VL_OK);
  assert_int_equal(stats.too_far, 2);
  assert_int_equal(stats.met, 0);
  close_work(&w);
  vl_context_destroy(context);
}

static void cancelled(void **state) {
  (void)state;
  static double rows[COUNT][6], t[COUNT];
  vlContext *context = new_context(2);
  Work w;
  fill(rows);
  assert_int_equal(open_work(context, VL_ACCELERATOR_AUTO, &w), VL_OK);
  vlCancel *cancel;
  assert_int_equal(vl_cancel_create(context, &cancel), VL_OK);
  vl_cancel_request(cancel);
  vlCastRays rays = rays_of(rows);
  vlCastDef def = vl_default_cast_def();
  def.cancel = cancel;
  vlCastHits hits = {.t = t};
  vlError error;
  assert_int_equal(vl_world_cast(w.world, &rays, &def, &hits, NULL, &error), VL_CANCELLED);
  vl_cancel_clear(cancel);
  assert_int_equal(vl_world_cast(w.world, &rays, &def, &hits, NULL, &error), VL_OK);
  vl_cancel_destroy(cancel);
  close_work(&w);
  vl_context_destroy(context);
}

static vlResult cast_once(vlContext *context, void *user) {
  static double rows[COUNT][6], t[COUNT];
  static float shading[3 * COUNT];
  (void)user;
  Work w;
  fill(rows);
  vlResult r = open_work(context, VL_ACCELERATOR_BVH, &w);
  vlCastRays rays = rays_of(rows);
  vlCastDef def = vl_default_cast_def();
  vlCastHits hits = {.t = t, .shading_normal = shading};
  if (r == VL_OK)
    r = vl_world_cast(w.world, &rays, &def, &hits, NULL, NULL);
  close_work(&w);
  return r;
}

static void without_memory(void **state) {
  (void)state;
  fail_everywhere(cast_once, NULL, 1);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(the_same_hits),  cmocka_unit_test(wrong_arguments),
      cmocka_unit_test(statistics),     cmocka_unit_test(cancelled),
      cmocka_unit_test(without_memory),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
