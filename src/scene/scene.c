/* scene/scene.c: creates and destroys scenes; functions for a scene's first error, its defs and
 * the numbers of its objects. */
#include "scene/scene.h"

#include "base/text.h"

#include "velo/medium.h"
#include "velo/shape_kinds.h"

bool vl_scene_fail(vlScene *scene, vlResult code, vlSource source, const char *format, ...) {
  if (scene->error.code != VL_OK)
    return false;
  char text[sizeof scene->error.message];
  VL_FORMAT(text, format);
  vl_fail_source(&scene->error, code, source, "%s", text);
  return false;
}

bool vl_scene_fail_memory(vlScene *scene) {
  return vl_scene_fail(scene, VL_ERROR_MEMORY, (vlSource){0}, "out of memory");
}

bool vl_scene_stopped(vlScene *scene, double fraction) {
  if (!vl_task_stopped(scene->task, "reading", fraction))
    return false;
  vl_scene_fail(scene, VL_CANCELLED, (vlSource){0}, "stopped");
  return true;
}

static vlSceneDefs default_defs(void) {
  const uint32_t width = 1280, height = 720; /* pbrt's default size, pixels */
  return (vlSceneDefs){.camera = vl_default_camera_def(width, height),
                       .film = vl_default_film_def(width, height),
                       .build = vl_default_build_def(),
                       .render = vl_default_render_def(),
                       .develop = vl_default_develop_def()};
}

vlResult vl_scene_create(vlContext *context, vlScene **result) {
  if (!context || !result)
    return VL_ERROR_ARGUMENT;
  *result = NULL;
  vlScene *scene = vl_alloc_zero(context, 1, sizeof *scene);
  if (!scene)
    return VL_ERROR_MEMORY;
  scene->context = context;
  scene->number = vl_context_number(context);
  scene->defs = default_defs();
  *result = scene;
  return VL_OK;
}

void vl_scene_free_beyond(const vlScene *scene, vlSceneCounts counts) {
  for (size_t i = counts.blocks; i < scene->blocks.count; i++)
    vl_free(scene->context, scene->blocks.items[i]);
  for (size_t i = counts.images; i < scene->images.count; i++)
    vl_image_destroy(scene->images.items[i]);
  for (size_t i = counts.apertures; i < scene->apertures.count; i++)
    vl_aperture_destroy(scene->apertures.items[i]);
  for (size_t i = counts.optics; i < scene->optics.count; i++)
    vl_optics_destroy(scene->optics.items[i]);
}

void vl_scene_destroy(vlScene *scene) {
  if (!scene)
    return;
  vlContext *context = scene->context;
  vl_scene_free_beyond(scene, (vlSceneCounts){0});
  for (size_t i = 0; i < scene->edits.count; i++) {
    vl_free(context, scene->edits.items[i].block);
    vl_image_destroy(scene->edits.items[i].image);
  }
#define FREE_ARRAY(array) VL_ARRAY_FREE(context, &scene->array);
  VL_SCENE_ARRAYS(FREE_ARRAY)
#undef FREE_ARRAY
  vl_free(context, scene);
}

vlResult vl_scene_result(const vlScene *scene, vlError *error) {
  if (!scene)
    return vl_fail_argument(error, "no scene");
  if (error)
    *error = scene->error;
  return scene->error.code;
}

vlSceneDefs *vl_scene_defs(vlScene *scene) {
  return &scene->defs;
}

void vl_scene_info(const vlScene *scene, vlSceneInfo *info) {
  *info = (vlSceneInfo){
      .shapes = scene->shapes.count - scene->removed_shapes.count,
      .textures = scene->textures.count - vl_scene_removed_count(&scene->texture_marks),
      .materials = scene->materials.count - vl_scene_removed_count(&scene->material_marks),
      .lights = scene->lights.count - vl_scene_removed_count(&scene->light_marks),
      .media = scene->media.count - vl_scene_removed_count(&scene->medium_marks),
      .groups = scene->groups.count - vl_scene_removed_count(&scene->group_marks),
      .instances = scene->instances.count - scene->removed_instances.count,
  };
  VL_EACH_ITEM(const vlShapeDef, shape, &scene->shapes) {
    info->vertices += shape->vertices;
    if (shape->kind == VL_SHAPE_TRIANGLES)
      info->triangles += shape->faces;
    if (shape->emission.index)
      info->emissive_shapes++;
  }
  info->lamps = vl_scene_lamps(scene);
}
