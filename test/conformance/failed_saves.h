/* conformance/failed_saves.h: the law of scenes that cannot be written: the result says why, by
 * each format, and no file is left. Scenes that lose a part are refused where the caller asks
 * for that. */
#ifndef TEST_CONFORMANCE_FAILED_SAVES_H
#define TEST_CONFORMANCE_FAILED_SAVES_H

#include <unistd.h>

#include "conformance.h"
#include "files.h"

static const char *const saved_suffixes[] = {"pbrt", "gltf", "glb"};
enum { SAVED_SUFFIXES = sizeof saved_suffixes / sizeof *saved_suffixes };

static void check_failed_save(vlScene *scene, const char *file, const vlSaveDef *def,
                              vlResult expected, const char *words) {
  char path[100];
  vlError error = {0};
  path_of(path, file);
  const vlResult result = vl_scene_save(scene, path, def, &error);
  if (result != expected)
    broken("settings", "save", "%s: the result is %d, not %d: %s", file, (int)result,
           (int)expected, error.message);
  if (!strstr(error.message, words))
    broken("settings", "save", "%s: \"%s\" is not in: %s", file, words, error.message);
  if (access(path, F_OK) == 0)
    broken("settings", "save", "%s is there, although it failed", file);
}

static void saves_that_fail(void **state) {
  (void)state;
  vlScene *plain = need_scene(HEAD "WorldBegin " LIGHTS BALL);
  assert_true(write_image("gone.png", 0));
  vlScene *gone =
      need_scene(HEAD "WorldBegin " LIGHTS
                      "Texture \"t\" \"spectrum\" \"imagemap\" \"string filename\" "
                      "\"gone.png\" Material \"diffuse\" \"texture reflectance\" \"t\" "
                      "Shape \"plymesh\" \"string filename\" \"a.ply\"");
  char path[100];
  path_of(path, "gone.png");
  assert_int_equal(unlink(path), 0);
  vlSaveDef strict = vl_default_save_def();
  strict.strict = true;
  for (int i = 0; i < SAVED_SUFFIXES; i++) {
    char file[40];
    snprintf(file, sizeof file, "nowhere/scene.%s", saved_suffixes[i]);
    check_failed_save(plain, file, NULL, VL_ERROR_IO, "nowhere");
    snprintf(file, sizeof file, "unsaved.%s", saved_suffixes[i]);
    if (i == 0) {
      check_failed_save(gone, file, NULL, VL_ERROR_MISSING, "gone.png");
      continue;
    }
    /* glTF is written without the image, and has no spheres */
    check_failed_save(gone, file, &strict, VL_ERROR_UNSUPPORTED, "cannot hold");
    check_failed_save(plain, file, &strict, VL_ERROR_UNSUPPORTED, "cannot hold");
  }
  check_failed_save(plain, "unsaved.fbx", NULL, VL_ERROR_ARGUMENT, "unknown kind");
  vl_scene_destroy(plain);
  vl_scene_destroy(gone);
  expect_no_failures();
}

#endif
