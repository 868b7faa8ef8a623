/* test/import/test_gltf_models.c: the features that Khronos' sample models show, each as a
 * small file made here: skins that share a mesh and joints, eight influences, many morph
 * targets, Unicode names, deep and wide node trees, hidden nodes, interleaved arrays, nearly
 * empty files. */
#include "import/gltf_load.h"
#include "velo/shape.h"

static void is_near(double a, double b, double max) {
  if (!(fabs(a - b) <= max))
    fail_msg("%.9g is not %.9g", a, b);
}

/* RecursiveSkeletons has two skins for one mesh, and one node is a child of a joint of its own
 * skin. The joints alone determine the position of a skinned mesh; its node's pose is
 * ignored. */
static void skins(void **state) {
  (void)state;
  Gltf *g = new_square();
  uint8_t joints[16] = {0};
  float weights[16] = {0}, bind[32] = {0};
  for (int i = 0; i < 4; i++) {
    joints[4 * i + 1] = 1;
    weights[4 * i] = 0.25f;
    weights[4 * i + 1] = 0.75f;
  }
  for (int i = 0; i < 8; i++)
    bind[5 * (i % 4) + 16 * (i / 4)] = 1;
  gltf_accessor(g, gltf_view(g, joints, sizeof joints, 0), 5121, 4, "VEC4", NULL); /* 2 */
  gltf_floats(g, weights, 4, "VEC4", 4);                                           /* 3 */
  gltf_floats(g, bind, 2, "MAT4", 16);                                             /* 4 */
  Loaded l;
  fine(&l, g,
       SCENE
       "\"nodes\":[{\"children\":[1,4]},{\"translation\":[4,0,0],\"children\":[2]},"
       "{\"translation\":[0,4,0],\"children\":[3]},"
       "{\"mesh\":0,\"skin\":0,\"translation\":[100,0,0]},{\"translation\":[0,0,-8],"
       "\"children\":[5]},{\"scale\":[2,2,2],\"children\":[6]},{\"mesh\":0,\"skin\":1}],"
       "\"skins\":[{\"joints\":[1,2],\"inverseBindMatrices\":4},{\"joints\":[4,5],"
       "\"inverseBindMatrices\":4,\"skeleton\":4}],"
       "\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0,\"JOINTS_0\":2,"
       "\"WEIGHTS_0\":3},\"indices\":1}]}]");
  assert_int_equal(l.scene->shapes.count, 2);
  const float *a = shape(&l, 0)->positions, *b = shape(&l, 1)->positions;
  const double *pa = shape(&l, 0)->group_from_shape, *pb = shape(&l, 1)->group_from_shape;
  /* joints of the first: (4, 0, 0) and (4, 4, 0); corner (1, 1, 0) */
  is_near((double)a[9] + pa[3], 5, 1e-5);
  is_near((double)a[10] + pa[7], 1 + 0.75 * 4, 1e-5);
  /* of the second: moved to z = -8, the other twice as large as well: 0.25 + 0.75 * 2 */
  is_near((double)b[9] + pb[3], 1.75, 1e-5);
  is_near((double)b[11] + pb[11], -8, 1e-5);
  end_load(&l);
  free(g);
}

/* JOINTS_1 and WEIGHTS_1 count as the first four do. */
static void eight_influences(void **state) {
  (void)state;
  Gltf *g = new_square();
  uint8_t first[16] = {0};
  uint16_t second[16] = {0}, rest_weights[16];
  float weights[16];
  for (int i = 0; i < 16; i++) {
    first[i] = (uint8_t)(i % 4);
    second[i] = (uint16_t)(4 + i % 4);
    weights[i] = 0.125f;
    rest_weights[i] = 8192;
  }
  gltf_accessor(g, gltf_view(g, first, sizeof first, 0), 5121, 4, "VEC4", NULL);
  gltf_floats(g, weights, 4, "VEC4", 4);
  gltf_accessor(g, gltf_view(g, second, sizeof second, 0), 5123, 4, "VEC4", NULL);
  gltf_accessor(g, gltf_view(g, rest_weights, sizeof rest_weights, 0), 5123, 4, "VEC4",
                ",\"normalized\":true");
  Loaded l;
  fine(&l, g,
       "\"scenes\":[{\"nodes\":[0,1,2,3,4,5,6,7,8]}],\"nodes\":[{\"mesh\":0,\"skin\":0},{},"
       "{},{},{},{},{},{},{\"translation\":[8,0,0]}],"
       "\"skins\":[{\"joints\":[1,2,3,4,5,6,7,8]}],"
       "\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0,\"JOINTS_0\":2,"
       "\"WEIGHTS_0\":3,\"JOINTS_1\":4,\"WEIGHTS_1\":5},\"indices\":1}]}]");
  is_near((double)shape(&l, 0)->positions[0] + shape(&l, 0)->group_from_shape[3], 1, 1e-3);
  end_load(&l);
  free(g);
}

/* MorphStressTest: many targets at once, the file's own weights, then animated ones. */
static void many_targets(void **state) {
  (void)state;
  Gltf *g = new_square();
  enum { TARGETS = 16 };
  char targets[1000] = "", weights[400] = "";
  float up[12] = {0}, keys[2 * TARGETS];
  const float times[2] = {0, 1};
  for (int k = 0; k < TARGETS; k++) {
    for (int i = 0; i < 4; i++)
      up[3 * i + 2] = (float)(1 << k % 8);
    sprintf(targets + strlen(targets), "%s{\"POSITION\":%d}", k ? "," : "",
            gltf_floats(g, up, 4, "VEC3", 3));
    sprintf(weights + strlen(weights), "%s%g", k ? "," : "", k == 3 ? 0.5 : 0);
    keys[k] = 0;
    keys[TARGETS + k] = k == 15 ? 1 : k == 0 ? -1 : 0;
  }
  int input = gltf_floats(g, times, 2, "SCALAR", 1),
      output = gltf_floats(g, keys, 2 * TARGETS, "SCALAR", 1);
  char rest[3000];
  snprintf(
      rest, sizeof rest,
      SCENE
      "\"nodes\":[{\"mesh\":0}],\"animations\":[{\"samplers\":[{\"input\":%d,\"output\":%d}],"
      "\"channels\":[{"
      "\"sampler\":"
      "0,\"target\":{\"node\":0,\"path\":\"weights\"}}]}],\"meshes\":[{\"weights\":[%s],"
      "\"primitives\":[{"
      "\"attributes\":{"
      "\"POSITION\":0},\"indices\":1,\"targets\":[%s]}]}]",
      input, output, weights, targets);
  Loaded l;
  fine(&l, g, rest);
  is_near((double)shape(&l, 0)->positions[2], 4, 1e-6);
  end_load(&l);
  vlLoadDef def = vl_default_load_def();
  def.time = 0.5;
  fine_with(&l, g, rest, &def);
  is_near((double)shape(&l, 0)->positions[2], 0.5 * 128 - 0.5, 1e-5);
  end_load(&l);
  free(g);
}

/* UnicodeTest: names of files as they are and escaped. */
static void unicode(void **state) {
  (void)state;
  Gltf *g = new_square();
  static const char *const uris[] = {"Unicode\u2764\u267bData.bin",
                                     "Unicode%E2%9D%A4%e2%99%bbData.bin"};
  gltf_file(in_folder(uris[0]), g->bytes, g->size);
  for (int i = 0; i < 2; i++) {
    char *text = gltf_json(g, uris[i],
                           SCENE "\"nodes\":[{\"mesh\":0,\"name\":\"\u2764\"}]," SQUARE_MESH);
    gltf_file(in_folder("\u267b.gltf"), text, strlen(text));
    free(text);
    Loaded l;
    start_load(&l);
    l.result = vl_scene_load(l.scene, in_folder("\u267b.gltf"), NULL, &l.error);
    if (l.result != VL_OK)
      fail_msg("%s", l.error.message);
    assert_int_equal(shape(&l, 0)->vertices, 4);
    end_load(&l);
  }
  free(g);
}

/* NodePerformanceTest: thousands side by side, and one below the other. */
static void many_nodes(void **state) {
  (void)state;
  enum { NODES = 5000 };
  Gltf *g = new_square();
  char *rest = malloc(NODES * 60);
  for (int deep = 0; deep < 2; deep++) {
    char *to = rest + sprintf(rest, SQUARE_MESH ",\"nodes\":[");
    for (int i = 0; i < NODES; i++) {
      to += sprintf(to, "%s{\"translation\":[%d,0,0]", i ? "," : "", deep ? 1 : i);
      if (!deep || i == NODES - 1)
        to += sprintf(to, ",\"mesh\":0");
      if (deep && i < NODES - 1)
        to += sprintf(to, ",\"children\":[%d]", i + 1);
      to += sprintf(to, "}");
    }
    sprintf(to, "]");
    Loaded l;
    fine(&l, g, rest);
    if (deep)
      is_near(shape(&l, 0)->group_from_shape[3], NODES, 1e-9);
    else
      assert_int_equal(l.scene->instances.count, NODES);
    end_load(&l);
  }
  free(rest);
  free(g);
}

/* KHR_node_visibility: hidden with all below. */
static void hidden(void **state) {
  (void)state;
  Gltf *g = new_square();
  Loaded l;
  fine(&l, g,
       "\"scenes\":[{\"nodes\":[0,2]}],\"extensionsUsed\":[\"KHR_node_visibility\",\"KHR_node_"
       "selectability\"],"
       "\"nodes\":[{\"children\":[1],\"extensions\":{\"KHR_node_visibility\":{\"visible\":"
       "false}}},"
       "{\"mesh\":0},{"
       "\"mesh\":0,"
       "\"translation\":[0,7,0],\"extensions\":{\"KHR_node_visibility\":{\"visible\":true}}}]"
       "," SQUARE_MESH);
  assert_int_equal(l.scene->shapes.count, 1);
  is_near(shape(&l, 0)->group_from_shape[7], 7, 0);
  assert_string_equal(l.log, "");
  end_load(&l);
  free(g);
}

/* BoxInterleaved, and accessors that begin inside of their view. */
static void interleaved(void **state) {
  (void)state;
  Gltf *g = calloc(1, sizeof *g);
  float rows[4][9]; /* uv, position, normal, one more */
  for (int i = 0; i < 4; i++) {
    const float row[9] = {
        0.25f, 0.5f, square[3 * i], square[3 * i + 1], square[3 * i + 2], 0, 0.6f, 0.8f, 99};
    memcpy(rows[i], row, sizeof row);
  }
  int view = gltf_view(g, rows, sizeof rows, 36);
  gltf_accessor(g, view, 5126, 4, "VEC3", ",\"byteOffset\":8");
  gltf_shorts(g, square_faces, 6);
  gltf_accessor(g, view, 5126, 4, "VEC3", ",\"byteOffset\":20");
  gltf_accessor(g, view, 5126, 4, "VEC2", NULL);
  Loaded l;
  fine(&l, g,
       SCENE
       "\"nodes\":[{\"mesh\":0}],\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0,"
       "\"NORMAL\":2,"
       "\"TEXCOORD_0\":3},\"indices\":1}]}]");
  assert_memory_equal(shape(&l, 0)->positions, square, sizeof square);
  is_near((double)shape(&l, 0)->normals[4], 0.6, 1e-6);
  is_near((double)shape(&l, 0)->uvs[6], 0.25, 1e-6);
  end_load(&l);
  free(g);
}

static void next_to_nothing(void **state) {
  (void)state;
  static const char *const texts[] = {
      "{\"asset\":{\"version\":\"2.0\"}}",
      "{\"asset\":{\"version\":\"2.0\",\"minVersion\":\"2.0\","
      "\"extras\":null},\"scenes\":[{}],\"scene\":0}",
      ("{\"asset\":{\"version\":\"2.1\",\"generator\":\"\"},\"nodes\":[{}],"
       "\"scenes\":[{\"nodes\":[0]}],\"materials\":[{}]}")};
  for (int i = 0; i < 3; i++) {
    gltf_file(in_folder("n.gltf"), texts[i], strlen(texts[i]));
    Loaded l;
    start_load(&l);
    l.result = vl_scene_load(l.scene, in_folder("n.gltf"), NULL, &l.error);
    if (l.result != VL_OK)
      fail_msg("%s: %s", texts[i], l.error.message);
    assert_int_equal(l.scene->shapes.count, 0);
    end_load(&l);
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(skins),        cmocka_unit_test(eight_influences),
      cmocka_unit_test(many_targets), cmocka_unit_test(unicode),
      cmocka_unit_test(many_nodes),   cmocka_unit_test(hidden),
      cmocka_unit_test(interleaved),  cmocka_unit_test(next_to_nothing)};
  return cmocka_run_group_tests(tests, set_up, tear_down);
}
