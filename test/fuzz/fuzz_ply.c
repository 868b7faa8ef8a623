/* test/fuzz/fuzz_ply.c: PLY files, ASCII and binary, read through a scene that names one. */
#include "fuzz.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
  static const char text[] =
      "WorldBegin\nShape \"plymesh\" \"string filename\" \"input.ply\"\n";
  fuzz_file("input.ply", data, size);
  vlContext *context = fuzz_context();
  vlScene *scene = NULL;
  if (vl_scene_create(context, &scene) == VL_OK) {
    vlError error;
    vl_scene_load(scene, fuzz_file("mesh.pbrt", (const uint8_t *)text, sizeof text - 1), NULL,
                  &error);
    vl_scene_destroy(scene);
  }
  fuzz_end(context);
  return 0;
}
