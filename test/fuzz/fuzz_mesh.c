/* test/fuzz/fuzz_mesh.c: meshes as scenes of their own: PLY with clouds and colours, STL, OFF.
 * The first byte chooses. */
#include "fuzz.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
  static const char *const names[4] = {"input.ply", "input.stl", "input.off", "input.stl.gz"};
  if (size == 0)
    return 0;
  const char *name = names[data[0] == 'p'                     ? 0
                           : data[0] == 'O' || data[0] == 'C' ? 2
                           : data[0] == 0x1f                  ? 3
                                                              : 1];
  vlContext *context = fuzz_context();
  vlScene *scene = NULL;
  vlError error;
  if (vl_scene_create(context, &scene) == VL_OK) {
    vlCompleteDef def = vl_default_complete_def();
    def.backdrop = def.open_walls = true;
    if (vl_scene_load(scene, fuzz_file(name, data, size), NULL, &error) == VL_OK)
      vl_scene_complete(scene, &def, &error);
    vl_scene_destroy(scene);
  }
  fuzz_end(context);
  return 0;
}
