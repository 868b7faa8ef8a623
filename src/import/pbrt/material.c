/* import/pbrt/material.c: Material and MakeNamedMaterial entities to the scene, a mix after its parts. Parameters and
 * defaults are pbrt-v4's. */
#include <stdio.h>
#include <string.h>

#include "import/pbrt/builder.h"

static const char *const kinds[] = {
    "diffuse",    "coateddiffuse",       "conductor",       "dielectric", "thindielectric", "mix",        "interface",
    "principled", "diffusetransmission", "coatedconductor", "hair",       "measured",       "subsurface", "",
    "none"};
static const vlMaterialKind kind_values[] = {VL_MATERIAL_DIFFUSE,
                                             VL_MATERIAL_COATED_DIFFUSE,
                                             VL_MATERIAL_CONDUCTOR,
                                             VL_MATERIAL_DIELECTRIC,
                                             VL_MATERIAL_THIN_DIELECTRIC,
                                             VL_MATERIAL_MIX,
                                             VL_MATERIAL_INTERFACE,
                                             VL_MATERIAL_PRINCIPLED,
                                             VL_MATERIAL_DIFFUSE_TRANSMISSION,
                                             VL_MATERIAL_COATED_CONDUCTOR,
                                             VL_MATERIAL_HAIR,
                                             VL_MATERIAL_MEASURED,
                                             VL_MATERIAL_SUBSURFACE,
                                             VL_MATERIAL_INTERFACE,
                                             VL_MATERIAL_INTERFACE};
_Static_assert(sizeof kinds / sizeof *kinds == sizeof kind_values / sizeof *kind_values, "a kind for each name");
enum { KINDS = sizeof kinds / sizeof *kinds, NAMES = KINDS - 2 };

bool vl_import_material_id(vlImport *import, const char *name, vlSource place, vlMaterialId *id, bool *is_interface) {
  uint32_t index;
  if (!vl_names_find(&import->named_materials, name, &index)) {
    const char *near = vl_names_nearest(&import->named_materials, name);
    if (near)
      return vl_import_fail(import, VL_ERROR_SCENE, place, "there is no material \"%.80s\" (did you mean \"%s\"?)",
                            name, near);
    return vl_import_fail(import, VL_ERROR_SCENE, place, "there is no material \"%.80s\"", name);
  }
  if (import->materials.items[index].state == VL_IN_PROGRESS)
    return vl_import_fail(import, VL_ERROR_SCENE, place, "material \"%.80s\" is mixed of itself", name);
  if (!vl_import_finish_material(import, index)) return false;
  id->index = import->materials.items[index].id;
  *is_interface = import->materials.items[index].is_interface;
  return true;
}

/* The ways to name roughness: of both directions, and of each, which fall back on it. */
static const char *const plain_roughness[3] = {"roughness", "uroughness", "vroughness"};
static const char *const metal_roughness[3] = {"conductor.roughness", "conductor.uroughness", "conductor.vroughness"};
static const char *const coat_roughness[3] = {"interface.roughness", "interface.uroughness", "interface.vroughness"};

static bool read_rough(vlDict *dict, const char *const names[3], vlFloatInput *u, vlFloatInput *v) {
  vlFloatInput both = vl_float_input(0.0f);
  bool has_u = false, has_v = false;
  if (!vl_import_float_input(dict, names[1], u, &has_u) || !vl_import_float_input(dict, names[2], v, &has_v) ||
      !vl_import_float_input(dict, names[0], &both, NULL))
    return false;
  if (!has_u) *u = both;
  if (!has_v) *v = both;
  return true;
}

static bool read_roughness(vlDict *dict, vlMaterialDef *def) {
  if (!read_rough(dict, plain_roughness, &def->u_roughness, &def->v_roughness)) return false;
  vl_dict_bool(dict, "remaproughness", &def->remap_roughness);
  return true;
}

/* An index of refraction: a number or a spectrum, not a texture. */
static bool read_index(vlDict *dict, const char *name, vlSpectrumInput *input) {
  vlParam *p = vl_dict_find(dict, name, VL_BIT_FLOAT | VL_BITS_SPECTRUM);
  if (!p) return dict->import->scene->error.code == VL_OK;
  *input = (vlSpectrumInput){0};
  if (p->type != VL_PARAM_FLOAT) return vl_import_spectrum(dict->import, p, &input->value);
  float eta = 1.5f;
  bool given = vl_dict_float(dict, name, &eta);
  input->value = vl_spectrum_constant(eta);
  return given;
}

static bool read_eta(vlDict *dict, vlMaterialDef *def) {
  return read_index(dict, "eta", &def->eta);
}

static bool read_metal(vlDict *dict, vlMaterialDef *def, const char *eta_name, const char *k_name) {
  bool eta, k;
  if (!vl_import_spectrum_input(dict, eta_name, &def->eta, false, &eta) ||
      !vl_import_spectrum_input(dict, k_name, &def->k, false, &k) ||
      !vl_import_spectrum_input(dict, "reflectance", &def->reflectance, true, &def->use_reflectance))
    return false;
  if (def->use_reflectance && (eta || k))
    return vl_import_fail(dict->import, VL_ERROR_SCENE, dict->place,
                          "%s: give either \"reflectance\" or \"%s\" and \"%s\", not both", dict->what, eta_name,
                          k_name);
  return true;
}

static bool read_conductor(vlDict *dict, vlMaterialDef *def) {
  return read_metal(dict, def, "eta", "k") && read_roughness(dict, def);
}

/* What lies between a coat and its base. */
static bool read_medium(vlDict *dict, vlMaterialDef *def) {
  return vl_import_float_input(dict, "thickness", &def->thickness, NULL) &&
         vl_import_float_input(dict, "g", &def->g, NULL) &&
         vl_import_spectrum_input(dict, "albedo", &def->albedo, true, NULL) &&
         (vl_dict_count(dict, "maxdepth", 1, &def->max_depth), vl_dict_count(dict, "nsamples", 1, &def->samples),
          vl_dict_bool(dict, "conserveenergy", &def->conserve_energy), dict->import->scene->error.code == VL_OK);
}

static bool read_coated_conductor(vlDict *dict, vlMaterialDef *def) {
  vl_dict_bool(dict, "remaproughness", &def->remap_roughness);
  return read_metal(dict, def, "conductor.eta", "conductor.k") &&
         read_rough(dict, metal_roughness, &def->u_roughness, &def->v_roughness) &&
         read_rough(dict, coat_roughness, &def->coat_u_roughness, &def->coat_v_roughness) &&
         read_index(dict, "interface.eta", &def->coat_eta) && read_medium(dict, def);
}

static bool read_diffuse_transmission(vlDict *dict, vlMaterialDef *def) {
  vl_dict_float(dict, "scale", &def->scale);
  return vl_import_spectrum_input(dict, "reflectance", &def->reflectance, true, NULL) &&
         vl_import_spectrum_input(dict, "transmittance", &def->transmittance, true, NULL);
}

static bool read_mix(vlDict *dict, vlMaterialDef *def) {
  vlImport *import = dict->import;
  vlParam *p = vl_dict_find(dict, "materials", 1u << VL_PARAM_STRING);
  if (!vl_import_float_input(dict, "amount", &def->amount, NULL)) return false;
  if (!p) {
    if (!vl_dict_done(dict)) return false;
    return vl_import_fail(import, VL_ERROR_SCENE, dict->place, "%s: \"string materials\" (two names) is missing",
                          dict->what);
  }
  if (p->strings.count != 2)
    return vl_import_fail(import, VL_ERROR_SCENE, p->place, "%s: parameter \"materials\" takes 2 values, found %zu",
                          dict->what, p->strings.count);
  for (int i = 0; i < 2; i++) {
    bool is_interface;
    if (!vl_import_material_id(import, p->strings.items[i], p->place, &def->materials[i], &is_interface)) return false;
  }
  return true;
}

static bool read_coat(vlDict *dict, vlMaterialDef *def) {
  return vl_import_spectrum_input(dict, "reflectance", &def->reflectance, true, NULL) && read_roughness(dict, def) &&
         read_eta(dict, def) && read_medium(dict, def);
}

/* Bumps: what every surface but a mix may have. */
static bool read_bump(vlDict *dict, vlMaterialDef *def) {
  vlImport *import = dict->import;
  if (!vl_import_float_input(dict, "displacement", &def->displacement, NULL)) return false;
  vlParam *p = vl_dict_find(dict, "normalmap", 1u << VL_PARAM_STRING);
  if (!p) return import->scene->error.code == VL_OK;
  char path[4096];
  if (p->strings.items[0][0] == 0) return true;
  if (!vl_import_path(import, p, path, sizeof path)) return false;
  def->normal_map = vl_import_keep(import, path);
  return def->normal_map != NULL;
}

static bool read_measured(vlDict *dict, vlMaterialDef *def) {
  vlImport *import = dict->import;
  vlParam *p = vl_dict_find(dict, "filename", 1u << VL_PARAM_STRING);
  char path[4096];
  if (!p)
    return import->scene->error.code == VL_OK &&
           vl_import_fail(import, VL_ERROR_SCENE, dict->place, "%s: \"string filename\" is missing", dict->what);
  if (!vl_import_path(import, p, path, sizeof path)) return false;
  def->measured = vl_import_keep(import, path);
  return def->measured != NULL;
}

static bool read_material(vlDict *dict, vlMaterialDef *def) {
  switch (def->kind) {
    case VL_MATERIAL_DIFFUSE:
      if (!vl_import_spectrum_input(dict, "reflectance", &def->reflectance, true, NULL)) return false;
      break;
    case VL_MATERIAL_COATED_DIFFUSE:
      if (!read_coat(dict, def)) return false;
      break;
    case VL_MATERIAL_CONDUCTOR:
      if (!read_conductor(dict, def)) return false;
      break;
    case VL_MATERIAL_DIELECTRIC:
      if (!read_eta(dict, def) || !read_roughness(dict, def)) return false;
      break;
    case VL_MATERIAL_THIN_DIELECTRIC:
      if (!read_eta(dict, def)) return false;
      break;
    case VL_MATERIAL_MIX:
      if (!read_mix(dict, def)) return false;
      break;
    case VL_MATERIAL_PRINCIPLED:
      if (!vl_import_principled(dict, def)) return false;
      break;
    case VL_MATERIAL_DIFFUSE_TRANSMISSION:
      if (!read_diffuse_transmission(dict, def)) return false;
      break;
    case VL_MATERIAL_COATED_CONDUCTOR:
      if (!read_coated_conductor(dict, def)) return false;
      break;
    case VL_MATERIAL_HAIR:
      if (!vl_import_hair(dict, def)) return false;
      break;
    case VL_MATERIAL_MEASURED:
      if (!read_measured(dict, def)) return false;
      break;
    case VL_MATERIAL_SUBSURFACE:
      if (!vl_import_subsurface(dict, def) || !read_roughness(dict, def)) return false;
      break;
    case VL_MATERIAL_INTERFACE: break;
  }
  if (def->kind != VL_MATERIAL_MIX && def->kind != VL_MATERIAL_INTERFACE && !read_bump(dict, def)) return false;
  return vl_dict_done(dict);
}

static bool find_kind(vlImport *import, vlPending *pending, vlDict *dict, int *kind) {
  const char *type = pending->kind;
  if (!type) { /* MakeNamedMaterial */
    if (!vl_dict_string(dict, "type", &type)) {
      if (import->scene->error.code != VL_OK) return false;
      return vl_import_fail(import, VL_ERROR_SCENE, pending->place,
                            "MakeNamedMaterial \"%.60s\": \"string type\" is missing", pending->name);
    }
  }
  *kind = -1;
  for (int i = 0; i < KINDS; i++)
    if (strcmp(type, kinds[i]) == 0) *kind = i;
  vlSource place = pending->place;
  if (*kind < 0 && !pending->kind) place = vl_dict_find(dict, "type", 1u << VL_PARAM_STRING)->place;
  return *kind >= 0 || vl_import_unknown(import, place, "material", type, kinds, NAMES, NULL, 0);
}

static bool finish(vlImport *import, uint32_t index) {
  vlPending *pending = &import->materials.items[index]; /* the array does not grow any more */
  char what[128];
  if (pending->kind)
    snprintf(what, sizeof what, "Material \"%.60s\"", pending->kind);
  else
    snprintf(what, sizeof what, "MakeNamedMaterial \"%.60s\"", pending->name);
  vlDict dict = vl_import_dict(import, what, pending->place, pending->space, &pending->params, NULL);
  int kind = -1;
  if (!find_kind(import, pending, &dict, &kind)) return false;
  vlMaterialDef def = vl_default_material_def(kind < 0 ? VL_MATERIAL_DIFFUSE : kind_values[kind]);
  def.name = pending->name;
  def.source = pending->place;
  if (kind >= 0 && !read_material(&dict, &def)) return false;
  pending->is_interface = def.kind == VL_MATERIAL_INTERFACE;
  pending->id = vl_scene_add_material(import->scene, &def).index;
  return pending->id != 0;
}

bool vl_import_finish_material(vlImport *import, uint32_t index) {
  vlPending *pending = &import->materials.items[index];
  if (pending->state == VL_DONE) return true;
  if (++import->depth > VL_IMPORT_DEPTH)
    return vl_import_fail(import, VL_ERROR_SCENE, pending->place, "materials are mixed of each other more than %d deep",
                          VL_IMPORT_DEPTH);
  pending->state = VL_IN_PROGRESS;
  if (!finish(import, index)) return false;
  import->depth--;
  pending->state = VL_DONE;
  return true;
}
