/* test/render/loaded.h: a scene file as a world and a camera, for tests that render it several
 * times. */
#ifndef TEST_RENDER_LOADED_H
#define TEST_RENDER_LOADED_H

#include <stdio.h>
#include <string.h>

#include "unit.h"
#include "velo/camera.h"
#include "velo/load.h"
#include "velo/render.h"
#include "velo/world.h"

typedef struct Loaded {
  vlContext *context; /* two threads */
  vlWorld *world;
  vlCamera camera;
} Loaded;

/* Loads a file of scenes/ at an image size. False: it cannot be loaded. */
static inline bool load_world(Loaded *l, const char *name, uint32_t width, uint32_t height) {
  vlContextDef def = vl_default_context_def();
  vlScene *scene = NULL;
  vlError error;
  char path[600];
  def.threads = 2;
  *l = (Loaded){.context = NULL};
  if (vl_context_create(&def, &l->context) != VL_OK ||
      vl_scene_create(l->context, &scene) != VL_OK)
    return false;
  snprintf(path, sizeof path, "%s/scenes/%s", VELO_SOURCE_DIR, name);
  vlResult result = vl_scene_load(scene, path, NULL, &error);
  vlCameraDef camera_def = vl_scene_defs(scene)->camera;
  camera_def.width = width;
  camera_def.height = height;
  if (result == VL_OK)
    result = vl_camera_make(&camera_def, &l->camera, NULL, &error);
  if (result == VL_OK)
    result = vl_world_build(scene, NULL, &l->world, &error);
  vl_scene_destroy(scene);
  return result == VL_OK;
}

static inline void unload_world(Loaded *l) {
  vl_world_destroy(l->world);
  vl_context_destroy(l->context);
}

#endif
