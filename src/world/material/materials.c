/* world/material/materials.c: scene materials -> world materials. Index 0 is the default, a diffuse grey. */
#include <math.h>
#include <string.h>

#include "base/error.h"
#include "math/ggx.h"
#include "scene/scene.h"
#include "world/world.h"

static vlResult fail(const vlMaterialDef *def, vlError *error, const char *what) {
  return vl_fail_at(error, VL_ERROR_SCENE, def->source.file, def->source.line, def->source.column,
                    "material \"%s\": %s", def->name ? def->name : "", what);
}

static float alpha_of(float roughness, bool remap) {
  return remap ? sqrtf(roughness > 0 ? roughness : 0) : roughness;
}

/* A coat's table of these alphas. */
static vlResult coat_table(vlWorld *world, const vlMaterialDef *def, const vlWorldMaterial *m, float low, float high,
                           const vlCoatTable **table, vlError *error) {
  float thickness = def->thickness.value;
  for (size_t i = 0; i < world->coats.count; i++) {
    vlCoatTable *t = world->coats.items[i].table;
    if (t->eta == m->eta_s && t->tau == thickness && world->coats.items[i].depth == def->max_depth &&
        t->alpha_min == low && t->alpha_max == high && t->conserves == def->conserve_energy) {
      *table = t;
      return VL_OK;
    }
  }
  vlCoatTable *built = NULL;
  if (vl_coat_build(world->context, m->eta_s, thickness, def->max_depth, low, high, &built) != VL_OK)
    return vl_fail_memory(error);
  vlResult r = def->conserve_energy ? vl_coat_conserve(world->context, built) : VL_OK;
  vlWorldCoat *slot = r != VL_OK ? NULL : VL_PUSH(world->context, &world->coats);
  if (!slot) {
    vl_coat_free(world->context, built);
    return vl_fail_memory(error);
  }
  built->imitate = world->def.imitate_pbrt;
  *slot = (vlWorldCoat){built, def->max_depth};
  *table = built;
  return VL_OK;
}

static vlResult coat_of(vlWorld *world, const vlMaterialDef *def, vlWorldMaterial *m, vlError *error) {
  const vlTextureNode *u = &world->nodes.items[m->u_roughness], *v = &world->nodes.items[m->v_roughness];
  if (u->kind != VL_NODE_FLOAT || v->kind != VL_NODE_FLOAT) return coat_table(world, def, m, 0, 1, &m->coat, error);
  float a = alpha_of(u->value, m->remap), b = alpha_of(v->value, m->remap), alpha = sqrtf(a * b);
  vlResult r = coat_table(world, def, m, alpha, alpha, &m->coat, error);
  if (r != VL_OK || !world->def.regularize) return r;
  alpha = sqrtf(vl_ggx_widened(a) * vl_ggx_widened(b));
  return coat_table(world, def, m, alpha, alpha, &m->widened, error);
}

/* What was measured: one file is read once. */
static vlResult measured_of(vlWorld *world, const vlMaterialDef *def, vlWorldMaterial *m, vlError *error) {
  for (size_t i = 0; i < world->measured.count && !m->measured; i++)
    if (strcmp(world->measured.items[i]->path, def->measured) == 0) m->measured = world->measured.items[i];
  if (m->measured) return VL_OK;
  vlMeasured **slot = VL_PUSH(world->context, &world->measured);
  if (!slot) return vl_fail_memory(error);
  vlResult r = vl_measured_read(world->context, def->measured, world->def.color == VL_COLOR_RGB, slot, error);
  m->measured = *slot;
  return r;
}

static vlResult dielectric_eta(vlWorld *world, const vlScene *scene, const vlMaterialDef *def,
                               const vlSpectrumInput *eta, vlWorldMaterial *m, vlError *error) {
  if (eta->texture.index) return fail(def, error, "a textured index of refraction is not supported");
  float value;
  if (vl_spectrum_is_constant(&eta->value, &value)) {
    if (!(value > 0) || !isfinite(value)) return fail(def, error, "the index of refraction must be a positive number");
    m->eta_s = value;
    return VL_OK;
  }
  if (def->kind == VL_MATERIAL_COATED_DIFFUSE || def->kind == VL_MATERIAL_COATED_CONDUCTOR ||
      def->kind == VL_MATERIAL_THIN_DIELECTRIC || world->def.color == VL_COLOR_RGB) {
    /* One number stands for the glass: the index at the sodium line, as catalogues give it. */
    float dense[VL_LAMBDA_COUNT];
    vlResult r = vl_spectrum_dense(&eta->value, VL_ROLE_UNBOUNDED, dense, error);
    if (r != VL_OK) return r;
    m->eta_s = vl_dense_at(dense, 589.3f);
    if (!(m->eta_s > 0)) return fail(def, error, "the index of refraction must be positive");
    if (world->def.color != VL_COLOR_RGB)
      vl_log(world->context, VL_LOG_WARNING, NULL,
             "material \"%s\": dispersion of this kind is not supported, the index at 589.3 nm is used",
             def->name ? def->name : "");
    return VL_OK;
  }
  m->dispersive = true;
  m->eta_s = 1.5f;
  return vl_world_spectrum_node(world, scene, *eta, VL_ROLE_UNBOUNDED, &m->eta, error);
}

static vlResult add_material(vlWorld *world, const vlScene *scene, const vlMaterialDef *def, vlError *error) {
  vlWorldMaterial material, *m = &material;
  memset(m, 0, sizeof *m);
  m->kind = def->kind;
  m->reflectance = m->eta = m->k = m->u_roughness = m->v_roughness = m->amount = m->displacement = m->normal_map =
      m->transmittance = -1;
  m->remap = def->remap_roughness;
  m->eta_s = 1.5f;
  vlResult r = VL_OK;
  bool metal = def->kind == VL_MATERIAL_CONDUCTOR || def->kind == VL_MATERIAL_COATED_CONDUCTOR;
  bool rough = metal || def->kind == VL_MATERIAL_DIELECTRIC || def->kind == VL_MATERIAL_COATED_DIFFUSE ||
               def->kind == VL_MATERIAL_SUBSURFACE;
  if (def->kind == VL_MATERIAL_DIFFUSE || def->kind == VL_MATERIAL_COATED_DIFFUSE ||
      def->kind == VL_MATERIAL_DIFFUSE_TRANSMISSION || (metal && def->use_reflectance))
    r = vl_world_spectrum_node(world, scene, def->reflectance, VL_ROLE_ALBEDO, &m->reflectance, error);
  m->use_reflectance = def->use_reflectance;
  if (r == VL_OK && rough) r = vl_world_float_node(world, scene, def->u_roughness, &m->u_roughness, error);
  if (r == VL_OK && rough) r = vl_world_float_node(world, scene, def->v_roughness, &m->v_roughness, error);
  if (r == VL_OK && metal && !def->use_reflectance) {
    r = vl_world_spectrum_node(world, scene, def->eta, VL_ROLE_UNBOUNDED, &m->eta, error);
    if (r == VL_OK) r = vl_world_spectrum_node(world, scene, def->k, VL_ROLE_UNBOUNDED, &m->k, error);
  }
  if (r == VL_OK && (def->kind == VL_MATERIAL_DIELECTRIC || def->kind == VL_MATERIAL_THIN_DIELECTRIC ||
                     def->kind == VL_MATERIAL_COATED_DIFFUSE))
    r = dielectric_eta(world, scene, def, &def->eta, m, error);
  if (r == VL_OK && def->kind == VL_MATERIAL_COATED_CONDUCTOR)
    r = dielectric_eta(world, scene, def, &def->coat_eta, m, error);
  if (r == VL_OK && def->kind == VL_MATERIAL_DIFFUSE_TRANSMISSION) {
    m->scale = def->scale;
    r = vl_world_spectrum_node(world, scene, def->transmittance, VL_ROLE_ALBEDO, &m->transmittance, error);
  }
  if (r == VL_OK && (def->kind == VL_MATERIAL_COATED_CONDUCTOR ||
                     (def->kind == VL_MATERIAL_COATED_DIFFUSE && !vl_coat_in_closed_form(def))))
    r = vl_world_layers(world, scene, def, m, error);
  else if (r == VL_OK && def->kind == VL_MATERIAL_COATED_DIFFUSE)
    r = coat_of(world, def, m, error);
  if (r == VL_OK && def->kind == VL_MATERIAL_SUBSURFACE) r = vl_world_subsurface(world, scene, def, m, error);
  if (r == VL_OK && def->kind == VL_MATERIAL_HAIR) r = vl_world_hair(world, scene, def, m, error);
  if (r == VL_OK && def->kind == VL_MATERIAL_MEASURED) r = measured_of(world, def, m, error);
  if (def->kind == VL_MATERIAL_PRINCIPLED) r = vl_world_principled(world, scene, def, m, error);
  if (r == VL_OK && def->kind == VL_MATERIAL_MIX) {
    m->mix[0] = def->materials[0].index, m->mix[1] = def->materials[1].index;
    for (int i = 0; i < 2; i++) {
      const vlWorldMaterial *part = &world->materials.items[m->mix[i]];
      m->absent[i] = part->kind == VL_MATERIAL_INTERFACE;
      m->has_subsurface = m->has_subsurface || part->has_subsurface;
      if (part->kind == VL_MATERIAL_MIX && (part->absent[0] || part->absent[1]))
        return fail(def, error, "a mix with an interface cannot be a part of another mix");
    }
    r = vl_world_float_node(world, scene, def->amount, &m->amount, error);
  }
  if (r == VL_OK && def->displacement.texture.index)
    r = vl_world_float_node(world, scene, def->displacement, &m->displacement, error);
  if (r == VL_OK && def->normal_map) {
    vlEncoding linear = VL_ENCODING_LINEAR;
    m->normal_map = vl_world_add_image(world, def->normal_map, NULL, &linear, 1, false, error);
    if (m->normal_map < 0) r = error && error->code ? error->code : VL_ERROR_SCENE;
  }
  if (r == VL_OK) {
    vlWorldMaterial *slot = VL_PUSH(world->context, &world->materials);
    if (slot)
      *slot = *m;
    else
      r = vl_fail_memory(error);
  }
  return vl_world_placed(def->source, error, r);
}

vlResult vl_world_add_materials(vlWorld *world, const vlScene *scene, vlError *error) {
  vlMaterialDef grey = vl_default_material_def(VL_MATERIAL_DIFFUSE);
  vlResult r = add_material(world, scene, &grey, error);
  for (size_t i = 0; r == VL_OK && i < scene->materials.count; i++)
    r = add_material(world, scene, &scene->materials.items[i], error);
  if (r == VL_OK && !(world->rank = vl_world_block(world, world->materials.count, sizeof(uint32_t))))
    return vl_fail_memory(error);
  uint32_t next = 0;
  for (int kind = 0; r == VL_OK && kind <= VL_MATERIAL_INTERFACE; kind++)
    for (size_t i = 0; i < world->materials.count; i++)
      if ((int)world->materials.items[i].kind == kind) world->rank[i] = next++;
  for (size_t i = 0; i < world->materials.count; i++)
    world->has_interfaces = world->has_interfaces || world->materials.items[i].kind == VL_MATERIAL_INTERFACE;
  return r;
}
