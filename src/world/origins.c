/* world/origins.c: what ids refer to: type, name and source location of each shape, material
 * and instance. Not read while rendering. */
#include <string.h>

#include "base/error.h"
#include "scene/scene.h"
#include "schema/schema.h"
#include "velo/channels.h"
#include "velo/material.h"
#include "velo/shape_kinds.h"
#include "world/world.h"

static const char *shape_type(vlShapeKind kind) {
#define NAME(kind, name) [kind] = #name,
  static const char *const names[] = {VL_SHAPE_KINDS(NAME)};
#undef NAME
  return names[kind];
}

static const char *copy_text(vlWorld *world, const char *text) {
  size_t size = strlen(text) + 1;
  char *copy = vl_world_block(world, size, 1);
  if (copy)
    memcpy(copy, text, size);
  return copy;
}

static bool copy_label(vlWorld *world, const vlLabel *from, vlLabel *to) {
  const char *const texts[3] = {from->name, from->path, from->place};
  const char **copies[3] = {&to->name, &to->path, &to->place};
  for (int k = 0; k < 3; k++)
    if (texts[k] && texts[k][0] && !(*copies[k] = copy_text(world, texts[k])))
      return false;
  return true;
}

/* Sources share their file names (scene/scene.h): each name is copied once. */
typedef struct Files {
  const char **copies; /* one per file in scene->files */
  size_t last;         /* index of the previous lookup's result */
} Files;

static void copy_source(Files *files, const vlScene *scene, vlSource source, vlSource *copy) {
  *copy = source;
  copy->file = NULL;
  for (size_t i = 0; source.file && i < scene->files.count; i++) {
    size_t at = (files->last + i) % scene->files.count;
    if (scene->files.items[at] != source.file)
      continue;
    copy->file = files->copies[at];
    files->last = at;
    return;
  }
}

static vlResult fill(vlWorld *world, const vlScene *scene, Files *files) {
  for (size_t i = 0; i < scene->shapes.count; i++) {
    vlWorldOrigin *o = &world->shape_origins[i];
    copy_source(files, scene, scene->shapes.items[i].source, &o->source);
    if (!copy_label(world, &scene->shapes.items[i].label, &o->label))
      return VL_ERROR_MEMORY;
  }
  /* the world's first material is the default material */
  for (size_t i = 0; i < scene->materials.count; i++) {
    vlWorldOrigin *o = &world->material_origins[i + 1];
    const vlMaterialDef *def = &scene->materials.items[i];
    copy_source(files, scene, def->source, &o->source);
    if (!copy_label(world, &(vlLabel){def->name, NULL, def->place}, &o->label))
      return VL_ERROR_MEMORY;
  }
  const char **names = vl_world_block(world, scene->groups.count, sizeof(char *));
  if (!names)
    return VL_ERROR_MEMORY;
  for (size_t i = 0; i < scene->groups.count; i++) {
    const char *name = scene->groups.items[i].name;
    names[i] = name[0] ? copy_text(world, name) : NULL;
    if (name[0] && !names[i])
      return VL_ERROR_MEMORY;
  }
  size_t next = 0;
  for (size_t i = 0; i < scene->instances.count; i++) { /* as in add_instances (shapes.c) */
    const vlSceneInstance *instance = &scene->instances.items[i];
    uint32_t group = instance->group.index;
    if (instance->hidden || world->groups.items[group].count == 0 ||
        next >= world->instances.count)
      continue;
    vlWorldOrigin *o = &world->instance_origins[next++];
    copy_source(files, scene, instance->source, &o->source);
    if (!copy_label(world, &instance->label, &o->label))
      return VL_ERROR_MEMORY;
    if (o->label.name)
      continue;
    o->label.name = names[group - 1];
    o->shared = true;
  }
  return VL_OK;
}

static vlWorldOrigin *make_origins(vlWorld *world, size_t count) {
  vlWorldOrigin *o = vl_world_block(world, count, sizeof *o);
  if (o)
    memset(o, 0, (count ? count : 1) * sizeof *o);
  return o;
}

vlResult vl_world_add_origins(vlWorld *world, const vlScene *scene, vlError *error) {
  world->shape_origins = make_origins(world, world->shapes.count);
  world->material_origins = make_origins(world, world->materials.count);
  world->instance_origins = make_origins(world, world->instances.count);
  Files files = {vl_world_block(world, scene->files.count, sizeof(char *)), 0};
  if (!world->shape_origins || !world->material_origins || !world->instance_origins ||
      !files.copies)
    return vl_fail_memory(error);
  for (size_t i = 0; i < scene->files.count; i++)
    if (!(files.copies[i] = copy_text(world, scene->files.items[i])))
      return vl_fail_memory(error);
  return fill(world, scene, &files) == VL_OK ? VL_OK : vl_fail_memory(error);
}

uint32_t vl_world_id_count(const vlWorld *world, vlIdKind kind) {
  if (!world)
    return 0;
  switch (kind) {
    case VL_ID_OBJECT:
      return (uint32_t)world->shapes.count;
    case VL_ID_MATERIAL:
      return (uint32_t)world->materials.count;
    case VL_ID_INSTANCE:
      return (uint32_t)world->instances.count;
  }
  return 0;
}

vlResult vl_world_id_info(const vlWorld *world, vlIdKind kind, uint32_t id, vlIdInfo *info) {
  if (!world || !info || id == 0 || id > vl_world_id_count(world, kind))
    return VL_ERROR_ARGUMENT;
  memset(info, 0, sizeof *info);
  const vlWorldOrigin *o = NULL;
  switch (kind) {
    case VL_ID_OBJECT:
      o = &world->shape_origins[id - 1];
      info->type = shape_type(world->shapes.items[id - 1].kind);
      info->material = world->shapes.items[id - 1].material + 1;
      break;
    case VL_ID_MATERIAL:
      o = &world->material_origins[id - 1];
      info->type =
          vl_kind_row(&vl_material_family, (int)world->materials.items[id - 1].kind)->name;
      break;
    case VL_ID_INSTANCE:
      o = &world->instance_origins[id - 1];
      info->type = "instance";
      break;
  }
  info->name = o->label.name;
  info->path = o->label.path;
  info->place = o->label.place;
  info->shared_name = o->shared;
  info->source = o->source;
  return VL_OK;
}
