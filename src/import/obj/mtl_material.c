/* import/obj/mtl_material.c: converts vlMtl to the principled material. docs/importers.md lists
 * the rules where MTL is ambiguous. */
#include <math.h>

#include "import/obj/obj.h"

#include "base/text.h"
#include "math/elementary.h"
#include "velo/light.h"
#include "velo/material.h"
#include "velo/texture.h"

static float given(float value, float otherwise) {
  return isnan(value) ? otherwise : value;
}

static float clamp01(float v) {
  return v > 0 ? v < 1 ? v : 1 : 0;
}

static vlTextureDef texture_def(const vlObj *obj, const vlMtlMap *map, bool spectrum) {
  vlTextureDef def = vl_default_texture_def(VL_TEXTURE_IMAGE, spectrum);
  def.source.file = obj->path;
  def.path = map->path;
  def.filter = VL_FILTER_TRILINEAR;
  def.wrap = map->clamp ? VL_WRAP_CLAMP : VL_WRAP_REPEAT;
  def.su = map->scale[0];
  def.sv = map->scale[1];
  def.du = map->offset[0];
  def.dv = map->offset[1];
  def.scale = map->gain;
  if (!spectrum) {
    def.encoding_given = true;
    def.encoding = VL_ENCODING_LINEAR;
    def.channel = map->channel;
    def.bias = map->base;
  }
  return def;
}

static bool color(vlObj *obj, const vlMtlMap *map, const float tint[3], bool vertices,
                  vlSpectrumInput *input) {
  *input = vl_spectrum_input(vl_spectrum_rgb(tint[0], tint[1], tint[2]));
  if (!map->path && !vertices)
    return true;
  vlTextureDef def = map->path ? texture_def(obj, map, true)
                               : vl_default_texture_def(VL_TEXTURE_VERTEX_COLOR, true);
  def.colors = vertices;
  memcpy(def.tint, tint, 3 * sizeof *tint);
  input->texture = vl_scene_add_texture(obj->scene, &def);
  return input->texture.index != 0;
}

static bool number(vlObj *obj, const vlMtlMap *map, float factor, vlFloatInput *input) {
  *input = vl_float_input(factor);
  if (!map->path)
    return true;
  vlTextureDef def = texture_def(obj, map, false);
  def.scale *= factor;
  def.bias *= factor;
  input->texture = vl_scene_add_texture(obj->scene, &def);
  return input->texture.index != 0;
}

/* Whether the file name of a bump map is that of a normal map. Many files name normal maps as
 * bump maps. */
static bool is_normal_map(const char *path) {
  static const char *const signs[] = {"normal", "_nrm", "_nor.", "_n.", "_ddn", "-n.", "_norm"};
  const char *name = path + vl_folder_length(path);
  for (size_t i = 0; i < VL_LENGTH(signs); i++)
    if (strcasestr(name, signs[i]))
      return true;
  return false;
}

static bool normal_or_bump_map(vlObj *obj, const vlMtl *m, vlMaterialDef *def) {
  const vlMtlMap *normal = &m->maps[VL_MTL_NORMAL], *bump = &m->maps[VL_MTL_BUMP];
  if (!normal->path && bump->path && is_normal_map(bump->path))
    normal = bump;
  if (normal->path) {
    vlTextureDef texture = texture_def(obj, normal, true);
    texture.encoding_given = true;
    texture.encoding = VL_ENCODING_LINEAR;
    texture.wrap = VL_WRAP_REPEAT;
    texture.scale = 1;
    def->principled.normal_scale = normal->bump;
    def->principled.normal = vl_scene_add_texture(obj->scene, &texture);
    return def->principled.normal.index != 0;
  }
  if (!bump->path)
    return true;
  vlTextureDef texture = texture_def(obj, bump, false);
  texture.scale *= (float)(0.002 * vl_extent_diagonal(&obj->box)) * bump->bump;
  texture.bias = 0;
  def->displacement.texture = vl_scene_add_texture(obj->scene, &texture);
  return def->displacement.texture.index != 0;
}

/* ---- which kind of thing it is ----------------------------------------------------------- */

static float brightest(const float c[3]) {
  return fmaxf(c[0], fmaxf(c[1], c[2]));
}

/* Refractive solids: illum 6 and 7. Transmission is 1 - d where d is below 1, otherwise 1 when
 * the filter Tf is not black. The colour is Tf; of a share that is transmitted, Kd, unless that
 * is black. */
static void glass(const vlMtl *m, vlMaterialDef *def, float base[3]) {
  float passes = m->d < 1 ? 1 - clamp01(m->d) : 1;
  def->principled.transmission = vl_float_input(passes);
  def->principled.thin_walled = false;
  const bool own = passes < 1 && brightest(base) > 0;
  for (int i = 0; i < 3; i++)
    base[i] = isnan(m->tf[i]) || own ? base[i] : clamp01(m->tf[i]);
  if (isnan(m->tf[0]) && brightest(base) == 0)
    base[0] = base[1] = base[2] = 1;
}

static void surface(const vlMtl *m, vlMaterialDef *def, float base[3]) {
  vlPrincipledDef *p = &def->principled;
  bool has_specular = !(m->illum == 0 || m->illum == 1), has_ks = !isnan(m->ks[0]);
  float ns = given(m->ns, has_ks ? 10.0f : 30.0f), ni = given(m->ni, 1.5f),
        metal = given(m->pm, 0.0f);
  bool mirrors = m->illum == 3 || m->illum == 5 || isnan(m->pm);
  if (isnan(m->pm) && mirrors && has_ks && has_specular && !m->maps[VL_MTL_KD].path &&
      brightest(base) == 0 && brightest(m->ks) > 0 && m->illum != 6 && m->illum != 7) {
    metal = 1; /* specular reflection only: a metal of that colour */
    for (int i = 0; i < 3; i++)
      base[i] = clamp01(m->ks[i]);
  } else if (has_ks && isnan(m->pr) && isnan(m->pm)) {
    /* Ks 0.5 stands for the reflectance that Ni gives */
    p->specular_color.value = vl_spectrum_rgb(2 * m->ks[0], 2 * m->ks[1], 2 * m->ks[2]);
    has_specular = has_specular && brightest(m->ks) > 0;
  }
  p->metallic = vl_float_input(clamp01(metal));
  p->specular = vl_float_input(has_specular || metal > 0 ? 1.0f : 0.0f);
  /* Converts Blinn's exponent to GGX (Walter et al. 2007): alpha^2 = 2 / (Ns + 2), alpha =
   * roughness^2. */
  p->roughness = vl_float_input(
      clamp01(given(m->pr, (float)vl_precise_pow(2 / (fmaxf(ns, 0) + 2), 0.25f))));
  def->eta = vl_spectrum_input(vl_spectrum_constant(ni > 1 && ni < 10 ? ni : 1.5f));
}

static bool emission(vlObj *obj, const vlMtl *m, vlObjMaterial *material) {
  float ke[3] = {m->ke[0], m->ke[1], m->ke[2]};
  const vlMtlMap *map = &m->maps[VL_MTL_KE];
  if (map->path && brightest(ke) == 0)
    ke[0] = ke[1] = ke[2] = 1;
  if (!(brightest(ke) > 0))
    return true;
  vlEmissionDef def = vl_default_emission_def();
  def.source.file = obj->path;
  def.two_sided = true;
  def.radiance = vl_spectrum_rgb(ke[0], ke[1], ke[2]);
  if (map->path) {
    vlTextureDef texture = texture_def(obj, map, true);
    memcpy(texture.tint, ke, 3 * sizeof *texture.tint);
    def.texture = vl_scene_add_texture(obj->scene, &texture);
    if (!def.texture.index)
      return false;
  }
  material->emission = vl_scene_add_emission(obj->scene, &def);
  return material->emission.index != 0;
}

bool vl_obj_make_material(vlObj *obj, vlObjMaterial *material) {
  if (material->made)
    return true;
  const vlMtl *m = &material->mtl;
  vlMaterialDef def = vl_default_material_def(VL_MATERIAL_PRINCIPLED);
  vlPrincipledDef *p = &def.principled;
  bool vertices = obj->colors.count > 0;
  if (!material->defined) {
    obj->line = material->line;
    vl_obj_warn(obj, VL_LOG_WARNING, "usemtl: no library has a material \"%s\"; it is grey",
                vl_short_text(material->name).text);
    obj->line = 0;
  }
  def.name = material->name[0] ? material->name : NULL;
  def.source = (vlSource){obj->path, material->line, material->line ? 1 : 0};
  float base[3] = {clamp01(m->kd[0]), clamp01(m->kd[1]), clamp01(m->kd[2])};
  if (m->maps[VL_MTL_KD].path && brightest(base) == 0)
    base[0] = base[1] = base[2] = 1; /* the image alone gives the colour */
  surface(m, &def, base);
  bool solid = m->illum == 6 || m->illum == 7;
  if (solid)
    glass(m, &def, base);
  if (!color(obj, &m->maps[VL_MTL_KD], base, vertices, &def.reflectance) ||
      (m->maps[VL_MTL_PM].path &&
       !number(obj, &m->maps[VL_MTL_PM], given(m->pm, 1), &p->metallic)) ||
      (m->maps[VL_MTL_PR].path &&
       !number(obj, &m->maps[VL_MTL_PR], given(m->pr, 1), &p->roughness)))
    return false;
  if (m->ps > 0) {
    const float sheen = clamp01(m->ps);
    p->sheen_color = vl_spectrum_input(vl_spectrum_rgb(sheen, sheen, sheen));
    p->sheen_roughness = vl_float_input(0.5f);
  }
  p->clearcoat = vl_float_input(clamp01(given(m->pc, 0)));
  p->clearcoat_roughness = vl_float_input(clamp01(given(m->pcr, 0)));
  p->anisotropy = vl_float_input(clamp01(given(m->aniso, 0)));
  p->anisotropy_rotation = vl_float_input(given(m->anisor, 0) * 6.2831853f);
  material->alpha = vl_float_input(solid ? 1.0f : clamp01(given(m->d, 1)));
  if (m->maps[VL_MTL_D].path && !solid &&
      !number(obj, &m->maps[VL_MTL_D], material->alpha.value, &material->alpha))
    return false;
  if (!normal_or_bump_map(obj, m, &def) || !emission(obj, m, material))
    return false;
  material->material = vl_scene_add_material(obj->scene, &def);
  material->made = material->material.index != 0;
  return material->made;
}
