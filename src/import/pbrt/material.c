/* import/pbrt/material.c: converts Material and MakeNamedMaterial to materials of the scene.
 * The parts of a mix are converted first. The rows describe the parameters
 * (material/NAME.row.c). */
#include <math.h>
#include <stdio.h>

#include "import/pbrt/builder.h"
#include "velo/material.h"

/* ---- the statements ---------------------------------------------------------------------- */

bool vl_import_material(vlImport *import, const vlStatement *s) {
  vlPending *p = vl_import_wait(import, s, VL_ATTR_MATERIAL, false);
  if (!p || !(p->kind = vl_import_keep(import, s->names[0])))
    return false;
  import->state.material = (uint32_t)import->materials.count;
  import->state.material_name = NULL;
  return true;
}

bool vl_import_make_named_material(vlImport *import, const vlStatement *s) {
  uint32_t index;
  if (vl_names_find(&import->named_materials, s->names[0], &index))
    return vl_import_wrong(
        import, s->source, "material \"%s\" is made a second time (first in line %u)",
        vl_short_text(s->names[0]).text, import->materials.items[index].source.line);
  vlPending *p = vl_import_wait(import, s, VL_ATTR_MATERIAL, false);
  if (!p || !(p->name = vl_import_keep(import, s->names[0])))
    return false;
  return vl_import_add_name(import, &import->named_materials, p->name,
                            import->materials.count - 1);
}

bool vl_import_named_material(vlImport *import, const vlStatement *s) {
  uint32_t index;
  import->state.material = 0;
  import->state.material_source = s->source;
  if (vl_names_find(&import->named_materials, s->names[0], &index)) {
    import->state.material_name = import->materials.items[index].name;
    return vl_scene_copy_source(import->scene, &import->state.material_source);
  }
  import->state.material_name = vl_import_keep(import, s->names[0]);
  return import->state.material_name &&
         vl_scene_copy_source(import->scene, &import->state.material_source);
}

/* ---- the end of the file ----------------------------------------------------------------- */

bool vl_import_material_id(vlImport *import, const char *name, vlSource source,
                           vlMaterialId *id, bool *is_interface) {
  uint32_t index;
  if (!vl_names_find(&import->named_materials, name, &index))
    return vl_import_missing_name(import, source, "material", name, &import->named_materials);
  if (import->materials.items[index].state == VL_IN_PROGRESS)
    return vl_import_wrong(import, source, "material \"%s\" is mixed of itself",
                           vl_short_text(name).text);
  if (!vl_import_finish_material(import, index))
    return false;
  id->index = import->materials.items[index].id;
  *is_interface = import->materials.items[index].is_interface;
  return true;
}

bool vl_import_give_up_material(vlImport *import, vlPending *pending) {
  vlMaterialDef def = vl_default_material_def(VL_MATERIAL_DIFFUSE);
  def.name = pending->name;
  pending->state = VL_DONE;
  pending->id = vl_scene_add_material(import->scene, &def).index;
  return pending->id != 0;
}

/* ---- what a table cannot say ------------------------------------------------------------- */

static bool finish_metal(vlDict *dict, vlMaterialDef *def, const char *eta, const char *k) {
  def->use_reflectance = vl_import_given(dict, "reflectance");
  if (!def->use_reflectance || (!vl_import_given(dict, eta) && !vl_import_given(dict, k)))
    return true;
  return vl_dict_fail(dict, "give either \"reflectance\" or \"%s\" and \"%s\", not both", eta,
                      k);
}

static bool finish_conductor(vlDict *dict, vlMaterialDef *def) {
  return finish_metal(dict, def, "eta", "k");
}

static bool finish_coated_conductor(vlDict *dict, vlMaterialDef *def) {
  return finish_metal(dict, def, "conductor.eta", "conductor.k");
}

static bool finish_mix(vlDict *dict, vlMaterialDef *def) {
  vlImport *import = dict->import;
  vlParam *p = vl_dict_find_counted(dict, "materials", VL_BIT_STRING, 2);
  if (!p)
    return vl_dict_missing(dict, "\"string materials\" (two names)");
  for (int i = 0; i < 2; i++) {
    bool is_interface;
    if (!vl_import_material_id(import, p->strings.items[i], p->source, &def->materials[i],
                               &is_interface))
      return false;
  }
  return true;
}

/* As in pbrt, only the first of sigma_a, reflectance and the melanins that is given has an
 * effect. */
static bool finish_hair(vlDict *dict, vlMaterialDef *def) {
  bool sigma = vl_import_given(dict, "sigma_a"),
       reflectance = vl_import_given(dict, "reflectance"),
       pheomelanin = vl_import_given(dict, "pheomelanin");
  bool melanin = vl_import_given(dict, "eumelanin") || pheomelanin;
  if (pheomelanin && !vl_import_given(dict, "eumelanin"))
    def->hair.eumelanin = vl_float_input(0.0f);
  def->hair.color = sigma         ? VL_HAIR_SIGMA_A
                    : reflectance ? VL_HAIR_REFLECTANCE
                                  : VL_HAIR_MELANIN;
  if (sigma + reflectance + melanin > 1)
    vl_dict_warn(dict,
                 "its colour is given in several ways; sigma_a comes before reflectance, "
                 "that before melanin");
  return true;
}

/* The interior of the solid is given in one of four ways, as in pbrt. */
static bool finish_subsurface(vlDict *dict, vlMaterialDef *def) {
  vlSubsurfaceDef *d = &def->subsurface;
  bool a = vl_import_given(dict, "sigma_a"), s = vl_import_given(dict, "sigma_s"),
       mfp = vl_import_given(dict, "mfp"), named;
  vlSpectrum preset_a, preset_s;
  d->from_reflectance = vl_import_given(dict, "reflectance");
  if (!vl_import_scattering_preset(dict, "name", &preset_a, &preset_s, &named))
    return false;
  if (named + (a || s) + (d->from_reflectance || mfp) > 1)
    return vl_dict_fail(
        dict,
        "give only one of \"name\", \"sigma_a\" and \"sigma_s\", \"reflectance\" (and "
        "\"mfp\"): each says all");
  if (a != s)
    return vl_dict_fail(dict, "%s",
                        a ? "\"sigma_s\" is missing beside \"sigma_a\""
                          : "\"sigma_a\" is missing beside \"sigma_s\"");
  if (mfp && !d->from_reflectance)
    return vl_dict_fail(dict, "\"reflectance\" is missing beside \"mfp\"");
  if (!named)
    return true;
  d->sigma_a = vl_spectrum_input(preset_a);
  d->sigma_s = vl_spectrum_input(preset_s);
  if (def->g.value == 0.0f)
    return true;
  vl_dict_warn(dict, "\"g\" is ignored beside \"name\": measured scattering is that of g = 0");
  def->g = vl_float_input(0.0f);
  return true;
}

/* Rules that run after the row's parameters are read; null: none. */
typedef bool Rule(vlDict *dict, vlMaterialDef *def);
static Rule *const rules[0 VL_MATERIAL_KINDS(VL_COUNT_KIND)] = {
    [VL_MATERIAL_CONDUCTOR] = finish_conductor,
    [VL_MATERIAL_COATED_CONDUCTOR] = finish_coated_conductor,
    [VL_MATERIAL_MIX] = finish_mix,
    [VL_MATERIAL_HAIR] = finish_hair,
    [VL_MATERIAL_SUBSURFACE] = finish_subsurface};

/* ---- materials --------------------------------------------------------------------------- */

static bool read_material(vlDict *dict, vlMaterialDef *def) {
  return vl_import_parameters(dict, def, true) &&
         (!rules[def->kind] || rules[def->kind](dict, def)) && vl_dict_done(dict);
}

/* Finds the kind, which may be unknown. False after an error. */
static bool find_kind(vlImport *import, vlPending *pending, vlDict *dict) {
  const char *type = pending->kind;
  vlSource source = pending->source;
  if (!type) { /* MakeNamedMaterial */
    if (!vl_dict_type(dict, &type))
      return false;
    source = vl_dict_find(dict, "type", VL_BIT_STRING)->source;
  }
  vl_dict_set_kind(dict, &vl_material_family,
                   type[0] ? vl_kind_find(&vl_material_family, type)
                           : VL_MATERIAL_INTERFACE); /* pbrt-v3's spelling */
  return dict->row || vl_import_unknown_kind(import, source, &vl_material_family, type);
}

static bool finish(vlImport *import, vlPending *pending) {
  char what[128];
  if (pending->kind)
    snprintf(what, sizeof what, "Material \"%s\"",
             vl_import_kind_text(&vl_material_family, pending->kind).text);
  else
    snprintf(what, sizeof what, "MakeNamedMaterial \"%s\"", vl_short_text(pending->name).text);
  vlDict dict =
      vl_import_dict(import, what, pending->source, pending->space, &pending->params, NULL);
  if (!find_kind(import, pending, &dict))
    return false;
  vlMaterialDef def =
      vl_default_material_def(dict.row ? (vlMaterialKind)dict.kind : VL_MATERIAL_DIFFUSE);
  def.name = pending->name;
  def.source = pending->source;
  if (dict.row && !read_material(&dict, &def))
    return false;
  pending->is_interface = def.kind == VL_MATERIAL_INTERFACE;
  pending->id = vl_scene_add_material(import->scene, &def).index;
  return pending->id != 0;
}

bool vl_import_finish_material(vlImport *import, uint32_t index) {
  /* the array no longer grows */
  return vl_import_finish_once(import, &import->materials.items[index], finish,
                               "materials are mixed of each other");
}

/* ---- rough coats ------------------------------------------------------------------------- */

static float alpha_of(const vlMaterialDef *m, const vlFloatInput *roughness) {
  if (roughness->texture.index)
    return 1;
  return m->remap_roughness ? sqrtf(roughness->value > 0 ? roughness->value : 0)
                            : roughness->value;
}

/* pbrt-v4 overestimates the light through rough coats (docs/decisions/0006). The note matters
 * when images of both renderers are compared. */
void vl_import_note_rough_coats(vlImport *import) {
  const vlScene *scene = import->scene;
  const vlMaterialDef *first = NULL;
  uint32_t count = 0;
  VL_EACH_ITEM(const vlMaterialDef, m, &scene->materials) {
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
