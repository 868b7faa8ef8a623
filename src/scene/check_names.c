/* scene/check_names.c: scene check: finds which objects are used by shapes, lights and
 * instances, and reports unused ones that have a name or a source location. Objects refer only
 * to earlier ones, so one pass from the last to the first suffices. */
#include <stdio.h>

#include "base/free.h"
#include "base/text.h"
#include "scene/check.h"
#include "scene/family.h"
#include "schema/schema.h"
#include "velo/light.h"
#include "velo/material.h"
#include "velo/medium.h"
#include "velo/shape.h"
#include "velo/texture.h"

uint32_t vl_check_inputs(vlSceneFamily family, const void *def,
                         vlTextureId inputs[VL_CHECK_INPUTS]) {
  return vl_row_textures(vl_scene_def_row(family, def), def, inputs, VL_CHECK_INPUTS);
}

/* "material "NAME"", "the material of line 3" or "its material". */
static vlCheckName name_of(const char *kind, const char *name, uint32_t line) {
  vlCheckName r;
  if (name && name[0])
    snprintf(r.text, sizeof r.text, "%s \"%s\"", kind, vl_short_text(name).text);
  else if (line)
    snprintf(r.text, sizeof r.text, "the %s of line %u", kind, line);
  else
    snprintf(r.text, sizeof r.text, "its %s", kind);
  return r;
}

vlCheckName vl_check_material_name(const vlMaterialDef *m) {
  return m ? name_of("material", m->name, m->source.line)
           : (vlCheckName){"the default material"};
}

vlCheckName vl_check_texture_name(const vlTextureDef *t) {
  return name_of("texture", t->name, t->source.line);
}

/* Marks what an object refers to. flags: an array of each family; null: not marked. */
static void mark_uses(const vlScene *scene, vlSceneFamily family, size_t index,
                      uint8_t *const flags[VL_SCENE_FAMILIES]) {
  const void *def = vl_scene_item(scene, family, (uint32_t)index);
  vlSceneUse uses[VL_SCENE_MAX_USES];
  const uint32_t count = def ? vl_scene_uses(family, def, uses) : 0;
  for (uint32_t i = 0; i < count; i++)
    if (flags[uses[i].family])
      flags[uses[i].family][uses[i].index - 1] = 1;
}

static void find_used(vlCheck *c) {
  const vlScene *s = c->scene;
  const vlSceneFamily roots[] = {VL_SCENE_SHAPES, VL_SCENE_LIGHTS, VL_SCENE_EMISSIONS,
                                 VL_SCENE_INSTANCES};
  const vlSceneFamily readers[] = {VL_SCENE_MATERIALS, VL_SCENE_TEXTURES};
  for (size_t k = 0; k < VL_LENGTH(roots); k++)
    for (size_t i = 1; i <= vl_scene_highest(s, roots[k]); i++)
      mark_uses(s, roots[k], i, c->used);
  if (s->defs.camera_medium.index)
    c->used[VL_SCENE_MEDIA][s->defs.camera_medium.index - 1] = 1;
  for (size_t k = 0; k < VL_LENGTH(readers); k++)
    for (size_t i = vl_scene_highest(s, readers[k]); i > 0; i--)
      if (c->used[readers[k]][i - 1])
        mark_uses(s, readers[k], i, c->used);
}

/* Marks what a material or another texture reads, used or not. It is not reported: its unused
 * reader is. */
static void mark_inputs_of_unused(const vlScene *scene, uint8_t *textures, uint8_t *materials) {
  uint8_t *const flags[VL_SCENE_FAMILIES] = {
      [VL_SCENE_TEXTURES] = textures, [VL_SCENE_MATERIALS] = materials};
  for (size_t i = 1; i <= scene->materials.count; i++)
    mark_uses(scene, VL_SCENE_MATERIALS, i, flags);
  for (size_t i = 1; i <= scene->textures.count; i++)
    mark_uses(scene, VL_SCENE_TEXTURES, i, flags);
}

static bool named(const char *name) {
  return name && name[0];
}

static void tell_unused(vlCheck *c) {
  const vlScene *s = c->scene;
  uint8_t *read = vl_alloc_zero(c->context, s->textures.count + 1, 1);
  uint8_t *mixed = vl_alloc_zero(c->context, s->materials.count + 1, 1);
  if (!read || !mixed) {
    VL_FREE(c->context, read, mixed);
    c->no_memory = true;
    return;
  }
  mark_inputs_of_unused(s, read, mixed);
  for (size_t i = 0; i < s->textures.count; i++) {
    const vlTextureDef *t = &s->textures.items[i];
    if (!c->used[VL_SCENE_TEXTURES][i] && !read[i] && named(t->name))
      vl_check_add(c, VL_FINDING_UNUSED, VL_SEVERITY_WARNING, t->source,
                   "texture \"%s\" is not used", vl_short_text(t->name).text);
  }
  for (size_t i = 0; i < s->materials.count; i++) {
    const vlMaterialDef *m = &s->materials.items[i];
    if (c->used[VL_SCENE_MATERIALS][i] || mixed[i])
      continue;
    if (named(m->name))
      vl_check_add(c, VL_FINDING_UNUSED, VL_SEVERITY_WARNING, m->source,
                   "material \"%s\" is not used", vl_short_text(m->name).text);
    else if (m->source.line)
      vl_check_add(c, VL_FINDING_REPLACED, VL_SEVERITY_NOTE, m->source,
                   "no shape takes this material");
  }
  for (size_t i = 0; i < s->media.count; i++)
    if (!c->used[VL_SCENE_MEDIA][i] && vl_scene_has(s, VL_SCENE_MEDIA, (uint32_t)i + 1))
      vl_check_add(c, VL_FINDING_UNUSED, VL_SEVERITY_WARNING, s->media.items[i].source,
                   "nothing lies in medium \"%s\"", vl_short_text(s->media.items[i].name).text);
  for (size_t i = 0; i < s->emissions.count; i++)
    if (!c->used[VL_SCENE_EMISSIONS][i] && vl_scene_has(s, VL_SCENE_EMISSIONS, (uint32_t)i + 1))
      vl_check_add(c, VL_FINDING_UNUSED, VL_SEVERITY_WARNING, s->emissions.items[i].source,
                   "no shape emits light by this area light");
  VL_FREE(c->context, read, mixed);
}

/* Reports unused groups. A group has no source location, so that of its first shape is
 * given. */
static void tell_groups(vlCheck *c) {
  const vlScene *s = c->scene;
  size_t next = 0;
  for (size_t g = 0; g < s->groups.count; g++) {
    const vlSceneGroup *group = &s->groups.items[g];
    if (!c->used[VL_SCENE_GROUPS][g] && group->shape_count && named(group->name)) {
      while (next < s->shapes.count && s->shapes.items[next].group.index != g + 1)
        next++;
      vlSource at = next < s->shapes.count ? s->shapes.items[next].source : (vlSource){0};
      next = 0;
      vl_check_add(c, VL_FINDING_UNUSED, VL_SEVERITY_WARNING, at,
                   "object \"%s\" is placed nowhere", vl_short_text(group->name).text);
    }
    if (!c->used[VL_SCENE_GROUPS][g] || group->shape_count)
      continue;
    size_t i = 0;
    while (s->instances.items[i].group.index != g + 1)
      i++;
    vl_check_add(c, VL_FINDING_UNUSED, VL_SEVERITY_NOTE, s->instances.items[i].source,
                 "object \"%s\" is placed, but holds no shapes",
                 vl_short_text(group->name).text);
  }
}

void vl_check_names(vlCheck *c) {
  find_used(c);
  tell_unused(c);
  tell_groups(c);
}
