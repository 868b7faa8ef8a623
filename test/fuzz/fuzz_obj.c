/* test/fuzz/fuzz_obj.c: OBJ and MTL: the input is both the OBJ file and its library. */
#include "fuzz.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
  vlContext *context = fuzz_context();
  vlScene *scene = NULL;
  vlError error;
  fuzz_file("m.mtl", data, size);
  if (vl_scene_create(context, &scene) == VL_OK)
    vl_scene_load(scene, fuzz_file("input.obj", data, size), NULL, &error);
  vl_scene_destroy(scene);
  fuzz_end(context);
  return 0;
}
