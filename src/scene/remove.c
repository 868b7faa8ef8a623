/* scene/remove.c: removes objects of a scene, whose ids new ones can take
 * (velo/edit.h). The def of a removed object is the default of its family, so that what
 * visits all objects meets one that does nothing. */
#include <stdio.h>
#include <string.h>

#include "scene/scene.h"
#include "schema/schema.h"
#include "velo/edit.h"
#include "velo/light.h"
#include "velo/material.h"
#include "velo/medium.h"
#include "velo/shape.h"
#include "velo/texture.h"

static const char *const things[] = {"texture", "material", "medium", "emission",
                                     "light",   "shape",    "group",  "instance"};

static vlSceneMarks *marks_of(vlScene *scene, vlSceneFamily family) {
  switch (family) {
    case VL_SCENE_TEXTURES:
      return &scene->texture_marks;
    case VL_SCENE_MATERIALS:
      return &scene->material_marks;
    case VL_SCENE_MEDIA:
      return &scene->medium_marks;
    case VL_SCENE_EMISSIONS:
      return &scene->emission_marks;
    case VL_SCENE_LIGHTS:
      return &scene->light_marks;
    case VL_SCENE_SHAPES:
      return &scene->shape_marks;
    case VL_SCENE_GROUPS:
      return &scene->group_marks;
    case VL_SCENE_INSTANCES:
      break;
  }
  return NULL; /* an instance holds its own state */
}

static vlSceneMark mark_at(const vlScene *scene, vlSceneFamily family, uint32_t index) {
  vlScene *const unchanged = (vlScene *)(uintptr_t)scene;
  return vl_scene_mark(marks_of(unchanged, family), index - 1);
}

/* The number of objects in the array of a family, removed ones included. Null: no family. */
static size_t *count_of(vlScene *scene, vlSceneFamily family) {
  switch (family) {
    case VL_SCENE_TEXTURES:
      return &scene->textures.count;
    case VL_SCENE_MATERIALS:
      return &scene->materials.count;
    case VL_SCENE_MEDIA:
      return &scene->media.count;
    case VL_SCENE_EMISSIONS:
      return &scene->emissions.count;
    case VL_SCENE_LIGHTS:
      return &scene->lights.count;
    case VL_SCENE_SHAPES:
      return &scene->shapes.count;
    case VL_SCENE_GROUPS:
      return &scene->groups.count;
    case VL_SCENE_INSTANCES:
      return &scene->instances.count;
  }
  return NULL;
}

uint32_t vl_scene_highest(const vlScene *scene, vlSceneFamily family) {
  vlScene *const unchanged = (vlScene *)(uintptr_t)scene;
  const size_t *count = scene ? count_of(unchanged, family) : NULL;
  return count ? (uint32_t)*count : 0;
}

bool vl_scene_has(const vlScene *scene, vlSceneFamily family, uint32_t index) {
  if (index == 0 || index > vl_scene_highest(scene, family))
    return false;
  if (family == VL_SCENE_INSTANCES)
    return !scene->instances.items[index - 1].removed;
  return !mark_at(scene, family, index).removed;
}

uint64_t vl_scene_serial(const vlScene *scene, vlSceneFamily family, uint32_t index) {
  if (!vl_scene_has(scene, family, index))
    return 0;
  if (family == VL_SCENE_INSTANCES)
    return scene->instances.items[index - 1].serial;
  return mark_at(scene, family, index).serial;
}

/* ---- who uses an object ------------------------------------------------------------------ */

enum { MAX_INPUTS = 64 }; /* textures that an object reads */

/* The search for the users of an object. */
typedef struct Users {
  vlSceneFamily family;
  uint32_t index;
  uint32_t count;
  char first[160];
} Users;

/* A user of this name (may be null) and index, of the family. */
static void note_user(Users *users, vlSceneFamily family, const char *name, size_t index) {
  if (users->count++ > 0)
    return;
  if (name && name[0])
    snprintf(users->first, sizeof users->first, "%s \"%s\"", things[family],
             vl_short_text(name).text);
  else
    snprintf(users->first, sizeof users->first, "%s number %zu", things[family], index + 1);
}

static bool is(const Users *users, vlSceneFamily family, uint32_t index) {
  return users->family == family && users->index == index;
}

/* Whether one of the inputs of a def is the texture. */
static bool reads(const Users *users, const vlKindRow *row, const void *def) {
  vlTextureId inputs[MAX_INPUTS];
  const uint32_t count =
      users->family == VL_SCENE_TEXTURES ? vl_row_textures(row, def, inputs, MAX_INPUTS) : 0;
  for (uint32_t i = 0; i < count; i++)
    if (inputs[i].index == users->index)
      return true;
  return false;
}

static void find_in_looks(const vlScene *scene, Users *users) {
  for (size_t i = 0; i < scene->textures.count; i++) {
    const vlTextureDef *d = &scene->textures.items[i];
    if (reads(users, vl_kind_row(&vl_texture_family, (int)d->kind), d))
      note_user(users, VL_SCENE_TEXTURES, d->name, i);
  }
  for (size_t i = 0; i < scene->materials.count; i++) {
    const vlMaterialDef *d = &scene->materials.items[i];
    if (reads(users, vl_kind_row(&vl_material_family, (int)d->kind), d) ||
        is(users, VL_SCENE_MATERIALS, d->materials[0].index) ||
        is(users, VL_SCENE_MATERIALS, d->materials[1].index))
      note_user(users, VL_SCENE_MATERIALS, d->name, i);
  }
  for (size_t i = 0; i < scene->emissions.count; i++) {
    const vlEmissionDef *d = &scene->emissions.items[i];
    if (reads(users, vl_kind_row(&vl_emission_family, 0), d) ||
        is(users, VL_SCENE_TEXTURES, d->texture.index))
      note_user(users, VL_SCENE_EMISSIONS, NULL, i);
  }
}

static void find_in_shapes(const vlScene *scene, Users *users) {
  for (size_t i = 0; i < scene->shapes.count; i++) {
    const vlShapeDef *d = &scene->shapes.items[i];
    if (reads(users, vl_kind_row(&vl_shape_family, (int)d->kind), d) ||
        is(users, VL_SCENE_TEXTURES, d->alpha.texture.index) ||
        is(users, VL_SCENE_TEXTURES, d->displacement.texture.index) ||
        is(users, VL_SCENE_MATERIALS, d->material.index) ||
        is(users, VL_SCENE_EMISSIONS, d->emission.index) ||
        is(users, VL_SCENE_MEDIA, d->inside.index) ||
        is(users, VL_SCENE_MEDIA, d->outside.index))
      note_user(users, VL_SCENE_SHAPES, d->label.name, i);
  }
}

static void find_users(const vlScene *scene, Users *users) {
  if (users->family == VL_SCENE_SHAPES || users->family == VL_SCENE_LIGHTS ||
      users->family == VL_SCENE_INSTANCES)
    return; /* nothing refers to them */
  find_in_looks(scene, users);
  find_in_shapes(scene, users);
  for (size_t i = 0; i < scene->lights.count; i++)
    if (is(users, VL_SCENE_MEDIA, scene->lights.items[i].medium.index))
      note_user(users, VL_SCENE_LIGHTS, NULL, i);
  for (size_t i = 0; i < scene->instances.count; i++) {
    const vlSceneInstance *instance = &scene->instances.items[i];
    if (!instance->removed && is(users, VL_SCENE_GROUPS, instance->group.index))
      note_user(users, VL_SCENE_INSTANCES, instance->label.name, i);
  }
  if (is(users, VL_SCENE_MEDIA, scene->defs.camera_medium.index) && users->count++ == 0)
    snprintf(users->first, sizeof users->first, "the camera");
}

/* ---- what a def points at ---------------------------------------------------------------- */

/* The blocks that a def points at. What does not fit stays with the scene. */
typedef struct Owned {
  const void *items[128];
  int count;
} Owned;

static void own(Owned *owned, const void *block) {
  const int most = (int)(sizeof owned->items / sizeof *owned->items);
  if (block && owned->count < most)
    owned->items[owned->count++] = block;
}

static void own_spectrum(Owned *owned, const vlSpectrum *spectrum) {
  if (spectrum->kind == VL_SPECTRUM_SAMPLED) {
    own(owned, spectrum->wavelengths);
    own(owned, spectrum->values);
  }
  if (spectrum->kind == VL_SPECTRUM_NAMED)
    own(owned, spectrum->name);
}

static void own_row(Owned *owned, const vlKindRow *row, const void *def) {
  for (uint32_t i = 0; i < row->parameter_count; i++) {
    const vlParameter *p = &row->parameters[i];
    const char *at = (const char *)def + p->offset;
    const char *second = p->second ? (const char *)def + p->second : NULL;
    if (p->flags & VL_PARAMETER_SHORTHAND)
      continue;
    if (p->type == VL_PARAMETER_STRING || p->type == VL_PARAMETER_FILE)
      own(owned, *(const char *const *)(const void *)at);
    if (p->type == VL_PARAMETER_SPECTRUM)
      own_spectrum(owned, (const vlSpectrum *)(const void *)at);
    if (p->type == VL_PARAMETER_SPECTRUM && second)
      own_spectrum(owned, (const vlSpectrum *)(const void *)second);
    if (p->type == VL_PARAMETER_SPECTRUM_INPUT)
      own_spectrum(owned, &((const vlSpectrumInput *)(const void *)at)->value);
    if ((p->type == VL_PARAMETER_SPECTRUM_INPUT || p->type == VL_PARAMETER_EITHER_INPUT) &&
        second)
      own_spectrum(owned, &((const vlSpectrumInput *)(const void *)second)->value);
  }
}

/* Frees these blocks, and what changes of the object have allocated. */
static void free_owned(vlScene *scene, const void *array, uint32_t index, const Owned *owned) {
  vl_scene_free_edits(scene, array, index, scene->edits.count);
  vl_scene_free_blocks(scene, owned->items, owned->count);
}

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

static void remove_texture(vlScene *scene, uint32_t index) {
  vlTextureDef *def = &scene->textures.items[index - 1];
  const vlTextureDef old = *def;
  Owned owned = {.count = 0};
  own_row(&owned, vl_kind_row(&vl_texture_family, (int)old.kind), &old);
  own(&owned, old.name);
  *def = vl_default_texture_def(VL_TEXTURE_CONSTANT, old.spectrum);
  if (!data_is_used(scene, old.data))
    own(&owned, old.data);
  free_owned(scene, &scene->textures, index, &owned);
  free_image(scene, old.image);
}

static void remove_material(vlScene *scene, uint32_t index) {
  vlMaterialDef *def = &scene->materials.items[index - 1];
  Owned owned = {.count = 0};
  own_row(&owned, vl_kind_row(&vl_material_family, (int)def->kind), def);
  own(&owned, def->name);
  own(&owned, def->place);
  *def = vl_default_material_def(VL_MATERIAL_DIFFUSE);
  free_owned(scene, &scene->materials, index, &owned);
}

static void remove_medium(vlScene *scene, uint32_t index) {
  vlMediumDef *def = &scene->media.items[index - 1];
  const float *grids[] = {def->density, def->emission_scales, def->temperature,
                          def->rgb_a,   def->rgb_s,           def->rgb_emission};
  Owned owned = {.count = 0};
  own_row(&owned, vl_kind_row(&vl_medium_family, (int)def->kind), def);
  own(&owned, def->name);
  for (size_t i = 0; i < sizeof grids / sizeof *grids; i++)
    own(&owned, grids[i]);
  *def = vl_default_medium_def(VL_MEDIUM_HOMOGENEOUS);
  free_owned(scene, &scene->media, index, &owned);
}

static void remove_emission(vlScene *scene, uint32_t index) {
  vlEmissionDef *def = &scene->emissions.items[index - 1];
  Owned owned = {.count = 0};
  own_row(&owned, vl_kind_row(&vl_emission_family, 0), def);
  *def = vl_default_emission_def();
  free_owned(scene, &scene->emissions, index, &owned);
}

static void remove_light(vlScene *scene, uint32_t index) {
  vlLightDef *def = &scene->lights.items[index - 1];
  const vlLightDef old = *def;
  Owned owned = {.count = 0};
  own_row(&owned, vl_kind_row(&vl_light_family, (int)old.kind), &old);
  *def = vl_default_light_def(VL_LIGHT_POINT);
  free_owned(scene, &scene->lights, index, &owned);
  free_image(scene, old.image);
}

/* Removes a group and its shapes. */
static vlResult remove_group(vlScene *scene, uint32_t index, vlError *error) {
  vlSceneGroup *group = &scene->groups.items[index - 1];
  if (!VL_RESERVE(scene->context, &scene->removed_shapes, group->shape_count) ||
      (scene->shapes.count > 0 &&
       !vl_scene_mark_of(scene, &scene->shape_marks, (uint32_t)scene->shapes.count)))
    return vl_fail_memory(error);
  for (uint32_t i = 1; i <= scene->shapes.count; i++) {
    if (scene->shapes.items[i - 1].group.index != index)
      continue;
    vlResult result = vl_scene_remove_shape(scene, (vlShapeId){i}, error);
    if (result != VL_OK)
      return result;
  }
  vl_scene_free_edits(scene, &scene->groups, index, scene->edits.count);
  const void *const name[] = {group->name};
  vl_scene_free_blocks(scene, name, 1);
  *group = (vlSceneGroup){.name = ""};
  return VL_OK;
}

static vlResult check_removal(const vlScene *scene, vlSceneFamily family, uint32_t index,
                              vlError *error) {
  vl_error_clear(error);
  if (!scene || (unsigned)family > VL_SCENE_INSTANCES)
    return vl_fail(error, VL_ERROR_ARGUMENT, "remove: scene is null, or unknown family");
  if (scene->error.code != VL_OK)
    return vl_scene_result(scene, error);
  if (!vl_scene_has(scene, family, index))
    return vl_fail(error, VL_ERROR_ARGUMENT, "%s: there is no such %s", things[family],
                   things[family]);
  Users users = {.family = family, .index = index};
  find_users(scene, &users);
  if (users.count == 0)
    return VL_OK;
  char others[48] = "";
  if (users.count > 1)
    snprintf(others, sizeof others, " and %u other%s", users.count - 1,
             users.count > 2 ? "s" : "");
  return vl_fail(error, VL_ERROR_SCENE, "%s: it cannot be removed, %s%s use%s it",
                 things[family], users.first, others, users.count > 1 ? "" : "s");
}

/* Cuts removed objects off the end of their array, so that loads, which add at the end, do not
 * make it grow. The mark stays, with a serial for the next object of this id. Groups stay:
 * removed instances still name them. */
static void trim(vlScene *scene, vlSceneFamily family) {
  if (family == VL_SCENE_GROUPS)
    return;
  const vlSceneMarks *marks = marks_of(scene, family);
  size_t *count = count_of(scene, family);
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
  vlSceneMark *mark = vl_scene_mark_of(scene, marks_of(scene, family), index);
  if (!mark)
    return vl_fail_memory(error);
  if (family == VL_SCENE_GROUPS)
    result = remove_group(scene, index, error);
  if (result != VL_OK)
    return result;
  if (family == VL_SCENE_TEXTURES)
    remove_texture(scene, index);
  if (family == VL_SCENE_MATERIALS)
    remove_material(scene, index);
  if (family == VL_SCENE_MEDIA)
    remove_medium(scene, index);
  if (family == VL_SCENE_EMISSIONS)
    remove_emission(scene, index);
  if (family == VL_SCENE_LIGHTS)
    remove_light(scene, index);
  mark->generation = vl_context_number(scene->context);
  mark->removed = mark->hidden = true;
  trim(scene, family);
  if (family == VL_SCENE_GROUPS)
    trim(scene, VL_SCENE_SHAPES);
  return VL_OK;
}

/* ---- free ids ---------------------------------------------------------------------------- */

/* The highest index in its own family that a def refers to; 0: none. */
static uint32_t highest_input(vlSceneFamily family, const void *def) {
  uint32_t highest = 0;
  if (def && family == VL_SCENE_MATERIALS) {
    const vlMaterialDef *material = def;
    if (material->kind == VL_MATERIAL_MIX)
      for (int i = 0; i < 2; i++)
        highest =
            material->materials[i].index > highest ? material->materials[i].index : highest;
  }
  if (def && family == VL_SCENE_TEXTURES) {
    const vlTextureDef *texture = def;
    const vlKindRow *row = vl_kind_row(&vl_texture_family, (int)texture->kind);
    vlTextureId inputs[MAX_INPUTS];
    const uint32_t count = row ? vl_row_textures(row, texture, inputs, MAX_INPUTS) : 0;
    for (uint32_t i = 0; i < count; i++)
      highest = inputs[i].index > highest ? inputs[i].index : highest;
  }
  return highest;
}

uint32_t vl_scene_removed(const vlScene *scene, vlSceneFamily family, const void *def) {
  const uint32_t count = vl_scene_highest(scene, family);
  if (family == VL_SCENE_SHAPES)
    return vl_scene_removed_shape(scene).index;
  if (family == VL_SCENE_INSTANCES)
    return 0;
  for (uint32_t i = highest_input(family, def) + 1; i <= count; i++)
    if (mark_at(scene, family, i).removed)
      return i;
  return 0;
}

vlResult vl_scene_set_group(vlScene *scene, vlGroupId id, const char *name, vlError *error) {
  vl_error_clear(error);
  if (!scene)
    return vl_fail(error, VL_ERROR_ARGUMENT, "group: scene is null");
  if (scene->error.code != VL_OK)
    return vl_scene_result(scene, error);
  if (id.index == 0 || id.index > scene->groups.count)
    return vl_fail(error, VL_ERROR_ARGUMENT, "group: there is no such group");
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
  *edit = (vlSceneEdit){&scene->groups, id.index, copy, NULL};
  vl_scene_free_edits(scene, &scene->groups, id.index, scene->edits.count - 1);
  const void *const old[] = {group->name};
  vl_scene_free_blocks(scene, old, 1);
  group->name = copy;
  mark->generation = vl_context_number(scene->context);
  if (mark->removed)
    mark->serial = mark->generation;
  mark->removed = mark->hidden = false;
  return VL_OK;
}
