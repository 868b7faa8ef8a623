/* test/api/test_contract.c: invalid arguments of every public function: a def without its
 * default function is rejected by its cookie, null arguments do not crash, and destroying null
 * is allowed. */
#include <math.h>
#include <string.h>

#include "unit.h"
#include "velo/velo.h"

static vlContext *context;

static int begin(void **state) {
  (void)state;
  vlContextDef def = vl_default_context_def();
  def.threads = 2;
  return vl_context_create(&def, &context) == VL_OK ? 0 : -1;
}

static int end(void **state) {
  (void)state;
  size_t left = vl_context_memory(context, NULL);
  vl_context_destroy(context);
  return left == 0 ? 0 : -1; /* the cases below leave nothing behind */
}

static void every_default_has_a_cookie(void **state) {
  (void)state;
  assert_int_not_equal(vl_default_context_def().cookie, 0);
  assert_int_not_equal(vl_default_image_def(1, 1, 1).cookie, 0);
  assert_int_not_equal(vl_default_write_def().cookie, 0);
  assert_int_not_equal(vl_default_denoise_def().cookie, 0);
  assert_int_not_equal(vl_default_camera_def(1, 1).cookie, 0);
  assert_int_not_equal(vl_default_texture_def(VL_TEXTURE_CONSTANT, true).cookie, 0);
  assert_int_not_equal(vl_default_material_def(VL_MATERIAL_DIFFUSE).cookie, 0);
  assert_int_not_equal(vl_default_emission_def().cookie, 0);
  assert_int_not_equal(vl_default_light_def(VL_LIGHT_POINT).cookie, 0);
  assert_int_not_equal(vl_default_shape_def(VL_SHAPE_SPHERE).cookie, 0);
  assert_int_not_equal(vl_default_load_def().cookie, 0);
  assert_int_not_equal(vl_default_build_def().cookie, 0);
  assert_int_not_equal(vl_default_film_def(1, 1).cookie, 0);
  assert_int_not_equal(vl_default_develop_def().cookie, 0);
  assert_int_not_equal(vl_default_render_def().cookie, 0);
}

static void a_def_made_by_hand_is_caught(void **state) {
  (void)state;
  vlError error;
  vlImageDef image_def = vl_default_image_def(4, 4, 3);
  image_def.cookie = 0;
  vlImage *image = NULL;
  assert_int_equal(vl_image_create(context, &image_def, &image), VL_ERROR_ARGUMENT);
  assert_null(image);

  vlCameraDef camera_def = vl_default_camera_def(4, 4);
  camera_def.cookie = 0;
  vlCamera camera;
  assert_int_equal(vl_camera_make(&camera_def, &camera, NULL, &error), VL_ERROR_ARGUMENT);

  vlFilmDef film_def = vl_default_film_def(4, 4);
  film_def.cookie = 0;
  vlFilm *film = NULL;
  assert_int_equal(vl_film_create(context, &film_def, &film), VL_ERROR_ARGUMENT);
  assert_null(film);

  vlScene *scene = NULL;
  assert_int_equal(vl_scene_create(context, &scene), VL_OK);
  vlBuildDef build_def = vl_default_build_def();
  build_def.cookie = 0;
  vlWorld *world = NULL;
  assert_int_equal(vl_world_build(scene, &build_def, &world, &error), VL_ERROR_ARGUMENT);
  assert_null(world);
  vlLoadDef load = vl_default_load_def();
  load.cookie = 0;
  assert_int_equal(vl_scene_load(scene, "none.pbrt", &load, &error), VL_ERROR_ARGUMENT);
  vl_scene_destroy(scene);

  /* each kind of thing that a scene takes, in a scene of its own, for a scene remembers its
   * first error */
  for (int kind = 0; kind < 5; kind++) {
    assert_int_equal(vl_scene_create(context, &scene), VL_OK);
    vlTextureDef texture = vl_default_texture_def(VL_TEXTURE_CONSTANT, true);
    vlMaterialDef material = vl_default_material_def(VL_MATERIAL_DIFFUSE);
    vlEmissionDef emission = vl_default_emission_def();
    vlLightDef light = vl_default_light_def(VL_LIGHT_POINT);
    vlShapeDef shape = vl_default_shape_def(VL_SHAPE_SPHERE);
    texture.cookie = material.cookie = emission.cookie = light.cookie = shape.cookie = 0;
    uint32_t index = 1;
    if (kind == 0)
      index = vl_scene_add_texture(scene, &texture).index;
    if (kind == 1)
      index = vl_scene_add_material(scene, &material).index;
    if (kind == 2)
      index = vl_scene_add_emission(scene, &emission).index;
    if (kind == 3)
      index = vl_scene_add_light(scene, &light).index;
    if (kind == 4)
      index = vl_scene_add_shape(scene, &shape).index;
    assert_int_equal(index, 0);
    assert_int_equal(vl_scene_result(scene, &error), VL_ERROR_ARGUMENT);
    vl_scene_destroy(scene);
  }
}

static void a_scene_remembers_its_first_error(void **state) {
  (void)state;
  vlScene *scene = NULL;
  assert_int_equal(vl_scene_create(context, &scene), VL_OK);
  vlShapeDef good = vl_default_shape_def(VL_SHAPE_SPHERE), bad = good;
  assert_int_not_equal(vl_scene_add_shape(scene, &good).index, 0);
  bad.radius = -1;
  assert_int_equal(vl_scene_add_shape(scene, &bad).index, 0);
  vlError error = {0};
  vlResult first = vl_scene_result(scene, &error);
  assert_int_not_equal(first, VL_OK);
  assert_true(strlen(error.message) > 0);
  assert_int_equal(vl_scene_add_shape(scene, &good).index, 0);
  vlMaterialDef material = vl_default_material_def(VL_MATERIAL_DIFFUSE);
  material.cookie = 0;
  assert_int_equal(vl_scene_add_material(scene, &material).index, 0);
  vlError again = {0};
  assert_int_equal(vl_scene_result(scene, &again), first);
  assert_string_equal(again.message, error.message);
  vlWorld *world = NULL;
  vlBuildDef build = vl_default_build_def();
  assert_int_not_equal(vl_world_build(scene, &build, &world, &error), VL_OK);
  assert_null(world);
  vl_scene_destroy(scene);
}

static void nothing_is_destroyed_quietly(void **state) {
  (void)state;
  vl_image_destroy(NULL);
  vl_scene_destroy(NULL);
  vl_world_destroy(NULL);
  vl_film_destroy(NULL);
  vl_context_destroy(NULL);
}

static void null_is_an_argument_error(void **state) {
  (void)state;
  vlError error;
  vlCameraDef camera_def = vl_default_camera_def(4, 4);
  vlImage *image = NULL;
  assert_int_equal(vl_scene_create(context, NULL), VL_ERROR_ARGUMENT);
  assert_int_equal(vl_camera_make(&camera_def, NULL, NULL, &error), VL_ERROR_ARGUMENT);
  assert_int_equal(vl_world_build(NULL, NULL, NULL, &error), VL_ERROR_ARGUMENT);
  assert_int_equal(vl_film_create(context, NULL, NULL), VL_ERROR_ARGUMENT);
  assert_int_equal(vl_film_develop(NULL, NULL, &image), VL_ERROR_ARGUMENT);
  assert_int_equal(vl_render(NULL, NULL, NULL, NULL, NULL, &error), VL_ERROR_ARGUMENT);
  assert_int_equal(vl_image_read(context, "none.png", NULL, &error), VL_ERROR_ARGUMENT);
}

static void a_null_def_stands_for_the_default(void **state) {
  (void)state;
  vlContext *own = NULL;
  assert_int_equal(vl_context_create(NULL, &own), VL_OK);
  vlScene *scene = NULL;
  vlWorld *world = NULL;
  vlError error;
  assert_int_equal(vl_scene_create(own, &scene), VL_OK);
  vlShapeDef sphere = vl_default_shape_def(VL_SHAPE_SPHERE);
  vl_scene_add_shape(scene, &sphere);
  vlLightDef sky = vl_default_light_def(VL_LIGHT_INFINITE);
  vl_scene_add_light(scene, &sky);
  assert_int_equal(vl_world_build(scene, NULL, &world, &error), VL_OK);
  vl_scene_destroy(scene);
  vlCamera camera;
  vlCameraDef camera_def = vl_default_camera_def(8, 8);
  camera_def.eye[2] = 5;
  assert_int_equal(vl_camera_make(&camera_def, &camera, NULL, &error), VL_OK);
  vlFilmDef film_def = vl_default_film_def(8, 8);
  vlFilm *film[2];
  vlImage *image[2];
  vlRenderDef render = vl_default_render_def();
  vlDevelopDef develop = vl_default_develop_def();
  for (int i = 0; i < 2; i++) {
    assert_int_equal(vl_film_create(own, &film_def, &film[i]), VL_OK);
    assert_int_equal(vl_render(world, &camera, film[i], i ? &render : NULL, NULL, &error),
                     VL_OK);
    assert_int_equal(vl_film_spp(film[i]), render.spp);
    assert_int_equal(vl_film_develop(film[i], i ? &develop : NULL, &image[i]), VL_OK);
  }
  assert_memory_equal(vl_image_const_pixels(image[0]), vl_image_const_pixels(image[1]),
                      8 * 8 * 4 * sizeof(float));
  assert_true(vl_image_get(image[0], 4, 4, 0) > 0.0f);
  develop.cookie = 0;
  vlImage *none = NULL;
  assert_int_equal(vl_film_develop(film[0], &develop, &none), VL_ERROR_ARGUMENT);
  render.cookie = 0;
  assert_int_equal(vl_render(world, &camera, film[0], &render, NULL, &error),
                   VL_ERROR_ARGUMENT);
  for (int i = 0; i < 2; i++) {
    vl_film_destroy(film[i]);
    vl_image_destroy(image[i]);
  }
  vl_world_destroy(world);
  vl_context_destroy(own);
}

static void spectra_have_names(void **state) {
  (void)state;
  uint32_t count = 0;
  while (vl_spectrum_name(count))
    count++;
  assert_true(count > 5);
  assert_null(vl_spectrum_name(UINT32_MAX));
  static const char *const wanted[] = {"metal-Au-eta", "metal-Cu-k", "glass-BK7",
                                       "stdillum-D65"};
  for (unsigned i = 0; i < sizeof wanted / sizeof *wanted; i++) {
    bool found = false;
    for (uint32_t j = 0; j < count; j++)
      found |= strcmp(vl_spectrum_name(j), wanted[i]) == 0;
    assert_true(found);
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(every_default_has_a_cookie),
      cmocka_unit_test(a_def_made_by_hand_is_caught),
      cmocka_unit_test(a_scene_remembers_its_first_error),
      cmocka_unit_test(nothing_is_destroyed_quietly),
      cmocka_unit_test(null_is_an_argument_error),
      cmocka_unit_test(a_null_def_stands_for_the_default),
      cmocka_unit_test(spectra_have_names),
  };
  return cmocka_run_group_tests(tests, begin, end);
}
