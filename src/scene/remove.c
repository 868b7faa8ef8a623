/* scene/remove.c: removes objects of a scene, whose ids new ones can take
 * (velo/edit.h). The def of a removed object is the default of its family, so that what
 * visits all objects meets one that does nothing. */
#include <stdio.h>
#include <string.h>

#include "base/error.h"
#include "base/text.h"
#include "scene/family.h"
#include "velo/light.h"
#include "velo/material.h"
#include "velo/medium.h"
#include "velo/shape_kinds.h"
#include "velo/texture.h"

/* ---- who uses an object ------------------------------------------------------------------ */

/* Whether the def refers to the object. */
static bool refers(vlSceneFamily family, const void *def, vlSceneUse object) {
  vlSceneUse uses[VL_SCENE_MAX_USES];
  const uint32_t count = vl_scene_uses(family, def, uses);
  for (uint32_t i = 0; i < count; i++)
    if (uses[i].family == object.family && uses[i].index == object.index)
      return true;
  return false;
}

/* The order in which the users of an object are sought, for messages that name the first. */
static const vlSceneFamily users[] = {VL_SCENE_TEXTURES,  VL_SCENE_MATERIALS,
                                      VL_SCENE_EMISSIONS, VL_SCENE_SHAPES,
                                      VL_SCENE_LIGHTS,    VL_SCENE_INSTANCES};

enum { USER_TEXT = 160 };

static void put_user(vlSceneFamily family, const void *def, uint32_t index,
                     char text[USER_TEXT]) {
  const char *thing = vl_scene_rows[family].thing;
  const char *name = vl_scene_def_name(family, def);
  if (name && name[0])
    snprintf(text, USER_TEXT, "%s \"%s\"", thing, vl_short_text(name).text);
  else
    snprintf(text, USER_TEXT, "%s number %u", thing, index);
}

/* The number of users of an object; first: what messages call the first one. */
static uint32_t find_users(const vlScene *scene, vlSceneUse object, char first[USER_TEXT]) {
  uint32_t count = 0;
  for (size_t k = 0; k < VL_LENGTH(users); k++) {
    const uint32_t highest = vl_scene_highest(scene, users[k]);
    for (uint32_t i = 1; i <= highest; i++) {
      const void *def = vl_scene_item(scene, users[k], i);
      if (def && refers(users[k], def, object) && count++ == 0)
        put_user(users[k], def, i, first);
    }
  }
  const bool camera =
      object.family == VL_SCENE_MEDIA && object.index == scene->defs.camera_medium.index;
  if (camera && count++ == 0)
    snprintf(first, USER_TEXT, "the camera");
  return count;
}

/* ---- what defs share --------------------------------------------------------------------- */

/* Takes an image, which was added with its object, from the scene unless another object has
 * it. */
static void free_image(vlScene *scene, const vlImage *image) {
  if (!image || vl_scene_image_is_used(scene, image))
    return;
  size_t kept = 0;
  for (size_t i = 0; i < scene->images.count; i++) {
    if (scene->images.items[i] == image)
      vl_image_destroy(scene->images.items[i]);
    else
      scene->images.items[kept++] = scene->images.items[i];
  }
  scene->images.count = kept;
}

/* Two textures of one encoded file share its bytes. */
static bool data_is_used(const vlScene *scene, const void *data) {
  for (size_t i = 0; i < scene->textures.count; i++)
    if (scene->textures.items[i].data == data)
      return true;
  return false;
}

/* ---- removing ---------------------------------------------------------------------------- */

/* Makes a def that of a removed object. */
static void reset(vlSceneFamily family, void *def) {
  vlTextureDef *texture = def;
  switch (family) {
    case VL_SCENE_TEXTURES:
      *texture = vl_default_texture_def(VL_TEXTURE_CONSTANT, texture->spectrum);
      break;
    case VL_SCENE_MATERIALS:
      *(vlMaterialDef *)def = vl_default_material_def(VL_MATERIAL_DIFFUSE);
      break;
    case VL_SCENE_MEDIA:
      *(vlMediumDef *)def = vl_default_medium_def(VL_MEDIUM_HOMOGENEOUS);
      break;
    case VL_SCENE_EMISSIONS:
      *(vlEmissionDef *)def = vl_default_emission_def();
      break;
    case VL_SCENE_LIGHTS:
      *(vlLightDef *)def = vl_default_light_def(VL_LIGHT_POINT);
      break;
    case VL_SCENE_SHAPES:
      *(vlShapeDef *)def = vl_default_shape_def(VL_SHAPE_TRIANGLES);
      break;
    case VL_SCENE_GROUPS:
      *(vlSceneGroup *)def = (vlSceneGroup){.name = ""};
      break;
    case VL_SCENE_INSTANCES:
      break;
  }
}

/* Frees what the object owns, and what changes of it have allocated. */
static void remove_object(vlScene *scene, vlSceneFamily family, uint32_t index) {
  const vlSceneRow *row = &vl_scene_rows[family];
  void *def = vl_scene_at(scene, family, index);
  const vlImage *image = NULL;
  const void *data = family == VL_SCENE_TEXTURES ? ((const vlTextureDef *)def)->data : NULL;
  vlSceneOwned owned;
  vl_scene_owned(family, def, &owned);
  if (row->image)
    memcpy(&image, (const char *)def + row->image, sizeof image);
  reset(family, def);
  if (!data_is_used(scene, data))
    vl_scene_own_block(&owned, data);
  vl_scene_free_edits(scene, family, index, scene->edits.count);
  vl_scene_free_blocks(scene, owned.items, owned.count);
  free_image(scene, image);
}

/* Removes the shapes of a group. */
static vlResult empty_group(vlScene *scene, uint32_t index, vlError *error) {
  const vlSceneGroup *group = &scene->groups.items[index - 1];
  if (!VL_RESERVE(scene->context, &scene->removed_shapes, group->shape_count) ||
      (scene->shapes.count > 0 &&
       !vl_scene_mark_of(scene, &scene->shape_marks, (uint32_t)scene->shapes.count)))
    return vl_fail_memory(error);
  for (uint32_t i = 1; i <= scene->shapes.count; i++) {
    if (scene->shapes.items[i - 1].group.index != index)
      continue;
    VL_TRY(vl_scene_remove_shape(scene, (vlShapeId){i}, error));
  }
  return VL_OK;
}

static vlResult check_removal(const vlScene *scene, vlSceneFamily family, uint32_t index,
                              vlError *error) {
  vl_error_clear(error);
  if (!scene || (unsigned)family > VL_SCENE_INSTANCES)
    return vl_fail_argument(error, "remove: scene is null, or unknown family");
  VL_TRY(vl_scene_result(scene, error));
  const char *thing = vl_scene_rows[family].thing;
  if (!vl_scene_has(scene, family, index))
    return vl_fail_argument(error, "%s: there is no such %s", thing, thing);
  char first[USER_TEXT];
  const uint32_t count = find_users(scene, (vlSceneUse){family, index}, first);
  if (count == 0)
    return VL_OK;
  char others[48] = "";
  if (count > 1)
    snprintf(others, sizeof others, " and %u other%s", count - 1, count > 2 ? "s" : "");
  return vl_fail(error, VL_ERROR_SCENE, "%s: it cannot be removed, %s%s use%s it", thing, first,
                 others, count > 1 ? "" : "s");
}

/* Cuts removed objects off the end of their array, so that loads, which add at the end, do not
 * make it grow. The mark stays, with a serial for the next object of this id. Groups stay:
 * removed instances still name them. */
static void trim(vlScene *scene, vlSceneFamily family) {
  if (family == VL_SCENE_GROUPS)
    return;
  const vlSceneMarks *marks = vl_scene_marks(scene, family);
  size_t *count = vl_scene_count_of(scene, family);
  while (*count > 0 && *count <= marks->count && marks->items[*count - 1].removed) {
    const uint64_t number = vl_context_number(scene->context);
    if (family == VL_SCENE_SHAPES)
      vl_scene_forget_removed_shape(scene, (uint32_t)*count);
    marks->items[*count - 1] = (vlSceneMark){.generation = number, .serial = number};
    (*count)--;
  }
}

vlResult vl_scene_remove(vlScene *scene, vlSceneFamily family, uint32_t index, vlError *error) {
  vlResult result = check_removal(scene, family, index, error);
  if (result != VL_OK)
    return result;
  if (family == VL_SCENE_SHAPES) {
    result = vl_scene_remove_shape(scene, (vlShapeId){index}, error);
    trim(scene, VL_SCENE_SHAPES);
    return result;
  }
  if (family == VL_SCENE_INSTANCES)
    return vl_scene_remove_instance(scene, (vlInstanceId){index}, error);
  vlSceneMark *mark = vl_scene_mark_of(scene, vl_scene_marks(scene, family), index);
  if (!mark)
    return vl_fail_memory(error);
  if (family == VL_SCENE_GROUPS)
    result = empty_group(scene, index, error);
  if (result != VL_OK)
    return result;
  remove_object(scene, family, index);
  mark->generation = vl_context_number(scene->context);
  mark->removed = mark->hidden = true;
  trim(scene, family);
  if (family == VL_SCENE_GROUPS)
    trim(scene, VL_SCENE_SHAPES);
  return VL_OK;
}

/* ---- free ids ---------------------------------------------------------------------------- */

/* The highest index in its own family that a def refers to; 0: none. The def is the caller's:
 * members that its kind does not use may hold anything. */
static uint32_t highest_input(vlSceneFamily family, const void *def) {
  if (family == VL_SCENE_MATERIALS && def && vl_scene_def_kind(family, def) != VL_MATERIAL_MIX)
    return 0;
  vlSceneUse uses[VL_SCENE_MAX_USES];
  const uint32_t count = def ? vl_scene_uses(family, def, uses) : 0;
  uint32_t highest = 0;
  for (uint32_t i = 0; i < count; i++)
    if (uses[i].family == family && uses[i].index > highest)
      highest = uses[i].index;
  return highest;
}

uint32_t vl_scene_removed(const vlScene *scene, vlSceneFamily family, const void *def) {
  const uint32_t count = vl_scene_highest(scene, family);
  if (family == VL_SCENE_SHAPES)
    return vl_scene_removed_shape(scene).index;
  if (family == VL_SCENE_INSTANCES)
    return 0;
  for (uint32_t i = highest_input(family, def) + 1; i <= count; i++)
    if (!vl_scene_has(scene, family, i))
      return i;
  return 0;
}

vlResult vl_scene_set_group(vlScene *scene, vlGroupId id, const char *name, vlError *error) {
  vl_error_clear(error);
  if (!scene)
    return vl_fail_argument(error, "group: scene is null");
  VL_TRY(vl_scene_result(scene, error));
  if (id.index == 0 || id.index > scene->groups.count)
    return vl_fail_argument(error, "group: there is no such group");
  vlSceneGroup *group = &scene->groups.items[id.index - 1];
  const size_t size = strlen(name ? name : "") + 1;
  char *copy = vl_alloc_array(scene->context, size, 1);
  vlSceneMark *mark = vl_scene_mark_of(scene, &scene->group_marks, id.index);
  vlSceneEdit *edit = copy && mark ? VL_PUSH(scene->context, &scene->edits) : NULL;
  if (!edit) {
    vl_free(scene->context, copy);
    return vl_fail_memory(error);
  }
  memcpy(copy, name ? name : "", size);
  *edit = (vlSceneEdit){VL_SCENE_GROUPS, id.index, copy, NULL};
  vl_scene_free_edits(scene, VL_SCENE_GROUPS, id.index, scene->edits.count - 1);
  const void *const old[] = {group->name};
  vl_scene_free_blocks(scene, old, 1);
  group->name = copy;
  vl_scene_note_change(scene, mark);
  return VL_OK;
}
