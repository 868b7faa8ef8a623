/* test/fuzz/fuzz_gltf.c: glTF, as .gltf or .glb by its first bytes: read at a time of its
 * animation, and completed. */
#include "fuzz.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
  vlContext *context = fuzz_context();
  vlScene *scene = NULL;
  vlError error;
  vlLoadDef load = vl_default_load_def();
  if (size % 3)
    load.time = 0.25 * (double)(size % 7);
  if (size % 3 == 2)
    load.time_close = load.time + 1;
  const char *path =
      fuzz_file(size > 0 && data[0] == 'g' ? "input.glb" : "input.gltf", data, size);
  if (vl_scene_create(context, &scene) == VL_OK)
    vl_scene_load(scene, path, &load, &error);
  vl_scene_destroy(scene);
  fuzz_end(context);
  return 0;
}
