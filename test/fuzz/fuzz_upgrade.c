/* test/fuzz/fuzz_upgrade.c: scenes of pbrt-v3: read and rewritten as pbrt-v4; what is written
 * must be read. Statements that the upgrade leaves alone may be wrong in both versions, so
 * errors of the second reading are no finding. */
#include "fuzz.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
  static char to[288];
  vlContext *context = fuzz_context();
  vlError error;
  const char *from = fuzz_file("input.pbrt", data, size);
  snprintf(to, sizeof to, "%.*supgraded.pbrt", (int)(strrchr(from, '/') + 1 - from), from);
  vlUpgradeDef def = vl_default_upgrade_def();
  def.strict = size > 0 && data[size - 1] % 4 == 1;
  if (vl_scene_upgrade(context, from, to, &def, &error) == VL_OK) {
    vlScene *scene = NULL;
    if (vl_scene_create(context, &scene) == VL_OK)
      vl_scene_load(scene, to, NULL, &error);
    vl_scene_destroy(scene);
  }
  fuzz_end(context);
  return 0;
}
