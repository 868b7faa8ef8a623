/* test/import/test_gltf.c: glTF files made here become the scenes that the specification
 * defines: arrays, modes, node trees, animation, deformation, tangents, cameras. */
#include "import/gltf_load.h"
#include "velo/material.h"
#include "velo/render.h"
#include "velo/shape.h"

/* ---- the file ---------------------------------------------------------------------------- */

/* The buffer is the first binary chunk of a .glb; another one is ignored. */
static void second_chunk(const Gltf *g, const char *rest) {
  size_t size;
  uint8_t *binary = gltf_binary(g, rest, &size);
  const size_t more = (g->size + 3) & ~(size_t)3, whole = size + 8 + more;
  uint8_t *both = calloc(1, whole);
  memcpy(both, binary, size);
  memcpy(both + 8, &(uint32_t){(uint32_t)whole}, 4);
  memcpy(both + size, (const uint32_t[2]){(uint32_t)more, 0x004E4942}, 8);
  gltf_file(in_folder("two.glb"), both, whole);
  free(both);
  free(binary);
  Loaded l;
  start_load(&l);
  assert_int_equal(vl_scene_load(l.scene, in_folder("two.glb"), NULL, NULL), VL_OK);
  assert_memory_equal(shape(&l, 0)->positions, square, sizeof square);
  end_load(&l);
}

/* Buffers are looked for in the folders of the search path, too. */
static void searched(void **state) {
  (void)state;
  Gltf *g = new_square();
  char *text = gltf_json(g, "elsewhere.bin", SCENE "\"nodes\":[{\"mesh\":0}]," SQUARE_MESH);
  gltf_file(in_folder("s.gltf"), text, strlen(text));
  free(text);
  mkdir(in_folder("away"), 0700);
  gltf_file(in_folder("away/elsewhere.bin"), g->bytes, g->size);
  free(g);
  char folders[600];
  snprintf(folders, sizeof folders, "/nowhere:%s", in_folder("away"));
  vlLoadDef def = vl_default_load_def();
  for (int i = 0; i < 2; i++) {
    Loaded l;
    start_load(&l);
    const vlResult result = vl_scene_load(l.scene, in_folder("s.gltf"), &def, NULL);
    assert_int_equal(result, i == 0 ? VL_ERROR_MISSING : VL_OK);
    end_load(&l);
    def.search_path = folders;
  }
}

static void containers(void **state) {
  (void)state;
  Gltf *g = new_square();
  const char *rest = SCENE "\"nodes\":[{\"mesh\":0}]," SQUARE_MESH;
  Loaded l;
  fine(&l, g, rest);
  assert_int_equal(shape(&l, 0)->faces, 2);
  assert_true(l.scene->defs.camera_missing && l.scene->defs.light_missing);
  end_load(&l);
  size_t size;
  uint8_t *binary = gltf_binary(g, rest, &size);
  gltf_file(in_folder("t.glb"), binary, size);
  free(binary);
  start_load(&l);
  assert_int_equal(vl_scene_load(l.scene, in_folder("t.glb"), NULL, NULL), VL_OK);
  assert_memory_equal(shape(&l, 0)->positions, square, sizeof square);
  end_load(&l);
  second_chunk(g, rest);
  /* a buffer in a file whose name needs escapes */
  gltf_file(in_folder("my data%.bin"), g->bytes, g->size);
  char *text = gltf_json(g, "my%20data%25.bin", rest);
  gltf_file(in_folder("u.gltf"), text, strlen(text));
  free(text);
  start_load(&l);
  assert_int_equal(vl_scene_load(l.scene, in_folder("u.gltf"), NULL, NULL), VL_OK);
  assert_int_equal(shape(&l, 0)->vertices, 4);
  end_load(&l);
  free(g);
}

/* Bytes normalised, elements apart, elements replaced, zeros without a view. */
static void arrays(void **state) {
  (void)state;
  Gltf *g = calloc(1, sizeof *g);
  /* 8 bytes apart */
  const int16_t quantised[] = {0, 0, 0, 99, 32767, 0, 0, 99, 0, -32768, 0, 99};
  int view = gltf_view(g, quantised, sizeof quantised, 8);
  gltf_accessor(g, view, 5122, 3, "VEC3", ",\"normalized\":true");
  const uint8_t colors[] = {255, 0, 51, 0, 0, 255, 0, 0, 0, 0, 0, 0}; /* 4 bytes apart */
  gltf_accessor(g, gltf_view(g, colors, sizeof colors, 4), 5121, 3, "VEC3",
                ",\"normalized\":true");
  const uint8_t where[] = {2, 0, 0, 0};
  const float put[] = {7, 8, 9};
  int indices = gltf_view(g, where, 1, 0), values = gltf_view(g, put, sizeof put, 0);
  char sparse[200];
  snprintf(sparse, sizeof sparse,
           ",\"sparse\":{\"count\":1,\"indices\":{\"bufferView\":%d,\"componentType\":5121},"
           "\"values\":{\"bufferView\":%d}}",
           indices, values);
  gltf_accessor(g, -1, 5126, 3, "VEC3", sparse);
  Loaded l;
  fine(&l, g,
       SCENE
       "\"extensionsUsed\":[\"KHR_mesh_quantization\"],"
       "\"extensionsRequired\":[\"KHR_mesh_quantization\"],\"nodes\":[{\"mesh\":0}],"
       "\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0,\"COLOR_0\":1,"
       "\"NORMAL\":2}}]}]");
  const vlShapeDef *s = shape(&l, 0);
  assert_int_equal(s->vertices, 3);
  const float positions[] = {0, 0, 0, 1, 0, 0, 0, -1, 0},
              normals[] = {0, 0, 0, 0, 0, 0, 7, 8, 9};
  assert_memory_equal(s->positions, positions, sizeof positions);
  assert_memory_equal(s->normals, normals, sizeof normals);
  assert_near((double)s->colors[0], 1, 0);
  assert_near((double)s->colors[2], 0.2, 1e-7);
  assert_near((double)s->colors[3], 1, 0); /* VEC3 is opaque */
  assert_near((double)s->colors[5], 1, 0);
  end_load(&l);
  free(g);
}

static void modes(void **state) {
  (void)state;
  static const struct {
    int mode;
    uint32_t faces;
  } cases[] = {{4, 1}, {5, 2}, {6, 2}, {0, 4 * 32}, {1, 2 * 20}, {2, 4 * 20}, {3, 3 * 20}};
  for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
    Gltf *g = new_square();
    char rest[400];
    snprintf(rest, sizeof rest,
             SCENE
             "\"nodes\":[{\"mesh\":0}],\"meshes\":[{\"primitives\":[{\"attributes\":{"
             "\"POSITION\":0},"
             "\"mode\":%d}]}]",
             cases[i].mode);
    Loaded l;
    fine(&l, g, rest);
    assert_int_equal(shape(&l, 0)->faces, cases[i].faces);
    /* balls and tubes are closed and look outwards: their volume is positive */
    const vlShapeDef *s = shape(&l, 0);
    double volume = 0;
    for (size_t f = 0; cases[i].mode < 4 && f < s->faces; f++) {
      const float *a = s->positions + 3 * s->indices[3 * f],
                  *b = s->positions + 3 * s->indices[3 * f + 1],
                  *c = s->positions + 3 * s->indices[3 * f + 2];
      volume += (double)a[0] * ((double)b[1] * c[2] - (double)b[2] * c[1]) -
                (double)a[1] * ((double)b[0] * c[2] - (double)b[2] * c[0]) +
                (double)a[2] * ((double)b[0] * c[1] - (double)b[1] * c[0]);
    }
    assert_true(cases[i].mode >= 4 || volume > 0);
    end_load(&l);
    free(g);
  }
  Gltf *g = new_square(); /* a strip of 4: 0 1 2, 1 3 2 */
  Loaded l;
  fine(&l, g,
       SCENE
       "\"nodes\":[{\"mesh\":0}],\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0},"
       "\"mode\":5}]}]");
  const uint32_t strip[] = {0, 1, 2, 1, 3, 2};
  assert_memory_equal(shape(&l, 0)->indices, strip, sizeof strip);
  end_load(&l);
  free(g);
}

/* ---- the tree ---------------------------------------------------------------------------- */

static void poses(void **state) {
  (void)state;
  Gltf *g = new_square();
  Loaded l;
  fine(&l, g,
       SCENE
       "\"nodes\":[{\"translation\":[1,2,3],\"rotation\":[0,0,0.70710678118,0.70710678118],"
       "\"children\":[1]},"
       "{\"mesh\":0,\"matrix\":[-2,0,0,0, 0,1,0,0, 0,0,1,0, 5,0,0,1]}]," SQUARE_MESH);
  const double *m = shape(&l, 0)->group_from_shape;
  const double expected[16] = {0, -1, 0, 1, -2, 0, 0, 7, 0, 0, 1, 3, 0, 0, 0, 1};
  for (int i = 0; i < 16; i++)
    assert_near(m[i], expected[i], 1e-9);
  assert_true(shape(&l, 0)->one_sided); /* the default material shows one side */
  end_load(&l);
  /* a mesh in two places is kept once */
  fine(&l, g, "\"nodes\":[{\"mesh\":0},{\"mesh\":0,\"translation\":[3,0,0]}]," SQUARE_MESH);
  assert_int_equal(l.scene->shapes.count, 1);
  assert_int_equal(l.scene->instances.count, 2);
  assert_near(l.scene->instances.items[1].world_from_group[3], 3, 0);
  end_load(&l);
  /* instances by attributes */
  const float places[] = {0, 0, 0, 2, 0, 0, 4, 0, 0};
  int translation = gltf_floats(g, places, 3, "VEC3", 3);
  char rest[600];
  snprintf(
      rest, sizeof rest,
      SCENE
      "\"extensionsUsed\":[\"EXT_mesh_gpu_instancing\"],\"nodes\":[{\"mesh\":0,"
      "\"translation\":[0,1,0],"
      "\"extensions\":{\"EXT_mesh_gpu_instancing\":{\"attributes\":{\"TRANSLATION\":%d}}}}]"
      "," SQUARE_MESH,
      translation);
  fine(&l, g, rest);
  assert_int_equal(l.scene->instances.count, 3);
  assert_near(l.scene->instances.items[2].world_from_group[3], 4, 0);
  assert_near(l.scene->instances.items[2].world_from_group[7], 1, 0);
  end_load(&l);
  /* a flat pose moves the vertices themselves */
  fine(&l, g, SCENE "\"nodes\":[{\"mesh\":0,\"scale\":[2,2,0]}]," SQUARE_MESH);
  assert_near((double)shape(&l, 0)->positions[3], 2, 0);
  end_load(&l);
  free(g);
}

static double at_time(const Gltf *g, const char *rest, double time, int element) {
  Loaded l;
  vlLoadDef def = vl_default_load_def();
  def.time = time;
  load(&l, g, rest, &def);
  if (l.result != VL_OK)
    print_message("%s\n", l.error.message);
  assert_int_equal(l.result, VL_OK);
  double x = shape(&l, 0)->group_from_shape[element];
  end_load(&l);
  return x;
}

static void animation(void **state) {
  (void)state;
  Gltf *g = new_square();
  const float times[] = {1, 2, 4}, places[] = {0, 0, 0, 1, 0, 0, 3, 0, 0};
  /* of each key the tangent before it, its value and the tangent behind it */
  const float cubic[] = {9, 0, 0, 0, 0, 0, 2, 0, 0, -1, 0, 0, 1, 0,
                         0, 4, 0, 0, 5, 0, 0, 3, 0, 0,  9, 0, 0};
  const float turns[] = {0, 0, 0, 1, 0, 0, 0.70710678f, 0.70710678f, 0, 0, -1, 0};
  gltf_floats(g, times, 3, "SCALAR", 1); /* 2 */
  gltf_floats(g, places, 3, "VEC3", 3);  /* 3 */
  gltf_floats(g, cubic, 9, "VEC3", 3);   /* 4 */
  gltf_floats(g, turns, 3, "VEC4", 4);   /* 5 */
  char rest[800];
  static const char *const modes_of[] = {"STEP", "LINEAR", "CUBICSPLINE"};
  const double expected[3][6] = {/* at 0, 1, 1.5, 2, 3, 9 */
                                 {0, 0, 0, 1, 1, 3},
                                 {0, 0, 0.5, 1, 2, 3},
                                 {0, 0, 0.875, 1, 1.75, 3}};
  const double moments[6] = {0, 1, 1.5, 2, 3, 9};
  for (int k = 0; k < 3; k++) {
    snprintf(
        rest, sizeof rest,
        SCENE
        "\"nodes\":[{\"mesh\":0}],\"animations\":[{\"samplers\":[{\"input\":2,\"output\":%d,"
        "\"interpolation\":\"%s\"}],\"channels\":[{\"sampler\":0,\"target\":{\"node\":0,"
        "\"path\":\"translation\"}}]}]," SQUARE_MESH,
        k == 2 ? 4 : 3, modes_of[k]);
    for (int i = 0; i < 6; i++)
      assert_near(at_time(g, rest, moments[i], 3), expected[k][i], 1e-6);
    assert_near(at_time(g, rest, VL_UNSET, 3), 0, 0);
  }
  snprintf(
      rest, sizeof rest,
      SCENE
      "\"nodes\":[{\"mesh\":0}],\"animations\":[{\"samplers\":[{\"input\":2,\"output\":5}],"
      "\"channels\":[{\"sampler\":0,\"target\":{\"node\":0,\"path\":\"rotation\"}}]}]"
      "," SQUARE_MESH);
  /* half of a quarter turn */
  assert_near(at_time(g, rest, 1.5, 0), cos(3.14159265358979 / 4), 1e-6);
  /* the short way on */
  assert_near(at_time(g, rest, 3, 4), sin(3.14159265358979 * 0.75), 1e-6);
  free(g);
}

static void morph_and_skin(void **state) {
  (void)state;
  Gltf *g = new_square();
  const float up[] = {0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1},
              right[] = {1, 0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0};
  gltf_floats(g, up, 4, "VEC3", 3);    /* 2 */
  gltf_floats(g, right, 4, "VEC3", 3); /* 3 */
  Loaded l;
  fine(&l, g,
       SCENE
       "\"nodes\":[{\"mesh\":0,\"weights\":[0.5,2]}],\"meshes\":[{\"weights\":[9,9],"
       "\"primitives\":[{\"attributes\":{\"POSITION\":0},"
       "\"indices\":1,\"targets\":[{\"POSITION\":2},{\"POSITION\":3}]}]}]");
  assert_near((double)shape(&l, 0)->positions[2], 0.5, 0);
  assert_near((double)shape(&l, 0)->positions[0], 2, 0);
  end_load(&l);
  const uint16_t joints[16] = {0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0};
  const float weights[16] = {0.25f, 0.75f, 0, 0, 0.25f, 0.75f, 0, 0,
                             0.25f, 0.75f, 0, 0, 0.25f, 0.75f, 0, 0};
  const float bind[32] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0,  0, 0, 1,
                          1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, -4, 0, 0, 1};
  gltf_accessor(g, gltf_view(g, joints, sizeof joints, 0), 5123, 4, "VEC4", NULL); /* 4 */
  gltf_floats(g, weights, 4, "VEC4", 4);                                           /* 5 */
  gltf_floats(g, bind, 2, "MAT4", 16);                                             /* 6 */
  fine(&l, g,
       "\"scenes\":[{\"nodes\":[0,1,2]}],"
       "\"nodes\":[{\"mesh\":0,\"skin\":0,\"translation\":[100,0,0]},"
       "{\"translation\":[0,8,0]},{\"translation\":[4,0,16]}],\"skins\":[{\"joints\":[1,2],"
       "\"inverseBindMatrices\":6}],"
       "\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0,\"JOINTS_0\":4,"
       "\"WEIGHTS_0\":5},\"indices\":1}]}]");
  const float *p =
      shape(&l, 0)
          ->positions; /* 1/4 of 8 up, 3/4 of 16 ahead; the node's own place does not count */
  assert_near((double)p[0], 0, 1e-6);
  assert_near((double)p[1], 2, 1e-6);
  assert_near((double)p[2], 12, 1e-6);
  assert_near(shape(&l, 0)->group_from_shape[3], 0, 0);
  end_load(&l);
  free(g);
}

/* ---- tangents ---------------------------------------------------------------------------- */

/* Two squares side by side, the right one's image mirrored; a normal map asks for tangents. The
 * vertices between them are shared and must be split. */
static void tangents(void **state) {
  (void)state;
  Gltf *g = calloc(1, sizeof *g);
  const float positions[] = {0, 0, 0, 1, 0, 0, 2, 0, 0, 0, 1, 0, 1, 1, 0, 2, 1, 0};
  const float normals[] = {0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1};
  const float uvs[] = {0, 1, 1, 1, 0, 1, 0, 0, 1, 0, 0, 0}; /* glTF's v points down */
  const uint16_t faces[] = {0, 1, 4, 0, 4, 3, 1, 2, 5, 1, 5, 4};
  gltf_floats(g, positions, 6, "VEC3", 3);
  gltf_floats(g, normals, 6, "VEC3", 3);
  gltf_floats(g, uvs, 6, "VEC2", 2);
  gltf_shorts(g, faces, 12);
  gltf_view(g, "not an image", 13, 0);
  Loaded l;
  fine(&l, g,
       SCENE
       "\"nodes\":[{\"mesh\":0}],\"images\":[{\"bufferView\":4,\"mimeType\":\"image/png\"}],"
       "\"textures\":[{\"source\":0}],"
       "\"materials\":[{\"normalTexture\":{\"index\":0,\"scale\":0.5}}],"
       "\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0,\"NORMAL\":1,"
       "\"TEXCOORD_0\":2},\"indices\":3,\"material\":0}]}]");
  const vlShapeDef *s = shape(&l, 0);
  assert_int_equal(s->vertices, 8);
  for (size_t f = 0; f < 4; f++)
    for (int k = 0; k < 3; k++) {
      uint32_t v = s->indices[3 * f + (size_t)k];
      assert_near((double)s->tangents[3 * v], f < 2 ? 1 : -1, 1e-6);
      assert_near((double)s->tangent_signs[v], f < 2 ? 1 : -1, 0); /* up is up in both */
    }
  assert_near((double)s->uvs[1], 0, 0); /* turned: v upwards */
  const vlMaterialDef *m = &l.scene->materials.items[s->material.index - 1];
  assert_near((double)m->principled.normal_scale, 0.5, 0);
  assert_true(m->principled.normal.index != 0);
  /* the image itself is looked at when the world is built, and its place is told */
  vlWorld *world;
  vlError error;
  assert_int_equal(vl_world_build(l.scene, NULL, &world, &error), VL_ERROR_SCENE);
  assert_non_null(strstr(error.message, "images[0]: not an image"));
  end_load(&l);
  free(g);
}

/* ---- cameras, variants, extensions ------------------------------------------------------- */

static void cameras(void **state) {
  (void)state;
  Gltf *g = new_square();
  const char *rest =
      "\"scenes\":[{\"nodes\":[0,1,2]}],\"nodes\":[{\"mesh\":0},"
      "{\"name\":\"front\",\"camera\":0,\"translation\":[0,0,5]},"
      "{\"camera\":1,\"scale\":[2,2,2]}],"
      "\"cameras\":[{\"type\":\"perspective\",\"perspective\":{\"yfov\":0.5,"
      "\"aspectRatio\":0.5,\"znear\":0.1}},"
      "{\"name\":\"flat\",\"type\":\"orthographic\",\"orthographic\":{\"xmag\":2,\"ymag\":1,"
      "\"znear\":0,\"zfar\":10}}]," SQUARE_MESH;
  static const char *const wanted[] = {NULL, "front", "0", "flat", "1"};
  for (int i = 0; i < 5; i++) {
    Loaded l;
    vlLoadDef def = vl_default_load_def();
    def.camera = wanted[i];
    load(&l, g, rest, &def);
    assert_int_equal(l.result, VL_OK);
    const vlSceneDefs *s = &l.scene->defs;
    assert_false(s->camera_missing);
    vlCamera camera;
    vlCameraDef made = s->camera;
    made.width = s->film.width;
    made.height = s->film.height;
    assert_int_equal(vl_camera_make(&made, &camera, NULL, NULL), VL_OK);
    double pixel[2], z, point[3] = {0, 0, 0};
    if (i < 3) {
      assert_near((double)s->film.width / s->film.height, 0.5, 1e-2);
      point[1] = 5 * tan(0.25); /* the upper edge of the image */
      assert_true(vl_camera_project(&camera, point, pixel, &z));
      assert_near(pixel[1], 0, 1e-6);
      assert_near(z, 5, 1e-9);
    } else {
      point[0] = 2;
      point[2] = -1; /* the right edge; the node's scale makes nothing larger */
      assert_true(vl_camera_project(&camera, point, pixel, &z));
      assert_near(pixel[0], s->film.width, 1e-6);
      assert_near(z, 1, 1e-9);
    }
    end_load(&l);
  }
  Loaded l;
  vlLoadDef def = vl_default_load_def();
  def.camera = "back";
  load(&l, g, rest, &def);
  assert_int_equal(l.result, VL_ERROR_SCENE);
  assert_string_equal(l.error.message, "the scene has no camera \"back\" (2 are there: front)");
  end_load(&l);
  free(g);
}

/* Everything is inside the image, and near its edge on some side. */
static void completion(void **state) {
  (void)state;
  Gltf *g = new_square();
  Loaded l;
  fine(&l, g,
       SCENE
       "\"nodes\":[{\"mesh\":0,\"scale\":[30,2,1],\"translation\":[100,7,-3]}]," SQUARE_MESH);
  vlCompleteDef def = vl_default_complete_def();
  def.width = 300;
  def.height = 200;
  def.ground = true;
  assert_int_equal(vl_scene_complete(l.scene, &def, NULL), VL_OK);
  const vlSceneDefs *s = &l.scene->defs;
  assert_false(s->camera_missing || s->light_missing);
  assert_int_equal(s->film.width, 300);
  assert_int_equal(l.scene->lights.count, 1);
  assert_int_equal(l.scene->shapes.count, 2);
  vlCamera camera;
  assert_int_equal(vl_camera_make(&s->camera, &camera, NULL, NULL), VL_OK);
  double max = 0;
  for (int k = 0; k < 4; k++) {
    double point[3] = {100 + 30.0 * (k & 1), 7 + 2.0 * (k >> 1), -3}, pixel[2];
    assert_true(vl_camera_project(&camera, point, pixel, NULL));
    double x = fabs(pixel[0] / 150 - 1), y = fabs(pixel[1] / 100 - 1);
    assert_true(x < 0.93 && y < 0.93);
    max = fmax(max, fmax(x, y));
  }
  assert_true(max > 0.8);
  end_load(&l);
  free(g);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(containers),     cmocka_unit_test(searched), cmocka_unit_test(arrays),
      cmocka_unit_test(modes),          cmocka_unit_test(poses),    cmocka_unit_test(animation),
      cmocka_unit_test(morph_and_skin), cmocka_unit_test(tangents), cmocka_unit_test(cameras),
      cmocka_unit_test(completion),
  };
  return cmocka_run_group_tests(tests, set_up, tear_down);
}
