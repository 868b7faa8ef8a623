/* import/pbrt/finish.c: the end of the import: mesh files are read, textures, materials and
 * media are resolved and linked to shapes. */
#include <math.h>

#include "import/pbrt/builder.h"
#include "velo/material.h"
#include "velo/shape.h"

/* ---- the end ----------------------------------------------------------------------------- */

static bool link_shape(vlImport *import, const vlShapeLink *link) {
  vlShapeDef *shape = &import->scene->shapes.items[link->shape];
  bool is_interface = false;
  if (link->material_name) {
    if (!vl_import_material_id(import, link->material_name, link->material_source,
                               &shape->material, &is_interface))
      return false;
  } else if (link->material) {
    const vlPending *p = &import->materials.items[link->material - 1];
    shape->material.index = p->id;
    is_interface = p->is_interface;
  }
  if (is_interface && shape->emission.index) {
    vl_import_warn(
        import, VL_LOG_WARNING, shape->source,
        "a shape of material \"interface\" gives no light: its area light is ignored");
    shape->emission.index = 0;
  }
  if (link->displacement &&
      !vl_import_texture_id(import, link->displacement, false, link->displacement_source,
                            &shape->displacement.texture))
    return false;
  return !link->alpha || vl_import_texture_id(import, link->alpha, false, link->alpha_source,
                                              &shape->alpha.texture);
}

/* While diagnosing: unfinished textures are skipped and unfinished materials become the default
 * one. */
static bool give_up(vlImport *import) {
  if (!vl_import_recover(import))
    return false;
  import->depth = 0;
  for (size_t i = 0; i < import->textures.count; i++)
    if (import->textures.items[i].state == VL_IN_PROGRESS)
      import->textures.items[i].state = VL_DONE;
  for (size_t i = 0; i < import->materials.count; i++) {
    vlPending *p = &import->materials.items[i];
    if (p->state != VL_IN_PROGRESS)
      continue;
    vlMaterialDef def = vl_default_material_def(VL_MATERIAL_DIFFUSE);
    def.name = p->name;
    p->state = VL_DONE;
    p->id = vl_scene_add_material(import->scene, &def).index;
    if (!p->id)
      return false;
  }
  return true;
}

static float alpha_of(const vlMaterialDef *m, const vlFloatInput *roughness) {
  if (roughness->texture.index)
    return 1;
  return m->remap_roughness ? sqrtf(roughness->value > 0 ? roughness->value : 0)
                            : roughness->value;
}

/* pbrt-v4 overestimates the light through rough coats (docs/decisions/0006). The note matters
 * when images of both renderers are compared. */
static void note_rough_coats(vlImport *import) {
  const vlScene *scene = import->scene;
  const vlMaterialDef *first = NULL;
  uint32_t count = 0;
  for (size_t i = 0; i < scene->materials.count; i++) {
    const vlMaterialDef *m = &scene->materials.items[i];
    if (m->kind != VL_MATERIAL_COATED_DIFFUSE)
      continue;
    if (fmaxf(alpha_of(m, &m->u_roughness), alpha_of(m, &m->v_roughness)) < 0.1f)
      continue;
    if (!count++)
      first = m;
  }
  if (count)
    vl_import_warn(import, VL_LOG_DEBUG, first->source,
                   "%u rough coat%s: pbrt-v4 shows such 2 to 8 %% too bright where lamps "
                   "light them; velo does so with --imitate-pbrt",
                   count, count == 1 ? "" : "s, of which this is the first");
}

bool vl_import_finish(vlImport *import) {
  vlScene *scene = import->scene;
  if (scene->error.code != VL_OK)
    return false;
  if (!import->in_world)
    return vl_import_fail(import, VL_ERROR_SCENE, (vlSource){import->first, 0, 0},
                          "the file has no WorldBegin");
  if (import->stack.count) {
    const vlStackEntry *top = &import->stack.items[import->stack.count - 1];
    return vl_import_fail(import, VL_ERROR_SCENE, top->source, "%s is never closed",
                          top->kind == 'o' ? "ObjectBegin" : "AttributeBegin");
  }
  if (!vl_import_flush_curves(import) || !vl_import_flush_meshes(import) ||
      !vl_import_flush_spheres(import))
    return false;
  if (!vl_import_read_meshes(import))
    return false;
  for (uint32_t i = 0; i < import->textures.count; i++)
    if (!vl_import_finish_texture(import, i) && !give_up(import))
      return false;
  for (uint32_t i = 0; i < import->materials.count; i++)
    if (!vl_import_finish_material(import, i) && !give_up(import))
      return false;
  for (size_t i = 0; i < import->links.count; i++)
    if (!link_shape(import, &import->links.items[i]) && !give_up(import))
      return false;
  if (!vl_import_finish_motion(import))
    return false;
  for (size_t i = 0; i < import->object_list.count; i++) {
    const vlObject *object = &import->object_list.items[i];
    if (object->defined)
      continue;
    vl_import_fail(import, VL_ERROR_SCENE, object->source, "there is no object \"%s\"",
                   vl_short_text(object->name).text);
    if (!vl_import_recover(import))
      return false;
  }
  note_rough_coats(import);
  return vl_import_finish_media(import);
}
