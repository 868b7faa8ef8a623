/* api/diagnose.c: loading a scene while a callback receives every error. */
#include "base/error.h"
#include "scene/scene.h"
#include "velo/check.h"

vlResult vl_scene_diagnose(vlScene *scene, const char *path, const vlLoadDef *def,
                           vlProblemFn *tell, void *user, vlError *error) {
  if (!scene || !tell)
    return vl_fail(error, VL_ERROR_ARGUMENT, "scene diagnose: scene or tell is null");
  scene->problem = tell;
  scene->problem_user = user;
  vlResult result = vl_scene_load(scene, path, def, error);
  scene->problem = NULL;
  return result;
}
