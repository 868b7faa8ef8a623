/* import/gltf/material.c: metallic-roughness materials and the KHR_materials extensions become
 * the principled material, its emission and its coverage. */
#include <stdio.h>
#include <string.h>

#include "base/text.h"
#include "import/gltf/gltf.h"
#include "import/labels.h"
#include "velo/light.h"
#include "velo/material.h"
#include "velo/texture.h"

typedef struct Reader {
  vlGltf *g;
  const vlGltfLocation *at;
  const json_t *json;
  vlMaterialDef *def;
  vlGltfMaterial *result;
  bool colors; /* the mesh has vertex colours */
} Reader;

/* ---- parameters -------------------------------------------------------------------------- */

/* A factor in [0, 1] times a channel of a texture. */
static bool channel(const Reader *r, const vlGltfLocation *at, const json_t *json,
                    const char *factor_key, const char *texture_key, int which,
                    float default_factor, vlFloatInput *input) {
  float factor = default_factor;
  if (factor_key && !vl_gltf_float(r->g, at, json, factor_key, &factor))
    return false;
  if (!(factor >= 0 && factor <= 1)) {
    vl_gltf_warn(r->g, VL_LOG_WARNING, VL_GLTF_KEY(at, factor_key),
                 "%g does not lie between 0 and 1: %d is taken", (double)factor, factor > 1);
    factor = factor > 1;
  }
  vlGltfTextureUse use = vl_gltf_use_channel(which, factor);
  *input = vl_float_input(factor);
  return vl_gltf_texture(r->g, at, json, texture_key, &use, &input->texture);
}

static bool read_color(const Reader *r, const vlGltfLocation *at, const json_t *json,
                       const char *key, size_t count, float color[4]) {
  double v[4] = {color[0], color[1], color[2], color[3]};
  if (!vl_gltf_numbers(r->g, at, json, key, count, v))
    return false;
  for (int i = 0; i < 4; i++)
    color[i] = v[i] > 0 ? (float)v[i] : 0.0f;
  return true;
}

/* A colour times an sRGB texture (times the vertex colours). */
static bool color_input(const Reader *r, const vlGltfLocation *at, const json_t *json,
                        const char *texture_key, const float color[4], bool vertex_colors,
                        vlSpectrumInput *input) {
  vlGltfTextureUse use = vl_gltf_use_color();
  memcpy(use.tint, color, sizeof use.tint);
  use.colors = vertex_colors;
  *input = vl_spectrum_input(vl_spectrum_rgb(color[0], color[1], color[2]));
  if (!vl_gltf_texture(r->g, at, json, texture_key, &use, &input->texture))
    return false;
  if (input->texture.index || !vertex_colors)
    return true;
  vlTextureDef def = vl_default_texture_def(VL_TEXTURE_VERTEX_COLOR, true);
  memcpy(def.tint, color, sizeof def.tint);
  def.source.file = r->g->path;
  input->texture = vl_scene_add_texture(r->g->scene, &def);
  return input->texture.index != 0;
}

static bool normal_input(const Reader *r, const vlGltfLocation *at, const json_t *json,
                         const char *key, vlTextureId *id, float *scale) {
  const json_t *info = json_object_get(json, key);
  vlGltfTextureUse use = vl_gltf_use_color();
  use.srgb = false;
  if (!vl_gltf_texture(r->g, at, json, key, &use, id) ||
      !vl_gltf_float(r->g, VL_GLTF_KEY(at, key), info, "scale", scale))
    return false;
  if (!id->index)
    return true;
  if (!r->result->needs_tangents &&
      !vl_gltf_texture_set(r->g, VL_GLTF_KEY(at, key), info, &r->result->tangent_set))
    return false;
  r->result->needs_tangents = true;
  return true;
}

/* ---- coverage ---------------------------------------------------------------------------- */

/* Reads the coverage: the base colour's fourth channel, interpreted by alphaMode. */
static bool read_alpha(const Reader *r, const vlGltfLocation *at, const json_t *json,
                       const char *texture_key, float factor) {
  static const char *const modes[] = {"OPAQUE", "MASK", "BLEND"};
  int mode = 0;
  float cutoff = 0.5f;
  r->result->alpha = vl_float_input(1.0f);
  if (!vl_gltf_choice(r->g, r->at, r->json, "alphaMode", modes, 3, &mode) ||
      !vl_gltf_float(r->g, r->at, r->json, "alphaCutoff", &cutoff))
    return false;
  if (mode == 0)
    return true;
  bool mask = mode == 1;
  vlGltfTextureUse use = vl_gltf_use_channel(3, factor);
  use.srgb = true; /* as for the base colour, so that both share the decoded image; alpha itself
                      is linear */
  use.colors = r->colors;
  if (mask)
    use.cutoff = cutoff;
  r->result->alpha.value = mask ? factor >= cutoff : factor > 1 ? 1 : factor;
  if (!vl_gltf_texture(r->g, at, json, texture_key, &use, &r->result->alpha.texture))
    return false;
  if (r->result->alpha.texture.index || !r->colors)
    return true;
  vlTextureDef def = vl_default_texture_def(VL_TEXTURE_VERTEX_COLOR, false);
  def.source.file = r->g->path;
  def.channel = 3;
  def.tint[3] = factor;
  if (mask)
    def.cutoff = cutoff;
  r->result->alpha.texture = vl_scene_add_texture(r->g->scene, &def);
  return r->result->alpha.texture.index != 0;
}

/* ---- the base ---------------------------------------------------------------------------- */

static bool read_metallic_roughness(const Reader *r, float base[4]) {
  const json_t *json;
  const vlGltfLocation *at = VL_GLTF_KEY(r->at, "pbrMetallicRoughness");
  vlPrincipledDef *p = &r->def->principled;
  return vl_gltf_object(r->g, r->at, r->json, "pbrMetallicRoughness", &json) &&
         read_color(r, at, json, "baseColorFactor", 4, base) &&
         color_input(r, at, json, "baseColorTexture", base, r->colors, &r->def->reflectance) &&
         channel(r, at, json, "metallicFactor", "metallicRoughnessTexture", 2, 1.0f,
                 &p->metallic) &&
         channel(r, at, json, "roughnessFactor", "metallicRoughnessTexture", 1, 1.0f,
                 &p->roughness) &&
         read_alpha(r, at, json, "baseColorTexture", base[3]);
}

/* Reads KHR_materials_pbrSpecularGlossiness as a material that is not metallic. The reflectance
 * at normal incidence is the specular colour. */
static bool read_specular_glossiness(const Reader *r, const json_t *json, float base[4]) {
  const vlGltfLocation *at =
      VL_GLTF_KEY(r->at, "extensions.KHR_materials_pbrSpecularGlossiness");
  vlPrincipledDef *p = &r->def->principled;
  float specular[4] = {1, 1, 1, 1}, glossiness = 1;
  if (!read_color(r, at, json, "diffuseFactor", 4, base) ||
      !read_color(r, at, json, "specularFactor", 3, specular) ||
      !color_input(r, at, json, "diffuseTexture", base, r->colors, &r->def->reflectance) ||
      !color_input(r, at, json, "specularGlossinessTexture", specular, false,
                   &p->specular_color) ||
      !vl_gltf_float(r->g, at, json, "glossinessFactor", &glossiness) ||
      !read_alpha(r, at, json, "diffuseTexture", base[3]))
    return false;
  p->metallic = vl_float_input(0.0f);
  p->roughness = vl_float_input(1.0f - glossiness);
  r->def->eta = vl_spectrum_input(vl_spectrum_constant(0.0f));
  vlGltfTextureUse use = vl_gltf_use_channel(3, -glossiness);
  use.srgb = true;
  use.bias = 1.0f;
  return vl_gltf_texture(r->g, at, json, "specularGlossinessTexture", &use,
                         &p->roughness.texture);
}

/* ---- extensions -------------------------------------------------------------------------- */

static const json_t *extension(const Reader *r, const char *name) {
  return vl_gltf_extension(r->json, name);
}

static bool read_specular(const Reader *r, const vlGltfLocation *at, const json_t *json,
                          vlPrincipledDef *p) {
  float color[4] = {1, 1, 1, 1};
  return channel(r, at, json, "specularFactor", "specularTexture", 3, 1.0f, &p->specular) &&
         read_color(r, at, json, "specularColorFactor", 3, color) &&
         color_input(r, at, json, "specularColorTexture", color, false, &p->specular_color);
}

static bool read_coat(const Reader *r, const vlGltfLocation *at, const json_t *json,
                      vlPrincipledDef *p) {
  return channel(r, at, json, "clearcoatFactor", "clearcoatTexture", 0, 0.0f, &p->clearcoat) &&
         channel(r, at, json, "clearcoatRoughnessFactor", "clearcoatRoughnessTexture", 1, 0.0f,
                 &p->clearcoat_roughness) &&
         normal_input(r, at, json, "clearcoatNormalTexture", &p->clearcoat_normal,
                      &p->clearcoat_normal_scale);
}

static bool read_sheen(const Reader *r, const vlGltfLocation *at, const json_t *json,
                       vlPrincipledDef *p) {
  float color[4] = {0, 0, 0, 1};
  return read_color(r, at, json, "sheenColorFactor", 3, color) &&
         color_input(r, at, json, "sheenColorTexture", color, false, &p->sheen_color) &&
         channel(r, at, json, "sheenRoughnessFactor", "sheenRoughnessTexture", 3, 0.0f,
                 &p->sheen_roughness);
}

static bool read_iridescence(const Reader *r, const vlGltfLocation *at, const json_t *json,
                             vlPrincipledDef *p) {
  float least = 100, most = 400;
  if (!channel(r, at, json, "iridescenceFactor", "iridescenceTexture", 0, 0.0f,
               &p->iridescence) ||
      !vl_gltf_float(r->g, at, json, "iridescenceIor", &p->iridescence_ior) ||
      !vl_gltf_float(r->g, at, json, "iridescenceThicknessMinimum", &least) ||
      !vl_gltf_float(r->g, at, json, "iridescenceThicknessMaximum", &most))
    return false;
  p->iridescence_ior = p->iridescence_ior < 1.0f ? 1.0f : p->iridescence_ior;
  p->iridescence_thickness = vl_float_input(most);
  vlGltfTextureUse use = vl_gltf_use_channel(1, most - least);
  use.bias = least;
  return vl_gltf_texture(r->g, at, json, "iridescenceThicknessTexture", &use,
                         &p->iridescence_thickness.texture);
}

static bool read_anisotropy(const Reader *r, const vlGltfLocation *at, const json_t *json,
                            vlPrincipledDef *p) {
  float rotation = 0;
  if (!channel(r, at, json, "anisotropyStrength", "anisotropyTexture", 2, 0.0f,
               &p->anisotropy) ||
      !vl_gltf_float(r->g, at, json, "anisotropyRotation", &rotation))
    return false;
  p->anisotropy_rotation = vl_float_input(rotation);
  if (p->anisotropy.texture.index || p->anisotropy.value > 0.0f)
    r->result->needs_tangents = true;
  return !p->anisotropy.texture.index ||
         vl_gltf_angle_texture(r->g, p->anisotropy.texture, rotation, &p->anisotropy_rotation);
}

/* The extensions that add one layer each; their functions are called where the material has the
 * extension. */
static const struct {
  const char *key;
  bool (*read)(const Reader *r, const vlGltfLocation *at, const json_t *json,
               vlPrincipledDef *p);
} layers[] = {{"extensions.KHR_materials_specular", read_specular},
              {"extensions.KHR_materials_clearcoat", read_coat},
              {"extensions.KHR_materials_sheen", read_sheen},
              {"extensions.KHR_materials_iridescence", read_iridescence},
              {"extensions.KHR_materials_anisotropy", read_anisotropy}};

/* Glossy materials have their own specular layer. */
static bool read_layers(const Reader *r, bool glossy) {
  for (size_t i = glossy ? 1 : 0; i < VL_LENGTH(layers); i++) {
    const json_t *json = extension(r, layers[i].key + strlen("extensions."));
    if (json &&
        !layers[i].read(r, VL_GLTF_KEY(r->at, layers[i].key), json, &r->def->principled))
      return false;
  }
  return true;
}

/* Reads the transmission of thin surfaces and solids. */
static bool read_transmission(const Reader *r) {
  const json_t *glass = extension(r, "KHR_materials_transmission"),
               *volume = extension(r, "KHR_materials_volume"),
               *diffuse = extension(r, "KHR_materials_diffuse_transmission"),
               *dispersion = extension(r, "KHR_materials_dispersion"),
               *ior = extension(r, "KHR_materials_ior");
  const vlGltfLocation *at = VL_GLTF_KEY(r->at, "extensions.KHR_materials_transmission");
  vlPrincipledDef *p = &r->def->principled;
  float color[4] = {1, 1, 1, 1}, index = 1.5f, thickness = 0;
  if (glass && !channel(r, at, glass, "transmissionFactor", "transmissionTexture", 0, 0.0f,
                        &p->transmission))
    return false;
  at = VL_GLTF_KEY(r->at, "extensions.KHR_materials_ior");
  if (!vl_gltf_float(r->g, at, ior, "ior", &index))
    return false;
  if (index != 0.0f && !(index >= 1.0f))
    return vl_gltf_fail(r->g, VL_GLTF_KEY(at, "ior"), "%g is below 1", (double)index);
  if (ior)
    r->def->eta = vl_spectrum_input(vl_spectrum_constant(index));
  at = VL_GLTF_KEY(r->at, "extensions.KHR_materials_dispersion");
  if (!vl_gltf_float(r->g, at, dispersion, "dispersion", &p->dispersion))
    return false;
  if (p->dispersion < 0.0f)
    return vl_gltf_fail(r->g, VL_GLTF_KEY(at, "dispersion"), "must not be negative");
  at = VL_GLTF_KEY(r->at, "extensions.KHR_materials_diffuse_transmission");
  if (diffuse && (!channel(r, at, diffuse, "diffuseTransmissionFactor",
                           "diffuseTransmissionTexture", 3, 0.0f, &p->diffuse_transmission) ||
                  !read_color(r, at, diffuse, "diffuseTransmissionColorFactor", 3, color) ||
                  !color_input(r, at, diffuse, "diffuseTransmissionColorTexture", color, false,
                               &p->diffuse_transmission_color)))
    return false;
  at = VL_GLTF_KEY(r->at, "extensions.KHR_materials_volume");
  if (!vl_gltf_float(r->g, at, volume, "thicknessFactor", &thickness))
    return false;
  p->thin_walled = !(thickness > 0.0f);
  return p->thin_walled || vl_gltf_volume(r->g, at, volume, r->result);
}

/* ---- emission ---------------------------------------------------------------------------- */

static bool add_emission(const Reader *r, const vlGltfLocation *at, const json_t *json,
                         const char *texture_key, const float color[4], float strength) {
  if (!(color[0] > 0 || color[1] > 0 || color[2] > 0) || !(strength > 0))
    return true;
  vlEmissionDef def = vl_default_emission_def();
  vlGltfTextureUse use = vl_gltf_use_color();
  memcpy(use.tint, color, sizeof use.tint);
  if (!vl_gltf_texture(r->g, at, json, texture_key, &use, &def.texture))
    return false;
  def.source.file = r->g->path;
  def.radiance = vl_spectrum_rgb(color[0], color[1], color[2]);
  def.scale = strength;
  def.two_sided = r->result->double_sided;
  r->result->emission = vl_scene_add_emission(r->g->scene, &def);
  return r->result->emission.index != 0;
}

static bool read_emission(const Reader *r) {
  float color[4] = {0, 0, 0, 1}, strength = 1;
  const json_t *json = extension(r, "KHR_materials_emissive_strength");
  return read_color(r, r->at, r->json, "emissiveFactor", 3, color) &&
         vl_gltf_float(r->g, VL_GLTF_KEY(r->at, "extensions.KHR_materials_emissive_strength"),
                       json, "emissiveStrength", &strength) &&
         add_emission(r, r->at, r->json, "emissiveTexture", color, strength);
}

/* KHR_materials_unlit: the image shows the base colour whatever the lighting. A black diffuse
 * surface emits it. */
static bool read_unlit(const Reader *r) {
  float base[4] = {1, 1, 1, 1};
  const json_t *json;
  const vlGltfLocation *at = VL_GLTF_KEY(r->at, "pbrMetallicRoughness");
  *r->def = vl_default_material_def(VL_MATERIAL_DIFFUSE);
  r->def->source.file = r->g->path;
  r->def->reflectance = vl_spectrum_input(vl_spectrum_constant(0.0f));
  return vl_gltf_object(r->g, r->at, r->json, "pbrMetallicRoughness", &json) &&
         read_color(r, at, json, "baseColorFactor", 4, base) &&
         read_alpha(r, at, json, "baseColorTexture", base[3]) &&
         add_emission(r, at, json, "baseColorTexture", base, 1.0f);
}

/* ---- the whole --------------------------------------------------------------------------- */

static bool read_material(const Reader *r) {
  float base[4] = {1, 1, 1, 1};
  vlPrincipledDef *p = &r->def->principled;
  if (!vl_gltf_bool(r->g, r->at, r->json, "doubleSided", &r->result->double_sided))
    return false;
  if (extension(r, "KHR_materials_unlit"))
    return read_unlit(r);
  const json_t *glossy = extension(r, "KHR_materials_pbrSpecularGlossiness");
  if (!(glossy ? read_specular_glossiness(r, glossy, base) : read_metallic_roughness(r, base)))
    return false;
  if (!normal_input(r, r->at, r->json, "normalTexture", &p->normal, &p->normal_scale))
    return false;
  if (!read_transmission(r) || !read_layers(r, glossy != NULL) || !read_emission(r))
    return false;
  bool passes = p->transmission.texture.index || p->transmission.value > 0.0f ||
                p->diffuse_transmission.texture.index || p->diffuse_transmission.value > 0.0f;
  if (passes)
    r->result->double_sided =
        true; /* light inside the solid must hit the back side of the surface */
  return true;
}

const vlGltfMaterial *vl_gltf_material(vlGltf *g, int64_t index, bool colors) {
  vlGltfMaterial *result = &g->materials[2 * (size_t)(index + 1) + colors];
  if (result->made)
    return result;
  vlMaterialDef def = vl_default_material_def(VL_MATERIAL_PRINCIPLED);
  static const json_t *const nothing = NULL;
  const json_t *json = index < 0 ? nothing : vl_gltf_item(g, "materials", (size_t)index);
  const char *name = index < 0 ? NULL : g->material_labels[index];
  const vlGltfMaterial *other =
      &g->materials[2 * (size_t)(index + 1) + !colors]; /* the same with vertex colours */
  if (name && other->made &&
      !vl_label_make_unique(g->scene, &g->material_names, name, (size_t)index, &name))
    return NULL;
  char location[40];
  snprintf(location, sizeof location, "materials[%d]", (int)index);
  Reader r = {g,      VL_GLTF_ITEM(NULL, "materials", (size_t)(index < 0 ? 0 : index)),
              json,   &def,
              result, colors};
  def.source.file = g->path;
  if (!read_material(&r))
    return NULL;
  def.name = name;
  def.place = index < 0 ? NULL : location;
  result->material = vl_scene_add_material(g->scene, &def);
  result->made = result->material.index != 0;
  return result->made ? result : NULL;
}
