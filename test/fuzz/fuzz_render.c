/* test/fuzz/fuzz_render.c: fuzzes the whole pipeline: builds a world from a scene file and
 * renders a few pixels. No input may cause a crash, a hang or excessive memory. */
#include "fuzz.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
  enum { SIDE = 6 };
  vlContext *context = fuzz_context();
  vlScene *scene = NULL;
  vlWorld *world = NULL;
  vlFilm *film = NULL;
  vlError error;
  vlLoadDef load = vl_default_load_def();
  load.permissive = true;
  vlBuildDef build = vl_default_build_def();
  build.color = size % 2 ? VL_COLOR_RGB : VL_COLOR_SPECTRAL;
  if (vl_scene_create(context, &scene) != VL_OK)
    exit(1);
  vlResult result = vl_scene_load(scene, fuzz_file("input.pbrt", data, size), &load, &error);
  if (result == VL_OK)
    result = vl_world_build(scene, &build, &world, &error);
  if (result == VL_OK) {
    vlSceneDefs *defs = vl_scene_defs(scene);
    vlCameraDef def = defs->camera;
    def.width = def.height = SIDE;
    vlCamera camera;
    vlFilmDef film_def = vl_default_film_def(SIDE, SIDE);
    film_def.filter = defs->film.filter;
    vlRenderDef render = vl_scene_defs(scene)->render;
    render.spp = 2;
    render.max_depth = render.max_depth > 6 ? 6 : render.max_depth;
    if (vl_camera_make(&def, &camera, NULL, &error) == VL_OK &&
        vl_film_create(context, &film_def, &film) == VL_OK)
      vl_render(world, &camera, film, &render, NULL, &error);
  }
  vl_film_destroy(film);
  vl_world_destroy(world);
  vl_scene_destroy(scene);
  fuzz_end(context);
  return 0;
}
