/* test_gltf_convert.c: glTF converted to pbrt gives nearly the same image: spheres of
 * dielectrics and metals, a wall with an emissive image whose uvs are far from the origin. */
#include "render/gltf_shots.h"
#include "velo/export.h"
#include "velo/load.h"

/* Renders the images of the glTF file and of the pbrt file that is written from it. */
static void both_ways(const Gltf *g, const char *rest, Image *own, Image *written) {
  char folder[] = "/tmp/velo-convert-XXXXXX", from[80], to[80], command[80];
  assert_non_null(mkdtemp(folder));
  snprintf(from, sizeof from, "%s/a.gltf", folder);
  snprintf(to, sizeof to, "%s/b.pbrt", folder);
  uint8_t pixels[48]; /* red, green, blue, white: pbrt's emission goes smoothly from texel to
                         texel */
  for (int i = 0; i < 48; i++)
    pixels[i] = i >= 36 || i / 12 == i % 3 ? 255 : 0;
  char name[80];
  snprintf(name, sizeof name, "%s/p.png", folder);
  gltf_write_text(g, from, rest);
  for (int pass = 0; pass < 2; pass++) {
    Stage s = stage_open(32, 32);
    vlError error;
    memset(&error, 0, sizeof error);
    if (pass == 0) {
      vlImageDef def = vl_default_image_def(16, 1, 3);
      def.type = VL_PIXEL_U8;
      def.encoding = VL_ENCODING_SRGB;
      vlImage *image;
      assert_int_equal(vl_image_create(s.context, &def, &image), VL_OK);
      memcpy(vl_image_pixels(image), pixels, sizeof pixels);
      assert_int_equal(vl_image_write(image, name, NULL, NULL), VL_OK);
      vl_image_destroy(image);
    }
    if (vl_scene_load(s.scene, pass ? to : from, NULL, &error) != VL_OK)
      fail_msg("%s", error.message);
    vlCompleteDef complete = vl_default_complete_def();
    complete.environment = VL_ENVIRONMENT_WHITE;
    if (pass == 0 && vl_scene_complete(s.scene, &complete, &error) != VL_OK)
      fail_msg("%s", error.message);
    if (pass == 0 && vl_scene_save(s.scene, to, NULL, &error) != VL_OK)
      fail_msg("%s", error.message);
    s.camera = vl_scene_defs(s.scene)->camera;
    s.camera.width = s.camera.height = 32;
    s.build.color = VL_COLOR_RGB;
    s.render.tracer = vl_scene_defs(s.scene)->render.tracer;
    s.render.spp = 64;
    s.render.max_depth = 32;
    *(pass ? written : own) = stage_finish(&s);
  }
  snprintf(command, sizeof command, "rm -rf '%s'", folder);
  assert_int_equal(system(command), 0);
}

#define NODES                                                                         \
  "\"scene\":0,\"scenes\":[{\"nodes\":[0,1]}],\"nodes\":[{\"mesh\":0},{\"camera\":0," \
  "\"translation\":[0,0,10]}]"                                                        \
  "," SHOT_CAMERA

/* A coat reflects light back to the base, so the base's colour must be brighter for the same
 * appearance; so must rough metals be, which lose light between their microfacets in pbrt.
 * pbrt's Fresnel curve of dark metals is steeper. */
static void balls(void **state) {
  (void)state;
  static const struct {
    double base, metal, rough, max;
  } cases[] = {{0.5, 0, 0.1, 0.03}, {0.8, 0, 0.3, 0.05},  {0.2, 0, 0.2, 0.03},
               {0.5, 0, 0.6, 0.03}, {0.05, 0, 0.6, 0.03}, {0.7, 1, 0.2, 0.03},
               {0.7, 1, 0.6, 0.03}, {0.7, 1, 0.8, 0.04},  {0.1, 1, 0.4, 0.03}};
  Gltf *g = calloc(1, sizeof *g);
  put_ball(g);
  for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
    char rest[1000];
    snprintf(rest, sizeof rest,
             NODES
             ",\"materials\":[{\"pbrMetallicRoughness\":{\"baseColorFactor\":[%g,%g,%g,1],"
             "\"metallicFactor\":%g,\"roughnessFactor\":%g}}],"
             "\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0,\"NORMAL\":0,"
             "\"TEXCOORD_0\":1},\"indices\":2,\"material\":0}]}]",
             cases[i].base, cases[i].base, cases[i].base, cases[i].metal, cases[i].rough);
    Image own, written;
    both_ways(g, rest, &own, &written);
    assert_near("ball", image_mean(&written, 1), image_mean(&own, 1), cases[i].max);
    image_free(&own);
    image_free(&written);
  }
  free(g);
}

static void wall(void **state) {
  (void)state;
  static const float corners[12] = {-1, -1, 0, 1, -1, 0, -1, 1, 0, 1, 1, 0};
  static const float uv[8] = {3, -4, 4, -4, 3, -5, 4, -5};
  static const uint16_t faces[6] = {0, 1, 2, 2, 1, 3};
  Gltf *g = calloc(1, sizeof *g);
  gltf_floats(g, corners, 4, "VEC3", 3);
  gltf_floats(g, uv, 4, "VEC2", 2);
  gltf_shorts(g, faces, 6);
  static const char *const materials[] = {
      "\"emissiveFactor\":[1,1,1],\"emissiveTexture\":{\"index\":0},"
      "\"pbrMetallicRoughness\":{\"baseColorFactor\":[0,0,0,1],\"metallicFactor\":0},"
      "\"extensions\":{\"KHR_materials_specular\":{\"specularFactor\":0}}",
      "\"pbrMetallicRoughness\":{\"baseColorTexture\":{\"index\":0},\"metallicFactor\":0,"
      "\"roughnessFactor\":0.1}"};
  for (int i = 0; i < 2; i++) {
    char rest[1400];
    snprintf(
        rest, sizeof rest,
        NODES
        ",\"images\":[{\"uri\":\"p.png\"}],\"samplers\":[{\"magFilter\":9728}],\"textures\":[{"
        "\"source\":0,"
        "\"sampler\":0}],\"materials\":[{%s}],\"meshes\":[{\"primitives\":[{\"attributes\":{"
        "\"POSITION\":0,"
        "\"TEXCOORD_0\":1},\"indices\":2,\"material\":0}]}]",
        materials[i]);
    Image own, written;
    both_ways(g, rest, &own, &written);
    for (uint32_t k = 0; k < 4; k++) /* red, green, blue, white */
      for (int c = 0; c < 3; c++)
        assert_near(i ? "painted" : "emissive",
                    image_region(&written, 8 * k + 2, 8, 8 * k + 6, 24, c),
                    image_region(&own, 8 * k + 2, 8, 8 * k + 6, 24, c), i ? 0.04 : 0.01);
    assert_true(image_region(&own, 2, 8, 6, 24, 0) > 0.9);
    image_free(&own);
    image_free(&written);
  }
  free(g);
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(balls), cmocka_unit_test(wall)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
