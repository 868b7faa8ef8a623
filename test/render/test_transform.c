/* test/render/test_transform.c: vl_scene_transform: a scene that is moved, turned and scaled
 * together with its camera has the same image. One small scene for each thing that has a place
 * or a length; the same seeds make the images equal up to rounding, so that a forgotten one is
 * seen at once. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "unit.h"
#include "velo/edit.h"
#include "velo/filter_kinds.h"
#include "velo/load.h"
#include "velo/render.h"
#include "velo/tracer.h"

enum { SIDE = 24, BANDS = 4 };

/* scale * rotation + shift: a third of a turn about (1, 1, 1), then a quarter about z, then the
 * shift. */
static const double similarity[16] = {0, -3, 0, 11, 0, 0, 3, -7, -3, 0, 0, 5, 0, 0, 0, 1};

static const char head[] =
    "LookAt 20 6 31.5  20 10 30.2  0 0 1\n"
    "Camera \"perspective\" \"float fov\" 40 \"float lensradius\" 0.1 "
    "\"float focaldistance\" 4\n"
    "WorldBegin\n"
    "Translate 20 10 30\n"; /* rounding is the same before and after: nothing is at
                                               the origin */
static const char floor_and_ball[] =
    "Shape \"bilinearmesh\" \"point3 P\" [-3 -3 0 3 -3 0 -3 3 0 3 3 0]\n"
    "AttributeBegin Translate 0 0 0.5 Shape \"sphere\" \"float radius\" 0.5 AttributeEnd\n";
static const char ball[] = "Translate 0 0 0.5 Shape \"sphere\" \"float radius\" 0.9\n";
static const char lamp[] =
    "AttributeBegin AreaLightSource \"diffuse\" \"rgb L\" [60 50 40]\n"
    "Translate -1 -1 2.5 ReverseOrientation Shape \"disk\" \"float radius\" 0.5 AttributeEnd\n";

static void means_of(vlContext *context, vlScene *scene, const double *move, double *means) {
  vlSceneDefs *defs = vl_scene_defs(scene);
  vlRenderDef render = defs->render;
  vlFilmDef film_def = vl_default_film_def(SIDE, SIDE);
  vlError error = {0};
  vlCamera whole, sized, camera;
  vlWorld *world;
  vlFilm *film;
  vlImage *image;
  render.spp = 32;
  render.tracer = VL_TRACER_VOLPATH;
  render.share_samples = false;
  film_def.filter = vl_default_pixel_filter(VL_PIXEL_FILTER_BOX);
  if (vl_world_build(scene, NULL, &world, &error) != VL_OK)
    fail_msg("build: %s", error.message);
  assert_int_equal(vl_camera_make(&defs->camera, &whole, NULL, &error), VL_OK);
  assert_int_equal(vl_camera_resize(&whole, SIDE, SIDE, &sized), VL_OK);
  double pose[16];
  for (int i = 0; i < 16; i++) {
    pose[i] = 0;
    for (int k = 0; k < 4; k++)
      pose[i] += move[i / 4 * 4 + k] * sized.world_from_camera[4 * k + i % 4];
  }
  assert_int_equal(vl_camera_move(&sized, pose, &camera, &error), VL_OK);
  assert_int_equal(vl_film_create(context, &film_def, &film), VL_OK);
  assert_int_equal(vl_render(world, &camera, film, &render, NULL, &error), VL_OK);
  assert_int_equal(vl_film_develop(film, NULL, &image), VL_OK);
  memset(means, 0, BANDS * 3 * sizeof *means);
  for (uint32_t y = 0; y < SIDE; y++)
    for (uint32_t x = 0; x < SIDE; x++)
      for (uint32_t c = 0; c < 3; c++)
        means[3 * (y * BANDS / SIDE) + c] +=
            (double)vl_image_get(image, x, y, c) * BANDS / (SIDE * SIDE);
  vl_image_destroy(image);
  vl_film_destroy(film);
  vl_world_destroy(world);
}

/* Expects the same means before and after. within: the largest relative difference: paths that
 * meet an edge differ. */
static void expect_same(const char *text, double within) {
  static const double stay[16] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
  double before[3 * BANDS], after[3 * BANDS];
  char whole[4096];
  vlContext *context;
  vlScene *scene;
  vlError error = {0};
  vlContextDef def = vl_default_context_def();
  def.threads = 2;
  assert_int_equal(vl_context_create(&def, &context), VL_OK);
  assert_int_equal(vl_scene_create(context, &scene), VL_OK);
  snprintf(whole, sizeof whole, "%s%s", head, text);
  /* its folder has textures */
  const char *name = VELO_SOURCE_DIR "/scenes/features/moved.pbrt";
  if (vl_scene_load_memory(scene, name, whole, strlen(whole), NULL, &error) != VL_OK)
    fail_msg("%u: %s", error.line, error.message);
  means_of(context, scene, stay, before);
  if (vl_scene_transform(scene, similarity, &error) != VL_OK)
    fail_msg("transform: %s", error.message);
  means_of(context, scene, similarity, after);
  double max = 0;
  for (int i = 0; i < 3 * BANDS; i++)
    max = fmax(max, before[i]);
  assert_true(max > 0.01);
  for (int i = 0; i < 3 * BANDS; i++)
    if (!(fabs(after[i] - before[i]) <= within * (before[i] + 0.1 * max)))
      fail_msg("%.200s: band %d, channel %d: %.6f before, %.6f after",
               text + (strlen(text) > 300 ? 128 : 0), i / 3, i % 3, before[i], after[i]);
  vl_scene_destroy(scene);
  assert_int_equal(vl_context_memory(context, NULL), 0);
  vl_context_destroy(context);
}

/* A scene of the parts. */
static void expect_same_of(const char *a, const char *b, const char *c, double within) {
  char text[3072];
  snprintf(text, sizeof text, "%s%s%s", a, b, c);
  expect_same(text, within);
}

static void test_lights(void **state) {
  (void)state;
  static const char *const lights[] = {
      "LightSource \"point\" \"point3 from\" [1 -1 2] \"rgb I\" [9 8 7]\n",
      "Translate 0.5 0 0 LightSource \"point\" \"point3 from\" [1 -1 2] \"float power\" 100\n",
      "Translate 0.5 0 0 LightSource \"spot\" \"point3 from\" [1 -1 2] "
      "\"point3 to\" [0 0 0] \"rgb I\" [9 8 7] \"float coneangle\" 25\n",
      "LightSource \"distant\" \"point3 from\" [1 -1 2] \"point3 to\" [0 0 0] "
      "\"float illuminance\" 3\n",
      "LightSource \"projection\" \"string filename\" \"textures/letters.png\" "
      "\"float scale\" 20 \"float fov\" 70\n",
      "AttributeBegin AreaLightSource \"diffuse\" "
      "\"float power\" 90 Translate 1 -1 2 Shape \"sphere\" "
      "\"float radius\" 0.2 AttributeEnd\n"};
  for (size_t i = 0; i < sizeof lights / sizeof *lights; i++) {
    char light[512];
    const bool placed = strstr(lights[i], "projection") != NULL; /* it looks along z */
    snprintf(light, sizeof light, "AttributeBegin %s %s AttributeEnd\n",
             placed ? "Translate 0 0 3 Rotate 180 1 0 0" : "", lights[i]);
    expect_same_of(light, floor_and_ball, "", 0.002);
  }
}

static void test_sky_through_a_portal(void **state) {
  (void)state;
  expect_same_of(
      "AttributeBegin Rotate 30 1 2 3 LightSource \"infinite\" "
      "\"string filename\" \"textures/sky.pfm\" AttributeEnd\n",
      "", floor_and_ball, 0.002);
  expect_same_of(
      "LightSource \"infinite\" \"string filename\" \"textures/sky.pfm\" "
      "\"point3 portal\" [19 9 33 19 11 33 21 11 33 21 9 33]\n",
      floor_and_ball, "", 0.002);
}

static void test_media(void **state) {
  (void)state;
  expect_same_of(lamp, floor_and_ball,
                 "MakeNamedMedium \"fog\" \"string type\" \"homogeneous\" "
                 "\"rgb sigma_a\" [0.2 0.4 0.6] \"rgb sigma_s\" [1 1 1.5] \"float g\" 0.4 "
                 "\"rgb Le\" [0.2 0.1 0]\n"
                 "AttributeBegin Material \"interface\" MediumInterface \"fog\" \"\" "
                 "Translate 1 0 0.6 Shape \"sphere\" \"float radius\" 0.5 AttributeEnd\n",
                 0.004);
  expect_same_of(
      lamp, floor_and_ball,
      "AttributeBegin Translate 0.6 0 0.2 MakeNamedMedium \"cloud\" "
      "\"string type\" \"cloud\" \"rgb sigma_s\" [9 9 9] \"rgb sigma_a\" [0 1 2] "
      "\"float density\" 2 \"float frequency\" 3 AttributeEnd\n"
      "AttributeBegin Material \"interface\" MediumInterface \"cloud\" \"\" Translate 1 0 "
      "0.6 Shape \"sphere\" \"float radius\" 0.5 AttributeEnd\n",
      0.01);
}

static void test_textures(void **state) {
  (void)state;
  expect_same_of(lamp,
                 "Texture \"t\" \"spectrum\" \"checkerboard\" \"integer dimension\" 3 "
                 "\"rgb tex1\" [.9 .2 .2] \"rgb tex2\" [.1 .8 .3]\n"
                 "Material \"diffuse\" \"texture reflectance\" \"t\"\n"
                 "Translate 0.03 0.07 0.04\n",
                 floor_and_ball, 0.004);
  expect_same_of(
      lamp,
      "Translate .2 .1 0 Scale .7 .7 .7 Texture \"t\" \"float\" \"fbm\" Translate .3 0 0\n"
      "Texture \"c\" \"spectrum\" \"mix\" \"texture amount\" \"t\" \"rgb tex1\" [.1 .1 .1] "
      "\"rgb tex2\" [.9 .8 .7]\n"
      "Material \"diffuse\" \"texture reflectance\" \"c\"\n",
      floor_and_ball, 0.004);
  expect_same_of(lamp,
                 "Texture \"c\" \"spectrum\" \"directionmix\" \"vector3 dir\" [0 0.3 1] "
                 "\"rgb tex1\" [.1 .1 .1] \"rgb tex2\" [.9 .8 .7]\n"
                 "Material \"diffuse\" \"texture reflectance\" \"c\"\n",
                 floor_and_ball, 0.004);
}

static void test_heights(void **state) {
  (void)state;
  expect_same_of(lamp,
                 "Texture \"h\" \"float\" \"wrinkled\"\nTexture \"b\" \"float\" \"scale\" "
                 "\"texture tex\" \"h\" "
                 "\"float scale\" 0.3\n"
                 "Material \"diffuse\" \"texture displacement\" \"b\"\n",
                 floor_and_ball, 0.004);
  expect_same_of(lamp,
                 "Texture \"h\" \"float\" \"fbm\"\n"
                 "Texture \"b\" \"float\" \"scale\" \"texture tex\" \"h\" "
                 "\"float scale\" 0.4\n"
                 "Translate 0 -0.5 0 Scale 2 2 2 Shape \"plymesh\" "
                 "\"string filename\" \"tetrahedron.ply\" \"texture displacement\" \"b\" "
                 "\"float edgelength\" 0.1\n",
                 "", 0.01);
}

static void test_subsurface_and_hair(void **state) {
  (void)state; /* probe rays start in another frame, so that the images have other noise */
  expect_same_of(
      lamp,
      "Material \"subsurface\" \"rgb mfp\" [0.3 0.2 0.1] \"rgb reflectance\" [.8 .7 .6]\n",
      ball, 0.1);
  expect_same_of(
      lamp, "Material \"subsurface\" \"rgb sigma_a\" [0.1 0.2 0.3] \"rgb sigma_s\" [3 4 5]\n",
      ball, 0.1);
  expect_same_of(lamp,
                 "Material \"hair\" \"rgb sigma_a\" [3 1 .3]\n"
                 "Shape \"curve\" \"string type\" \"cylinder\" "
                 "\"point3 P\" [-1 0 0 -.3 0 .6 .3 .2 .6 1 0 1] \"float width\" .5\n",
                 "", 0.004);
}

static void test_instances(void **state) {
  (void)state;
  expect_same_of(
      lamp,
      "AttributeBegin Identity ObjectBegin \"ball\" Shape \"sphere\" \"float radius\" 0.3 "
      "ObjectEnd AttributeEnd\n"
      "AttributeBegin Translate 0.5 0 0.3 Scale 1 1 2 ObjectInstance \"ball\" AttributeEnd\n",
      "AttributeBegin ActiveTransform EndTime Translate -1 0 0.5 Rotate 40 0 1 1 "
      "ActiveTransform All\n"
      "ObjectInstance \"ball\" AttributeEnd\n",
      0.004);
}

static void test_wrong_matrices(void **state) {
  (void)state;
  static const double wrong[][16] = {
      {1, 0, 0, 0, 0, 2, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1},    /* not uniform */
      {-1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1},   /* mirrors */
      {1, 0.1, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1},  /* shears */
      {0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 1},    /* singular */
      {1, 0, 0, NAN, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1},  /* not finite */
      {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0.5, 1}}; /* projective */
  vlContext *context;
  vlScene *scene;
  vlError error;
  assert_int_equal(vl_context_create(NULL, &context), VL_OK);
  assert_int_equal(vl_scene_create(context, &scene), VL_OK);
  for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++) {
    assert_int_equal(vl_scene_transform(scene, wrong[i], &error), VL_ERROR_ARGUMENT);
    assert_non_null(strstr(error.message, "transform"));
  }
  assert_int_equal(vl_scene_transform(NULL, similarity, &error), VL_ERROR_ARGUMENT);
  assert_int_equal(vl_scene_transform(scene, NULL, NULL), VL_ERROR_ARGUMENT);
  assert_int_equal(vl_scene_transform(scene, similarity, &error), VL_OK);
  vl_scene_destroy(scene);
  vl_context_destroy(context);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(test_lights),    cmocka_unit_test(test_sky_through_a_portal),
      cmocka_unit_test(test_media),     cmocka_unit_test(test_textures),
      cmocka_unit_test(test_heights),   cmocka_unit_test(test_subsurface_and_hair),
      cmocka_unit_test(test_instances), cmocka_unit_test(test_wrong_matrices)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
