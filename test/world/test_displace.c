/* test_displace.c: displaced meshes: subdivision, displacement, no cracks; too fine a
 * subdivision is an error. */
#include <math.h>
#include <stdlib.h>
#include <string.h>
/* cmocka.h needs the headers above */

#include "unit.h"
#include "velo/shape_kinds.h"
#include "velo/texture.h"
#include "world/world.h"

typedef struct Made {
  vlContext *context;
  vlWorld *world;
  vlResult result;
  vlError error;
} Made;

/* An octahedron of radius 1 (or without its lower half), displaced by a number, twice as large
 * in the world. */
static Made make(float amount, float edge, bool half, bool quads) {
  static const float p[18] = {1, 0, 0, 0, 1, 0, -1, 0, 0, 0, -1, 0, 0, 0, 1, 0, 0, -1};
  static const uint32_t f[24] = {0, 1, 4, 1, 2, 4, 2, 3, 4, 3, 0, 4,
                                 1, 0, 5, 2, 1, 5, 3, 2, 5, 0, 3, 5};
  Made m;
  memset(&m, 0, sizeof m);
  vlScene *scene;
  vlContextDef context_def = vl_default_context_def();
  assert_int_equal(vl_context_create(&context_def, &m.context), VL_OK);
  assert_int_equal(vl_scene_create(m.context, &scene), VL_OK);
  vlTextureDef texture = vl_default_texture_def(VL_TEXTURE_CONSTANT, false);
  texture.float_a = vl_float_input(amount);
  vlShapeDef def = vl_default_shape_def(quads ? VL_SHAPE_BILINEAR : VL_SHAPE_TRIANGLES);
  def.displacement.texture = vl_scene_add_texture(scene, &texture);
  def.edge_length = edge;
  def.vertices = 6;
  def.faces = half ? 4 : 8;
  def.positions = p;
  def.indices = f;
  for (int i = 0; i < 3; i++)
    def.group_from_shape[5 * i] = 2;
  vl_scene_add_shape(scene, &def);
  m.result = vl_world_build(scene, NULL, &m.world, &m.error);
  vl_scene_destroy(scene);
  return m;
}

static void finish(Made *m) {
  vl_world_destroy(m->world);
  assert_int_equal(vl_context_memory(m->context, NULL), 0);
  vl_context_destroy(m->context);
}

static void closed_and_fine(void **state) {
  (void)state;
  for (int half = 0; half < 2; half++) {
    Made m = make(0, 0.21f, half, false);
    assert_int_equal(m.result, VL_OK);
    const vlWorldShape *s = &m.world->shapes.items[0];
    assert_true(s->faces > 8 * 60);
    assert_int_equal(m.world->info.triangles, s->faces);
    /* every edge inside is there twice, once each way; of the half, those at the rim once */
    long seams = 0;
    for (uint32_t i = 0; i < 3 * s->faces; i++) {
      uint32_t a = s->indices[i], b = s->indices[i % 3 == 2 ? i - 2 : i + 1];
      const float *p = s->positions + 3 * (size_t)a, *q = s->positions + 3 * (size_t)b;
      double l = hypot(hypot(p[0] - q[0], p[1] - q[1]), p[2] - q[2]);
      assert_true(l <= 0.21 * 1.0001 && l > 0.21 / 4);
      seams += a < b ? 1 : -1;
      if (fabsf(p[2]) < 1e-6f && fabsf(q[2]) < 1e-6f)
        continue; /* the rim */
      bool other = false;
      for (uint32_t k = 0; k < 3 * s->faces && !other; k++)
        other = s->indices[k] == b && s->indices[k % 3 == 2 ? k - 2 : k + 1] == a;
      assert_true(other);
    }
    if (!half)
      assert_int_equal(seams, 0);
    if (!half)
      assert_int_equal(s->vertices - s->faces * 3 / 2 + s->faces, 2); /* Euler */
    finish(&m);
  }
}

static void moves_along_normals(void **state) {
  (void)state;
  Made m = make(0.1f, 100, true, false); /* shape space: twice that in the world */
  assert_int_equal(m.result, VL_OK);
  const vlWorldShape *s = &m.world->shapes.items[0];
  assert_int_equal(s->faces, 4);
  assert_int_equal(s->vertices, 6); /* one of them of no face: stays */
  assert_true(fabsf(s->positions[14] - 2.2f) < 1e-6f);
  assert_true(fabsf(s->positions[17] + 2.0f) < 1e-6f);
  for (int i = 0; i < 4; i++) {
    /* at the rim the mean of two faces: 2 up, 1 out... */
    const float *p = s->positions + 3 * i, *n = s->normals + 3 * i;
    double out = sqrt((double)p[0] * p[0] + (double)p[1] * p[1]) - 2;
    assert_true(fabs(out * out + (double)p[2] * p[2] - 0.04) < 1e-5 && p[2] > 0.05f);
    assert_true(fabs((double)n[0] * n[0] + (double)n[1] * n[1] + (double)n[2] * n[2] - 1) <
                1e-5);
  }
  finish(&m);
}

static void refused(void **state) {
  (void)state;
  Made m = make(0.1f, 1e-7f, false, false);
  assert_int_equal(m.result, VL_ERROR_SCENE);
  assert_non_null(strstr(m.error.message, "need more than 4194304 triangles"));
  finish(&m);
  m = make(0.1f, 0, false, false);
  assert_int_equal(m.result, VL_ERROR_SCENE);
  assert_non_null(strstr(m.error.message, "parameter \"edgelength\" must be a number above 0"));
  finish(&m);
  m = make(0.1f, 1, false, true);
  assert_int_equal(m.result, VL_ERROR_SCENE);
  assert_non_null(strstr(m.error.message, "only triangles at rest"));
  finish(&m);
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(closed_and_fine),
                                     cmocka_unit_test(moves_along_normals),
                                     cmocka_unit_test(refused)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
