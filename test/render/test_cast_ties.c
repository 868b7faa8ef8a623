/* test/render/test_cast_ties.c: rays of the caller where several surfaces lie at the same
 * distance: what they meet does not depend on whether they are traced as packets (similar
 * neighbours), one by one, or in velo's own tree. */
#include "render/shots.h"

#include "api/small_world.h"
#include "velo/rays.h"

enum { SIDE = 48, CELLS = 12, COUNT = SIDE * SIDE, HITS = 3 };

typedef struct Answer {
  double t[HITS * COUNT];
  uint32_t object[HITS * COUNT], instance[HITS * COUNT], primitive[HITS * COUNT];
} Answer;

/* A square of 2 CELLS^2 triangles, from -1 to 1, at height y; so flat that neighbours and
 * copies of it are met at the same distance. */
static void add_square(vlScene *scene, vlGroupId group, float y) {
  static float positions[3 * (CELLS + 1) * (CELLS + 1)];
  static uint32_t indices[6 * CELLS * CELLS];
  for (uint32_t j = 0; j <= CELLS; j++)
    for (uint32_t i = 0; i <= CELLS; i++) {
      float *p = positions + 3 * (j * (CELLS + 1) + i);
      p[0] = 2.0f * (float)i / CELLS - 1.0f;
      p[1] = y;
      p[2] = 2.0f * (float)j / CELLS - 1.0f;
    }
  for (uint32_t j = 0; j < CELLS; j++)
    for (uint32_t i = 0; i < CELLS; i++) {
      uint32_t k = j * (CELLS + 1) + i;
      const uint32_t quad[6] = {k, k + 1, k + CELLS + 1, k + 1, k + CELLS + 2, k + CELLS + 1};
      memcpy(indices + 6 * (j * CELLS + i), quad, sizeof quad);
    }
  vlShapeDef def = vl_default_shape_def(VL_SHAPE_TRIANGLES);
  def.positions = positions;
  def.vertices = (CELLS + 1) * (CELLS + 1);
  def.indices = indices;
  def.faces = 2 * CELLS * CELLS;
  def.group = group;
  vl_scene_add_shape(scene, &def);
}

/* Squares upon each other, outside of instances and in them, and spheres in them. */
static vlWorld *new_world(vlContext *context, vlAccelerator accelerator, bool instances) {
  vlScene *scene;
  vlWorld *world = NULL;
  vlError error;
  assert_int_equal(vl_scene_create(context, &scene), VL_OK);
  add_square(scene, (vlGroupId){0}, 0);
  add_square(scene, (vlGroupId){0}, 0);
  for (int i = 0; i < 2; i++) {
    vlShapeDef ball = vl_default_shape_def(VL_SHAPE_SPHERE);
    ball.radius = 0.3f;
    ball.z_min = -0.3f;
    ball.z_max = 0.3f;
    vl_scene_add_shape(scene, &ball);
  }
  vlGroupId group = vl_scene_add_group(scene, "square");
  add_square(scene, group, 0);
  for (int i = 0; i < 3 && instances; i++) {
    double place[16];
    small_place(place, i == 2 ? 0.5 : 0, 0, 0);
    vl_scene_add_instance(scene, group, place, (vlSource){0});
  }
  vlBuildDef build = vl_default_build_def();
  build.accelerator = accelerator;
  assert_int_equal(vl_scene_result(scene, &error), VL_OK);
  assert_int_equal(vl_world_build(scene, &build, &world, &error), VL_OK);
  vl_scene_destroy(scene);
  return world;
}

/* Those of a camera above, none through an edge: there the accelerators themselves may differ.
 * apart: in an order in which neighbours are far from each other. */
static void fill(double rows[COUNT][6], bool apart) {
  for (uint32_t i = 0; i < COUNT; i++) {
    uint32_t k = apart ? i * 1025u % COUNT : i;
    const double row[6] = {0,  2,
                           0,  2.4 * (k % SIDE + 0.37) / SIDE - 1.2,
                           -2, 2.4 * (k / SIDE + 0.61) / SIDE - 1.2};
    memcpy(rows[i], row, sizeof row);
  }
}

static void cast(const vlWorld *world, bool apart, Answer *answer) {
  static double rows[COUNT][6];
  static Answer found;
  vlError error;
  fill(rows, apart);
  vlCastRays rays = {.count = COUNT,
                     .origins = {rows, sizeof *rows, true},
                     .directions = {&rows[0][3], sizeof *rows, true}};
  vlCastDef def = vl_default_cast_def();
  def.hits = HITS;
  vlCastHits hits = {.t = found.t,
                     .object = found.object,
                     .instance = found.instance,
                     .primitive = found.primitive};
  assert_int_equal(vl_world_cast(world, &rays, &def, &hits, NULL, &error), VL_OK);
  for (uint32_t i = 0; i < COUNT; i++) {
    uint32_t k = apart ? i * 1025u % COUNT : i;
    for (uint32_t h = 0; h < HITS; h++) {
      answer->t[HITS * k + h] = found.t[HITS * i + h];
      answer->object[HITS * k + h] = found.object[HITS * i + h];
      answer->instance[HITS * k + h] = found.instance[HITS * i + h];
      answer->primitive[HITS * k + h] = found.primitive[HITS * i + h];
    }
  }
}

static void check(bool instances) {
  static Answer answers[3];
  vlContext *context = NULL;
  vlContextDef def = vl_default_context_def();
  def.threads = 1;
  assert_int_equal(vl_context_create(&def, &context), VL_OK);
  for (int k = 0; k < 3; k++) {
    vlAccelerator kind = k == 2 ? VL_ACCELERATOR_BVH : VL_ACCELERATOR_AUTO;
    vlWorld *world = new_world(context, kind, instances);
    cast(world, k == 1, &answers[k]);
    vl_world_destroy(world);
  }
  uint32_t met = 0, ties = 0;
  for (uint32_t i = 0; i < COUNT; i++) {
    met += answers[0].object[HITS * i] != 0;
    ties += answers[0].primitive[HITS * i] > 1;
  }
  assert_true(met > COUNT / 2 && ties > COUNT / 4);
  for (int k = 1; k < 3; k++)
    assert_memory_equal(&answers[0], &answers[k], sizeof answers[0]);
  vl_context_destroy(context);
}

static void squares_upon_each_other(void **state) {
  (void)state;
  check(false);
}

static void squares_in_instances(void **state) {
  (void)state;
  check(true);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(squares_upon_each_other),
      cmocka_unit_test(squares_in_instances),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
