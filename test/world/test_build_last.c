/* test/world/test_build_last.c: a scene that passes its meshes to its last world: the same
 * world with less memory. */
#include <string.h>

#include "scene/scene.h"
#include "unit.h"
#include "velo/check.h"
#include "velo/render.h"
#include "velo/shape_kinds.h"
#include "world/world.h"

enum { N = 60, VERTICES = (N + 1) * (N + 1), FACES = 2 * N * N };

static vlScene *make(vlContext *context) {
  static float p[3 * VERTICES], uv[2 * VERTICES];
  static uint32_t f[3 * FACES];
  for (uint32_t i = 0; i < VERTICES; i++) {
    p[3 * i] = uv[2 * i] = (float)(i % (N + 1));
    p[3 * i + 1] = uv[2 * i + 1] = (float)(i / (N + 1));
    p[3 * i + 2] = (float)(i % 7);
  }
  for (uint32_t k = 0, i = 0; i < N * N; i++) {
    uint32_t v = i / N * (N + 1) + i % N,
             face[6] = {v, v + 1, v + N + 2, v, v + N + 2, v + N + 1};
    for (int j = 0; j < 6; j++)
      f[k++] = face[j];
  }
  vlScene *scene = NULL;
  assert_int_equal(vl_scene_create(context, &scene), VL_OK);
  vlShapeDef d = vl_default_shape_def(VL_SHAPE_TRIANGLES);
  d.vertices = VERTICES;
  d.faces = FACES;
  d.positions = p;
  d.uvs = uv;
  d.normals = p;
  d.indices = f;
  d.group_from_shape[3] = 5;
  vl_scene_add_shape(scene, &d);
  d.kind = VL_SHAPE_SPHERE;
  vl_scene_add_shape(scene, &d);
  assert_int_equal(vl_scene_result(scene, NULL), VL_OK);
  return scene;
}

static void the_same_world_in_less_memory(void **state) {
  (void)state;
  vlContext *context = NULL;
  vlContextDef def = vl_default_context_def();
  def.threads = 1; /* each thread that builds an accelerator has memory that it does not fill */
  assert_int_equal(vl_context_create(&def, &context), VL_OK);
  vlScene *scene = make(context);
  vlWorld *first = NULL, *last = NULL, *none = NULL;
  assert_int_equal(vl_world_build(scene, NULL, &first, NULL), VL_OK);
  size_t before = vl_context_memory(context, NULL);
  assert_int_equal(vl_world_build_last(scene, NULL, &last, NULL), VL_OK);
  const vlWorldShape *a = &first->shapes.items[0], *b = &last->shapes.items[0];
  assert_memory_equal(a->positions, b->positions, 12 * VERTICES);
  assert_memory_equal(a->normals, b->normals, 12 * VERTICES);
  assert_memory_equal(a->uvs, b->uvs, 8 * VERTICES);
  assert_memory_equal(a->indices, b->indices, 12 * FACES);
  vl_world_destroy(first);
  size_t mesh = 12 * FACES + 32 * VERTICES;
  assert_true(vl_context_memory(context, NULL) + mesh <= before);
  vlSceneInfo info;
  vl_scene_info(scene, &info);
  assert_int_equal(info.triangles, FACES);
  vlError error = {0};
  assert_int_equal(vl_world_build(scene, NULL, &none, &error), VL_ERROR_ARGUMENT);
  assert_non_null(strstr(error.message, "gave its meshes"));
  vlCheck *check = NULL;
  assert_int_equal(vl_scene_check(scene, NULL, &check, &error), VL_ERROR_ARGUMENT);
  vl_scene_destroy(scene);
  vl_world_destroy(last);
  assert_int_equal(vl_context_memory(context, NULL), 0);
  vl_context_destroy(context);
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(the_same_world_in_less_memory)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
