/* world/build.c: compiles a scene into a constant world: materials (with their textures),
 * shapes, lights, accelerator. */
#include <stddef.h>
#include <string.h>

#include "base/cookie.h"
#include "base/error.h"
#include "base/file.h"
#include "base/free.h"
#include "base/machine.h"
#include "base/text.h"
#include "scene/scene.h"
#include "schema/schema.h"
#include "world/part.h"
#include "world/world.h"

/* ---- parts (part.h) ---------------------------------------------------------------------- */

vlPart *vl_part_add(vlWorld *world) {
  vlPart **slot = VL_PUSH(world->context, &world->parts);
  if (!slot)
    return NULL;
  vlPart *part = *slot = vl_alloc_zero(world->context, 1, sizeof *part);
  if (!part) {
    world->parts.count--;
    return NULL;
  }
  part->context = world->context;
  atomic_init(&part->users, 1);
  return part;
}

static void release_part(vlPart *part) {
  if (atomic_fetch_sub(&part->users, 1) > 1)
    return;
  vlContext *context = part->context;
  if (part->destroy)
    part->destroy(context, part->object);
  for (size_t i = 0; i < part->blocks.count; i++)
    vl_free(context, part->blocks.items[i]);
  VL_ARRAY_FREE(context, &part->blocks);
  vl_free(context, part);
}

bool vl_part_share(vlWorld *world, vlPart *part) {
  vlPart **slot = VL_PUSH(world->context, &world->parts);
  if (!slot)
    return false;
  atomic_fetch_add(&part->users, 1);
  *slot = part;
  return true;
}

void vl_part_drop(vlWorld *world, vlPart *part) {
  size_t i = world->parts.count;
  while (i > 0 && world->parts.items[i - 1] != part)
    i--;
  if (i == 0)
    return;
  world->parts.items[i - 1] = world->parts.items[--world->parts.count];
  release_part(part);
}

/* ---- memory of a world ------------------------------------------------------------------- */

void *vl_world_block(vlWorld *world, size_t count, size_t size) {
  void **slot = world->part ? VL_PUSH(world->context, &world->part->blocks)
                            : VL_PUSH(world->context, &world->blocks);
  if (!slot)
    return NULL;
  *slot = vl_alloc_array(world->context, count ? count : 1, size);
  return *slot;
}

bool vl_world_copy_floats(vlWorld *world, const float *from, size_t count, float **to) {
  if (!from)
    return true;
  if (!(*to = vl_world_block(world, count, sizeof **to)))
    return false;
  memcpy(*to, from, count * sizeof **to);
  return true;
}

/* ---- building ---------------------------------------------------------------------------- */

vlResult vl_world_step(const vlWorld *world, const char *name, double fraction,
                       vlError *error) {
  return vl_task_stopped(world->task, name, fraction) ? vl_fail(error, VL_CANCELLED, "stopped")
                                                      : VL_OK;
}

/* The previous world, if the new one can share its parts. */
static const vlWorld *usable(const vlWorld *previous, const vlBuildDef *d) {
  if (!previous)
    return NULL;
  const vlBuildDef *p = &previous->def;
  return p->color == d->color && p->bits == d->bits && p->imitate_pbrt == d->imitate_pbrt
             ? previous
             : NULL;
}

/* Does the work of a build. giving: as in build. */
static vlResult fill(vlWorld *world, const vlScene *scene, vlScene *giving, vlError *error) {
  VL_TRY(vl_world_step(world, "images", 0, error));
  VL_TRY(vl_world_preload_images(world, scene, error));
  VL_TRY(vl_world_add_materials(world, scene, error));
  VL_TRY(vl_world_add_shapes(world, scene, error));
  VL_TRY(vl_world_add_media(world, scene, error));
  VL_TRY(vl_world_add_origins(world, scene, error));
  VL_TRY(vl_world_add_lights(world, scene, error));
  if (giving)
    vl_scene_drop_meshes(giving); /* frees memory before the accelerator allocates */
  VL_TRY(vl_accel_build(world, error));
  return vl_world_step(world, "accelerator", 1, error);
}

/* giving: the same scene if its meshes may be freed during the build, else null. */
static vlResult build(const vlScene *scene, vlScene *giving, const vlBuildDef *def,
                      vlWorld **result, vlError *error) {
  vl_error_clear(error);
  if (!result)
    return vl_fail_argument(error, "world build: result is null");
  *result = NULL;
  if (!scene)
    return vl_fail_argument(error, "world build: scene is null");
  vlBuildDef d = def ? *def : vl_default_build_def();
  if (d.cookie != VL_COOKIE_BUILD)
    return vl_fail_argument(error, "world build: " VL_BAD_COOKIE);
  char wrong[VL_GIVEN_MESSAGE];
  if (!vl_choices_check(VL_SETTING_RENDER, offsetof(vlSceneDefs, build), sizeof d, &d, wrong))
    return vl_fail_argument(error, "world build: %s", wrong);
  VL_TRY(vl_scene_result(scene, error));
  if (scene->meshes_dropped)
    return vl_fail_argument(error,
                            "world build: the scene gave its meshes to an earlier world");
  if (d.previous && d.previous->context != scene->context)
    return vl_fail_argument(error, "world build: the previous world is of another context");
  double start = vl_seconds();
  vlWorld *world = vl_alloc_zero(scene->context, 1, sizeof *world);
  if (!world)
    return vl_fail_memory(error);
  vlTask task;
  vl_task_start(&task, d.cancel, d.progress, d.progress_user);
  world->context = scene->context;
  world->def = d;
  world->scene_number = scene->number;
  world->number = vl_context_number(scene->context);
  world->previous = usable(d.previous, &d);
  world->def.previous = NULL;
  world->def.cancel = NULL;
  world->def.progress = NULL;
  world->def.progress_user = NULL;
  world->task = &task;
  vlError local;
  vl_error_clear(&local);
  vlResult r = fill(world, scene, giving, &local);
  world->texture_memo = NULL;
  world->task = NULL;
  world->previous = NULL;
  world->part = NULL;
  if (r != VL_OK) {
    if (error)
      *error = local;
    vl_world_destroy(world);
    return r;
  }
  memcpy(world->info.bounds_min, world->bounds_min, 3 * sizeof *world->info.bounds_min);
  memcpy(world->info.bounds_max, world->bounds_max, 3 * sizeof *world->info.bounds_max);
  world->info.build_seconds = vl_seconds() - start;
  for (size_t i = 0; i < world->images.count; i++)
    world->info.texture_bytes += vl_mipmap_bytes(world->images.items[i].mipmap);
  world->info.bytes = vl_context_memory(world->context, NULL);
  *result = world;
  return VL_OK;
}

vlResult vl_world_build(const vlScene *scene, const vlBuildDef *def, vlWorld **result,
                        vlError *error) {
  unsigned floats = vl_machine_set_floats();
  vlResult r = build(scene, NULL, def, result, error);
  vl_machine_restore_floats(floats);
  return r;
}

vlResult vl_world_build_last(vlScene *scene, const vlBuildDef *def, vlWorld **result,
                             vlError *error) {
  unsigned floats = vl_machine_set_floats();
  vlResult r = build(scene, scene, def, result, error);
  vl_machine_restore_floats(floats);
  return r;
}

void vl_world_destroy(vlWorld *world) {
  if (!world)
    return;
  vlContext *c = world->context;
  vl_accel_destroy(c, &world->accel);
  for (size_t i = 0; i < world->parts.count; i++)
    release_part(world->parts.items[i]); /* after the accelerator */
  for (size_t i = 0; i < world->blocks.count; i++)
    vl_free(c, world->blocks.items[i]);
  VL_FREE(c, world->parts.items, world->blocks.items, world->shapes.items, world->groups.items,
          world->instances.items, world->materials.items, world->nodes.items,
          world->images.items, world->emitted.items, world->lights.items,
          world->infinite_lights.items, world->environments.items,
          world->environment_parts.items, world->lamps.items, world->measured.items,
          world->measured_parts.items, world->medium_parts.items, world->coats.items,
          world->media.items, world);
}

void vl_world_warn(const vlWorld *world, vlSource source, const char *format, ...) {
  char text[512];
  VL_FORMAT(text, format);
  vlError where;
  vl_fail_source(&where, VL_ERROR_SCENE, source, " ");
  vl_log(world->context, VL_LOG_WARNING, &where, "%s", text);
}

vlResult vl_world_locate_error(vlSource source, vlError *error, vlResult r) {
  if (r == VL_OK || r == VL_ERROR_MEMORY || !error || error->line)
    return r;
  char message[sizeof error->message];
  memcpy(message, error->message, sizeof message);
  return vl_fail_source(error, r, source, "%s", message);
}

void vl_world_info(const vlWorld *world, vlWorldInfo *info) {
  *info = world->info;
  info->moves = world->moves;
  info->time_open = world->moves ? world->time_open : 0;
  info->time_close = world->moves ? world->time_close : 0;
}
