/* test/import/test_gltf_unused.c: `velo scene check` reads what no scene of a glTF file
 * uses. */
#include "import/gltf_load.h"
#include "velo/check.h"

static void tell(void *user, const vlError *problem) {
  (void)user;
  fail_msg("%s", problem->message); /* what is not used does not stop a render */
}

static void diagnose(Loaded *l, const Gltf *g, const char *rest) {
  gltf_write_text(g, in_folder("t.gltf"), rest);
  start_load(l);
  l->result = vl_scene_diagnose(l->scene, in_folder("t.gltf"), NULL, tell, NULL, &l->error);
  assert_int_equal(l->result, VL_OK);
}

static void says(const Loaded *l, const char *text) {
  if (!strstr(l->log, text))
    fail_msg("\"%s\" is not in:\n%s", text, l->log);
}

static void broken(void **state) {
  (void)state;
  Gltf *g = new_square();
  const uint16_t wrong[] = {0, 1, 9};
  const float high[] = {0, 1, 2};
  gltf_shorts(g, wrong, 3); /* 2 */
  gltf_accessor(g, gltf_view(g, high, sizeof high, 0), 5126, 3, "SCALAR",
                ",\"min\":[0],\"max\":[1.5]"); /* 3 */
  const char *rest = SCENE
      "\"nodes\":[{\"mesh\":0},{\"mesh\":1}],"
      "\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0},\"indices\":1}]},"
      "{\"primitives\":[{\"attributes\":{\"POSITION\":0},\"indices\":2}]},"
      "{\"primitives\":[{\"attributes\":{\"POSITION\":7}}]}],"
      "\"materials\":[{\"pbrMetallicRoughness\":{\"baseColorTexture\":{\"index\":4}}}],"
      "\"cameras\":[{\"type\":\"perspective\",\"perspective\":{\"yfov\":9,\"znear\":0.1}}],"
      "\"animations\":[{\"samplers\":[{\"input\":3}],\"channels\":[{\"sampler\":0,\"target\":{"
      "\"node\":0,"
      "\"path\":\"scale\"}}]}]";
  Loaded l;
  diagnose(&l, g, rest);
  says(&l, "names vertex 9, but there are only 4");
  says(&l, "meshes[2].primitives[0].attributes.POSITION");
  says(&l, "meshes[2]: UNUSED_OBJECT");
  says(&l, "materials[0]: UNUSED_OBJECT");
  says(&l, "no scene uses it, but: materials[0].pbrMetallicRoughness.baseColorTexture");
  says(&l, "cameras[0].perspective.yfov");
  says(&l, "animations[0].samplers[0]");
  says(&l, "accessors[3].max[0]: ACCESSOR_MAX_MISMATCH: 1.5 is given, the data has 2");
  assert_null(strstr(l.log, "ACCESSOR_MIN_MISMATCH"));
  assert_null(strstr(l.log, "meshes[0]"));
  assert_int_equal(l.scene->shapes.count, 1);
  assert_int_equal(l.scene->materials.count, 1); /* the default one */
  end_load(&l);
  fine(&l, g, rest); /* a render reads only what the scene uses */
  assert_string_equal(l.log, "");
  end_load(&l);
  free(g);
}

static void good(void **state) {
  (void)state;
  Gltf *g = new_square();
  Loaded l;
  diagnose(&l, g,
           SCENE
           "\"nodes\":[{\"mesh\":0}],\"materials\":[{}],"
           "\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0},"
           "\"indices\":1,\"material\":0}]}]");
  assert_string_equal(l.log, "");
  end_load(&l);
  free(g);
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(broken), cmocka_unit_test(good)};
  return cmocka_run_group_tests(tests, set_up, tear_down);
}
