/* test/fuzz/fuzz_scene.c: scene files: tokens, directives, parameters, the scene's checks. */
#include "fuzz.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
  vlContext *context = fuzz_context();
  vlScene *scene = NULL;
  if (vl_scene_create(context, &scene) == VL_OK) {
    vlError error;
    vlLoadDef load = vl_default_load_def();
    load.permissive = size > 0 && data[size - 1] % 2;
    vl_scene_load(scene, fuzz_file("input.pbrt", data, size), &load, &error);
    vl_scene_destroy(scene);
  }
  fuzz_end(context);
  return 0;
}
