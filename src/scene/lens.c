/* scene/lens.c: ownership of the lens and other objects that the scene's camera points at. */
#include <string.h>

#include "base/error.h"
#include "scene/scene.h"

/* Memory is reserved first, so that a failed allocation never leaves an object with two
 * owners. */
vlResult vl_scene_take_camera(vlScene *scene, vlScene *from, vlError *error) {
  vl_error_clear(error);
  if (!scene || !from)
    return vl_fail_argument(error, "scene take camera: scene or from is null");
  vlContext *context = scene->context;
  if (from->context != context)
    return vl_fail_argument(error, "scene take camera: the scenes are of different contexts");
  if (scene == from)
    return VL_OK;
  if (!VL_RESERVE(context, &scene->apertures, from->apertures.count) ||
      !VL_RESERVE(context, &scene->optics, from->optics.count))
    return vl_fail_memory(error);
  for (size_t i = 0; i < from->apertures.count; i++)
    scene->apertures.items[scene->apertures.count++] = from->apertures.items[i];
  for (size_t i = 0; i < from->optics.count; i++)
    scene->optics.items[scene->optics.count++] = from->optics.items[i];
  from->apertures.count = from->optics.count = 0;
  vlSceneDefs *to = &scene->defs;
  const vlSceneDefs *s = &from->defs;
  to->camera = s->camera;
  to->camera_missing = s->camera_missing;
  to->film.width = s->film.width;
  to->film.height = s->film.height;
  memcpy(to->film.crop, s->film.crop, sizeof to->film.crop);
  return VL_OK;
}

vlResult vl_scene_refocus(vlScene *scene, double distance, vlError *error) {
  vl_error_clear(error);
  if (!scene)
    return vl_fail_argument(error, "scene refocus: scene is null");
  vlCameraDef *camera = &scene->defs.camera;
  if (!camera->lens.optics)
    return vl_fail_argument(error, "scene refocus: the camera's lens is thin");
  if (!VL_RESERVE(scene->context, &scene->optics, 1))
    return vl_fail_memory(error);
  vlOptics *optics;
  VL_TRY(vl_optics_refocus(scene->context, camera->lens.optics, distance, &optics, error));
  scene->optics.items[scene->optics.count++] = optics;
  camera->lens.optics = optics;
  return VL_OK;
}
