/* test/api/test_version.c: the library's version; a def of another ABI version is rejected. */
#include <stdio.h>
#include <string.h>

#include "unit.h"
#include "velo/velo.h"
#include "world/accel/accel.h"

static void the_version_is_the_headers(void **state) {
  (void)state;
  const vlVersion *version = vl_version();
  char text[32];
  snprintf(text, sizeof text, "%d.%d.%d", VL_VERSION_MAJOR, VL_VERSION_MINOR, VL_VERSION_PATCH);
  assert_string_equal(version->text, text);
  assert_int_equal(version->major, VL_VERSION_MAJOR);
  assert_int_equal(version->minor, VL_VERSION_MINOR);
  assert_int_equal(version->patch, VL_VERSION_PATCH);
  assert_int_equal(version->abi, VL_ABI_VERSION);
  assert_true(strlen(version->compiler) > 4);
  assert_true(strstr(version->instruction_sets, "x86-64-v3") ||
              strcmp(version->instruction_sets, "base") == 0);
}

static void libraries_have_versions(void **state) {
  (void)state;
  const vlLibrary *library;
  uint32_t count = 0;
  bool embree = false;
  for (; (library = vl_version_library(count)); count++) {
    assert_true(library->name[0] != 0);
    assert_true(library->version[0] >= '0' && library->version[0] <= '9');
    embree = embree || strcmp(library->name, "Embree") == 0;
  }
  vlBuildDef def = vl_default_build_def();
  def.accelerator = VL_ACCELERATOR_EMBREE;
  def.bits = VL_BITS_FAST;
  vlAccelerator kind;
  assert_int_equal(embree, vl_accel_choose(&def, &kind, NULL) == VL_OK); /* built with it */
  assert_true(count >= (embree ? 10 : 9));
  assert_null(vl_version_library(UINT32_MAX));
}

/* The same def, as a library of the next ABI version would have marked it. */
static uint32_t next_abi(uint32_t cookie) {
  assert_int_equal(cookie >> 8 & 0xffff, VL_ABI_VERSION);
  return cookie + (1u << 8);
}

static void a_def_of_another_abi_is_refused(void **state) {
  (void)state;
  vlContextDef context_def = vl_default_context_def();
  context_def.threads = 1;
  vlContext *context = NULL;
  uint32_t good = context_def.cookie;
  context_def.cookie = next_abi(good);
  assert_int_equal(vl_context_create(&context_def, &context), VL_ERROR_ARGUMENT);
  /* a program compiled with other headers */
  context_def = vl_default_context_def_abi(VL_ABI_VERSION + 1);
  assert_int_equal(vl_context_create(&context_def, &context), VL_ERROR_ARGUMENT);
  assert_null(context);
  context_def = vl_default_context_def();
  assert_int_equal(context_def.cookie, good);
  assert_int_equal(vl_context_create(&context_def, &context), VL_OK);

  vlFilmDef film_def = vl_default_film_def(4, 4);
  film_def.cookie = next_abi(film_def.cookie);
  vlFilm *film = NULL;
  assert_int_equal(vl_film_create(context, &film_def, &film), VL_ERROR_ARGUMENT);
  vlCameraDef camera_def = vl_default_camera_def(4, 4);
  camera_def.cookie = next_abi(camera_def.cookie);
  vlCamera camera;
  assert_int_equal(vl_camera_make(&camera_def, &camera, NULL, NULL), VL_ERROR_ARGUMENT);
  vlScene *scene = NULL;
  assert_int_equal(vl_scene_create(context, &scene), VL_OK);
  vlBuildDef build_def = vl_default_build_def();
  build_def.cookie = next_abi(build_def.cookie);
  vlWorld *world = NULL;
  assert_int_equal(vl_world_build(scene, &build_def, &world, NULL), VL_ERROR_ARGUMENT);
  vl_scene_destroy(scene);
  vl_context_destroy(context);
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(the_version_is_the_headers),
                                     cmocka_unit_test(libraries_have_versions),
                                     cmocka_unit_test(a_def_of_another_abi_is_refused)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
