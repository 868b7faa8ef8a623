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
  const vlGltfLocation *at; /* of the object that is read: the material or a part of it */
  vlMaterialDef *def;
  vlGltfMaterial *result;
  bool colors; /* the mesh has vertex colours */
} Reader;

/* ---- parameters -------------------------------------------------------------------------- */

/* A factor in [0, 1] times a channel of a texture. */
static bool channel(const Reader *r, const char *factor_key, const char *texture_key, int which,
                    float default_factor, vlFloatInput *input) {
  float factor = default_factor;
  if (!vl_gltf_float(r->at, factor_key, &factor))
    return false;
  if (!(factor >= 0 && factor <= 1)) {
    vl_gltf_warn(VL_LOG_WARNING, VL_GLTF_KEY(r->at, factor_key),
                 "%g does not lie between 0 and 1: %d is taken", (double)factor, factor > 1);
    factor = factor > 1;
  }
  vlGltfTextureUse use = vl_gltf_use_channel(which, factor);
  *input = vl_float_input(factor);
  return vl_gltf_texture(r->at, texture_key, &use, &input->texture);
}

static bool read_color(const Reader *r, const char *key, size_t count, float color[4]) {
  double v[4] = {color[0], color[1], color[2], color[3]};
  if (!vl_gltf_numbers(r->at, key, count, v))
    return false;
  for (int i = 0; i < 4; i++)
    color[i] = v[i] > 0 ? (float)v[i] : 0.0f;
  return true;
}

/* The texture that the part names; where there is none, vertex colours if the use has them. */
static bool take_texture(const Reader *r, const vlGltfLocation *at, const char *key,
                         const vlGltfTextureUse *use, vlTextureId *id) {
  if (!vl_gltf_texture(at, key, use, id))
    return false;
  if (id->index || !use->colors)
    return true;
  vlTextureDef def = vl_default_texture_def(VL_TEXTURE_VERTEX_COLOR, use->spectrum);
  def.source.file = r->g->path;
  def.channel = use->channel;
  def.cutoff = use->cutoff;
  memcpy(def.tint, use->tint, sizeof def.tint);
  *id = vl_scene_add_texture(r->g->scene, &def);
  return id->index != 0;
}

/* A colour times an sRGB texture (times the vertex colours). */
static bool color_input(const Reader *r, const char *texture_key, const float color[4],
                        bool vertex_colors, vlSpectrumInput *input) {
  vlGltfTextureUse use = vl_gltf_use_color();
  memcpy(use.tint, color, sizeof use.tint);
  use.colors = vertex_colors;
  *input = vl_spectrum_input(vl_spectrum_rgb(color[0], color[1], color[2]));
  return take_texture(r, r->at, texture_key, &use, &input->texture);
}

/* A colour's factor, whose default is `first`, times its texture. */
static bool layer_color(const Reader *r, const char *factor_key, const char *texture_key,
                        float first, vlSpectrumInput *input) {
  float color[4] = {first, first, first, 1};
  return read_color(r, factor_key, 3, color) &&
         color_input(r, texture_key, color, false, input);
}

static bool normal_input(const Reader *r, const char *key, vlTextureId *id, float *scale) {
  const vlGltfLocation *at = VL_GLTF_KEY(r->at, key);
  vlGltfTextureUse use = vl_gltf_use_color();
  use.srgb = false;
  if (!vl_gltf_texture(r->at, key, &use, id) || !vl_gltf_float(at, "scale", scale))
    return false;
  if (!id->index)
    return true;
  if (!r->result->needs_tangents && !vl_gltf_texture_set(r->g, at, &r->result->tangent_set))
    return false;
  r->result->needs_tangents = true;
  return true;
}

/* ---- coverage ---------------------------------------------------------------------------- */

/* Reads the coverage: the base colour's fourth channel, interpreted by alphaMode. */
static bool read_alpha(const Reader *r, const vlGltfLocation *at, const char *texture_key,
                       float factor) {
  static const char *const modes[] = {"OPAQUE", "MASK", "BLEND"};
  int mode = 0;
  float cutoff = 0.5f;
  r->result->alpha = vl_float_input(1.0f);
  if (!vl_gltf_choice(r->at, "alphaMode", modes, 3, &mode) ||
      !vl_gltf_float(r->at, "alphaCutoff", &cutoff))
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
  return take_texture(r, at, texture_key, &use, &r->result->alpha.texture);
}

/* ---- the base ---------------------------------------------------------------------------- */

static Reader part(const Reader *r, const vlGltfLocation *at) {
  Reader result = *r;
  result.at = at;
  return result;
}

static bool read_metallic_roughness(const Reader *r, float base[4]) {
  const json_t *json;
  const Reader own = part(r, VL_GLTF_KEY(r->at, "pbrMetallicRoughness"));
  vlPrincipledDef *p = &r->def->principled;
  return vl_gltf_object(r->at, "pbrMetallicRoughness", &json) &&
         read_color(&own, "baseColorFactor", 4, base) &&
         color_input(&own, "baseColorTexture", base, r->colors, &r->def->reflectance) &&
         channel(&own, "metallicFactor", "metallicRoughnessTexture", 2, 1.0f, &p->metallic) &&
         channel(&own, "roughnessFactor", "metallicRoughnessTexture", 1, 1.0f, &p->roughness) &&
         read_alpha(r, own.at, "baseColorTexture", base[3]);
}

/* Reads KHR_materials_pbrSpecularGlossiness as a material that is not metallic. The reflectance
 * at normal incidence is the specular colour. */
static bool read_specular_glossiness(const Reader *r, float base[4]) {
  const Reader own =
      part(r, VL_GLTF_KEY(r->at, "extensions.KHR_materials_pbrSpecularGlossiness"));
  vlPrincipledDef *p = &r->def->principled;
  float specular[4] = {1, 1, 1, 1}, glossiness = 1;
  if (!read_color(&own, "diffuseFactor", 4, base) ||
      !read_color(&own, "specularFactor", 3, specular) ||
      !color_input(&own, "diffuseTexture", base, r->colors, &r->def->reflectance) ||
      !color_input(&own, "specularGlossinessTexture", specular, false, &p->specular_color) ||
      !vl_gltf_float(own.at, "glossinessFactor", &glossiness) ||
      !read_alpha(r, own.at, "diffuseTexture", base[3]))
    return false;
  p->metallic = vl_float_input(0.0f);
  p->roughness = vl_float_input(1.0f - glossiness);
  r->def->eta = vl_spectrum_input(vl_spectrum_constant(0.0f));
  vlGltfTextureUse use = vl_gltf_use_channel(3, -glossiness);
  use.srgb = true;
  use.bias = 1.0f;
  return vl_gltf_texture(own.at, "specularGlossinessTexture", &use, &p->roughness.texture);
}

/* ---- extensions -------------------------------------------------------------------------- */

static bool read_specular(const Reader *r, vlPrincipledDef *p) {
  return channel(r, "specularFactor", "specularTexture", 3, 1.0f, &p->specular) &&
         layer_color(r, "specularColorFactor", "specularColorTexture", 1, &p->specular_color);
}

static bool read_coat(const Reader *r, vlPrincipledDef *p) {
  return channel(r, "clearcoatFactor", "clearcoatTexture", 0, 0.0f, &p->clearcoat) &&
         channel(r, "clearcoatRoughnessFactor", "clearcoatRoughnessTexture", 1, 0.0f,
                 &p->clearcoat_roughness) &&
         normal_input(r, "clearcoatNormalTexture", &p->clearcoat_normal,
                      &p->clearcoat_normal_scale);
}

static bool read_sheen(const Reader *r, vlPrincipledDef *p) {
  return layer_color(r, "sheenColorFactor", "sheenColorTexture", 0, &p->sheen_color) &&
         channel(r, "sheenRoughnessFactor", "sheenRoughnessTexture", 3, 0.0f,
                 &p->sheen_roughness);
}

static bool read_iridescence(const Reader *r, vlPrincipledDef *p) {
  float min = 100, max = 400;
  if (!channel(r, "iridescenceFactor", "iridescenceTexture", 0, 0.0f, &p->iridescence) ||
      !vl_gltf_float(r->at, "iridescenceIor", &p->iridescence_ior) ||
      !vl_gltf_float(r->at, "iridescenceThicknessMinimum", &min) ||
      !vl_gltf_float(r->at, "iridescenceThicknessMaximum", &max))
    return false;
  p->iridescence_ior = p->iridescence_ior < 1.0f ? 1.0f : p->iridescence_ior;
  p->iridescence_thickness = vl_float_input(max);
  vlGltfTextureUse use = vl_gltf_use_channel(1, max - min);
  use.bias = min;
  return vl_gltf_texture(r->at, "iridescenceThicknessTexture", &use,
                         &p->iridescence_thickness.texture);
}

static bool read_anisotropy(const Reader *r, vlPrincipledDef *p) {
  float rotation = 0;
  if (!channel(r, "anisotropyStrength", "anisotropyTexture", 2, 0.0f, &p->anisotropy) ||
      !vl_gltf_float(r->at, "anisotropyRotation", &rotation))
    return false;
  p->anisotropy_rotation = vl_float_input(rotation);
  if (p->anisotropy.texture.index || p->anisotropy.value > 0.0f)
    r->result->needs_tangents = true;
  return !p->anisotropy.texture.index ||
         vl_gltf_angle_texture(r->g, p->anisotropy.texture, rotation, &p->anisotropy_rotation);
}

/* ---- light that passes ------------------------------------------------------------------- */

static bool read_glass(const Reader *r, vlPrincipledDef *p) {
  return channel(r, "transmissionFactor", "transmissionTexture", 0, 0.0f, &p->transmission);
}

static bool read_ior(const Reader *r, VL_UNUSED vlPrincipledDef *p) {
  float index = 1.5f;
  if (!vl_gltf_float(r->at, "ior", &index))
    return false;
  if (index != 0.0f && !(index >= 1.0f))
    return vl_gltf_fail_key(r->at, "ior", "%g is below 1", (double)index);
  r->def->eta = vl_spectrum_input(vl_spectrum_constant(index));
  return true;
}

static bool read_dispersion(const Reader *r, vlPrincipledDef *p) {
  if (!vl_gltf_float(r->at, "dispersion", &p->dispersion))
    return false;
  return !(p->dispersion < 0.0f) ||
         vl_gltf_fail_key(r->at, "dispersion", "must not be negative");
}

static bool read_diffuse(const Reader *r, vlPrincipledDef *p) {
  return channel(r, "diffuseTransmissionFactor", "diffuseTransmissionTexture", 3, 0.0f,
                 &p->diffuse_transmission) &&
         layer_color(r, "diffuseTransmissionColorFactor", "diffuseTransmissionColorTexture", 1,
                     &p->diffuse_transmission_color);
}

static bool read_volume(const Reader *r, vlPrincipledDef *p) {
  float thickness = 0;
  if (!vl_gltf_float(r->at, "thicknessFactor", &thickness))
    return false;
  p->thin_walled = !(thickness > 0.0f);
  return p->thin_walled || vl_gltf_volume(r->g, r->at, r->result);
}

/* The extensions, in the order in which they are read; their functions are called where the
 * material has the extension. not_glossy: glossy materials have their own layer of it. */
static const struct {
  const char *key;
  bool (*read)(const Reader *r, vlPrincipledDef *p);
  bool not_glossy;
} layers[] = {{"extensions.KHR_materials_transmission", read_glass, false},
              {"extensions.KHR_materials_ior", read_ior, false},
              {"extensions.KHR_materials_dispersion", read_dispersion, false},
              {"extensions.KHR_materials_diffuse_transmission", read_diffuse, false},
              {"extensions.KHR_materials_volume", read_volume, false},
              {"extensions.KHR_materials_specular", read_specular, true},
              {"extensions.KHR_materials_clearcoat", read_coat, false},
              {"extensions.KHR_materials_sheen", read_sheen, false},
              {"extensions.KHR_materials_iridescence", read_iridescence, false},
              {"extensions.KHR_materials_anisotropy", read_anisotropy, false}};

static bool read_layers(const Reader *r, bool glossy) {
  r->def->principled.thin_walled = true;
  for (size_t i = 0; i < VL_LENGTH(layers); i++) {
    const Reader layer = part(r, VL_GLTF_KEY(r->at, layers[i].key));
    if ((glossy && layers[i].not_glossy) || !json_is_object(vl_gltf_json(layer.at)))
      continue;
    if (!layers[i].read(&layer, &r->def->principled))
      return false;
  }
  return true;
}

/* ---- emission ---------------------------------------------------------------------------- */

static bool add_emission(const Reader *r, const char *texture_key, const float color[4],
                         float strength) {
  if (!(color[0] > 0 || color[1] > 0 || color[2] > 0) || !(strength > 0))
    return true;
  vlEmissionDef def = vl_default_emission_def();
  vlGltfTextureUse use = vl_gltf_use_color();
  memcpy(use.tint, color, sizeof use.tint);
  if (!vl_gltf_texture(r->at, texture_key, &use, &def.texture))
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
  return read_color(r, "emissiveFactor", 3, color) &&
         vl_gltf_float(VL_GLTF_KEY(r->at, "extensions.KHR_materials_emissive_strength"),
                       "emissiveStrength", &strength) &&
         add_emission(r, "emissiveTexture", color, strength);
}

/* KHR_materials_unlit: the image shows the base colour whatever the lighting. A black diffuse
 * surface emits it. */
static bool read_unlit(const Reader *r) {
  float base[4] = {1, 1, 1, 1};
  const json_t *json;
  const Reader own = part(r, VL_GLTF_KEY(r->at, "pbrMetallicRoughness"));
  *r->def = vl_default_material_def(VL_MATERIAL_DIFFUSE);
  r->def->source.file = r->g->path;
  r->def->reflectance = vl_spectrum_input(vl_spectrum_constant(0.0f));
  return vl_gltf_object(r->at, "pbrMetallicRoughness", &json) &&
         read_color(&own, "baseColorFactor", 4, base) &&
         read_alpha(r, own.at, "baseColorTexture", base[3]) &&
         add_emission(&own, "baseColorTexture", base, 1.0f);
}

/* ---- the whole --------------------------------------------------------------------------- */

static bool read_material(const Reader *r) {
  float base[4] = {1, 1, 1, 1};
  vlPrincipledDef *p = &r->def->principled;
  if (!vl_gltf_bool(r->at, "doubleSided", &r->result->double_sided))
    return false;
  const json_t *json = vl_gltf_json(r->at);
  if (vl_gltf_extension(json, "KHR_materials_unlit"))
    return read_unlit(r);
  const json_t *glossy = vl_gltf_extension(json, "KHR_materials_pbrSpecularGlossiness");
  if (!(glossy ? read_specular_glossiness(r, base) : read_metallic_roughness(r, base)))
    return false;
  if (!normal_input(r, "normalTexture", &p->normal, &p->normal_scale))
    return false;
  if (!read_layers(r, glossy != NULL) || !read_emission(r))
    return false;
  bool passes = p->transmission.texture.index || p->transmission.value > 0.0f ||
                p->diffuse_transmission.texture.index || p->diffuse_transmission.value > 0.0f;
  if (passes)
    /* light inside the solid must hit the back side of the surface */
    r->result->double_sided = true;
  return true;
}

const vlGltfMaterial *vl_gltf_material(vlGltf *g, size_t index, bool colors) {
  vlGltfMaterial *result = &g->materials[2 * (index + 1) + colors];
  if (result->made)
    return result;
  vlMaterialDef def = vl_default_material_def(VL_MATERIAL_PRINCIPLED);
  const char *name = index == VL_GLTF_NONE ? NULL : g->material_labels[index];
  /* the same with vertex colours */
  const vlGltfMaterial *other = &g->materials[2 * (index + 1) + !colors];
  if (name && other->made &&
      !vl_label_make_unique(g->scene, &g->material_names, name, index, &name))
    return NULL;
  char location[40];
  snprintf(location, sizeof location, "materials[%zu]", index);
  Reader r = {g,
              VL_GLTF_ROOT(g, "materials", index == VL_GLTF_NONE ? g->material_count : index),
              &def, result, colors};
  def.source.file = g->path;
  if (!read_material(&r))
    return NULL;
  def.name = name;
  def.place = index == VL_GLTF_NONE ? NULL : location;
  result->material = vl_scene_add_material(g->scene, &def);
  result->made = result->material.index != 0;
  return result->made ? result : NULL;
}
