/* material/compile.c: compiles the materials of a scene; of the kinds with few inputs it has
 * the functions. Material 0 of the world is the default material, a diffuse grey. */
#include <assert.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "base/error.h"
#include "material/compile.h"
#include "math/ggx.h"
#include "schema/schema.h"
#include "velo/schema.h"
#include "velo/texture.h"

typedef struct Label {
  char text[200];
} Label;

/* `material "gold"`, or the kind of one without a name. */
static Label label_of(const vlMaterialDef *def) {
  Label label;
  if (def->name && def->name[0])
    snprintf(label.text, sizeof label.text, "material \"%s\"", vl_short_text(def->name).text);
  else
    snprintf(label.text, sizeof label.text, "%s",
             vl_kind_row(&vl_material_family, (int)def->kind)->name);
  return label;
}

static vlResult material_fail(const vlMaterialBuild *b, const char *what) {
  const vlMaterialDef *def = b->def;
  return vl_fail_source(b->error, VL_ERROR_SCENE, def->source, "%s: %s", label_of(def).text,
                        what);
}

vlResult vl_material_floats(const vlMaterialBuild *b, const vlMaterialFloat *floats,
                            size_t count) {
  vlResult r = VL_OK;
  for (size_t i = 0; r == VL_OK && i < count; i++)
    r = vl_material_float(b, floats[i].input, floats[i].node);
  return r;
}

/* ---- coats ------------------------------------------------------------------------------- */

static float alpha_of(float roughness, bool remap) {
  return remap ? sqrtf(roughness > 0 ? roughness : 0) : roughness;
}

static const vlWorldCoat *find_coat(const vlWorld *world, const vlCoatTable *wanted,
                                    uint32_t depth) {
  for (size_t i = 0; i < world->coats.count; i++) {
    const vlCoatTable *t = world->coats.items[i].table;
    if (t && t->eta == wanted->eta && t->tau == wanted->tau &&
        world->coats.items[i].depth == depth && t->alpha_min == wanted->alpha_min &&
        t->alpha_max == wanted->alpha_max && t->anisotropic == wanted->anisotropic &&
        t->rough_y == wanted->rough_y && t->conserves == wanted->conserves)
      return &world->coats.items[i];
  }
  return NULL;
}

static void free_coat(vlContext *context, void *table) {
  vl_coat_free(context, table);
}

/* Gives the coat table for these alphas, along u and along v, or, if one of them is textured,
 * for all up to 1. Coats with equal parameters share a table. */
static vlResult coat_table(vlWorld *world, const vlMaterialDef *def, const vlWorldMaterial *m,
                           bool textured, float u, float v, const vlCoatTable **table,
                           vlError *error) {
  float thickness = def->thickness.value;
  const vlCoatTable wanted = {.eta = m->eta_s,
                              .tau = thickness,
                              .alpha_min = textured ? 0 : fminf(u, v),
                              .alpha_max = textured ? 1 : fmaxf(u, v),
                              .anisotropic = !textured && u != v,
                              .rough_y = !textured && v > u,
                              .conserves = def->conserve_energy};
  const vlWorldCoat *known = find_coat(world, &wanted, def->max_depth);
  if (known) {
    *table = known->table;
    return VL_OK;
  }
  known = world->previous ? find_coat(world->previous, &wanted, def->max_depth) : NULL;
  if (known) {
    vlWorldCoat *shared = VL_PUSH(world->context, &world->coats);
    if (!shared || !vl_part_share(world, known->part))
      return vl_fail_memory(error);
    *shared = *known;
    *table = known->table;
    return VL_OK;
  }
  vlCoatTable *built = NULL;
  vlResult r = textured ? vl_coat_build(world->context, m->eta_s, thickness, def->max_depth, 0,
                                        1, &built)
                        : vl_coat_build_anisotropic(world->context, m->eta_s, thickness,
                                                    def->max_depth, u, v, &built);
  if (r != VL_OK)
    return vl_fail_memory(error);
  r = def->conserve_energy ? vl_coat_conserve(world->context, built) : VL_OK;
  vlWorldCoat *slot = r != VL_OK ? NULL : VL_PUSH(world->context, &world->coats);
  vlPart *part = slot ? vl_part_add(world) : NULL;
  if (!part) {
    vl_coat_free(world->context, built);
    return vl_fail_memory(error);
  }
  part->destroy = free_coat;
  part->object = built;
  built->imitate = world->def.imitate_pbrt;
  *slot = (vlWorldCoat){part, built, def->max_depth};
  *table = built;
  return VL_OK;
}

static vlResult coat_of(vlWorld *world, const vlMaterialDef *def, vlWorldMaterial *m,
                        vlError *error) {
  const vlTextureNode *u = &world->nodes.items[m->u_roughness],
                      *v = &world->nodes.items[m->v_roughness];
  if (u->kind != VL_TEXTURE_CONSTANT || v->kind != VL_TEXTURE_CONSTANT)
    return coat_table(world, def, m, true, 0, 0, &m->coat, error);
  float a = alpha_of(u->value, m->remap), b = alpha_of(v->value, m->remap);
  vlResult r = coat_table(world, def, m, false, a, b, &m->coat, error);
  if (r != VL_OK || !world->def.regularize)
    return r;
  return coat_table(world, def, m, false, vl_ggx_widened(a), vl_ggx_widened(b), &m->widened,
                    error);
}

static void free_measured(vlContext *context, void *measured) {
  vl_measured_free(context, measured);
}

/* Loads a measured material; each file is read once. */
static vlResult measured_of(vlWorld *world, const vlMaterialDef *def, vlWorldMaterial *m,
                            vlError *error) {
  for (size_t i = 0; i < world->measured.count && !m->measured; i++)
    if (world->measured.items[i] && strcmp(world->measured.items[i]->path, def->measured) == 0)
      m->measured = world->measured.items[i];
  if (m->measured)
    return VL_OK;
  vlFileStamp stamp = vl_file_stamp(def->measured);
  const vlWorld *previous = world->previous;
  vlWorldFilePart *kept = VL_PUSH(world->context, &world->measured_parts);
  vlMeasured **slot = kept ? VL_PUSH(world->context, &world->measured) : NULL;
  if (!slot)
    return vl_fail_memory(error);
  for (size_t i = 0; previous && stamp.there && i < previous->measured.count; i++) {
    const vlWorldFilePart *known = &previous->measured_parts.items[i];
    vlMeasured *from = previous->measured.items[i];
    if (!vl_file_stamp_same(&known->stamp, &stamp) || strcmp(from->path, def->measured) != 0)
      continue;
    if (!vl_part_share(world, known->part))
      return vl_fail_memory(error);
    *kept = *known;
    m->measured = *slot = from;
    return VL_OK;
  }
  vlMeasured *made = NULL;
  VL_TRY(vl_measured_read(world->context, def->measured, world->def.color == VL_COLOR_RGB,
                          &made, error));
  vlPart *part = vl_part_add(world);
  if (!part)
    vl_measured_free(world->context, made);
  if (!part)
    return vl_fail_memory(error);
  part->destroy = free_measured;
  part->object = made;
  *kept = (vlWorldFilePart){.part = part, .stamp = stamp};
  m->measured = *slot = made;
  return VL_OK;
}

/* ---- what several kinds have ------------------------------------------------------------- */

vlResult vl_material_roughness(const vlMaterialBuild *b) {
  const vlMaterialFloat floats[] = {{b->def->u_roughness, &b->m->u_roughness},
                                    {b->def->v_roughness, &b->m->v_roughness}};
  return vl_material_floats(b, floats, 2);
}

static vlSpectrumRole role_of(const vlMaterialDef *def, const vlSpectrumInput *input) {
  static const vlSpectrumRole roles[] = {[VL_PARAMETER_NO_ROLE] = VL_ROLE_UNBOUNDED,
                                         [VL_PARAMETER_ALBEDO] = VL_ROLE_ALBEDO,
                                         [VL_PARAMETER_UNBOUNDED] = VL_ROLE_UNBOUNDED,
                                         [VL_PARAMETER_ILLUMINANT] = VL_ROLE_ILLUMINANT};
  const vlKindRow *row = vl_kind_row(&vl_material_family, (int)def->kind);
  const size_t offset = (size_t)((const char *)input - (const char *)def);
  for (uint32_t i = 0; i < row->parameter_count; i++)
    if (row->parameters[i].type == VL_PARAMETER_SPECTRUM_INPUT &&
        row->parameters[i].offset == offset)
      return roles[row->parameters[i].role];
  assert(!"a spectrum of the material's row");
  return VL_ROLE_UNBOUNDED;
}

vlResult vl_material_spectrum(const vlMaterialBuild *b, const vlSpectrumInput *input,
                              int32_t *node) {
  return vl_world_spectrum_node(b->world, b->scene, *input, role_of(b->def, input), node,
                                b->error);
}

static vlResult compile_metal(const vlMaterialBuild *b) {
  b->m->use_reflectance = b->def->use_reflectance;
  if (b->def->use_reflectance)
    return vl_material_spectrum(b, &b->def->reflectance, &b->m->reflectance);
  VL_TRY(vl_material_spectrum(b, &b->def->eta, &b->m->eta));
  return vl_material_spectrum(b, &b->def->k, &b->m->k);
}

static vlResult compile_index(const vlMaterialBuild *b, const vlSpectrumInput *eta,
                              bool disperses) {
  vlWorldMaterial *m = b->m;
  float value;
  if (vl_spectrum_is_constant(&eta->value, &value)) {
    if (!(value > 0) || !isfinite(value))
      return material_fail(b, "the index of refraction must be a positive number");
    m->eta_s = value;
    return VL_OK;
  }
  bool spectral = b->world->def.color != VL_COLOR_RGB;
  if (spectral && disperses) {
    m->dispersive = true;
    return vl_material_spectrum(b, eta, &m->eta);
  }
  /* A dispersive index given as a single number stands for a glass: it is the index at the
   * sodium line, as in catalogues. */
  float dense[VL_LAMBDA_COUNT];
  VL_TRY(vl_spectrum_dense(&eta->value, VL_ROLE_UNBOUNDED, dense, b->error));
  m->eta_s = vl_dense_at(dense, 589.3f);
  if (!(m->eta_s > 0))
    return material_fail(b, "the index of refraction must be positive");
  if (spectral)
    vl_world_warn(b->world, b->def->source,
                  "%s: dispersion of this kind is not supported, the index at 589.3 nm is used",
                  label_of(b->def).text);
  return VL_OK;
}

/* ---- a function per kind ----------------------------------------------------------------- */

vlResult vl_compile_diffuse_material(const vlMaterialBuild *b) {
  b->m->bsdf = VL_BSDF_DIFFUSE;
  return vl_material_spectrum(b, &b->def->reflectance, &b->m->reflectance);
}

/* Compiles the inputs of a coat that random walks evaluate (layered.hot.c). metal: the base is
 * a conductor. */
static vlResult compile_layers(const vlMaterialBuild *b, bool metal) {
  const vlMaterialDef *def = b->def;
  vlWorldLayers *l = vl_world_block(b->world, 1, sizeof *l);
  if (!l)
    return vl_fail_memory(b->error);
  b->m->bsdf = VL_BSDF_LAYERED;
  b->m->layers = l;
  l->metal = metal;
  l->coat_u = l->coat_v = -1;
  /* Limits. No walk takes more steps, because Russian roulette ends it before. More walks per
   * evaluation gain nothing over more samples per pixel. */
  l->depth = def->max_depth < 1000 ? def->max_depth : 1000;
  l->walks = def->samples < 256 ? def->samples : 256;
  const vlMaterialFloat floats[] = {{def->thickness, &l->thickness},
                                    {def->g, &l->g},
                                    {def->coat_u_roughness, &l->coat_u},
                                    {def->coat_v_roughness, &l->coat_v}};
  VL_TRY(vl_material_spectrum(b, &def->albedo, &l->albedo));
  return vl_material_floats(b, floats, metal ? 4 : 2);
}

vlResult vl_compile_coated_diffuse_material(const vlMaterialBuild *b) {
  b->m->bsdf = VL_BSDF_COATED_DIFFUSE;
  VL_TRY(vl_material_spectrum(b, &b->def->reflectance, &b->m->reflectance));
  VL_TRY(vl_material_roughness(b));
  VL_TRY(compile_index(b, &b->def->eta, false));
  return vl_coat_in_closed_form(b->def) ? coat_of(b->world, b->def, b->m, b->error)
                                        : compile_layers(b, false);
}

vlResult vl_compile_conductor_material(const vlMaterialBuild *b) {
  b->m->bsdf = VL_BSDF_CONDUCTOR;
  b->m->smooth = VL_SMOOTH_BY_ALPHA;
  VL_TRY(vl_material_roughness(b));
  return compile_metal(b);
}

vlResult vl_compile_coated_conductor_material(const vlMaterialBuild *b) {
  VL_TRY(vl_material_roughness(b));
  VL_TRY(compile_metal(b));
  VL_TRY(compile_index(b, &b->def->coat_eta, false));
  return compile_layers(b, true);
}

vlResult vl_compile_dielectric_material(const vlMaterialBuild *b) {
  b->m->bsdf = VL_BSDF_DIELECTRIC;
  b->m->smooth = VL_SMOOTH_BY_ALPHA_OR_INDEX;
  VL_TRY(vl_material_roughness(b));
  return compile_index(b, &b->def->eta, true);
}

vlResult vl_compile_thin_dielectric_material(const vlMaterialBuild *b) {
  b->m->bsdf = VL_BSDF_THIN_DIELECTRIC;
  b->m->smooth = VL_SMOOTH_ALWAYS;
  return compile_index(b, &b->def->eta, false);
}

vlResult vl_compile_diffuse_transmission_material(const vlMaterialBuild *b) {
  b->m->bsdf = VL_BSDF_DIFFUSE_TRANSMISSION;
  b->m->scale = b->def->scale;
  VL_TRY(vl_material_spectrum(b, &b->def->reflectance, &b->m->reflectance));
  return vl_material_spectrum(b, &b->def->transmittance, &b->m->transmittance);
}

vlResult vl_compile_measured_material(const vlMaterialBuild *b) {
  b->m->bsdf = VL_BSDF_MEASURED;
  return measured_of(b->world, b->def, b->m, b->error);
}

/* Makes the node of the share of a mix that is not interface. */
static vlResult make_presence(const vlMaterialBuild *b, const vlWorldMaterial *first,
                              const vlWorldMaterial *second) {
  const vlWorldMaterial *parts[2] = {first, second};
  int32_t nodes[2];
  for (int i = 0; i < 2; i++) {
    nodes[i] = parts[i]->presence;
    if (nodes[i] >= 0)
      continue;
    VL_TRY(vl_material_float(b, vl_float_input(parts[i]->nothing ? 0.0f : 1.0f), &nodes[i]));
  }
  return vl_world_mix_node(b->world, nodes[0], nodes[1], b->m->amount, &b->m->presence,
                           b->error);
}

/* At each hit, a mix uses the BSDF of one of its parts. */
vlResult vl_compile_mix_material(const vlMaterialBuild *b) {
  vlWorldMaterial *m = b->m;
  m->mixed = true;
  for (int i = 0; i < 2; i++)
    m->mix[i] = b->def->materials[i].index;
  const vlWorldMaterial *first = &b->world->materials.items[m->mix[0]],
                        *second = &b->world->materials.items[m->mix[1]];
  m->has_subsurface = first->has_subsurface || second->has_subsurface;
  m->nothing = first->nothing && second->nothing;
  vlResult r = vl_material_float(b, b->def->amount, &m->amount);
  bool holes =
      first->nothing || second->nothing || first->presence >= 0 || second->presence >= 0;
  return r == VL_OK && holes && !m->nothing ? make_presence(b, first, second) : r;
}

/* An interface is never shaded. */
vlResult vl_compile_interface_material(const vlMaterialBuild *b) {
  b->m->bsdf = VL_BSDF_DIFFUSE;
  b->m->nothing = true;
  return VL_OK;
}

static vlResult compile_kind(const vlMaterialBuild *b) {
  switch (b->def->kind) {
#define COMPILE(kind, name, row, compile) \
  case kind:                              \
    return compile(b);
    VL_MATERIAL_KINDS(COMPILE)
#undef COMPILE
  }
  return VL_ERROR_ARGUMENT;
}

static vlResult bumps(const vlMaterialBuild *b) {
  vlResult r = VL_OK;
  if (b->def->displacement.texture.index)
    r = vl_material_float(b, b->def->displacement, &b->m->displacement);
  if (r != VL_OK || !b->def->normal_map)
    return r;
  vlEncoding linear = VL_ENCODING_LINEAR;
  b->m->normal_map =
      vl_world_add_image(b->world, b->def->normal_map, NULL, &linear, false, b->error);
  return b->m->normal_map >= 0        ? VL_OK
         : b->error && b->error->code ? b->error->code
                                      : VL_ERROR_SCENE;
}

static vlResult add_material(vlWorld *world, const vlScene *scene, const vlMaterialDef *def,
                             vlError *error) {
  vlWorldMaterial m;
  memset(&m, 0, sizeof m);
  m.kind = def->kind;
  m.traits = vl_kind_row(&vl_material_family, (int)def->kind)->traits;
  m.one_sided = (m.traits & (VL_MATERIAL_OPAQUE | VL_MATERIAL_REFRACTS)) == VL_MATERIAL_OPAQUE;
  m.reflectance = m.eta = m.k = m.u_roughness = m.v_roughness = m.amount = m.presence = -1;
  m.displacement = m.normal_map = m.transmittance = -1;
  m.remap = def->remap_roughness;
  m.eta_s = 1.5f;
  const vlMaterialBuild b = {world, scene, def, &m, error};
  vlResult r = compile_kind(&b);
  m.diffuse = m.bsdf == VL_BSDF_DIFFUSE;
  if (r == VL_OK)
    r = bumps(&b);
  if (r == VL_OK) {
    vlWorldMaterial *slot = VL_PUSH(world->context, &world->materials);
    if (slot)
      *slot = m;
    else
      r = vl_fail_memory(error);
  }
  return vl_world_locate_error(def->source, error, r);
}

vlResult vl_world_add_materials(vlWorld *world, const vlScene *scene, vlError *error) {
  vlMaterialDef grey = vl_default_material_def(VL_MATERIAL_DIFFUSE);
  vlResult r = add_material(world, scene, &grey, error);
  for (size_t i = 0; r == VL_OK && i < scene->materials.count; i++) {
    r = vl_world_step(world, "materials",
                      0.3 + 0.1 * (double)i / (double)scene->materials.count, error);
    if (r == VL_OK)
      r = add_material(world, scene, &scene->materials.items[i], error);
  }
  if (r == VL_OK &&
      !(world->rank = vl_world_block(world, world->materials.count, sizeof(uint32_t))))
    return vl_fail_memory(error);
  uint32_t next = 0;
  for (int kind = 0; r == VL_OK && kind < (int)vl_material_family.kind_count; kind++)
    for (size_t i = 0; i < world->materials.count; i++)
      if ((int)world->materials.items[i].kind == kind)
        world->rank[i] = next++;
  for (size_t i = 0; i < world->materials.count; i++) {
    world->has_interfaces =
        world->has_interfaces || world->materials.items[i].kind == VL_MATERIAL_INTERFACE;
    world->has_mixtures = world->has_mixtures || world->materials.items[i].mixed;
  }
  return r;
}
