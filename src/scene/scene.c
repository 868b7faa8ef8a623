/* scene/scene.c: creates and destroys scenes; functions for a scene's first error, its defs and
 * the numbers of its objects. */
#include "scene/scene.h"
#include "base/text.h"
#include "base/unset.h"

#include <string.h>

#include "velo/light.h"
#include "velo/material.h"
#include "velo/medium.h"
#include "velo/shape_kinds.h"
#include "velo/texture.h"

vlResult vl_scene_fail(vlScene *scene, vlResult code, vlSource source, const char *format,
                       ...) {
  if (scene->error.code != VL_OK)
    return scene->error.code;
  char text[sizeof scene->error.message];
  VL_FORMAT(text, format);
  return vl_fail_at(&scene->error, code, source.file, source.line, source.column, "%s", text);
}

bool vl_scene_fail_memory(vlScene *scene) {
  vl_scene_fail(scene, VL_ERROR_MEMORY, (vlSource){0}, "out of memory");
  return false;
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

void vl_scene_destroy(vlScene *scene) {
  if (!scene)
    return;
  vlContext *context = scene->context;
  for (size_t i = 0; i < scene->blocks.count; i++)
    vl_free(context, scene->blocks.items[i]);
  for (size_t i = 0; i < scene->images.count; i++)
    vl_image_destroy(scene->images.items[i]);
  for (size_t i = 0; i < scene->apertures.count; i++)
    vl_aperture_destroy(scene->apertures.items[i]);
  for (size_t i = 0; i < scene->optics.count; i++)
    vl_optics_destroy(scene->optics.items[i]);
  for (size_t i = 0; i < scene->edits.count; i++) {
    vl_free(context, scene->edits.items[i].block);
    vl_image_destroy(scene->edits.items[i].image);
  }
  VL_ARRAY_FREE(context, &scene->edits);
  VL_ARRAY_FREE(context, &scene->removed_shapes);
  VL_ARRAY_FREE(context, &scene->removed_instances);
  VL_ARRAY_FREE(context, &scene->texture_marks);
  VL_ARRAY_FREE(context, &scene->material_marks);
  VL_ARRAY_FREE(context, &scene->emission_marks);
  VL_ARRAY_FREE(context, &scene->group_marks);
  VL_ARRAY_FREE(context, &scene->light_marks);
  VL_ARRAY_FREE(context, &scene->medium_marks);
  VL_ARRAY_FREE(context, &scene->shape_marks);
  VL_ARRAY_FREE(context, &scene->apertures);
  VL_ARRAY_FREE(context, &scene->optics);
  VL_ARRAY_FREE(context, &scene->textures);
  VL_ARRAY_FREE(context, &scene->materials);
  VL_ARRAY_FREE(context, &scene->emissions);
  VL_ARRAY_FREE(context, &scene->lights);
  VL_ARRAY_FREE(context, &scene->media);
  VL_ARRAY_FREE(context, &scene->shapes);
  VL_ARRAY_FREE(context, &scene->groups);
  VL_ARRAY_FREE(context, &scene->instances);
  VL_ARRAY_FREE(context, &scene->blocks);
  VL_ARRAY_FREE(context, &scene->images);
  VL_ARRAY_FREE(context, &scene->files);
  VL_ARRAY_FREE(context, &scene->choices);
  VL_ARRAY_FREE(context, &scene->unread);
  VL_ARRAY_FREE(context, &scene->frame_points);
  vl_free(context, scene);
}

vlResult vl_scene_result(const vlScene *scene, vlError *error) {
  if (!scene)
    return vl_fail(error, VL_ERROR_ARGUMENT, "no scene");
  if (error)
    *error = scene->error;
  return scene->error.code;
}

vlSceneDefs *vl_scene_defs(vlScene *scene) {
  return &scene->defs;
}

#define COUNT_KINDS(name, array, marks)                        \
  if (strcmp(family, name) == 0) {                             \
    for (size_t i = 0; i < scene->array.count; i++)            \
      count += (uint32_t)scene->array.items[i].kind == kind && \
               !vl_scene_mark(&scene->marks, i).removed;       \
    return count;                                              \
  }

uint64_t vl_scene_kind_count(const vlScene *scene, const char *family, uint32_t kind) {
  uint64_t count = 0;
  COUNT_KINDS("materials", materials, material_marks)
  COUNT_KINDS("textures", textures, texture_marks)
  COUNT_KINDS("media", media, medium_marks)
  COUNT_KINDS("lights", lights, light_marks)
  COUNT_KINDS("shapes", shapes, shape_marks)
  return 0;
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
  for (size_t i = 0; i < scene->shapes.count; i++) {
    const vlShapeDef *shape = &scene->shapes.items[i];
    info->vertices += shape->vertices;
    if (shape->kind == VL_SHAPE_TRIANGLES)
      info->triangles += shape->faces;
    if (shape->emission.index)
      info->emissive_shapes++;
  }
  for (size_t i = 0; i < scene->lights.count; i++)
    info->lamps += vl_light_is_near(&scene->lights.items[i]);
  for (size_t i = 0; i < scene->emissions.count; i++)
    info->lamps += !vl_is_unset(scene->emissions.items[i].power);
  info->lamps -= vl_scene_removed_count(&scene->light_marks); /* they are point lights now */
}
