/* test/fuzz/fuzz_table.c: files that scenes name besides meshes and images, chosen by their
 * first bytes: measured materials and NanoVDB grids; any other input is read as a spectrum, a
 * lens, a list of poses and a lamp file. */
#include "fuzz.h"
#include "velo/lamp.h"
#include "velo/trajectory.h"

static bool begins(const uint8_t *data, size_t size, const char *word) {
  return size >= strlen(word) && memcmp(data, word, strlen(word)) == 0;
}

/* A scene of this text that names the file "input", up to its world. */
static void build(const char *text) {
  vlContext *context = fuzz_context();
  vlScene *scene = NULL;
  vlWorld *world = NULL;
  vlError error;
  const char *path = fuzz_file("table.pbrt", (const uint8_t *)text, strlen(text));
  if (vl_scene_create(context, &scene) == VL_OK &&
      vl_scene_load(scene, path, NULL, &error) == VL_OK)
    vl_world_build(scene, NULL, &world, &error);
  vl_world_destroy(world);
  vl_scene_destroy(scene);
  fuzz_end(context);
}

static void read_lamp(const uint8_t *data, size_t size) {
  vlContext *context = fuzz_context();
  vlLamp *lamp = NULL;
  vlError error;
  const double down[3] = {0.1, -1, 0.2};
  if (vl_lamp_read(context, "input", data, size, &lamp, &error) == VL_OK) {
    vlLampInfo info;
    vl_lamp_info(lamp, &info);
    double intensity = vl_lamp_intensity(lamp, down);
    if (!(info.flux >= 0) || !(intensity >= 0) || !(info.max_intensity >= intensity * 0.9999))
      abort();
  }
  vl_lamp_destroy(lamp);
  fuzz_end(context);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
  const char *path = fuzz_file("input", data, size);
  if (begins(data, size, "tensor")) {
    build(
        "WorldBegin\nMaterial \"measured\" \"string filename\" \"input\"\nShape \"sphere\"\n");
    return 0;
  }
  if (begins(data, size, "NanoVDB")) {
    build(
        "WorldBegin\n"
        "MakeNamedMedium \"m\" \"string type\" \"nanovdb\" \"string filename\" \"input\"\n"
        "MediumInterface \"m\" \"\"\n"
        "Material \"interface\"\n"
        "Shape \"sphere\"\n");
    return 0;
  }
  read_lamp(data, size);
  build(
      "WorldBegin\nMaterial \"diffuse\" \"spectrum reflectance\" \"input\"\nShape "
      "\"sphere\"\n");
  build("Camera \"realistic\" \"string lensfile\" \"input\"\nWorldBegin\nShape \"sphere\"\n");
  vlContext *context = fuzz_context();
  vlTrajectory *trajectory = NULL;
  vlError error;
  path = fuzz_file("input", data, size);
  if (vl_trajectory_load(context, path, NULL, &trajectory, &error) == VL_OK)
    vl_trajectory_destroy(trajectory);
  fuzz_end(context);
  return 0;
}
