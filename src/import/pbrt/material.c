/* import/pbrt/material.c: converts Material and MakeNamedMaterial to materials of the scene.
 * The parts of a mix are converted first. The rows describe the parameters
 * (material/NAME.row.c). */
#include <assert.h>
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
  if (vl_names_add(import->context, &import->named_materials, p->name,
                   (uint32_t)import->materials.count - 1))
    return true;
  return vl_import_fail_memory(import);
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

/* ---- what a table cannot say ------------------------------------------------------------- */

/* The parameters of one material: its row, and which of them the file gives. */
typedef struct Reading {
  vlDict *dict;
  const vlKindRow *row;
  const bool *given;
} Reading;

static bool given(const Reading *r, const char *name) {
  return vl_import_given(r->row, r->given, name);
}

static bool finish_metal(const Reading *r, vlMaterialDef *def, const char *eta, const char *k) {
  def->use_reflectance = given(r, "reflectance");
  if (!def->use_reflectance || (!given(r, eta) && !given(r, k)))
    return true;
  return vl_dict_fail(r->dict, "give either \"reflectance\" or \"%s\" and \"%s\", not both",
                      eta, k);
}

static bool finish_conductor(const Reading *r, vlMaterialDef *def) {
  return finish_metal(r, def, "eta", "k");
}

static bool finish_coated_conductor(const Reading *r, vlMaterialDef *def) {
  return finish_metal(r, def, "conductor.eta", "conductor.k");
}

static bool finish_mix(const Reading *r, vlMaterialDef *def) {
  vlImport *import = r->dict->import;
  vlParam *p = vl_dict_find(r->dict, "materials", VL_BIT_STRING);
  if (!p)
    return vl_dict_done(r->dict) &&
           vl_dict_fail(r->dict, "\"string materials\" (two names) is missing");
  if (p->strings.count != 2)
    return vl_dict_fail_at(r->dict, p->source,
                           "parameter \"materials\" takes 2 values, found %zu",
                           p->strings.count);
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
static bool finish_hair(const Reading *r, vlMaterialDef *def) {
  bool sigma = given(r, "sigma_a"), reflectance = given(r, "reflectance"),
       pheomelanin = given(r, "pheomelanin");
  bool melanin = given(r, "eumelanin") || pheomelanin;
  if (pheomelanin && !given(r, "eumelanin"))
    def->hair.eumelanin = vl_float_input(0.0f);
  def->hair.color = sigma         ? VL_HAIR_SIGMA_A
                    : reflectance ? VL_HAIR_REFLECTANCE
                                  : VL_HAIR_MELANIN;
  if (sigma + reflectance + melanin > 1)
    vl_dict_warn(r->dict,
                 "its colour is given in several ways; sigma_a comes before reflectance, "
                 "that before melanin");
  return true;
}

/* The interior of the solid is given in one of four ways, as in pbrt. */
static bool finish_subsurface(const Reading *r, vlMaterialDef *def) {
  vlSubsurfaceDef *d = &def->subsurface;
  bool a = given(r, "sigma_a"), s = given(r, "sigma_s"), mfp = given(r, "mfp"), named;
  vlSpectrum preset_a, preset_s;
  d->from_reflectance = given(r, "reflectance");
  if (!vl_import_scattering_preset(r->dict, "name", &preset_a, &preset_s, &named))
    return false;
  if (named + (a || s) + (d->from_reflectance || mfp) > 1)
    return vl_dict_fail(
        r->dict,
        "give only one of \"name\", \"sigma_a\" and \"sigma_s\", \"reflectance\" (and "
        "\"mfp\"): each says all");
  if (a != s)
    return vl_dict_fail(r->dict, "%s",
                        a ? "\"sigma_s\" is missing beside \"sigma_a\""
                          : "\"sigma_a\" is missing beside \"sigma_s\"");
  if (mfp && !d->from_reflectance)
    return vl_dict_fail(r->dict, "\"reflectance\" is missing beside \"mfp\"");
  if (!named)
    return true;
  d->sigma_a = vl_spectrum_input(preset_a);
  d->sigma_s = vl_spectrum_input(preset_s);
  if (def->g.value == 0.0f)
    return true;
  vl_dict_warn(r->dict,
               "\"g\" is ignored beside \"name\": measured scattering is that of g = 0");
  def->g = vl_float_input(0.0f);
  return true;
}

/* Rules that run after the row's parameters are read; null: none. */
typedef bool Rule(const Reading *r, vlMaterialDef *def);
static Rule *const rules[0 VL_MATERIAL_KINDS(VL_COUNT_KIND)] = {
    [VL_MATERIAL_CONDUCTOR] = finish_conductor,
    [VL_MATERIAL_COATED_CONDUCTOR] = finish_coated_conductor,
    [VL_MATERIAL_MIX] = finish_mix,
    [VL_MATERIAL_HAIR] = finish_hair,
    [VL_MATERIAL_SUBSURFACE] = finish_subsurface};

/* ---- materials --------------------------------------------------------------------------- */

static bool read_material(vlDict *dict, vlMaterialDef *def) {
  enum { MAX_PARAMETERS = 64 };
  bool is_given[MAX_PARAMETERS];
  const vlKindRow *row = vl_kind_row(&vl_material_family, (int)def->kind);
  const Reading r = {dict, row, is_given};
  assert(row->parameter_count <= MAX_PARAMETERS);
  return vl_import_parameters(dict, row, def, true, is_given) &&
         (!rules[def->kind] || rules[def->kind](&r, def)) && vl_dict_done(dict);
}

/* Finds the kind; *kind is -1 for an unknown name. False after an error. */
static bool find_kind(vlImport *import, vlPending *pending, vlDict *dict, int *kind) {
  const char *type = pending->kind;
  vlSource source = pending->source;
  if (!type) { /* MakeNamedMaterial */
    if (!vl_dict_string(dict, "type", &type)) {
      if (!vl_import_fine(import))
        return false;
      return vl_import_wrong(import, source,
                             "MakeNamedMaterial \"%s\": \"string type\" is missing",
                             vl_short_text(pending->name).text);
    }
    source = vl_dict_find(dict, "type", VL_BIT_STRING)->source;
  }
  *kind = type[0] ? vl_kind_find(&vl_material_family, type)
                  : VL_MATERIAL_INTERFACE; /* pbrt-v3's spelling */
  return *kind >= 0 || vl_import_unknown_kind(import, source, &vl_material_family, type);
}

static bool finish(vlImport *import, uint32_t index) {
  vlPending *pending = &import->materials.items[index]; /* the array no longer grows */
  char what[128];
  if (pending->kind)
    snprintf(what, sizeof what, "Material \"%s\"",
             vl_import_kind_text(&vl_material_family, pending->kind).text);
  else
    snprintf(what, sizeof what, "MakeNamedMaterial \"%s\"", vl_short_text(pending->name).text);
  vlDict dict =
      vl_import_dict(import, what, pending->source, pending->space, &pending->params, NULL);
  int kind = -1;
  if (!find_kind(import, pending, &dict, &kind))
    return false;
  vlMaterialDef def =
      vl_default_material_def(kind < 0 ? VL_MATERIAL_DIFFUSE : (vlMaterialKind)kind);
  def.name = pending->name;
  def.source = pending->source;
  if (kind >= 0 && !read_material(&dict, &def))
    return false;
  pending->is_interface = def.kind == VL_MATERIAL_INTERFACE;
  pending->id = vl_scene_add_material(import->scene, &def).index;
  return pending->id != 0;
}

bool vl_import_finish_material(vlImport *import, uint32_t index) {
  vlPending *pending = &import->materials.items[index];
  if (pending->state == VL_DONE)
    return true;
  if (++import->depth > VL_IMPORT_DEPTH)
    return vl_import_wrong(import, pending->source,
                           "materials are mixed of each other more than %d deep",
                           VL_IMPORT_DEPTH);
  pending->state = VL_IN_PROGRESS;
  if (!finish(import, index))
    return false;
  import->depth--;
  pending->state = VL_DONE;
  return true;
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
