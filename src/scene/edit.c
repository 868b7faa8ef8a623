/* scene/edit.c: changes to objects of a scene (velo/edit.h). A new def is checked and stored by
 * the vl_scene_add_* function, while the scene looks as it did before the object was added; so
 * ids refer to lower ones only. */
#include "velo/edit.h"

#include <math.h>
#include <string.h>

#include "scene/scene.h"
#include "velo/light.h"
#include "velo/material.h"
#include "velo/medium.h"
#include "velo/shape_kinds.h"
#include "velo/texture.h"

/* ---- defs -------------------------------------------------------------------------------- */

#define ITEM(scene, array, id)                                 \
  ((scene) && (id).index && (id).index <= (scene)->array.count \
       ? &(scene)->array.items[(id).index - 1]                 \
       : NULL)

const vlTextureDef *vl_scene_texture(const vlScene *scene, vlTextureId id) {
  return vl_scene_has(scene, VL_SCENE_TEXTURES, id.index) ? ITEM(scene, textures, id) : NULL;
}
const vlMaterialDef *vl_scene_material(const vlScene *scene, vlMaterialId id) {
  return vl_scene_has(scene, VL_SCENE_MATERIALS, id.index) ? ITEM(scene, materials, id) : NULL;
}
const vlEmissionDef *vl_scene_emission(const vlScene *scene, vlEmissionId id) {
  return vl_scene_has(scene, VL_SCENE_EMISSIONS, id.index) ? ITEM(scene, emissions, id) : NULL;
}
const vlLightDef *vl_scene_light(const vlScene *scene, vlLightId id) {
  return vl_scene_has(scene, VL_SCENE_LIGHTS, id.index) ? ITEM(scene, lights, id) : NULL;
}
const vlMediumDef *vl_scene_medium(const vlScene *scene, vlMediumId id) {
  return vl_scene_has(scene, VL_SCENE_MEDIA, id.index) ? ITEM(scene, media, id) : NULL;
}
const vlShapeDef *vl_scene_shape(const vlScene *scene, vlShapeId id) {
  const vlShapeDef *def = ITEM(scene, shapes, id);
  return def && !vl_scene_shape_is_removed(scene, id.index - 1) ? def : NULL;
}

vlResult vl_scene_instance(const vlScene *scene, vlInstanceId id, vlInstanceInfo *info) {
  const vlSceneInstance *instance = ITEM(scene, instances, id);
  if (!instance || instance->removed || !info)
    return VL_ERROR_ARGUMENT;
  *info = (vlInstanceInfo){.group = instance->group,
                           .moves = instance->keys > 0,
                           .keys = instance->keys,
                           .times = instance->keys > 0 ? instance->times : NULL,
                           .poses = instance->keys > 0 ? instance->poses : NULL,
                           .shown = !instance->hidden,
                           .source = instance->source,
                           .label = instance->label};
  memcpy(info->world_from_group, instance->world_from_group, sizeof info->world_from_group);
  return VL_OK;
}

/* ---- checks ------------------------------------------------------------------------------ */

static vlResult check(const vlScene *scene, bool found, const char *what, vlError *error) {
  vl_error_clear(error);
  if (!scene)
    return vl_fail(error, VL_ERROR_ARGUMENT, "%s: scene is null", what);
  if (scene->error.code != VL_OK)
    return vl_scene_result(scene, error);
  return found ? VL_OK
               : vl_fail(error, VL_ERROR_ARGUMENT, "%s: there is no such %s", what, what);
}

/* Takes the error of a failed change out of the scene. */
static vlResult take_error(vlScene *scene, vlError *error) {
  vlResult result = scene->error.code;
  if (error)
    *error = scene->error;
  vl_error_clear(&scene->error);
  return result;
}

/* ---- replacing a def --------------------------------------------------------------------- */

/* A def that is set again keeps its image, which another object may then have, too. */
bool vl_scene_image_is_used(const vlScene *scene, const vlImage *image) {
  bool used = false;
  for (size_t i = 0; i < scene->textures.count; i++)
    used = used || scene->textures.items[i].image == image;
  for (size_t i = 0; i < scene->lights.count; i++)
    used = used || scene->lights.items[i].image == image;
  return used;
}

/* Frees what an earlier change of the object has allocated; entries from `end` on are of this
 * change. */
void vl_scene_free_edits(vlScene *scene, const void *array, uint32_t id, size_t end) {
  size_t kept = 0;
  for (size_t i = 0; i < scene->edits.count; i++) {
    vlSceneEdit e = scene->edits.items[i];
    if (i < end && e.array == array && e.id == id &&
        !(e.image && vl_scene_image_is_used(scene, e.image))) {
      vl_free(scene->context, e.block);
      vl_image_destroy(e.image);
    } else {
      scene->edits.items[kept++] = e;
    }
  }
  scene->edits.count = kept;
}

/* Moves the blocks and images that the change has added to the scene's lists into its edits.
 * There is room. */
static void note_edits(vlScene *scene, const void *array, uint32_t id, size_t blocks,
                       size_t images) {
  for (size_t i = blocks; i < scene->blocks.count; i++)
    scene->edits.items[scene->edits.count++] =
        (vlSceneEdit){array, id, scene->blocks.items[i], NULL};
  for (size_t i = images; i < scene->images.count; i++)
    scene->edits.items[scene->edits.count++] =
        (vlSceneEdit){array, id, NULL, scene->images.items[i]};
  scene->blocks.count = blocks;
  scene->images.count = images;
}

/* Ends a change: what the failed or the replaced def has allocated is freed. */
static vlResult finish(vlScene *scene, const void *array, uint32_t id, size_t blocks,
                       size_t images, bool done, vlError *error) {
  size_t old = scene->edits.count;
  if (done && VL_RESERVE(scene->context, &scene->edits,
                         scene->blocks.count - blocks + scene->images.count - images)) {
    note_edits(scene, array, id, blocks, images);
    vl_scene_free_edits(scene, array, id, old);
    return VL_OK;
  }
  if (done)
    return VL_OK; /* no memory for the list: the blocks stay with the scene */
  for (size_t i = blocks; i < scene->blocks.count; i++)
    vl_free(scene->context, scene->blocks.items[i]);
  for (size_t i = images; i < scene->images.count; i++)
    vl_image_destroy(scene->images.items[i]);
  scene->blocks.count = blocks;
  scene->images.count = images;
  return take_error(scene, error);
}

vlSceneMark *vl_scene_mark_of(vlScene *scene, vlSceneMarks *marks, uint32_t id) {
  while (marks->count < id) {
    vlSceneMark *mark = VL_PUSH(scene->context, marks);
    if (!mark)
      return NULL;
  }
  return &marks->items[id - 1];
}

/* A removed object is there again. */
static void note_change(vlScene *scene, vlSceneMark *mark) {
  mark->generation = vl_context_number(scene->context);
  if (!mark->removed)
    return;
  mark->removed = false;
  mark->hidden = false;
  mark->serial = mark->generation;
}

/* Sets the object of an array by the function that adds one. After success the object's mark
 * has a new generation. */
#define SET(scene, array, marks, add, id, def, what, error)                          \
  do {                                                                               \
    VL_TRY(check(scene, ITEM(scene, array, id) != NULL, what, error));               \
    vlSceneMark *mark = vl_scene_mark_of(scene, &(scene)->marks, (id).index);        \
    if (!mark)                                                                       \
      return vl_fail_memory(error);                                                  \
    if (!(def))                                                                      \
      return vl_fail(error, VL_ERROR_ARGUMENT, "%s: def is null", what);             \
    vlSource source = (def)->source; /* its file's name outlives the change */       \
    if (!vl_scene_copy_source(scene, &source))                                       \
      return take_error(scene, error);                                               \
    size_t blocks = (scene)->blocks.count, images = (scene)->images.count;           \
    size_t count = (scene)->array.count;                                             \
    const size_t at = (id).index - 1;                                                \
    __typeof__(*(scene)->array.items) old = (scene)->array.items[at];                \
    (scene)->array.count = at;                                                       \
    bool done = add(scene, def).index != 0;                                          \
    (scene)->array.count = count;                                                    \
    if (!done)                                                                       \
      (scene)->array.items[at] = old;                                                \
    VL_TRY(finish(scene, &(scene)->array, (id).index, blocks, images, done, error)); \
    note_change(scene, mark);                                                        \
    return VL_OK;                                                                    \
  } while (0)

vlResult vl_scene_set_texture(vlScene *scene, vlTextureId id, const vlTextureDef *def,
                              vlError *error) {
  VL_TRY(check(scene, ITEM(scene, textures, id) != NULL, "texture", error));
  const bool there = vl_scene_has(scene, VL_SCENE_TEXTURES, id.index);
  if (there && def && def->spectrum != scene->textures.items[id.index - 1].spectrum)
    return vl_fail(error, VL_ERROR_ARGUMENT, "texture: a texture of %s cannot become one of %s",
                   def->spectrum ? "floats" : "colours", def->spectrum ? "colours" : "floats");
  SET(scene, textures, texture_marks, vl_scene_add_texture, id, def, "texture", error);
}

vlResult vl_scene_set_material(vlScene *scene, vlMaterialId id, const vlMaterialDef *def,
                               vlError *error) {
  SET(scene, materials, material_marks, vl_scene_add_material, id, def, "material", error);
}

vlResult vl_scene_set_emission(vlScene *scene, vlEmissionId id, const vlEmissionDef *def,
                               vlError *error) {
  SET(scene, emissions, emission_marks, vl_scene_add_emission, id, def, "emission", error);
}

vlResult vl_scene_set_light(vlScene *scene, vlLightId id, const vlLightDef *def,
                            vlError *error) {
  SET(scene, lights, light_marks, vl_scene_add_light, id, def, "light", error);
}

vlResult vl_scene_set_medium(vlScene *scene, vlMediumId id, const vlMediumDef *def,
                             vlError *error) {
  SET(scene, media, medium_marks, vl_scene_add_medium, id, def, "medium", error);
}

static vlResult set_shape(vlScene *scene, vlShapeId id, const vlShapeDef *def, vlError *error) {
  SET(scene, shapes, shape_marks, vl_scene_add_shape, id, def, "shape", error);
}

/* ---- shapes, lights ---------------------------------------------------------------------- */

static vlResult show(vlScene *scene, vlSceneMarks *marks, uint32_t id, bool shown,
                     vlError *error) {
  vlSceneMark *mark = vl_scene_mark_of(scene, marks, id);
  if (!mark)
    return vl_fail_memory(error);
  mark->hidden = !shown;
  return VL_OK;
}

vlResult vl_scene_show_light(vlScene *scene, vlLightId id, bool shown, vlError *error) {
  VL_TRY(check(scene, vl_scene_light(scene, id) != NULL, "light", error));
  return show(scene, &scene->light_marks, id.index, shown, error);
}

vlResult vl_scene_show_shape(vlScene *scene, vlShapeId id, bool shown, vlError *error) {
  VL_TRY(check(scene, vl_scene_shape(scene, id) != NULL, "shape", error));
  return show(scene, &scene->shape_marks, id.index, shown, error);
}

void vl_scene_free_blocks(vlScene *scene, const void *const *own, int count) {
  size_t kept = 0;
  for (size_t i = 0; i < scene->blocks.count; i++) {
    void *block = scene->blocks.items[i];
    bool found = false;
    for (int k = 0; k < count; k++)
      found = found || own[k] == block;
    if (found)
      vl_free(scene->context, block);
    else
      scene->blocks.items[kept++] = block;
  }
  scene->blocks.count = kept;
}

/* Frees the arrays and names of a shape as it was added. Later ones are among the edits. */
static void free_added(vlScene *scene, const vlShapeDef *def) {
  enum { NAMES = 3 };
  const void *own[VL_SHAPE_ARRAYS + NAMES];
  vl_shape_arrays(def, own);
  own[VL_SHAPE_ARRAYS] = def->label.name;
  own[VL_SHAPE_ARRAYS + 1] = def->label.path;
  own[VL_SHAPE_ARRAYS + 2] = def->label.place;
  vl_scene_free_blocks(scene, own, VL_SHAPE_ARRAYS + NAMES);
}

/* Ends the change of a shape, old as it was before. */
static void end_change(vlScene *scene, const vlShapeDef *old) {
  free_added(scene, old);
  if (old->group.index)
    scene->groups.items[old->group.index - 1].shape_count--;
}

void vl_scene_forget_removed_shape(vlScene *scene, uint32_t id) {
  size_t kept = 0;
  for (size_t i = 0; i < scene->removed_shapes.count; i++)
    if (scene->removed_shapes.items[i] != id)
      scene->removed_shapes.items[kept++] = scene->removed_shapes.items[i];
  scene->removed_shapes.count = kept;
}

vlResult vl_scene_set_shape(vlScene *scene, vlShapeId id, const vlShapeDef *def,
                            vlError *error) {
  VL_TRY(check(scene, ITEM(scene, shapes, id) != NULL, "shape", error));
  const vlShapeDef old = scene->shapes.items[id.index - 1];
  const bool removed = vl_scene_shape_is_removed(scene, id.index - 1);
  VL_TRY(set_shape(scene, id, def, error));
  end_change(scene, &old);
  if (removed)
    vl_scene_forget_removed_shape(scene, id.index);
  return VL_OK;
}

vlResult vl_scene_remove_shape(vlScene *scene, vlShapeId id, vlError *error) {
  VL_TRY(check(scene, vl_scene_shape(scene, id) != NULL, "shape", error));
  vlSceneMark *mark = vl_scene_mark_of(scene, &scene->shape_marks, id.index);
  uint32_t *slot = mark ? VL_PUSH(scene->context, &scene->removed_shapes) : NULL;
  if (!slot)
    return vl_fail_memory(error);
  *slot = id.index;
  vlShapeDef *def = &scene->shapes.items[id.index - 1];
  end_change(scene, def);
  mark->generation = vl_context_number(scene->context);
  vl_scene_free_edits(scene, &scene->shapes, id.index, scene->edits.count);
  *def = vl_default_shape_def(VL_SHAPE_TRIANGLES);
  mark->removed = mark->hidden = true;
  return VL_OK;
}

vlShapeId vl_scene_removed_shape(const vlScene *scene) {
  vlShapeId first = {0};
  for (size_t i = 0; scene && i < scene->removed_shapes.count; i++)
    if (first.index == 0 || scene->removed_shapes.items[i] < first.index)
      first.index = scene->removed_shapes.items[i];
  return first;
}

uint64_t vl_scene_shape_serial(const vlScene *scene, vlShapeId id) {
  return vl_scene_shape(scene, id) ? vl_scene_mark(&scene->shape_marks, id.index - 1).serial
                                   : 0;
}

vlResult vl_scene_set_shape_material(vlScene *scene, vlShapeId id, vlMaterialId material,
                                     vlError *error) {
  VL_TRY(check(scene, vl_scene_shape(scene, id) != NULL, "shape", error));
  VL_TRY(check(scene,
               !material.index || vl_scene_has(scene, VL_SCENE_MATERIALS, material.index),
               "material", error));
  scene->shapes.items[id.index - 1].material = material;
  return VL_OK;
}

vlResult vl_scene_set_shape_emission(vlScene *scene, vlShapeId id, vlEmissionId emission,
                                     vlError *error) {
  VL_TRY(check(scene, vl_scene_shape(scene, id) != NULL, "shape", error));
  VL_TRY(check(scene,
               !emission.index || vl_scene_has(scene, VL_SCENE_EMISSIONS, emission.index),
               "emission", error));
  const vlShapeDef *shape = &scene->shapes.items[id.index - 1];
  if (emission.index && !vl_shape_may_emit(shape))
    return vl_fail(error, VL_ERROR_SCENE, "shape: a shape of this kind cannot emit light");
  scene->shapes.items[id.index - 1].emission = emission;
  return VL_OK;
}

/* ---- instances --------------------------------------------------------------------------- */

static vlResult find_instance(vlScene *scene, vlInstanceId id, vlSceneInstance **instance,
                              vlError *error) {
  *instance = ITEM(scene, instances, id);
  return check(scene, *instance && !(*instance)->removed, "instance", error);
}

vlResult vl_scene_set_instance(vlScene *scene, vlInstanceId id,
                               const double world_from_group[16], vlError *error) {
  vlSceneInstance *instance;
  VL_TRY(find_instance(scene, id, &instance, error));
  for (int i = 0; i < 16; i++)
    if (!world_from_group || !isfinite(world_from_group[i]))
      return vl_fail(error, VL_ERROR_SCENE, "instance: transform is not finite");
  memcpy(instance->world_from_group, world_from_group, sizeof instance->world_from_group);
  instance->keys = 0;
  return VL_OK;
}

vlResult vl_scene_show_instance(vlScene *scene, vlInstanceId id, bool shown, vlError *error) {
  vlSceneInstance *instance;
  VL_TRY(find_instance(scene, id, &instance, error));
  instance->hidden = !shown;
  return VL_OK;
}

vlResult vl_scene_remove_instance(vlScene *scene, vlInstanceId id, vlError *error) {
  vlSceneInstance *instance;
  VL_TRY(find_instance(scene, id, &instance, error));
  uint32_t *slot = VL_PUSH(scene->context, &scene->removed_instances);
  if (!slot)
    return vl_fail_memory(error);
  *slot = id.index;
  const void *const own[] = {instance->times, instance->poses, instance->label.name,
                             instance->label.path, instance->label.place};
  vl_scene_free_blocks(scene, own, sizeof own / sizeof *own);
  instance->times = instance->poses = NULL;
  instance->keys = 0;
  instance->label = (vlLabel){0};
  instance->removed = instance->hidden = true;
  scene->groups.items[instance->group.index - 1].instance_count--;
  return VL_OK;
}

vlInstanceId vl_scene_fill_instance(vlScene *scene) {
  if (!scene || scene->instances.count == 0 || scene->removed_instances.count == 0)
    return (vlInstanceId){scene ? (uint32_t)scene->instances.count : 0};
  uint32_t *ids = scene->removed_instances.items;
  size_t lowest = 0;
  for (size_t i = 1; i < scene->removed_instances.count; i++)
    lowest = ids[i] < ids[lowest] ? i : lowest;
  const vlInstanceId freed = {ids[lowest]};
  vlSceneInstance *last = &scene->instances.items[scene->instances.count - 1];
  if (last->removed)
    return (vlInstanceId){0};
  ids[lowest] = ids[--scene->removed_instances.count];
  scene->instances.items[freed.index - 1] = *last;
  scene->instances.items[freed.index - 1].serial = vl_context_number(scene->context);
  scene->instances.count--;
  return freed;
}

uint64_t vl_scene_instance_serial(const vlScene *scene, vlInstanceId id) {
  const vlSceneInstance *instance = ITEM(scene, instances, id);
  return instance && !instance->removed ? instance->serial : 0;
}
