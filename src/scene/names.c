/* scene/names.c: what a scene's ids stand for, and what its file lets one choose. */
#include <string.h>

#include "scene/scene.h"
#include "schema/schema.h"
#include "velo/material.h"
#include "velo/shape.h"

/* Whether an instance is in the worlds of the scene: those without shapes are not, nor those
 * that are hidden. */
static bool is_placed(const vlScene *scene, const vlSceneInstance *instance) {
  return !instance->hidden && scene->groups.items[instance->group.index - 1].shape_count > 0;
}

uint32_t vl_scene_id_count(const vlScene *scene, vlIdKind kind) {
  if (!scene)
    return 0;
  uint32_t placed = 0;
  switch (kind) {
    case VL_ID_OBJECT:
      return (uint32_t)scene->shapes.count;
    case VL_ID_MATERIAL:
      return (uint32_t)scene->materials.count + 1;
    case VL_ID_INSTANCE:
      for (size_t i = 0; i < scene->instances.count; i++)
        placed += is_placed(scene, &scene->instances.items[i]);
      return placed;
  }
  return 0;
}

static const vlSceneInstance *find_instance(const vlScene *scene, uint32_t id) {
  for (size_t i = 0; i < scene->instances.count; i++)
    if (is_placed(scene, &scene->instances.items[i]) && --id == 0)
      return &scene->instances.items[i];
  return NULL;
}

static void set_label(vlIdInfo *info, const vlLabel *label) {
  info->name = label->name;
  info->path = label->path;
  info->place = label->place;
}

vlResult vl_scene_id_info(const vlScene *scene, vlIdKind kind, uint32_t id, vlIdInfo *info) {
  if (!scene || !info || id == 0 || id > vl_scene_id_count(scene, kind))
    return VL_ERROR_ARGUMENT;
  memset(info, 0, sizeof *info);
  if (kind == VL_ID_OBJECT) {
    const vlShapeDef *d = &scene->shapes.items[id - 1];
    set_label(info, &d->label);
    info->type = vl_kind_row(&vl_shape_family, (int)d->kind)->name;
    info->source = d->source;
    info->material = d->material.index + 1;
  } else if (kind == VL_ID_MATERIAL) {
    info->type = vl_kind_row(&vl_material_family, VL_MATERIAL_DIFFUSE)->name;
    if (id == 1)
      return VL_OK; /* the default material */
    const vlMaterialDef *d = &scene->materials.items[id - 2];
    set_label(info, &(vlLabel){d->name, NULL, d->place});
    info->type = vl_kind_row(&vl_material_family, (int)d->kind)->name;
    info->source = d->source;
  } else {
    const vlSceneInstance *instance = find_instance(scene, id);
    if (!instance)
      return VL_ERROR_ARGUMENT;
    const char *group = scene->groups.items[instance->group.index - 1].name;
    set_label(info, &instance->label);
    info->shared_name = !info->name;
    if (!info->name && group[0])
      info->name = group;
    info->type = "instance";
    info->source = instance->source;
  }
  return VL_OK;
}

/* ---- choices ----------------------------------------------------------------------------- */

bool vl_scene_add_choice(vlScene *scene, vlChoiceKind kind, const char *name, double seconds) {
  if (!vl_scene_copy_string(scene, &name))
    return false;
  vlSceneChoice *choice = VL_PUSH(scene->context, &scene->choices);
  if (!choice)
    return vl_scene_fail_memory(scene);
  *choice = (vlSceneChoice){kind, {name, seconds}};
  return true;
}

uint32_t vl_scene_choice_count(const vlScene *scene, vlChoiceKind kind) {
  uint32_t count = 0;
  for (size_t i = 0; scene && i < scene->choices.count; i++)
    count += scene->choices.items[i].kind == kind;
  return count;
}

vlResult vl_scene_choice_info(const vlScene *scene, vlChoiceKind kind, uint32_t index,
                              vlChoiceInfo *info) {
  for (size_t i = 0; scene && info && i < scene->choices.count; i++)
    if (scene->choices.items[i].kind == kind && index-- == 0) {
      *info = scene->choices.items[i].info;
      return VL_OK;
    }
  return VL_ERROR_ARGUMENT;
}
