/* test/import/test_gltf_damage.c: damaged glTF files give a clear error or an image, without
 * crashes, hangs or excessive memory. A file that uses much of the format is truncated and has
 * bytes and numbers changed, by a fixed seed. */
#include "import/gltf_writer.h"
#include "import/load.h"

#include "failing_allocator.h"
#include "math/hash.h"
#include "velo/render.h"

enum { ROUNDS = 400 };

/* A 2 x 2 image, as PNG. */
static const uint8_t png[] = {
    0x89, 0x50, 0x4e, 0x47, 0x0d, 0x0a, 0x1a, 0x0a, 0x00, 0x00, 0x00, 0x0d, 0x49,
    0x48, 0x44, 0x52, 0x00, 0x00, 0x00, 0x02, 0x00, 0x00, 0x00, 0x02, 0x08, 0x06,
    0x00, 0x00, 0x00, 0x72, 0xb6, 0x0d, 0x24, 0x00, 0x00, 0x00, 0x15, 0x49, 0x44,
    0x41, 0x54, 0x78, 0xda, 0x63, 0xf8, 0xcf, 0xc0, 0xf0, 0x1f, 0x08, 0x1b, 0x18,
    0x80, 0x34, 0x08, 0x38, 0x00, 0x00, 0x44, 0x13, 0x08, 0xb9, 0xdc, 0x3d, 0x03,
    0xe2, 0x00, 0x00, 0x00, 0x00, 0x49, 0x45, 0x4e, 0x44, 0xae, 0x42, 0x60, 0x82};

static const char rest[] =
    "\"scene\":0,\"scenes\":[{\"nodes\":[0,2,3,4,5,6]}],"
    "\"extensionsUsed\":[\"KHR_lights_punctual\",\"EXT_mesh_gpu_instancing\","
    "\"KHR_materials_clearcoat\"],"
    "\"extensions\":{\"KHR_lights_punctual\":{\"lights\":[{\"type\":\"spot\","
    "\"intensity\":5,\"color\":[1,0.5,0.2],"
    "\"spot\":{\"innerConeAngle\":0.2,\"outerConeAngle\":0.5}}]}},"
    "\"nodes\":[{\"mesh\":0,\"rotation\":[0,0.1,0,0.99],\"children\":[1]},"
    "{\"mesh\":1,\"scale\":[0.5,-0.5,0.5],\"translation\":[1,0,0]},"
    "{\"mesh\":0,\"matrix\":[1,0,0,0,0,1,0,0,0,0,1,0,-2,0,0,1]},{\"mesh\":2,\"skin\":0},"
    "{\"camera\":0,\"translation\":[0,0,6]},"
    "{\"extensions\":{\"KHR_lights_punctual\":{\"light\":0}},\"translation\":[0,3,3]},"
    "{\"mesh\":1,\"extensions\":{\"EXT_mesh_gpu_instancing\":{\"attributes\":{"
    "\"TRANSLATION\":5}}}}],"
    "\"cameras\":[{\"type\":\"perspective\",\"perspective\":{\"yfov\":0.7,"
    "\"aspectRatio\":1.5,\"znear\":0.1}}],\"skins\":[{\"joints\":[1,2],"
    "\"inverseBindMatrices\":8}],"
    "\"animations\":[{\"samplers\":[{\"input\":9,\"output\":10,"
    "\"interpolation\":\"LINEAR\"}],"
    "\"channels\":[{\"sampler\":0,\"target\":{\"node\":1,\"path\":\"translation\"}}]}],"
    "\"images\":[{\"bufferView\":11,\"mimeType\":\"image/png\"}],"
    "\"samplers\":[{\"wrapS\":33648,\"magFilter\":9728}],"
    "\"textures\":[{\"source\":0,\"sampler\":0}],"
    "\"materials\":[{\"pbrMetallicRoughness\":{\"baseColorTexture\":{\"index\":0},"
    "\"metallicFactor\":0.5},\"normalTexture\":{\"index\":0,\"scale\":0.7},"
    "\"alphaMode\":\"MASK\",\"alphaCutoff\":0.3},{\"emissiveFactor\":[1,2,3],"
    "\"emissiveTexture\":{\"index\":0},"
    "\"alphaMode\":\"BLEND\",\"doubleSided\":true,"
    "\"extensions\":{\"KHR_materials_clearcoat\":{\"clearcoatFactor\":1,"
    "\"clearcoatTexture\":{\"index\":0}}}}],\"meshes\":[{\"weights\":[0.5],"
    "\"primitives\":[{\"attributes\":{\"POSITION\":0,\"TEXCOORD_0\":2,\"NORMAL\":4},"
    "\"indices\":1,\"material\":0,\"targets\":[{\"POSITION\":4}]}]},"
    "{\"primitives\":[{\"attributes\":{\"POSITION\":0,\"COLOR_0\":3},"
    "\"mode\":5,\"material\":1},{\"attributes\":{\"POSITION\":0},\"mode\":3}]},"
    "{\"primitives\":[{\"attributes\":{\"POSITION\":0,\"JOINTS_0\":6,\"WEIGHTS_0\":7},"
    "\"indices\":1}]}]";

static uint8_t *new_file(size_t *size) {
  Gltf *g = calloc(1, sizeof *g);
  const float square[12] = {0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0},
              uvs[8] = {0, 0, 2, 0, 0, 2, 2, 2};
  const float up[12] = {0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1}, places[6] = {0, 2, 0, 0, -2, 0};
  const float weights[16] = {1, 0, 0, 0, 0.5f, 0.5f, 0, 0, 0, 1, 0, 0, 1, 0, 0, 0};
  const float bind[32] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1,
                          1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
  const float times[2] = {0, 1}, moves[6] = {0, 0, 0, 1, 1, 1};
  const uint16_t faces[6] = {0, 1, 2, 2, 1, 3};
  const uint8_t colors[16] = {255, 0, 0,   255, 0,   255, 0,   255,
                              0,   0, 255, 128, 255, 255, 255, 255};
  const uint8_t joints[16] = {0, 0, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 1, 0, 0, 0};
  gltf_floats(g, square, 4, "VEC3", 3); /* 0 */
  gltf_shorts(g, faces, 6);             /* 1 */
  gltf_floats(g, uvs, 4, "VEC2", 2);    /* 2 */
  /* 3 */
  gltf_accessor(g, gltf_view(g, colors, 16, 0), 5121, 4, "VEC4", ",\"normalized\":true");
  gltf_floats(g, up, 4, "VEC3", 3);                                     /* 4 */
  gltf_floats(g, places, 2, "VEC3", 3);                                 /* 5 */
  gltf_accessor(g, gltf_view(g, joints, 16, 0), 5121, 4, "VEC4", NULL); /* 6 */
  gltf_floats(g, weights, 4, "VEC4", 4);                                /* 7 */
  gltf_floats(g, bind, 2, "MAT4", 16);                                  /* 8 */
  gltf_floats(g, times, 2, "SCALAR", 1);                                /* 9 */
  gltf_floats(g, moves, 2, "VEC3", 3);                                  /* 10 */
  gltf_view(g, png, sizeof png, 0);                                     /* 11 */
  uint8_t *file = gltf_binary(g, rest, size);
  free(g);
  return file;
}

static char path[64];

/* An error, or an image of finite numbers. */
static vlResult try_file(const uint8_t *data, size_t size, char message[512]) {
  gltf_file(path, data, size);
  Loaded l;
  start_load(&l);
  vlLoadDef load = vl_default_load_def();
  load.time = 0.5;
  vlCompleteDef complete = vl_default_complete_def();
  complete.environment = VL_ENVIRONMENT_WHITE;
  complete.width = complete.height = 8;
  vlWorld *world = NULL;
  vlFilm *film = NULL;
  vlImage *image = NULL;
  vlResult r = vl_scene_load(l.scene, path, &load, &l.error);
  if (r == VL_OK)
    r = vl_scene_complete(l.scene, &complete, &l.error);
  if (r == VL_OK)
    r = vl_world_build(l.scene, NULL, &world, &l.error);
  vlCamera camera, small;
  if (r == VL_OK) {
    vlCameraDef def = l.scene->defs.camera;
    def.width = l.scene->defs.film.width;
    def.height = l.scene->defs.film.height;
    r = vl_camera_make(&def, &camera, NULL, &l.error);
  }
  if (r == VL_OK)
    r = vl_camera_resize(&camera, 8, 8, &small);
  if (r == VL_OK) {
    vlFilmDef def = vl_default_film_def(8, 8);
    r = vl_film_create(l.context, &def, &film);
    vlRenderDef render = vl_default_render_def();
    render.spp = 1;
    if (r == VL_OK)
      r = vl_render(world, &small, film, &render, NULL, &l.error);
    if (r == VL_OK)
      r = vl_film_develop(film, NULL, &image);
  }
  if (r != VL_OK) {
    assert_true(r == VL_ERROR_SCENE || r == VL_ERROR_MISSING || r == VL_ERROR_UNSUPPORTED ||
                r == VL_ERROR_ARGUMENT);
    assert_true(strlen(l.error.message) > 5);
    snprintf(message, 512, "%s", l.error.message);
  }
  size_t peak;
  vl_context_memory(l.context, &peak);
  assert_true(peak < 100u << 20);
  vl_image_destroy(image);
  vl_film_destroy(film);
  vl_world_destroy(world);
  end_load(&l);
  return r;
}

static void replace_number(uint8_t *data, size_t size, uint32_t pick) {
  static const char *const odd[] = {
      "-1",    "0",     "1e9",   "4294967295", "1e39", "99999999999999999999",
      "0.5",   "7",     "\"x\"", "null",       "[]",   "{}",
      "1e-39", "65536", "3",     "254"};
  size_t at = 20 + pick % (size > 40 ? size - 40 : 1);
  while (at < size && (data[at] < '0' || data[at] > '9'))
    at++;
  size_t end = at;
  while (end < size && strchr("0123456789.eE-+", data[end]) && data[end])
    end++;
  const char *text = odd[vl_hash(pick) % (sizeof odd / sizeof *odd)];
  size_t length = strlen(text);
  if (end >= size || end - at < 1)
    return;
  /* keeps the length of the chunk: shorter words are padded with blanks, longer words are
   * cut */
  for (size_t i = at; i < end; i++)
    data[i] = i - at < length ? (uint8_t)text[i - at] : ' ';
}

static void damage(void **state) {
  (void)state;
  size_t size;
  uint8_t *file = new_file(&size), *copy = malloc(size);
  char message[512];
  snprintf(path, sizeof path, "/tmp/velo-damage-%d.glb", (int)getpid());
  vlResult r = try_file(file, size, message);
  if (r != VL_OK)
    print_message("%s\n", message);
  assert_int_equal(r, VL_OK);
  int good = 0, refused = 0;
  for (uint32_t k = 0; k < ROUNDS; k++) {
    memcpy(copy, file, size);
    size_t length = size;
    uint32_t h = vl_hash(k + 1);
    switch (k % 4) {
      case 0:
        length = h % size;
        break;
      case 1:
        for (uint32_t i = 0; i < 1 + h % 8; i++)
          copy[vl_hash2(h, i) % size] ^= (uint8_t)(1u << (vl_hash2(i, h) & 7));
        break;
      case 2:
        replace_number(copy, size, h);
        break;
      default: /* numbers in the arrays */
        for (uint32_t i = 0; i < 4; i++)
          copy[size - 1 - vl_hash2(h, i) % 700] = (uint8_t)vl_hash2(i, h);
        break;
    }
    if (k % 4 == 0 && length >= 12)
      memcpy(copy + 8, &(uint32_t){(uint32_t)length}, 4); /* the header states the new length */
    if (try_file(copy, length, message) == VL_OK)
      good++;
    else
      refused++;
  }
  print_message("%d images, %d errors\n", good, refused);
  assert_true(good > ROUNDS / 10 && refused > ROUNDS / 4);
  unlink(path);
  free(copy);
  free(file);
}

static vlResult load_whole(vlContext *context, void *user) {
  vlScene *scene;
  vlResult result = vl_scene_create(context, &scene);
  if (result != VL_OK)
    return result;
  vlError error;
  vlLoadDef load = vl_default_load_def();
  load.time = 0.5;
  vlCompleteDef complete = vl_default_complete_def();
  complete.environment = VL_ENVIRONMENT_WHITE;
  complete.ground = complete.reframe = true;
  result = vl_scene_load(scene, user, &load, &error);
  if (result == VL_OK)
    result = vl_scene_complete(scene, &complete, &error);
  if (result != VL_OK && result != VL_ERROR_MEMORY)
    print_message("%s: %s\n", error.file, error.message);
  vl_scene_destroy(scene);
  return result;
}

/* Memory runs out at the n-th call, for every n. */
static void memory(void **state) {
  (void)state;
  size_t size;
  uint8_t *file = new_file(&size);
  snprintf(path, sizeof path, "/tmp/velo-gltf-memory-%d.glb", (int)getpid());
  gltf_file(path, file, size);
  fail_everywhere(load_whole, path, 60);
  unlink(path);
  free(file);
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(damage), cmocka_unit_test(memory)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
