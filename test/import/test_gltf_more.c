/* test/import/test_gltf_more.c: glTF beyond the core: a shutter interval, several scenes,
 * variants, compressed buffers, WebP beside other images, image-based lights, textures with
 * their own uv sets and transforms, unsupported extensions. */
#include <meshoptimizer.h>

#include "image/image.h"
#include "import/gltf_load.h"
#include "math/octahedral.h"
#include "velo/light.h"
#include "velo/material.h"
#include "velo/shape.h"
#include "velo/texture.h"

static void is_near(double a, double b, double max) {
  if (!(fabs(a - b) <= max))
    fail_msg("%.9g is not %.9g", a, b);
}

/* ---- time -------------------------------------------------------------------------------- */

static void motion(void **state) {
  (void)state;
  Gltf *g = new_square();
  const float times[] = {0, 4}, places[] = {0, 0, 0, 8, 0, 0}, weights[] = {0, 1};
  const float up[] = {0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 1}; /* of the last vertex alone */
  gltf_floats(g, times, 2, "SCALAR", 1);                   /* 2 */
  gltf_floats(g, places, 2, "VEC3", 3);                    /* 3 */
  gltf_floats(g, weights, 2, "SCALAR", 1);                 /* 4 */
  gltf_floats(g, up, 4, "VEC3", 3);                        /* 5 */
  vlLoadDef def = vl_default_load_def();
  def.time = 1;
  def.time_close = 2;
  const char *moved = SCENE
      "\"nodes\":[{\"children\":[1,2]},{\"mesh\":0},{\"camera\":0}],"
      "\"cameras\":[{\"type\":\"perspective\",\"perspective\":{\"yfov\":1,\"znear\":0.1}}],"
      "\"animations\":[{\"samplers\":[{\"input\":2,\"output\":3}],\"channels\":[{\"sampler\":0,"
      "\"target\":{\"node\":0,"
      "\"path\":\"translation\"}}]}]," SQUARE_MESH;
  Loaded l;
  fine_with(&l, g, moved, &def);
  assert_int_equal(l.scene->instances.count, 1);
  const vlSceneInstance *instance = &l.scene->instances.items[0];
  assert_true(instance->keys >= 2);
  uint32_t last = instance->keys - 1;
  is_near(instance->times[0], 0, 0);
  is_near(instance->times[last], 1, 1e-12);
  is_near(instance->poses[3], 2, 1e-6);
  is_near(instance->poses[16 * last + 3], 4, 1e-6);
  const vlCameraDef *camera = &l.scene->defs.camera;
  assert_true(camera->has_matrix_close);
  is_near(camera->world_from_camera[3], 2, 1e-6);
  is_near(camera->world_from_camera_close[3], 4, 1e-6);
  is_near(camera->shutter_open, 0, 0);
  is_near(camera->shutter_close, 1, 1e-12);
  end_load(&l);
  def.time_close = VL_UNSET; /* one moment: all is still */
  fine_with(&l, g, moved, &def);
  assert_int_equal(l.scene->instances.count, 0);
  assert_false(l.scene->defs.camera.has_matrix_close);
  end_load(&l);
  def.time_close = 0.5;
  load(&l, g, moved, &def);
  assert_int_equal(l.result, VL_ERROR_SCENE);
  end_load(&l);
  /* what deforms has its vertices at both ends */
  def.time_close = 3;
  fine_with(
      &l, g,
      SCENE
      "\"nodes\":[{\"mesh\":0}],\"animations\":[{\"samplers\":[{\"input\":2,\"output\":4}],"
      "\"channels\":[{\"sampler\":0,\"target\":{\"node\":0,\"path\":\"weights\"}}]}],"
      "\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0},\"indices\":1,"
      "\"targets\":[{\"POSITION\":5}]}]}]",
      &def);
  const vlShapeDef *s = &l.scene->shapes.items[0];
  assert_non_null(s->positions_close);
  is_near((double)s->positions[11], 0.25, 1e-6);
  is_near((double)s->positions_close[11], 0.75, 1e-6);
  is_near(s->times[1], 2, 1e-12);
  end_load(&l);
  free(g);
}

/* ---- scenes ------------------------------------------------------------------------------ */

static void scenes(void **state) {
  (void)state;
  Gltf *g = new_square();
  const char *rest =
      "\"scene\":1,\"scenes\":[{\"name\":\"the "
      "\\\"first\\\"\",\"nodes\":[0]},{\"nodes\":[0,1]}],"
      "\"nodes\":[{\"mesh\":0},{\"mesh\":0,\"translation\":[3,0,0]}]," SQUARE_MESH;
  static const struct {
    const char *name;
    size_t instances;
  } cases[] = {{NULL, 2}, {"the \"first\"", 0}, {"0", 0}, {"1", 2}};
  Loaded l;
  vlLoadDef def = vl_default_load_def();
  for (size_t i = 0; i < 4; i++) {
    def.scene = cases[i].name;
    fine_with(&l, g, rest, &def);
    assert_int_equal(l.scene->instances.count, cases[i].instances);
    end_load(&l);
  }
  def.scene = "2";
  load(&l, g, rest, &def);
  assert_string_equal(l.error.message, "there is no scene \"2\" (2 are there: the \"first\")");
  end_load(&l);
  free(g);
}

/* ---- extensions -------------------------------------------------------------------------- */

static void put_packed(Gltf *g, int offset, size_t size, const char *mode, size_t count,
                       size_t stride) {
  size_t n = strlen(g->views);
  snprintf(g->views + n, sizeof g->views - n,
           "%s{\"buffer\":0,\"byteLength\":%zu,\"extensions\":{\"EXT_meshopt_compression\":{"
           "\"buffer\":"
           "0,"
           "\"byteOffset\":%d,\"byteLength\":%zu,\"byteStride\":%zu,\"count\":%zu,\"mode\":\"%"
           "s\"}}}",
           n ? "," : "", count * stride, offset, size, stride, count, mode);
  g->view_count++;
}

static void packed(void **state) {
  (void)state;
  unsigned char vertices[1000], faces[1000];
  const unsigned indices[6] = {0, 1, 2, 2, 1, 3};
  size_t a = meshopt_encodeVertexBuffer(vertices, sizeof vertices, square, 4, 12);
  size_t b = meshopt_encodeIndexBuffer(faces, sizeof faces, indices, 6);
  assert_true(a > 0 && b > 0);
  const char *rest = SCENE
      "\"extensionsUsed\":[\"EXT_meshopt_compression\"],"
      "\"extensionsRequired\":[\"EXT_meshopt_compression\"],\"nodes\":[{\"mesh\":0}]"
      "," SQUARE_MESH;
  for (int damage = 0; damage < 3; damage++) {
    Gltf *g = calloc(1, sizeof *g);
    memcpy(g->bytes, vertices, a);
    memcpy(g->bytes + 500, faces, b);
    g->size = 1000;
    put_packed(g, 0, damage == 1 ? a / 2 : a, "ATTRIBUTES", damage == 2 ? 100000000 : 4, 12);
    put_packed(g, 500, b, "TRIANGLES", 6, 2);
    gltf_accessor(g, 0, 5126, 4, "VEC3", NULL);
    gltf_accessor(g, 1, 5123, 6, "SCALAR", NULL);
    Loaded l;
    load(&l, g, rest, NULL);
    if (damage) {
      assert_int_equal(l.result, VL_ERROR_SCENE);
      assert_non_null(strstr(l.error.message, damage == 1
                                                  ? "its bytes are no meshopt ATTRIBUTES"
                                                  : "cannot hold"));
    } else {
      if (l.result != VL_OK)
        print_message("%s\n", l.error.message);
      assert_int_equal(l.result, VL_OK);
      assert_memory_equal(l.scene->shapes.items[0].positions, square, sizeof square);
      assert_int_equal(l.scene->shapes.items[0].faces, 2);
    }
    end_load(&l);
    free(g);
  }
}

static void lacking(void **state) {
  (void)state;
  Gltf *g = new_square();
  static const char *const names[] = {"KHR_materials_subsurface", "KHR_texture_basisu"};
  Loaded l;
  char rest[400];
  for (int i = 0; i < 2; i++)
    for (int required = 0; required < 2; required++) {
      snprintf(rest, sizeof rest,
               SCENE
               "\"extensions%s\":[\"%s\",\"KHR_xmp_json_ld\"],\"nodes\":[{\"mesh\":0}],%s",
               required ? "Required" : "Used", names[i], SQUARE_MESH);
      load(&l, g, rest, NULL);
      assert_int_equal(l.result, required ? VL_ERROR_UNSUPPORTED : VL_OK);
      const char *said = required ? l.error.message : strstr(l.log, "warning");
      assert_non_null(said);
      assert_non_null(strstr(said, names[i]));
      assert_null(required ? NULL : strstr(said + 7, "warning")); /* one */
      end_load(&l);
    }
  free(g);
}

/* ---- images ------------------------------------------------------------------------------ */

/* Each texture its own uv set and transform, and WebP before the other image. */
static void textures(void **state) {
  (void)state;
  Gltf *g = new_square();
  Loaded l;
  static const char *const images[] = {"a.png", "a.webp"}; /* are looked for, but not read */
  for (int i = 0; i < 2; i++) {
    FILE *f = fopen(in_folder(images[i]), "w");
    assert_non_null(f);
    fclose(f);
  }
  fine_with(
      &l, g,
      SCENE
      "\"extensionsUsed\":[\"KHR_texture_transform\",\"EXT_texture_webp\"],\"nodes\":[{"
      "\"mesh\":0}],"
      "\"images\":[{\"uri\":\"a.png\"},{\"uri\":\"a.webp\"}],"
      "\"textures\":[{\"source\":0,\"extensions\":{\"EXT_texture_webp\":{\"source\":1}}},{"
      "\"source\":0}],"
      "\"materials\":[{\"pbrMetallicRoughness\":{\"baseColorTexture\":{\"index\":0,"
      "\"texCoord\":1,\"extensions\":{"
      "\"KHR_texture_transform\":{\"offset\":[0.5,0],\"scale\":[2,2],\"texCoord\":2}}},"
      "\"metallicRoughnessTexture\":{\"index\":1,\"texCoord\":1}}}],"
      "\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0},\"indices\":1,"
      "\"material\":0}]}]",
      NULL);
  const vlMaterialDef *m =
      &l.scene->materials.items[l.scene->shapes.items[0].material.index - 1];
  const vlTextureDef *color = &l.scene->textures.items[m->reflectance.texture.index - 1],
                     *rough =
                         &l.scene->textures.items[m->principled.roughness.texture.index - 1];
  assert_non_null(strstr(color->path, "a.webp"));
  assert_int_equal(color->uv_set, 2);
  assert_true(color->st_from_uv_given);
  is_near((double)color->st_from_uv[0], 2, 1e-6);
  is_near((double)color->st_from_uv[2], 0.5, 1e-6);
  assert_non_null(strstr(rough->path, "a.png"));
  assert_int_equal(rough->uv_set, 1);
  assert_false(rough->st_from_uv_given);
  assert_int_equal(rough->channel, 1);
  end_load(&l);
  free(g);
}

static void surroundings(void **state) {
  (void)state;
  Gltf *g = new_square();
  Loaded l;
  start_load(&l);
  /* RGBD: 1 / 0.2 = 5 from above, elsewhere as many sixths as the face */
  for (int face = 0; face < 6; face++) {
    vlImageDef def = vl_default_image_def(4, 4, 4);
    def.type = VL_PIXEL_U8;
    def.encoding = VL_ENCODING_SRGB;
    vlImage *image;
    assert_int_equal(vl_image_create(l.context, &def, &image), VL_OK);
    uint8_t *p = vl_image_pixels(image);
    for (int i = 0; i < 16; i++) {
      p[4 * i] = p[4 * i + 1] = p[4 * i + 2] = 255;
      p[4 * i + 3] = face == 2 ? 51 : 255;
    }
    for (int i = 0; i < 16 && face == 0; i++)
      p[4 * i + 1] = p[4 * i + 2] = 0;
    for (int i = 8; i < 16 && face == 4; i++) /* its lower half is red */
      p[4 * i + 1] = p[4 * i + 2] = 0;
    char name[20];
    snprintf(name, sizeof name, "%d.png", face);
    assert_int_equal(vl_image_write(image, in_folder(name), NULL, NULL), VL_OK);
    vl_image_destroy(image);
  }
  end_load(&l);
  fine_with(
      &l, g,
      "\"scenes\":[{\"nodes\":[0],\"extensions\":{\"EXT_lights_image_based\":{\"light\":0}}}],"
      "\"extensionsUsed\":[\"EXT_lights_image_based\"],\"nodes\":[{\"mesh\":0}],"
      "\"images\":[{\"uri\":\"0.png\"},{\"uri\":\"1.png\"},{\"uri\":\"2.png\"},{\"uri\":\"3."
      "png\"},"
      "{\"uri\":\"4.png\"},{\"uri\":\"5.png\"}],\"extensions\":{\"EXT_lights_image_based\":{"
      "\"lights\":[{"
      "\"intensity\":2,\"rotation\":[0,0,0.70710678,0.70710678],\"specularImageSize\":4,"
      "\"specularImages\":[[0,1,2,3,4,5]]}]}}," SQUARE_MESH,
      NULL);
  assert_int_equal(l.scene->lights.count, 1);
  assert_false(l.scene->defs.light_missing);
  const vlLightDef *light = &l.scene->lights.items[0];
  is_near((double)light->scale, 2, 0);
  is_near(light->world_from_light[1], -1, 1e-6); /* its up is the world's -x */
  const struct {
    vlVec3 from;
    float red, green, slack;
  } looks[] = {{{0, 1, 0}, 5, 5, 0.01f},
               {{0, -1, 0}, 1, 1, 0.01f},
               {{1, 0, 0}, 1, 0, 0.01f},
               {{-1, 0, 0}, 1, 1, 0.01f},
               /* between the second row and the third */
               {{0, 0.1f, 1}, 1, 0.75f, 0.1f},
               {{0, -0.1f, 1}, 1, 0.25f, 0.1f}};
  uint32_t side = vl_image_width(light->image);
  for (size_t i = 0; i < sizeof looks / sizeof *looks; i++) {
    vlVec2 at = vl_octahedral_encode(vl_normalize(looks[i].from));
    uint32_t x = (uint32_t)fminf(at.x * (float)side, (float)side - 1),
             y = (uint32_t)fminf(at.y * (float)side, (float)side - 1);
    is_near((double)vl_image_get(light->image, x, y, 0), (double)looks[i].red, 0.01);
    is_near((double)vl_image_get(light->image, x, y, 1), (double)looks[i].green,
            (double)looks[i].slack);
  }
  end_load(&l);
  free(g);
}

static void lamps(void **state) {
  (void)state;
  Gltf *g = new_square();
  Loaded l;
  fine_with(&l, g,
            SCENE
            "\"extensionsUsed\":[\"KHR_lights_punctual\"],"
            "\"nodes\":[{\"extensions\":{\"KHR_lights_punctual\":{\"light\":0}}}],"
            "\"extensions\":{\"KHR_lights_punctual\":{\"lights\":[{\"type\":\"spot\","
            "\"intensity\":3,\"spot\":{\"innerConeAngle\":0.2,\"outerConeAngle\":0.5}}]}}",
            NULL);
  const vlLightDef *light = &l.scene->lights.items[0];
  assert_true(light->cone_squared);
  is_near((double)light->cone_angle, 0.5, 1e-6);
  is_near((double)light->cone_delta, 0.3, 1e-6);
  end_load(&l);
  free(g);
}

static void variants(void **state) {
  (void)state;
  Gltf *g = new_square();
  const char *rest = SCENE
      "\"extensionsUsed\":[\"KHR_materials_variants\",\"EXT_unheard_of\"],"
      "\"extensions\":{\"KHR_materials_variants\":{\"variants\":[{\"name\":\"red\"},"
      "{\"name\":\"blue\"}]}},\"materials\":[{\"name\":\"own\"},"
      "{\"name\":\"sea\",\"doubleSided\":true}],\"nodes\":[{\"mesh\":0}],"
      "\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0},"
      "\"indices\":1,\"material\":0,"
      "\"extensions\":{\"KHR_materials_variants\":{\"mappings\":[{\"material\":1,"
      "\"variants\":[1]}]}}}]}]";
  static const char *const names[] = {NULL, "red", "blue"}, *const expected[] = {"own", "own",
                                                                                 "sea"};
  for (int i = 0; i < 3; i++) {
    Loaded l;
    vlLoadDef def = vl_default_load_def();
    def.variant = names[i];
    load(&l, g, rest, &def);
    assert_int_equal(l.result, VL_OK);
    assert_string_equal(l.scene->materials.items[shape(&l, 0)->material.index - 1].name,
                        expected[i]);
    assert_int_equal(shape(&l, 0)->one_sided, i < 2);
    const char *first = strstr(l.log, "EXT_unheard_… is ignored");
    assert_non_null(first);
    assert_null(strstr(first + 1, "EXT_unheard_…")); /* once */
    end_load(&l);
  }
  Loaded l;
  vlLoadDef def = vl_default_load_def();
  def.variant = "green";
  load(&l, g, rest, &def);
  assert_string_equal(l.error.message,
                      "there is no variant \"green\" (2 are there: red, blue)");
  end_load(&l);
  free(g);
}

/* A ball of 224 faces, compressed. Positions have 12 bits, normals 8. Builds without libdraco
 * name it. */
static void draco(void **state) {
  (void)state;
  char path[500];
  snprintf(path, sizeof path, "%s/test/fuzz/corpus/gltf/draco.glb",
           getenv("VELO_SOURCE_DIR") ? getenv("VELO_SOURCE_DIR") : ".");
  Loaded l;
  start_load(&l);
  l.result = vl_scene_load(l.scene, path, NULL, &l.error);
  if (l.result == VL_ERROR_UNSUPPORTED) {
    assert_non_null(strstr(l.error.message, "without libdraco"));
    end_load(&l);
    skip();
  }
  if (l.result != VL_OK)
    fail_msg("%s", l.error.message);
  assert_int_equal(l.scene->shapes.count, 1);
  const vlShapeDef *d = &l.scene->shapes.items[0];
  assert_int_equal(d->faces, 224);
  assert_true(d->normals && d->uvs);
  for (uint32_t i = 0; i < d->vertices; i++) {
    double length = 0, along = 0;
    for (int k = 0; k < 3; k++) {
      double p = d->positions[3 * i + (uint32_t)k], n = d->normals[3 * i + (uint32_t)k];
      length += p * p;
      along += p * n;
    }
    assert_true(fabs(sqrt(length) - 1) < 2e-3 && along > 0.99);
  }
  end_load(&l);
}

/* Points are sized by all that is drawn, whatever the size of their own mesh and the scale of
 * its node; or by the file's camera. */
static void points_by_the_image(void **state) {
  (void)state;
  static const char *const cameras[] = {
      "", "", "{\"type\":\"perspective\",\"perspective\":{\"yfov\":0.9,\"znear\":1}}",
      "{\"type\":\"orthographic\",\"orthographic\":{\"xmag\":9,\"ymag\":9,\"znear\":1,"
      "\"zfar\":200}}"};
  double extents[4];
  for (int k = 0; k < 4; k++) {
    bool scaled = k == 1;
    Gltf *g = calloc(1, sizeof *g);
    const float p[3] = {0, 0, 0}, q[6] = {-50, 0, 0, 50, 0, 0};
    gltf_accessor(g, gltf_view(g, p, sizeof p, 0), 5126, 1, "VEC3",
                  ",\"min\":[0,0,0],\"max\":[0,0,0]");
    gltf_accessor(g, gltf_view(g, q, sizeof q, 0), 5126, 2, "VEC3",
                  ",\"min\":[-50,0,0],\"max\":[50,0,0]");
    Loaded l;
    char rest[900];
    snprintf(
        rest, sizeof rest,
        "\"scene\":0,\"scenes\":[{\"nodes\":[0,1%s]}],\"nodes\":[{\"mesh\":0,\"scale\":[%g,%g,"
        "%g]},{\"mesh\":1}"
        "%s],%s%s%s"
        "\"meshes\":[{\"primitives\":[{\"mode\":0,"
        "\"attributes\":{\"POSITION\":0}}]},{\"primitives\":[{\"mode\":1,\"attributes\":{"
        "\"POSITION\":1}}]}]",
        *cameras[k] ? ",2" : "", scaled ? 4.0 : 1.0, scaled ? 4.0 : 1.0, scaled ? 4.0 : 1.0,
        *cameras[k] ? ",{\"camera\":0,\"translation\":[0,0,100]}" : "",
        *cameras[k] ? "\"cameras\":[" : "", cameras[k], *cameras[k] ? "]," : "");
    load(&l, g, rest, NULL);
    if (l.result != VL_OK)
      fail_msg("%s", l.error.message);
    double low[3], high[3];
    l.scene->shapes.count = 1; /* the points alone */
    vl_scene_bounds(l.scene, low, high);
    extents[k] = high[0] - low[0];
    end_load(&l);
    free(g);
  }
  assert_true(fabs(extents[0] - 0.3) < 0.02 && fabs(extents[1] - extents[0]) < 1e-3);
  is_near(extents[2], 2 * 200 * tan(0.45) / 720, 0.02);
  is_near(extents[3], 2 * 18.0 / 720, 0.004);
}

/* A buffer without uri is legal where nothing reads it. */
static void no_uri(void **state) {
  (void)state;
  Gltf *g = new_square();
  Loaded l;
  load(&l, g, SCENE "\"nodes\":[{\"mesh\":0}]," SQUARE_MESH, NULL);
  assert_int_equal(l.result, VL_OK);
  end_load(&l);
  free(g);
  for (int read = 0; read < 2; read++) {
    char path[] = "/tmp/velo-no-uri-XXXXXX.gltf";
    int file = mkstemps(path, 5);
    assert_true(file >= 0);
    FILE *f = fdopen(file, "w");
    fprintf(f,
            "{\"asset\":{\"version\":\"2.0\"},\"buffers\":[{\"byteLength\":36}],"
            "\"bufferViews\":[{\"buffer\":0,\"byteLength\":36}],"
            "\"accessors\":[{\"bufferView\":0,\"componentType\":5126,\"count\":3,"
            "\"type\":\"VEC3\"}],\"meshes\":[{\"primitives\":[{\"attributes\":{"
            "\"POSITION\":0}}]}],\"nodes\":[{%s}],\"scenes\":[{\"nodes\":[0]}],\"scene\":0}",
            read ? "\"mesh\":0" : "");
    fclose(f);
    start_load(&l);
    l.result = vl_scene_load(l.scene, path, NULL, &l.error);
    unlink(path);
    assert_int_equal(l.result, read ? VL_ERROR_SCENE : VL_OK);
    if (read)
      assert_non_null(strstr(l.error.message, "holds nothing that velo can read"));
    end_load(&l);
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(variants), cmocka_unit_test(motion),
      cmocka_unit_test(scenes),   cmocka_unit_test(packed),
      cmocka_unit_test(draco),    cmocka_unit_test(points_by_the_image),
      cmocka_unit_test(no_uri),   cmocka_unit_test(lacking),
      cmocka_unit_test(textures), cmocka_unit_test(surroundings),
      cmocka_unit_test(lamps),
  };
  return cmocka_run_group_tests(tests, set_up, tear_down);
}
