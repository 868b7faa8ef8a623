/* export/gltf/material.c: materials as metallic-roughness with the KHR extensions. The
 * principled material is exported losslessly where possible; other materials are
 * approximated. */
#include <math.h>

#include "export/image.h"
#include "schema/schema.h"

#include "base/text.h"
#include "image/image.h"
#include "math/elementary.h"
#include "velo/light.h"
#include "velo/material.h"
#include "velo/medium.h"
#include "velo/shape.h"

/* ---- inputs ------------------------------------------------------------------------------ */

static json_t *extension(vlExport *x, json_t *material, const char *name) {
  vl_gltf_use(x, name);
  return vl_gltf_child(vl_gltf_child(material, "extensions"), name);
}

static void set_number(json_t *to, const char *key, double value) {
  if (isfinite(value))
    json_object_set_new(to, key, json_real(value));
}

/* v, cut off at 0 and 1; NaN becomes 0. */
static double unit(double v) {
  return fmin(fmax(v, 0), 1);
}

/* Whether a texture is a number plus a factor times a channel of an image. */
static bool reads_channel(const vlTextureDef *t, int channel) {
  return t && t->channel == channel && isnan(t->cutoff) && !t->invert;
}

/* Whether that number is 0. */
static bool is_channel(const vlTextureDef *t, int channel) {
  return reads_channel(t, channel) && t->bias == 0;
}

static double factor_of(const vlTextureDef *t, int channel) {
  return (double)t->scale * (double)t->tint[channel];
}

/* Writes a factor times a channel of an image. */
static void put_channel(vlExport *x, json_t *to, const char *factor_key,
                        const char *texture_key, int channel, const vlFloatInput *input) {
  const vlTextureDef *t = vl_export_texture(x, input->texture);
  json_t *info = is_channel(t, channel) ? vl_gltf_texture_info(x, t, channel != 3) : NULL;
  if (input->texture.index && !info)
    vl_export_lose(x, "textured %s: a number stands in", factor_key);
  set_number(to, factor_key,
             unit(info ? factor_of(t, channel) : (double)vl_export_number(x, input)));
  if (info)
    json_object_set_new(to, texture_key, info);
}

/* Writes a colour factor times an sRGB image. coverage: the factor's fourth number; below 0:
 * the factor has three. */
static void put_color(vlExport *x, json_t *to, const char *factor_key, const char *texture_key,
                      bool bounded, const vlSpectrumInput *input, double coverage) {
  const vlTextureDef *t = vl_export_texture(x, input->texture);
  json_t *info = t && !t->invert ? vl_gltf_texture_info(x, t, false) : NULL;
  if (t && t->invert)
    vl_export_lose(x, "inverted images in %s: a colour stands in", texture_key);
  float rgb[3];
  vl_export_rgb(x, input, rgb);
  json_t *factor = json_array();
  for (int i = 0; i < 3; i++) {
    double v = info ? factor_of(t, i) : (double)rgb[i];
    if (bounded && v > 1 + 1e-6)
      vl_export_lose(x, "%s above 1: cut off", factor_key);
    json_array_append_new(factor, json_real(bounded ? unit(v) : v > 0 ? v : 0));
  }
  if (coverage >= 0)
    json_array_append_new(factor, json_real(unit(coverage)));
  json_object_set_new(to, factor_key, factor);
  if (info)
    json_object_set_new(to, texture_key, info);
}

static void put_normal(vlExport *x, json_t *to, const char *key, vlTextureId id, float scale) {
  const vlTextureDef *t = vl_export_texture(x, id);
  json_t *info = t ? vl_gltf_texture_info(x, t, true) : NULL;
  if (id.index && !t)
    vl_export_lose(x, "normal maps that are not images: left out");
  if (!info)
    return;
  if (t->invert || t->scale != 1 || t->tint[0] != 1 || t->tint[1] != 1 || t->tint[2] != 1)
    vl_export_lose(x, "factors on the texels of normal maps: 1 stands in");
  if (scale != 1.0f)
    set_number(info, "scale", scale);
  json_object_set_new(to, key, info);
}

/* ---- the base ---------------------------------------------------------------------------- */

/* Whether two textures read the same texels at each point; their curves may differ. */
static bool same_texels(const vlTextureDef *a, const vlTextureDef *b) {
  double p[6], q[6];
  vl_export_st_from_uv(a, p);
  vl_export_st_from_uv(b, q);
  return a->data == b->data && a->image == b->image && a->uv_set == b->uv_set &&
         (a->path == b->path || (a->path && b->path && vl_text_is(a->path, b->path))) &&
         a->mapping == b->mapping && memcmp(p, q, sizeof p) == 0 && a->filter == b->filter &&
         a->wrap == b->wrap && vl_export_wrap_t(a) == vl_export_wrap_t(b);
}

/* An image that cannot be read has none; it is left out, which is counted when it is put. */
static bool image_has_alpha(vlExport *x, const vlTextureDef *t) {
  uint32_t channel[4];
  vlImage *own = NULL;
  const vlResult before = x->result;
  const vlImage *image = t ? vl_export_pixels(x, t, &own) : NULL;
  const uint32_t have = image ? vl_image_color(image, channel) : 0;
  vl_image_destroy(own);
  if (x->result != VL_ERROR_MEMORY)
    x->result = before;
  return have == 2 || have == 4;
}

static bool vertices_have_alpha(const vlShapeDef *d) {
  bool all = true;
  for (size_t i = 0; d->colors && i < d->vertices; i++)
    all = all && d->colors[4 * i + 3] == 1;
  return !all;
}

/* In glTF the coverage is the base colour's alpha: the product of the factor, of the image's
 * and of the vertices'. colors: the mesh has vertex colours. */
static void put_coverage(vlExport *x, json_t *material, const vlShapeDef *d,
                         const vlMaterialDef *m, bool colors, double *factor) {
  const vlFloatInput *alpha = &d->alpha;
  const vlTextureDef *t = vl_scene_texture(x->scene, alpha->texture);
  const vlTextureDef *base = m ? vl_export_texture(x, m->reflectance.texture) : NULL;
  bool plain = t && t->bias == 0 && !t->invert;
  bool of_vertices = plain && t->kind == VL_TEXTURE_VERTEX_COLOR && colors;
  bool of_base =
      plain && t->kind == VL_TEXTURE_IMAGE && t->channel == 3 && base && same_texels(t, base);
  *factor = of_base       ? factor_of(t, 3)
            : of_vertices ? (double)t->tint[3]
                          : (double)vl_export_number(x, alpha);
  if (!t && alpha->value >= 1)
    return;
  bool mask = (of_base || of_vertices) && !isnan(t->cutoff);
  json_object_set_new(material, "alphaMode", json_string(mask ? "MASK" : "BLEND"));
  if (mask)
    set_number(material, "alphaCutoff", t->cutoff);
  if (t && !of_base && !of_vertices)
    vl_export_lose(x, "coverage that is not the fourth channel of the base colour's image");
  if (of_base && t->colors && !colors)
    vl_export_lose(x, "coverage of vertices whose colours are not used: left out");
  const bool tinted = of_vertices || (of_base && t->colors);
  if ((!of_base && image_has_alpha(x, base)) || (colors && !tinted && vertices_have_alpha(d)))
    vl_export_lose(x, "coverage besides that of the base colour: times that, as in glTF");
}

static void put_base(vlExport *x, json_t *material, const vlSpectrumInput *color,
                     double coverage, double metallic, double roughness) {
  json_t *base = json_object();
  put_color(x, base, "baseColorFactor", "baseColorTexture", true, color, coverage);
  set_number(base, "metallicFactor", unit(metallic));
  set_number(base, "roughnessFactor", unit(roughness));
  json_object_set_new(material, "pbrMetallicRoughness", base);
}

static void put_metal(vlExport *x, json_t *base, const vlPrincipledDef *p) {
  const vlTextureDef *m = vl_export_texture(x, p->metallic.texture);
  const vlTextureDef *r = vl_export_texture(x, p->roughness.texture);
  bool good = is_channel(m, 2) && is_channel(r, 1) && same_texels(m, r) &&
              m->encoding_given == r->encoding_given && m->encoding == r->encoding;
  json_t *info = good ? vl_gltf_texture_info(x, m, true) : NULL;
  if ((p->metallic.texture.index || p->roughness.texture.index) && !info)
    vl_export_lose(x, "textured metallic or roughness, not of one image: numbers stand in");
  set_number(base, "metallicFactor",
             unit(info ? factor_of(m, 2) : (double)vl_export_number(x, &p->metallic)));
  set_number(base, "roughnessFactor",
             unit(info ? factor_of(r, 1) : (double)vl_export_number(x, &p->roughness)));
  if (info)
    json_object_set_new(base, "metallicRoughnessTexture", info);
}

static void put_ior(vlExport *x, json_t *material, float eta) {
  if (eta != 1.5f)
    set_number(extension(x, material, "KHR_materials_ior"), "ior",
               eta >= 1 || eta == 0 ? eta : 1.0f);
}

static bool is_zero(const vlSpectrum *s) {
  float rgb[3];
  vl_export_light_rgb(s, rgb);
  return s->scale == 0 || (s->kind == VL_SPECTRUM_CONSTANT && s->value == 0) ||
         !(rgb[0] + rgb[1] + rgb[2] > 0);
}

static void put_volume(vlExport *x, json_t *material, vlMediumId inside) {
  json_t *volume = extension(x, material, "KHR_materials_volume");
  set_number(volume, "thicknessFactor", 1);
  if (!inside.index)
    return;
  const vlMediumDef *m = &x->scene->media.items[inside.index - 1];
  float sigma[3];
  vlSpectrumInput input = {.value = m->sigma_a};
  if (m->kind != VL_MEDIUM_HOMOGENEOUS || !is_zero(&m->sigma_s))
    vl_export_lose(x, "media that scatter or vary: what they absorb alone");
  vl_export_rgb(x, &input, sigma);
  for (int i = 0; i < 3; i++)
    sigma[i] *= m->scale;
  const float max = fmaxf(sigma[0], fmaxf(sigma[1], sigma[2]));
  if (!(max > 0))
    return;
  json_t *color = json_array();
  for (int i = 0; i < 3; i++)
    json_array_append_new(color, json_real(vl_precise_exp(-(double)sigma[i] / (double)max)));
  json_object_set_new(volume, "attenuationColor", color);
  set_number(volume, "attenuationDistance", 1.0 / (double)max);
}

/* ---- principled -------------------------------------------------------------------------- */

static void put_sheen_coat(vlExport *x, json_t *material, const vlPrincipledDef *p) {
  float sheen[3];
  vl_export_rgb(x, &p->sheen_color, sheen);
  if (p->sheen_color.texture.index || sheen[0] > 0 || sheen[1] > 0 || sheen[2] > 0) {
    json_t *e = extension(x, material, "KHR_materials_sheen");
    put_color(x, e, "sheenColorFactor", "sheenColorTexture", true, &p->sheen_color, -1);
    put_channel(x, e, "sheenRoughnessFactor", "sheenRoughnessTexture", 3, &p->sheen_roughness);
  }
  if (!vl_export_is_on(&p->clearcoat))
    return;
  json_t *e = extension(x, material, "KHR_materials_clearcoat");
  put_channel(x, e, "clearcoatFactor", "clearcoatTexture", 0, &p->clearcoat);
  put_channel(x, e, "clearcoatRoughnessFactor", "clearcoatRoughnessTexture", 1,
              &p->clearcoat_roughness);
  put_normal(x, e, "clearcoatNormalTexture", p->clearcoat_normal, p->clearcoat_normal_scale);
}

/* An image has strengths and directions. Those of glTF files have become two textures of one
 * name. */
static void put_anisotropy(vlExport *x, json_t *to, const vlPrincipledDef *p) {
  const vlTextureDef *strength = vl_export_texture(x, p->anisotropy.texture);
  const vlTextureDef *angle = vl_export_texture(x, p->anisotropy_rotation.texture);
  vlFloatInput input = p->anisotropy;
  bool pair = strength && angle && angle->image && angle->name && strength->name &&
              vl_text_is(angle->name, strength->name);
  if (!pair && (input.texture.index || p->anisotropy_rotation.texture.index))
    vl_export_lose(x, "textured anisotropy that is not from a glTF file: numbers stand in");
  if (!pair)
    input = vl_float_input(vl_export_number(x, &p->anisotropy));
  put_channel(x, to, "anisotropyStrength", "anisotropyTexture", 2, &input);
  set_number(to, "anisotropyRotation", p->anisotropy_rotation.value);
}

static void put_film(vlExport *x, json_t *material, const vlPrincipledDef *p) {
  if (vl_export_is_on(&p->iridescence)) {
    json_t *e = extension(x, material, "KHR_materials_iridescence");
    put_channel(x, e, "iridescenceFactor", "iridescenceTexture", 0, &p->iridescence);
    set_number(e, "iridescenceIor", p->iridescence_ior);
    const vlTextureDef *t = vl_export_texture(x, p->iridescence_thickness.texture);
    json_t *info = reads_channel(t, 1) ? vl_gltf_texture_info(x, t, true) : NULL;
    double max = info ? (double)t->bias + factor_of(t, 1)
                      : (double)vl_export_number(x, &p->iridescence_thickness);
    if (p->iridescence_thickness.texture.index && !info)
      vl_export_lose(x, "textured iridescence thickness: a number stands in");
    set_number(e, "iridescenceThicknessMinimum", info ? (double)t->bias : fmin(100, max));
    set_number(e, "iridescenceThicknessMaximum", max);
    if (info)
      json_object_set_new(e, "iridescenceThicknessTexture", info);
  }
  if (vl_export_is_on(&p->anisotropy))
    put_anisotropy(x, extension(x, material, "KHR_materials_anisotropy"), p);
}

static void put_passing(vlExport *x, json_t *material, const vlPrincipledDef *p,
                        vlMediumId inside) {
  if (vl_export_is_on(&p->transmission))
    put_channel(x, extension(x, material, "KHR_materials_transmission"), "transmissionFactor",
                "transmissionTexture", 0, &p->transmission);
  if (vl_export_is_on(&p->diffuse_transmission)) {
    json_t *e = extension(x, material, "KHR_materials_diffuse_transmission");
    put_channel(x, e, "diffuseTransmissionFactor", "diffuseTransmissionTexture", 3,
                &p->diffuse_transmission);
    put_color(x, e, "diffuseTransmissionColorFactor", "diffuseTransmissionColorTexture", true,
              &p->diffuse_transmission_color, -1);
  }
  if (!p->thin_walled &&
      (vl_export_is_on(&p->transmission) || vl_export_is_on(&p->diffuse_transmission))) {
    put_volume(x, material, inside);
    if (p->dispersion > 0)
      set_number(extension(x, material, "KHR_materials_dispersion"), "dispersion",
                 p->dispersion);
  }
}

static void put_principled(vlExport *x, json_t *material, const vlMaterialDef *m,
                           vlMediumId inside, double coverage) {
  const vlPrincipledDef *p = &m->principled;
  put_base(x, material, &m->reflectance, coverage, 1, 1);
  put_metal(x, json_object_get(material, "pbrMetallicRoughness"), p);
  put_ior(x, material, vl_export_eta(&m->eta.value));
  if (p->specular.texture.index || p->specular.value != 1 ||
      !vl_export_is_white(x, &p->specular_color)) {
    json_t *e = extension(x, material, "KHR_materials_specular");
    put_channel(x, e, "specularFactor", "specularTexture", 3, &p->specular);
    put_color(x, e, "specularColorFactor", "specularColorTexture", false, &p->specular_color,
              -1);
  }
  put_sheen_coat(x, material, p);
  put_film(x, material, p);
  put_passing(x, material, p, inside);
  put_normal(x, material, "normalTexture", p->normal, p->normal_scale);
}

/* ---- others ------------------------------------------------------------------------------ */

/* One roughness for both directions. */
static double own_roughness(vlExport *x, const vlMaterialDef *m) {
  const float u = vl_export_alpha(x, m, &m->u_roughness);
  if (u != vl_export_alpha(x, m, &m->v_roughness))
    vl_export_lose(x, "roughness that differs by direction: that along u");
  return sqrt((double)u);
}

static void put_glass(vlExport *x, json_t *material, const vlMaterialDef *m, vlMediumId inside,
                      double coverage) {
  vlSpectrumInput white = vl_spectrum_input(vl_spectrum_constant(1));
  bool thin = m->kind == VL_MATERIAL_THIN_DIELECTRIC;
  const double roughness = thin ? 0 : own_roughness(x, m);
  if (roughness > 0)
    vl_export_lose(x, "rough glass: as glTF's, which keeps the light of several reflections");
  put_base(x, material, &white, coverage, 0, roughness);
  put_ior(x, material, vl_export_eta(&m->eta.value));
  set_number(extension(x, material, "KHR_materials_transmission"), "transmissionFactor", 1);
  if (!thin)
    put_volume(x, material, inside);
  if (m->eta.value.kind != VL_SPECTRUM_CONSTANT)
    vl_export_lose(x, "indices of refraction by wavelength: that at 589 nm");
}

static void put_diffuse(vlExport *x, json_t *material, const vlMaterialDef *m,
                        VL_UNUSED vlMediumId inside, double coverage) {
  put_base(x, material, &m->reflectance, coverage, 0, 1);
  set_number(extension(x, material, "KHR_materials_specular"), "specularFactor", 0);
}

static void put_coated(vlExport *x, json_t *material, const vlMaterialDef *m,
                       VL_UNUSED vlMediumId inside, double coverage) {
  vl_export_lose(x, "coateddiffuse: as a rough dielectric");
  put_base(x, material, &m->reflectance, coverage, 0, own_roughness(x, m));
  put_ior(x, material, vl_export_eta(&m->eta.value));
}

static void put_conductor(vlExport *x, json_t *material, const vlMaterialDef *m,
                          VL_UNUSED vlMediumId inside, double coverage) {
  float rgb[3];
  vlSpectrumInput color = m->reflectance;
  vl_export_metal_rgb(x, m, rgb);
  if (!m->use_reflectance)
    color = vl_spectrum_input(vl_spectrum_rgb(rgb[0], rgb[1], rgb[2]));
  if (!m->use_reflectance)
    vl_export_lose(x, "metals by eta and k: their colour at normal incidence");
  put_base(x, material, &color, coverage, 1, own_roughness(x, m));
}

static void put_coated_conductor(vlExport *x, json_t *material, const vlMaterialDef *m,
                                 vlMediumId inside, double coverage) {
  put_conductor(x, material, m, inside, coverage);
  vl_export_lose(x, "coatedconductor: as a metal with a clear coat");
  set_number(extension(x, material, "KHR_materials_clearcoat"), "clearcoatFactor", 1);
  set_number(extension(x, material, "KHR_materials_clearcoat"), "clearcoatRoughnessFactor",
             unit(sqrt((double)vl_export_alpha(x, m, &m->coat_u_roughness))));
}

static double largest_factor(const json_t *color) {
  double max = 0;
  for (size_t i = 0; i < 3; i++)
    max = fmax(max, json_number_value(json_array_get(color, i)));
  return max;
}

static void scale_factor(json_t *color, double by) {
  for (size_t i = 0; i < 3; i++)
    json_array_set_new(color, i,
                       json_real(unit(by * json_number_value(json_array_get(color, i)))));
}

/* glTF's leaves reflect a share of the light in one colour and pass the rest in another. The
 * share is that of the larger numbers, so that both colours have as much room below 1. */
static void put_leaf(vlExport *x, json_t *material, const vlMaterialDef *m, vlMediumId inside,
                     double coverage) {
  static const char key[] = "diffuseTransmissionColorFactor";
  put_diffuse(x, material, m, inside, coverage);
  json_t *leaf = extension(x, material, "KHR_materials_diffuse_transmission");
  put_color(x, leaf, key, "diffuseTransmissionColorTexture", true, &m->transmittance, -1);
  json_t *reflected =
      json_object_get(json_object_get(material, "pbrMetallicRoughness"), "baseColorFactor");
  json_t *passed = json_object_get(leaf, key);
  const double r = largest_factor(reflected), t = largest_factor(passed);
  const double share = r + t > 0 ? t / (r + t) : 0.5;
  if ((r + t) * (double)m->scale > 1 + 1e-6)
    vl_export_lose(x, "diffusetransmission: of more than all light, all is written");
  scale_factor(reflected, share < 1 ? (double)m->scale / (1 - share) : 0);
  scale_factor(passed, share > 0 ? (double)m->scale / share : 0);
  set_number(leaf, "diffuseTransmissionFactor", share);
}

static void put_subsurface(vlExport *x, json_t *material, const vlMaterialDef *m,
                           VL_UNUSED vlMediumId inside, double coverage) {
  vlSpectrumInput color = m->reflectance;
  vl_export_lose(
      x, "subsurface: as a rough dielectric, its colour grey where no reflectance says it");
  if (!m->subsurface.from_reflectance)
    color = vl_spectrum_input(vl_spectrum_constant(0.5f));
  put_base(x, material, &color, coverage, 0, own_roughness(x, m));
  put_ior(x, material, vl_export_eta(&m->eta.value));
}

static void put_grey(vlExport *x, json_t *material, VL_UNUSED const vlMaterialDef *m,
                     VL_UNUSED vlMediumId inside, double coverage) {
  const vlSpectrumInput grey = vl_spectrum_input(vl_spectrum_constant(0.5f));
  vl_export_lose(x, "materials of kinds that glTF has not: grey");
  put_base(x, material, &grey, coverage, 0, 1);
}

/* Writes one kind of material. inside: the medium behind the surface. Kinds without an entry:
 * put_grey. */
typedef void Put(vlExport *x, json_t *material, const vlMaterialDef *m, vlMediumId inside,
                 double coverage);
static Put *const puts_of_kind[0 VL_MATERIAL_KINDS(VL_COUNT_KIND)] = {
    [VL_MATERIAL_DIFFUSE] = put_diffuse,
    [VL_MATERIAL_COATED_DIFFUSE] = put_coated,
    [VL_MATERIAL_CONDUCTOR] = put_conductor,
    [VL_MATERIAL_COATED_CONDUCTOR] = put_coated_conductor,
    [VL_MATERIAL_DIELECTRIC] = put_glass,
    [VL_MATERIAL_THIN_DIELECTRIC] = put_glass,
    [VL_MATERIAL_PRINCIPLED] = put_principled,
    [VL_MATERIAL_DIFFUSE_TRANSMISSION] = put_leaf,
    [VL_MATERIAL_SUBSURFACE] = put_subsurface};

/* ---- emission ---------------------------------------------------------------------------- */

/* Both sides of what glTF calls double-sided emit light. So a shape that emits to one side
 * alone is written without doubleSided, whether or not it is one_sided. */
static void put_emission(vlExport *x, json_t *material, const vlEmissionDef *e,
                         bool one_sided) {
  float rgb[3];
  vlTextureDef image = vl_default_texture_def(VL_TEXTURE_IMAGE, true);
  const vlTextureDef *t = vl_export_texture(x, e->texture);
  if (t && t->invert) {
    vl_export_lose(x, "inverted images of area lights: their radiance stands in");
    t = NULL;
  }
  vl_export_light_rgb(&e->radiance, rgb);
  if (t)
    for (int i = 0; i < 3; i++)
      rgb[i] = (float)factor_of(t, i);
  if (e->image) {
    image.path = e->image;
    rgb[0] = rgb[1] = rgb[2] = 1;
    t = &image;
  }
  double max = fmax(rgb[0], fmax(rgb[1], rgb[2])), scale = e->scale;
  if (!(max > 0))
    return;
  if (!isnan(e->power))
    vl_export_lose(x, "area lights given by their power: radiance 1 is written");
  if (!e->two_sided && !one_sided)
    vl_export_lose(x, "backs of area lights that emit to one side: not seen, as in glTF");
  if (e->two_sided && one_sided)
    vl_export_lose(x, "backs of one-sided area lights that emit to both sides: dark");
  if (e->spread < 3.1415f)
    vl_export_lose(x, "spreads of area lights: the same radiance in all directions");
  json_t *factor = json_array(), *info = t ? vl_gltf_texture_info(x, t, false) : NULL;
  double over = max * scale > 1 ? max * scale : 1;
  for (int i = 0; i < 3; i++)
    json_array_append_new(factor, json_real(unit((double)rgb[i] * scale / over)));
  json_object_set_new(material, "emissiveFactor", factor);
  if (info)
    json_object_set_new(material, "emissiveTexture", info);
  if (over > 1)
    set_number(extension(x, material, "KHR_materials_emissive_strength"), "emissiveStrength",
               over);
}

/* ---- the whole --------------------------------------------------------------------------- */

static const vlMaterialDef *material_of(const vlExport *x, const vlShapeDef *d) {
  const vlMaterialDef *m = vl_scene_material(x->scene, d->material);
  for (int depth = 0; m && m->kind == VL_MATERIAL_MIX && depth < 16; depth++)
    m = vl_scene_material(x->scene, m->materials[0]);
  return m;
}

static bool wants_colors(const vlExport *x, const vlMaterialDef *m) {
  const vlTextureDef *t = m ? vl_scene_texture(x->scene, m->reflectance.texture) : NULL;
  return t && (t->kind == VL_TEXTURE_VERTEX_COLOR || t->colors);
}

json_int_t vl_gltf_put_material(vlExport *x, const vlShapeDef *d, bool *colors,
                                bool *tangents) {
  const vlMaterialDef *own = vl_scene_material(x->scene, d->material), *m = material_of(x, d);
  vlExportLook look = {.material = d->material,
                       .alpha = d->alpha,
                       .emission = d->emission,
                       .inside = d->inside,
                       .one_sided = d->one_sided};
  *colors = wants_colors(x, m);
  *tangents = m && (m->principled.normal.index || m->principled.clearcoat_normal.index ||
                    vl_export_is_on(&m->principled.anisotropy));
  VL_EACH_ITEM(const vlExportLook, l, &x->looks) {
    if (l->material.index == look.material.index && l->emission.index == look.emission.index &&
        l->inside.index == look.inside.index && l->one_sided == look.one_sided &&
        l->alpha.texture.index == look.alpha.texture.index &&
        l->alpha.value == look.alpha.value)
      return l->index;
  }
  json_t *json = json_object();
  double coverage;
  if (m)
    vl_gltf_name(json, m->name);
  if (own && own->kind == VL_MATERIAL_MIX)
    vl_export_lose(x, "material mix: its first alone");
  put_coverage(x, json, d, m, *colors, &coverage);
  vlMaterialDef plain = vl_default_material_def(VL_MATERIAL_DIFFUSE);
  if (!m)
    m = &plain;
  Put *put = puts_of_kind[m->kind] ? puts_of_kind[m->kind] : put_grey;
  put(x, json, m, d->inside, coverage);
  if (m->displacement.texture.index)
    vl_export_lose(x, "bump maps: left out");
  if (m->normal_map) {
    vlTextureDef image = vl_default_texture_def(VL_TEXTURE_IMAGE, true);
    image.path = m->normal_map;
    json_t *info = vl_gltf_texture_info(x, &image, true);
    if (info)
      json_object_set_new(json, "normalTexture", info);
  }
  const vlEmissionDef *e =
      d->emission.index ? &x->scene->emissions.items[d->emission.index - 1] : NULL;
  if (e)
    put_emission(x, json, e, d->one_sided);
  /* rays hit transmissive surfaces from both sides */
  bool body =
      json_object_get(json_object_get(json, "extensions"), "KHR_materials_volume") != NULL;
  if (!d->one_sided && !body && !(e && !e->two_sided))
    json_object_set_new(json, "doubleSided", json_true());
  if (!json_object_size(json_object_get(json, "extensions")))
    json_object_del(json, "extensions");
  look.index = vl_gltf_put(x, "materials", json);
  vlExportLook *slot = VL_PUSH(x->context, &x->looks);
  if (slot)
    *slot = look;
  return look.index;
}
