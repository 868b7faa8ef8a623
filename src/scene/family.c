/* scene/family.c: see family.h. */
#include "scene/family.h"

#include <string.h>

#include "base/cookie.h"
#include "base/text.h"
#include "schema/schema.h"
#include "velo/light.h"
#include "velo/material.h"
#include "velo/medium.h"
#include "velo/shape.h"
#include "velo/texture.h"

/* ---- the rows ---------------------------------------------------------------------------- */

#define ADD(add, add_def)                                \
  static uint32_t add(vlScene *scene, const void *def) { \
    return add_def(scene, def).index;                    \
  }
ADD(add_texture, vl_scene_add_texture)
ADD(add_material, vl_scene_add_material)
ADD(add_medium, vl_scene_add_medium)
ADD(add_emission, vl_scene_add_emission)
ADD(add_light, vl_scene_add_light)
ADD(add_shape, vl_scene_add_shape)

#define ARRAY(array)                                                                \
  .items = offsetof(vlScene, array.items), .count = offsetof(vlScene, array.count), \
  .capacity = offsetof(vlScene, array.capacity),                                    \
  .size = sizeof *((vlScene *)NULL)->array.items
#define DEFS(name, array, marked, Def, family, tag, adder)         \
  .thing = name, ARRAY(array), .marks = offsetof(vlScene, marked), \
  .source = offsetof(Def, source), .kinds = &family, .cookie = tag, .add = adder

const vlSceneRow vl_scene_rows[VL_SCENE_FAMILIES] = {
    [VL_SCENE_TEXTURES] = {DEFS("texture", textures, texture_marks, vlTextureDef,
                                vl_texture_family, VL_COOKIE_TEXTURE, add_texture),
                           .kind = offsetof(vlTextureDef, kind),
                           .name = offsetof(vlTextureDef, name),
                           .image = offsetof(vlTextureDef, image)},
    [VL_SCENE_MATERIALS] = {DEFS("material", materials, material_marks, vlMaterialDef,
                                 vl_material_family, VL_COOKIE_MATERIAL, add_material),
                            .kind = offsetof(vlMaterialDef, kind),
                            .name = offsetof(vlMaterialDef, name)},
    [VL_SCENE_MEDIA] = {DEFS("medium", media, medium_marks, vlMediumDef, vl_medium_family,
                             VL_COOKIE_MEDIUM, add_medium),
                        .kind = offsetof(vlMediumDef, kind),
                        .name = offsetof(vlMediumDef, name)},
    [VL_SCENE_EMISSIONS] = {DEFS("emission", emissions, emission_marks, vlEmissionDef,
                                 vl_emission_family, VL_COOKIE_EMISSION, add_emission)},
    [VL_SCENE_LIGHTS] = {DEFS("light", lights, light_marks, vlLightDef, vl_light_family,
                              VL_COOKIE_LIGHT, add_light),
                         .kind = offsetof(vlLightDef, kind),
                         .image = offsetof(vlLightDef, image)},
    [VL_SCENE_SHAPES] = {DEFS("shape", shapes, shape_marks, vlShapeDef, vl_shape_family,
                              VL_COOKIE_SHAPE, add_shape),
                         .kind = offsetof(vlShapeDef, kind),
                         .name = offsetof(vlShapeDef, label.name)},
    [VL_SCENE_GROUPS] = {.thing = "group",
                         ARRAY(groups),
                         .marks = offsetof(vlScene, group_marks),
                         .name = offsetof(vlSceneGroup, name)},
    [VL_SCENE_INSTANCES] = {.thing = "instance",
                            ARRAY(instances),
                            .name = offsetof(vlSceneInstance, label.name)},
};

/* A member of a def: an id of an object of another family, or a pointer to a block. */
typedef struct Member {
  vlSceneFamily family;
  size_t at;
} Member;

/* The ids in defs, besides those that rows of kinds describe. */
static const struct {
  Member from;
  vlSceneFamily to;
} ids[] = {
    {{VL_SCENE_MATERIALS, offsetof(vlMaterialDef, materials[0].index)}, VL_SCENE_MATERIALS},
    {{VL_SCENE_MATERIALS, offsetof(vlMaterialDef, materials[1].index)}, VL_SCENE_MATERIALS},
    {{VL_SCENE_EMISSIONS, offsetof(vlEmissionDef, texture.index)}, VL_SCENE_TEXTURES},
    {{VL_SCENE_LIGHTS, offsetof(vlLightDef, medium.index)}, VL_SCENE_MEDIA},
    {{VL_SCENE_SHAPES, offsetof(vlShapeDef, alpha.texture.index)}, VL_SCENE_TEXTURES},
    {{VL_SCENE_SHAPES, offsetof(vlShapeDef, displacement.texture.index)}, VL_SCENE_TEXTURES},
    {{VL_SCENE_SHAPES, offsetof(vlShapeDef, material.index)}, VL_SCENE_MATERIALS},
    {{VL_SCENE_SHAPES, offsetof(vlShapeDef, emission.index)}, VL_SCENE_EMISSIONS},
    {{VL_SCENE_SHAPES, offsetof(vlShapeDef, inside.index)}, VL_SCENE_MEDIA},
    {{VL_SCENE_SHAPES, offsetof(vlShapeDef, outside.index)}, VL_SCENE_MEDIA},
    {{VL_SCENE_INSTANCES, offsetof(vlSceneInstance, group.index)}, VL_SCENE_GROUPS},
};

/* The blocks of defs, besides names and those that rows of kinds describe. */
static const Member blocks[] = {
    {VL_SCENE_MATERIALS, offsetof(vlMaterialDef, place)},
    {VL_SCENE_MEDIA, offsetof(vlMediumDef, density)},
    {VL_SCENE_MEDIA, offsetof(vlMediumDef, emission_scales)},
    {VL_SCENE_MEDIA, offsetof(vlMediumDef, temperature)},
    {VL_SCENE_MEDIA, offsetof(vlMediumDef, rgb_a)},
    {VL_SCENE_MEDIA, offsetof(vlMediumDef, rgb_s)},
    {VL_SCENE_MEDIA, offsetof(vlMediumDef, rgb_emission)},
};

/* ---- arrays ------------------------------------------------------------------------------ */

static void *member(vlScene *scene, size_t offset) {
  return (char *)scene + offset;
}

size_t *vl_scene_count_of(vlScene *scene, vlSceneFamily family) {
  return member(scene, vl_scene_rows[family].count);
}

void *vl_scene_at(vlScene *scene, vlSceneFamily family, uint32_t index) {
  const vlSceneRow *row = &vl_scene_rows[family];
  if (!scene || index == 0 || index > *vl_scene_count_of(scene, family))
    return NULL;
  char *const *items = member(scene, row->items);
  return *items + row->size * (index - 1);
}

vlSceneMarks *vl_scene_marks(vlScene *scene, vlSceneFamily family) {
  const size_t offset = vl_scene_rows[family].marks;
  return offset ? member(scene, offset) : NULL;
}

uint32_t vl_scene_highest(const vlScene *scene, vlSceneFamily family) {
  vlScene *const unchanged = (vlScene *)(uintptr_t)scene;
  if (!scene || (unsigned)family >= VL_SCENE_FAMILIES)
    return 0;
  return (uint32_t)*vl_scene_count_of(unchanged, family);
}

/* The state of an object that the array holds. */
static vlSceneMark state_of(const vlScene *scene, vlSceneFamily family, uint32_t index) {
  vlScene *const unchanged = (vlScene *)(uintptr_t)scene;
  const vlSceneMarks *marks = vl_scene_marks(unchanged, family);
  if (marks)
    return vl_scene_mark(marks, index - 1);
  const vlSceneInstance *instance = &scene->instances.items[index - 1];
  return (vlSceneMark){
      .serial = instance->serial, .hidden = instance->hidden, .removed = instance->removed};
}

bool vl_scene_has(const vlScene *scene, vlSceneFamily family, uint32_t index) {
  return index != 0 && index <= vl_scene_highest(scene, family) &&
         !state_of(scene, family, index).removed;
}

uint64_t vl_scene_serial(const vlScene *scene, vlSceneFamily family, uint32_t index) {
  return vl_scene_has(scene, family, index) ? state_of(scene, family, index).serial : 0;
}

const void *vl_scene_item(const vlScene *scene, vlSceneFamily family, uint32_t index) {
  vlScene *const unchanged = (vlScene *)(uintptr_t)scene;
  return vl_scene_has(scene, family, index) ? vl_scene_at(unchanged, family, index) : NULL;
}

/* ---- defs -------------------------------------------------------------------------------- */

int vl_scene_def_kind(vlSceneFamily family, const void *def) {
  const size_t offset = vl_scene_rows[family].kind;
  int kind = 0;
  if (offset)
    memcpy(&kind, (const char *)def + offset, sizeof kind);
  return kind;
}

const vlKindRow *vl_scene_def_row(vlSceneFamily family, const void *def) {
  const vlKindFamily *kinds = vl_scene_rows[family].kinds;
  return kinds ? vl_kind_row(kinds, vl_scene_def_kind(family, def)) : NULL;
}

vlSource vl_scene_def_source(vlSceneFamily family, const void *def) {
  vlSource source;
  memcpy(&source, (const char *)def + vl_scene_rows[family].source, sizeof source);
  return source;
}

uint64_t vl_scene_kind_count(const vlScene *scene, const char *family, uint32_t kind) {
  uint64_t count = 0;
  for (int k = 0; k < VL_SCENE_FAMILIES; k++) {
    const vlSceneRow *row = &vl_scene_rows[k];
    if (!row->kind || strcmp(row->kinds->name, family) != 0)
      continue;
    for (uint32_t i = 1; i <= vl_scene_highest(scene, (vlSceneFamily)k); i++) {
      const void *def = vl_scene_item(scene, (vlSceneFamily)k, i);
      count += def && vl_scene_def_kind((vlSceneFamily)k, def) == (int)kind;
    }
  }
  return count;
}

/* The pointer in a member of a def. */
static const void *pointer_at(const void *def, size_t offset) {
  const void *pointer;
  memcpy(&pointer, (const char *)def + offset, sizeof pointer);
  return pointer;
}

const char *vl_scene_def_name(vlSceneFamily family, const void *def) {
  const size_t offset = vl_scene_rows[family].name;
  return offset ? pointer_at(def, offset) : NULL;
}

uint32_t vl_scene_uses(vlSceneFamily family, const void *def,
                       vlSceneUse uses[VL_SCENE_MAX_USES]) {
  enum { MAX_IDS = VL_LENGTH(ids) };
  vlTextureId inputs[VL_SCENE_MAX_USES - MAX_IDS];
  const vlKindRow *row = vl_scene_def_row(family, def);
  const uint32_t max = VL_SCENE_MAX_USES - MAX_IDS;
  uint32_t count = row ? vl_row_textures(row, def, inputs, max) : 0;
  for (uint32_t i = 0; i < count; i++)
    uses[i] = (vlSceneUse){VL_SCENE_TEXTURES, inputs[i].index};
  for (size_t i = 0; i < MAX_IDS; i++) {
    if (ids[i].from.family != family)
      continue;
    const uint32_t index =
        *(const uint32_t *)(const void *)((const char *)def + ids[i].from.at);
    if (index)
      uses[count++] = (vlSceneUse){ids[i].to, index};
  }
  return count;
}

/* ---- what a def owns --------------------------------------------------------------------- */

void vl_scene_own_block(vlSceneOwned *owned, const void *block) {
  const int max = (int)(VL_LENGTH(owned->items));
  if (block && owned->count < max)
    owned->items[owned->count++] = block;
}

static void own_spectrum(vlSceneOwned *owned, const vlSpectrum *spectrum) {
  if (spectrum->kind == VL_SPECTRUM_SAMPLED) {
    vl_scene_own_block(owned, spectrum->wavelengths);
    vl_scene_own_block(owned, spectrum->values);
  }
  if (spectrum->kind == VL_SPECTRUM_NAMED)
    vl_scene_own_block(owned, spectrum->name);
}

static void own_row(vlSceneOwned *owned, const vlKindRow *row, const void *def) {
  VL_EACH_PARAMETER(p, row) {
    const char *at = (const char *)def + p->offset;
    const char *second = p->second ? (const char *)def + p->second : NULL;
    if (p->flags & VL_PARAMETER_SHORTHAND)
      continue;
    if (p->type == VL_PARAMETER_STRING || p->type == VL_PARAMETER_FILE)
      vl_scene_own_block(owned, pointer_at(def, p->offset));
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

void vl_scene_owned(vlSceneFamily family, const void *def, vlSceneOwned *owned) {
  const vlKindRow *row = vl_scene_def_row(family, def);
  owned->count = 0;
  if (row)
    own_row(owned, row, def);
  vl_scene_own_block(owned, vl_scene_def_name(family, def));
  for (size_t i = 0; i < VL_LENGTH(blocks); i++)
    if (blocks[i].family == family)
      vl_scene_own_block(owned, pointer_at(def, blocks[i].at));
}
