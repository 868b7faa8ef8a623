/* test/import/test_gltf_parts.c: parts of glTF files, each against the text of the
 * specification: vertex colours of all types, meshopt's filters, animation pointers, the six
 * faces of cube maps, lights, emission, variants. */
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

/* ---- colours ----------------------------------------------------------------------------- */

/* COLOR_0: VEC3 or VEC4 of floats, normalised bytes or shorts; three are opaque. The colours
 * are linear. */
static void vertex_colors(void **state) {
  (void)state;
  static const float floats[16] = {1, 0.5f, 0.25f, 0.75f, 0, 1, 0, 0, 0, 0, 0, 1, 1, 1, 1, 1};
  uint8_t bytes[16], bytes3[16] = {0};
  uint16_t shorts[16], shorts3[16] = {0};
  float floats3[12];
  for (int i = 0; i < 16; i++) {
    bytes[i] = (uint8_t)(floats[i] * 255 + 0.5f);
    shorts[i] = (uint16_t)(floats[i] * 65535);
  }
  for (int i = 0; i < 4; i++)
    for (int c = 0; c < 3; c++) {
      floats3[3 * i + c] = floats[4 * i + c];
      bytes3[4 * i + c] = bytes[4 * i + c];
      shorts3[4 * i + c] = shorts[4 * i + c];
    }
  const struct {
    const void *data;
    size_t size;
    int stride, type;
    const char *shape;
  } cases[] = {
      {floats, sizeof floats, 0, 5126, "VEC4"}, {floats3, sizeof floats3, 0, 5126, "VEC3"},
      {bytes, sizeof bytes, 0, 5121, "VEC4"},   {bytes3, sizeof bytes3, 4, 5121, "VEC3"},
      {shorts, sizeof shorts, 0, 5123, "VEC4"}, {shorts3, sizeof shorts3, 8, 5123, "VEC3"}};
  for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
    Gltf *g = new_square();
    gltf_accessor(g, gltf_view(g, cases[i].data, cases[i].size, cases[i].stride), cases[i].type,
                  4, cases[i].shape, cases[i].type == 5126 ? NULL : ",\"normalized\":true");
    Loaded l;
    fine(
        &l, g,
        SCENE
        "\"nodes\":[{\"mesh\":0}],\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0,"
        "\"COLOR_0\":2},"
        "\"indices\":1}]}]");
    bool alpha = cases[i].shape[3] == '4';
    for (int k = 0; k < 16; k++)
      is_near((double)shape(&l, 0)->colors[k], k % 4 == 3 && !alpha ? 1 : (double)floats[k],
              0.003);
    end_load(&l);
    free(g);
  }
}

/* Coverage is the base colour's fourth number times the vertices': by BLEND, by MASK with its
 * cutoff, not in OPAQUE. */
static void vertex_alpha(void **state) {
  (void)state;
  static const char *const modes[] = {"OPAQUE", "BLEND", "MASK"};
  static const float colors[16] = {1, 1, 1, 0.5f, 1, 1, 1, 0.5f, 1, 1, 1, 0.5f, 1, 1, 1, 0.5f};
  Gltf *g = new_square();
  gltf_floats(g, colors, 4, "VEC4", 4);
  for (int i = 0; i < 3; i++) {
    char rest[600];
    snprintf(
        rest, sizeof rest,
        SCENE
        "\"nodes\":[{\"mesh\":0}],\"materials\":[{\"alphaMode\":\"%s\",\"alphaCutoff\":0.3,"
        "\"pbrMetallicRoughness\":{\"baseColorFactor\":[1,1,1,0.8]}}],\"meshes\":[{"
        "\"primitives\":[{"
        "\"attributes\":{\"POSITION\":0,\"COLOR_0\":2},\"indices\":1,\"material\":0}]}]",
        modes[i]);
    Loaded l;
    fine(&l, g, rest);
    vlFloatInput alpha = shape(&l, 0)->alpha;
    if (i == 0) {
      assert_int_equal(alpha.texture.index, 0);
      is_near((double)alpha.value, 1, 0);
    } else {
      const vlTextureDef *t = &l.scene->textures.items[alpha.texture.index - 1];
      assert_int_equal(t->kind, VL_TEXTURE_VERTEX_COLOR);
      assert_int_equal(t->channel, 3);
      is_near((double)t->tint[3], 0.8, 1e-6);
      assert_true(i == 1 ? t->cutoff != t->cutoff : t->cutoff == 0.3f);
    }
    end_load(&l);
  }
  free(g);
}

/* ---- packed numbers ---------------------------------------------------------------------- */

static void put_packed(Gltf *g, const unsigned char *data, size_t size, const char *filter,
                       size_t count, size_t stride) {
  /* its bytes; the view itself is replaced by the next */
  int view = gltf_view(g, data, size, 0);
  char *text = strrchr(g->views, '{');
  unsigned offset = 0;
  sscanf(strstr(text, "byteOffset") + 12, "%u", &offset);
  snprintf(text, sizeof g->views - (size_t)(text - g->views),
           "{\"buffer\":0,\"byteLength\":%zu,"
           "\"extensions\":{\"EXT_meshopt_compression\":{\"buffer\":0,\"byteOffset\":%u,"
           "\"byteLength\":%zu,\"byteStride\":%zu,\"count\":%zu,\"mode\":\"ATTRIBUTES\","
           "\"filter\":\"%s\"}}}",
           count * stride, offset, size, stride, count, filter);
  (void)view;
}

/* Normals by OCTAHEDRAL (bytes and shorts), positions by EXPONENTIAL, rotations of instances by
 * QUATERNION. */
static void filters(void **state) {
  (void)state;
  static const float normals[16] = {0, 0,     1,     0, 0.6f, 0, 0.8f, 0,
                                    0, -0.6f, -0.8f, 0, 1,    0, 0,    0};
  static const float places[12] = {0, 0, 0, 1.5f, 0, 0, 0, 2.25f, 0, 1.5f, 2.25f, -300};
  static const float turns[16] = {0,    0,    0,    1,    0, 0.70710678f, 0, 0.70710678f,
                                  0.5f, 0.5f, 0.5f, 0.5f, 0, -1,          0, 0};
  for (int wide = 0; wide < 2; wide++) {
    unsigned char raw[64], packed[400];
    size_t stride = wide ? 8 : 4;
    Gltf *g = calloc(1, sizeof *g);
    meshopt_encodeFilterExp(raw, 4, 12, 20, places);
    size_t n = meshopt_encodeVertexBuffer(packed, sizeof packed, raw, 4, 12);
    put_packed(g, packed, n, "EXPONENTIAL", 4, 12);
    gltf_accessor(g, 0, 5126, 4, "VEC3", NULL);
    meshopt_encodeFilterOct(raw, 4, stride, wide ? 16 : 8, normals);
    n = meshopt_encodeVertexBuffer(packed, sizeof packed, raw, 4, stride);
    put_packed(g, packed, n, "OCTAHEDRAL", 4, stride);
    gltf_accessor(g, 1, wide ? 5122 : 5120, 4, "VEC3", ",\"normalized\":true");
    meshopt_encodeFilterQuat(raw, 4, 8, 16, turns);
    n = meshopt_encodeVertexBuffer(packed, sizeof packed, raw, 4, 8);
    put_packed(g, packed, n, "QUATERNION", 4, 8);
    gltf_accessor(g, 2, 5122, 4, "VEC4", ",\"normalized\":true");
    gltf_shorts(g, square_faces, 6);
    Loaded l;
    fine(&l, g,
         SCENE
         "\"extensionsUsed\":[\"EXT_meshopt_compression\",\"EXT_mesh_gpu_instancing\","
         "\"KHR_mesh_quantization\"],"
         "\"nodes\":[{\"mesh\":0,"
         "\"extensions\":{\"EXT_mesh_gpu_instancing\":{\"attributes\":{\"ROTATION\":2}}}}],"
         "\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0,\"NORMAL\":1},"
         "\"indices\":3}]}]");
    const vlShapeDef *s = shape(&l, 0);
    for (int i = 0; i < 4; i++) {
      const float *p = s->normals + 3 * i;
      double length = sqrt((double)(p[0] * p[0] + p[1] * p[1] + p[2] * p[2]));
      for (int k = 0; k < 3; k++) {
        is_near((double)s->positions[3 * i + k], (double)places[3 * i + k], 1e-3);
        is_near((double)p[k] / length, (double)normals[4 * i + k], wide ? 1e-3 : 0.02);
      }
    }
    assert_int_equal(l.scene->instances.count, 4);
    for (int i = 0; i < 4; i++) { /* z axis turned by the quaternion */
      const float *q = turns + 4 * i;
      const double *m = l.scene->instances.items[i].world_from_group;
      is_near(m[2], (double)(2 * (q[0] * q[2] + q[3] * q[1])), 2e-3);
      is_near(m[6], (double)(2 * (q[1] * q[2] - q[3] * q[0])), 2e-3);
      is_near(m[10], (double)(1 - 2 * (q[0] * q[0] + q[1] * q[1])), 2e-3);
    }
    end_load(&l);
    free(g);
  }
}

/* ---- animation --------------------------------------------------------------------------- */

static void pointers(void **state) {
  (void)state;
  Gltf *g = new_square();
  const float times[] = {0, 2}, places[] = {0, 0, 0, 6, 0, 0}, scales[] = {1, 3};
  gltf_floats(g, times, 2, "SCALAR", 1);
  gltf_floats(g, places, 2, "VEC3", 3);
  gltf_floats(g, scales, 2, "SCALAR", 1);
  vlLoadDef def = vl_default_load_def();
  def.time = 1;
  Loaded l;
  fine_with(
      &l, g,
      SCENE
      "\"extensionsUsed\":[\"KHR_animation_pointer\"],\"extensionsRequired\":[\"KHR_animation_"
      "pointer\"],"
      "\"nodes\":[{\"mesh\":0}],\"animations\":[{\"samplers\":[{\"input\":2,\"output\":3},{"
      "\"input\":2,\"output\":4}],"
      "\"channels\":[{\"sampler\":0,\"target\":{\"path\":\"pointer\",\"extensions\":{\"KHR_"
      "animation_pointer\":{"
      "\"pointer\":\"/nodes/0/"
      "translation\"}}}},{\"sampler\":1,\"target\":{\"path\":\"pointer\",\"extensions\":{"
      "\"KHR_animation_pointer\":{\"pointer\":\"/materials/0/"
      "emissiveFactor\"}}}}]}]," SQUARE_MESH,
      &def);
  is_near(shape(&l, 0)->group_from_shape[3], 3, 1e-6);
  assert_non_null(strstr(l.log, "/materials/0… is not animated"));
  end_load(&l);
  free(g);
}

/* ---- surroundings ------------------------------------------------------------------------ */

/* Six faces in the order +x -x +y -y +z -z, as OpenGL's cube maps have them (specification 4.6,
 * table 8.19): each of a colour, a quarter at its image's top left in white. What is seen along
 * each axis and towards that corner. */
static void faces(void **state) {
  (void)state;
  static const uint8_t colors[6][3] = {{255, 0, 0},   {0, 255, 255}, {0, 255, 0},
                                       {255, 0, 255}, {0, 0, 255},   {255, 255, 0}};
  Gltf *g = new_square();
  Loaded l;
  start_load(&l);
  for (int face = 0; face < 6; face++) {
    vlImageDef def = vl_default_image_def(32, 32, 3);
    def.type = VL_PIXEL_U8;
    def.encoding = VL_ENCODING_SRGB;
    vlImage *image;
    assert_int_equal(vl_image_create(l.context, &def, &image), VL_OK);
    for (uint32_t y = 0; y < 32; y++)
      for (uint32_t x = 0; x < 32; x++) {
        uint8_t *p = (uint8_t *)vl_image_row(image, y) + 3 * x;
        for (int c = 0; c < 3; c++)
          p[c] = x < 8 && y < 8 ? 255 : colors[face][c];
      }
    char name[20];
    snprintf(name, sizeof name, "f%d.png", face);
    assert_int_equal(vl_image_write(image, in_folder(name), NULL, NULL), VL_OK);
    vl_image_destroy(image);
  }
  end_load(&l);
  fine(&l, g,
       "\"scenes\":[{\"nodes\":[0],"
       "\"extensions\":{\"EXT_lights_image_based\":{\"light\":0}}}],"
       "\"extensionsUsed\":[\"EXT_lights_image_based\"],\"nodes\":[{\"mesh\":0}],"
       "\"images\":[{\"uri\":\"f0.png\"},{\"uri\":\"f1.png\"},{\"uri\":\"f2.png\"},"
       "{\"uri\":\"f3.png\"},{\"uri\":\"f4.png\"},{\"uri\":\"f5.png\"}],"
       "\"extensions\":{\"EXT_lights_image_based\":{\"lights\":[{\"specularImageSize\":32,"
       "\"specularImages\":[[0,1,2,3,4,5]]}]}}," SQUARE_MESH);
  /* table 8.19: along the face's axis, with s and t running as below; top left is s = t = -1 */
  static const struct {
    vlVec3 axis, s, t;
  } table[6] = {{{1, 0, 0}, {0, 0, -1}, {0, -1, 0}}, {{-1, 0, 0}, {0, 0, 1}, {0, -1, 0}},
                {{0, 1, 0}, {1, 0, 0}, {0, 0, 1}},   {{0, -1, 0}, {1, 0, 0}, {0, 0, -1}},
                {{0, 0, 1}, {1, 0, 0}, {0, -1, 0}},  {{0, 0, -1}, {-1, 0, 0}, {0, -1, 0}}};
  const vlLightDef *light = &l.scene->lights.items[0];
  uint32_t side = vl_image_width(light->image);
  for (int face = 0; face < 6; face++)
    for (int corner = 0; corner < 4; corner++) {
      float s = corner & 1 ? 0.75f : -0.75f, t = corner & 2 ? 0.75f : -0.75f;
      vlVec3 d =
          vl_add(table[face].axis, vl_add(vl_mul(table[face].s, s), vl_mul(table[face].t, t)));
      vlVec2 at = vl_octahedral_encode(vl_normalize(d));
      uint32_t x = (uint32_t)(at.x * (float)side), y = (uint32_t)(at.y * (float)side);
      for (uint32_t c = 0; c < 3; c++)
        is_near((double)vl_image_get(light->image, x, y, c),
                corner == 0 ? 1 : colors[face][c] / 255.0, 0.02);
    }
  end_load(&l);
  free(g);
}

/* ---- variants ---------------------------------------------------------------------------- */

/* Without a choice, and for a variant that a primitive does not name: the primitive's own
 * material. */
static void variants(void **state) {
  (void)state;
  Gltf *g = new_square();
  const char *rest = SCENE
      "\"nodes\":[{\"mesh\":0}],\"extensionsUsed\":[\"KHR_materials_variants\"],"
      "\"extensions\":{\"KHR_materials_variants\":{\"variants\":[{\"name\":\"day\"},"
      "{\"name\":\"night\"},{\"name\":\"dusk\"}]}},\"materials\":[{\"name\":\"own\"},"
      "{\"name\":\"dark\"}],\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0},"
      "\"indices\":1,\"material\":0,"
      "\"extensions\":{\"KHR_materials_variants\":{\"mappings\":[{\"material\":1,"
      "\"variants\":[1,2]}]}}}]}]";
  static const char *const cases[][2] = {
      {NULL, "own"}, {"day", "own"}, {"night", "dark"}, {"dusk", "dark"}};
  for (int i = 0; i < 4; i++) {
    vlLoadDef def = vl_default_load_def();
    def.variant = cases[i][0];
    Loaded l;
    fine_with(&l, g, rest, &def);
    assert_string_equal(l.scene->materials.items[shape(&l, 0)->material.index - 1].name,
                        cases[i][1]);
    end_load(&l);
  }
  free(g);
}

/* ---- anisotropy -------------------------------------------------------------------------- */

/* Red and green of the texture are the direction, from -1 to 1: it becomes an angle modulo pi,
 * plus the rotation. A mesh without normals gets flat ones, and tangents along u. */
static void anisotropy(void **state) {
  (void)state;
  static const uint8_t pixels[12] = {255, 128, 255, 128, 255, 255, 0, 128, 255, 128, 0, 255};
  static const double directions[4][2] = {
      {1, 1. / 255}, {1. / 255, 1}, {-1, 1. / 255}, {1. / 255, -1}};
  static const float uvs[8] = {0, 0, 1, 0, 0, 1, 1, 1};
  vlContext *context;
  vlImage *image;
  vlError error;
  vlContextDef cd = vl_default_context_def();
  assert_int_equal(vl_context_create(&cd, &context), VL_OK);
  vlImageDef def = vl_default_image_def(4, 1, 3);
  def.type = VL_PIXEL_U8;
  assert_int_equal(vl_image_create(context, &def, &image), VL_OK);
  memcpy(vl_image_pixels(image), pixels, sizeof pixels);
  assert_int_equal(vl_image_write(image, in_folder("directions.png"), NULL, &error), VL_OK);
  vl_image_destroy(image);
  vl_context_destroy(context);
  Gltf *g = new_square();
  gltf_floats(g, uvs, 4, "VEC2", 2);
  Loaded l;
  fine(&l, g,
       SCENE
       "\"nodes\":[{\"mesh\":0}],\"images\":[{\"uri\":\"directions.png\"}],"
       "\"textures\":[{\"source\":0}],\"extensionsUsed\":[\"KHR_materials_anisotropy\"],"
       "\"materials\":[{\"extensions\":{\"KHR_materials_anisotropy\":{"
       "\"anisotropyStrength\":0.5,\"anisotropyRotation\":0.25,"
       "\"anisotropyTexture\":{\"index\":0}}}}],"
       "\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0,\"TEXCOORD_0\":2},"
       "\"indices\":1,\"material\":0}]}]");
  const vlPrincipledDef *p = &l.scene->materials.items[l.scene->materials.count - 1].principled;
  const vlTextureDef *strength = &l.scene->textures.items[p->anisotropy.texture.index - 1];
  const vlTextureDef *turn = &l.scene->textures.items[p->anisotropy_rotation.texture.index - 1];
  assert_int_equal(strength->channel, 2);
  is_near((double)strength->tint[2], 0.5, 0);
  assert_int_equal(turn->filter, VL_FILTER_POINT);
  for (int i = 0; i < 4; i++) {
    double wanted = atan2(directions[i][1], directions[i][0]) + 0.25, apart;
    apart = fabs(remainder(
        (double)((const float *)vl_image_pixels((vlImage *)turn->image))[i] - wanted, M_PI));
    is_near(apart, 0, 1e-5);
  }
  assert_int_equal(shape(&l, 0)->vertices, 6);
  for (int i = 0; i < 6; i++) {
    is_near((double)shape(&l, 0)->normals[3 * i + 2], 1, 0);
    is_near((double)shape(&l, 0)->tangents[3 * i], 1, 1e-6);
  }
  end_load(&l);
  free(g);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(vertex_colors), cmocka_unit_test(vertex_alpha),
      cmocka_unit_test(filters),       cmocka_unit_test(pointers),
      cmocka_unit_test(faces),         cmocka_unit_test(variants),
      cmocka_unit_test(anisotropy)};
  return cmocka_run_group_tests(tests, set_up, tear_down);
}
