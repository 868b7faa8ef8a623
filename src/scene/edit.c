/* scene/edit.c: changes to objects of a scene (velo/edit.h). A new def is checked and stored by
 * the vl_scene_add_* function, while the scene looks as it did before the object was added; so
 * ids refer to lower ones only. */
#include "velo/edit.h"

#include <math.h>
#include <string.h>

#include "base/text.h"
#include "scene/family.h"
#include "velo/light.h"
#include "velo/material.h"
#include "velo/medium.h"
#include "velo/shape_kinds.h"
#include "velo/texture.h"

/* ---- defs -------------------------------------------------------------------------------- */

const vlTextureDef *vl_scene_texture(const vlScene *scene, vlTextureId id) {
  return vl_scene_item(scene, VL_SCENE_TEXTURES, id.index);
}
const vlMaterialDef *vl_scene_material(const vlScene *scene, vlMaterialId id) {
  return vl_scene_item(scene, VL_SCENE_MATERIALS, id.index);
}
const vlEmissionDef *vl_scene_emission(const vlScene *scene, vlEmissionId id) {
  return vl_scene_item(scene, VL_SCENE_EMISSIONS, id.index);
}
const vlLightDef *vl_scene_light(const vlScene *scene, vlLightId id) {
  return vl_scene_item(scene, VL_SCENE_LIGHTS, id.index);
}
const vlMediumDef *vl_scene_medium(const vlScene *scene, vlMediumId id) {
  return vl_scene_item(scene, VL_SCENE_MEDIA, id.index);
}
const vlShapeDef *vl_scene_shape(const vlScene *scene, vlShapeId id) {
  return vl_scene_item(scene, VL_SCENE_SHAPES, id.index);
}

vlResult vl_scene_instance(const vlScene *scene, vlInstanceId id, vlInstanceInfo *info) {
  const vlSceneInstance *instance = vl_scene_item(scene, VL_SCENE_INSTANCES, id.index);
  if (!instance || !info)
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
    return vl_fail_argument(error, "%s: scene is null", what);
  VL_TRY(vl_scene_result(scene, error));
  return found ? VL_OK : vl_fail_argument(error, "%s: there is no such %s", what, what);
}

/* Whether a change of this object may begin: the scene has no error, and the object is there.
 */
static vlResult check_object(const vlScene *scene, vlSceneFamily family, uint32_t index,
                             vlError *error) {
  return check(scene, vl_scene_has(scene, family, index), vl_scene_rows[family].thing, error);
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
void vl_scene_free_edits(vlScene *scene, vlSceneFamily family, uint32_t id, size_t end) {
  size_t kept = 0;
  for (size_t i = 0; i < scene->edits.count; i++) {
    vlSceneEdit e = scene->edits.items[i];
    if (i < end && e.family == family && e.id == id &&
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
static void note_edits(vlScene *scene, vlSceneFamily family, uint32_t id, size_t blocks,
                       size_t images) {
  for (size_t i = blocks; i < scene->blocks.count; i++)
    scene->edits.items[scene->edits.count++] =
        (vlSceneEdit){family, id, scene->blocks.items[i], NULL};
  for (size_t i = images; i < scene->images.count; i++)
    scene->edits.items[scene->edits.count++] =
        (vlSceneEdit){family, id, NULL, scene->images.items[i]};
  scene->blocks.count = blocks;
  scene->images.count = images;
}

/* Ends a change: what the failed or the replaced def has allocated is freed. */
static vlResult finish(vlScene *scene, vlSceneFamily family, uint32_t id, size_t blocks,
                       size_t images, bool done, vlError *error) {
  size_t old = scene->edits.count;
  if (done && VL_RESERVE(scene->context, &scene->edits,
                         scene->blocks.count - blocks + scene->images.count - images)) {
    note_edits(scene, family, id, blocks, images);
    vl_scene_free_edits(scene, family, id, old);
    return VL_OK;
  }
  if (done)
    return VL_OK; /* no memory for the list: the blocks stay with the scene */
  vl_scene_free_beyond(
      scene, (vlSceneCounts){blocks, images, scene->apertures.count, scene->optics.count});
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

void vl_scene_note_change(vlScene *scene, vlSceneMark *mark) {
  mark->generation = vl_context_number(scene->context);
  if (!mark->removed)
    return;
  mark->removed = false;
  mark->hidden = false;
  mark->serial = mark->generation;
}

/* A def of any family that has them. */
typedef union AnyDef {
  vlTextureDef texture;
  vlMaterialDef material;
  vlEmissionDef emission;
  vlLightDef light;
  vlMediumDef medium;
  vlShapeDef shape;
} AnyDef;

/* Sets an object by the function that adds one. After success the object's mark has a new
 * generation. */
static vlResult set_object(vlScene *scene, vlSceneFamily family, uint32_t id, const void *def,
                           vlError *error) {
  const vlSceneRow *row = &vl_scene_rows[family];
  void *object = vl_scene_at(scene, family, id); /* a removed one, too */
  VL_TRY(check(scene, object != NULL, row->thing, error));
  vlSceneMark *mark = vl_scene_mark_of(scene, vl_scene_marks(scene, family), id);
  if (!mark)
    return vl_fail_memory(error);
  if (!def)
    return vl_fail_argument(error, "%s: def is null", row->thing);
  vlSource source = vl_scene_def_source(family, def); /* its file's name outlives the change */
  if (!vl_scene_copy_source(scene, &source))
    return take_error(scene, error);
  const size_t blocks = scene->blocks.count;
  const size_t images = scene->images.count;
  size_t *count = vl_scene_count_of(scene, family);
  const size_t all = *count;
  AnyDef old;
  memcpy(&old, object, row->size);
  *count = id - 1;
  const bool done = row->add(scene, def) != 0;
  *count = all;
  if (!done)
    memcpy(vl_scene_at(scene, family, id), &old, row->size);
  VL_TRY(finish(scene, family, id, blocks, images, done, error));
  vl_scene_note_change(scene, mark);
  return VL_OK;
}

vlResult vl_scene_set_texture(vlScene *scene, vlTextureId id, const vlTextureDef *def,
                              vlError *error) {
  const vlTextureDef *old = vl_scene_at(scene, VL_SCENE_TEXTURES, id.index);
  VL_TRY(check(scene, old != NULL, "texture", error));
  const bool there = vl_scene_has(scene, VL_SCENE_TEXTURES, id.index);
  if (there && def && def->spectrum != old->spectrum)
    return vl_fail_argument(error, "texture: a texture of %s cannot become one of %s",
                            def->spectrum ? "floats" : "colours",
                            def->spectrum ? "colours" : "floats");
  return set_object(scene, VL_SCENE_TEXTURES, id.index, def, error);
}

vlResult vl_scene_set_material(vlScene *scene, vlMaterialId id, const vlMaterialDef *def,
                               vlError *error) {
  return set_object(scene, VL_SCENE_MATERIALS, id.index, def, error);
}

vlResult vl_scene_set_emission(vlScene *scene, vlEmissionId id, const vlEmissionDef *def,
                               vlError *error) {
  return set_object(scene, VL_SCENE_EMISSIONS, id.index, def, error);
}

vlResult vl_scene_set_light(vlScene *scene, vlLightId id, const vlLightDef *def,
                            vlError *error) {
  return set_object(scene, VL_SCENE_LIGHTS, id.index, def, error);
}

vlResult vl_scene_set_medium(vlScene *scene, vlMediumId id, const vlMediumDef *def,
                             vlError *error) {
  return set_object(scene, VL_SCENE_MEDIA, id.index, def, error);
}

/* ---- shapes, lights ---------------------------------------------------------------------- */

static vlResult show(vlScene *scene, vlSceneFamily family, uint32_t index, bool shown,
                     vlError *error) {
  VL_TRY(check_object(scene, family, index, error));
  vlSceneMark *mark = vl_scene_mark_of(scene, vl_scene_marks(scene, family), index);
  if (!mark)
    return vl_fail_memory(error);
  mark->hidden = !shown;
  return VL_OK;
}

vlResult vl_scene_show_light(vlScene *scene, vlLightId id, bool shown, vlError *error) {
  return show(scene, VL_SCENE_LIGHTS, id.index, shown, error);
}

vlResult vl_scene_show_shape(vlScene *scene, vlShapeId id, bool shown, vlError *error) {
  return show(scene, VL_SCENE_SHAPES, id.index, shown, error);
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
  const vlShapeDef *shape = vl_scene_at(scene, VL_SCENE_SHAPES, id.index);
  VL_TRY(check(scene, shape != NULL, "shape", error));
  const vlShapeDef old = *shape;
  const bool removed = vl_scene_shape_is_removed(scene, id.index - 1);
  VL_TRY(set_object(scene, VL_SCENE_SHAPES, id.index, def, error));
  end_change(scene, &old);
  if (removed)
    vl_scene_forget_removed_shape(scene, id.index);
  return VL_OK;
}

vlResult vl_scene_remove_shape(vlScene *scene, vlShapeId id, vlError *error) {
  VL_TRY(check_object(scene, VL_SCENE_SHAPES, id.index, error));
  vlSceneMark *mark = vl_scene_mark_of(scene, &scene->shape_marks, id.index);
  uint32_t *slot = mark ? VL_PUSH(scene->context, &scene->removed_shapes) : NULL;
  if (!slot)
    return vl_fail_memory(error);
  *slot = id.index;
  vlShapeDef *def = &scene->shapes.items[id.index - 1];
  end_change(scene, def);
  mark->generation = vl_context_number(scene->context);
  vl_scene_free_edits(scene, VL_SCENE_SHAPES, id.index, scene->edits.count);
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
  return vl_scene_serial(scene, VL_SCENE_SHAPES, id.index);
}

vlResult vl_scene_set_shape_material(vlScene *scene, vlShapeId id, vlMaterialId material,
                                     vlError *error) {
  VL_TRY(check_object(scene, VL_SCENE_SHAPES, id.index, error));
  if (material.index)
    VL_TRY(check_object(scene, VL_SCENE_MATERIALS, material.index, error));
  scene->shapes.items[id.index - 1].material = material;
  return VL_OK;
}

vlResult vl_scene_set_shape_emission(vlScene *scene, vlShapeId id, vlEmissionId emission,
                                     vlError *error) {
  VL_TRY(check_object(scene, VL_SCENE_SHAPES, id.index, error));
  if (emission.index)
    VL_TRY(check_object(scene, VL_SCENE_EMISSIONS, emission.index, error));
  const vlShapeDef *shape = &scene->shapes.items[id.index - 1];
  if (emission.index && !vl_shape_may_emit(shape))
    return vl_fail(error, VL_ERROR_SCENE, "shape: a shape of this kind cannot emit light");
  scene->shapes.items[id.index - 1].emission = emission;
  return VL_OK;
}

/* ---- instances --------------------------------------------------------------------------- */

static vlResult find_instance(vlScene *scene, vlInstanceId id, vlSceneInstance **instance,
                              vlError *error) {
  *instance = vl_scene_at(scene, VL_SCENE_INSTANCES, id.index);
  return check_object(scene, VL_SCENE_INSTANCES, id.index, error);
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
  vl_scene_free_blocks(scene, own, VL_LENGTH(own));
  instance->times = instance->poses = NULL;
  instance->keys = 0;
  instance->label = (vlLabel){0};
  instance->removed = instance->hidden = true;
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
  return vl_scene_serial(scene, VL_SCENE_INSTANCES, id.index);
}
