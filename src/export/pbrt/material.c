/* export/pbrt/material.c: materials of pbrt-v4. pbrt's own kinds are written unchanged; the
 * principled material is approximated. */
#include <stdio.h>

#include "export/image.h"
#include "export/pbrt/pbrt.h"
#include "velo/material.h"

/* ---- principled -------------------------------------------------------------------------- */

static void count_losses(vlExport *x, const vlMaterialDef *m) {
  const vlPrincipledDef *p = &m->principled;
  float rgb[3];
  if (vl_export_is_on(&p->clearcoat))
    vl_export_lose(x, "clear coats: left out");
  vl_export_rgb(x, &p->sheen_color, rgb);
  if (p->sheen_color.texture.index || rgb[0] + rgb[1] + rgb[2] > 0)
    vl_export_lose(x, "sheen: left out");
  if (vl_export_is_on(&p->iridescence))
    vl_export_lose(x, "iridescence: left out");
  if (vl_export_is_on(&p->anisotropy))
    vl_export_lose(x, "anisotropy of principled materials: left out");
  if (p->dispersion > 0)
    vl_export_lose(x, "dispersion: left out");
  if (!vl_export_is_white(x, &p->specular_color) || p->specular.texture.index ||
      (p->specular.value != 1 && p->specular.value != 0))
    vl_export_lose(x, "strength and colour of dielectrics' reflection: left out");
  if (p->clearcoat_normal.index || (p->normal.index && p->normal_scale != 1))
    vl_export_lose(x, "normal maps' scale, and those of coats: left out");
  if (p->normal.index && m->normal_map)
    vl_export_lose(x, "a second normal map: left out");
}

/* The material's bump map, and its normal map: a texture of the principled material, or a file.
 * height: the bump map, prepared. */
static bool put_bumps(vlExport *x, const vlMaterialDef *m, const vlPbrtInput *height) {
  const vlTextureDef *t = vl_export_texture(x, m->principled.normal);
  vlTextureDef file = vl_default_texture_def(VL_TEXTURE_IMAGE, true);
  char name[300];
  if (height->texture[0])
    vl_pbrt_put_number(x, "displacement", height);
  file.path = m->normal_map;
  t = t || !m->normal_map ? t : &file;
  if (!t)
    return true;
  if (!vl_pbrt_image(x, t, VL_PBRT_COLORS, name))
    return false;
  PUT(" \"string normalmap\" \"%s\"", name);
  return true;
}

/* Albedo of the specular lobe of a principled dielectric, averaged over all directions: a fit,
 * within 0.0015, to renders of black spheres of eta 1.5, whose reflectance at normal incidence
 * is 0.04. */
static float specular_albedo(vlExport *x, const vlPrincipledDef *p, double eta, float alpha) {
  const double f0 = (eta - 1) * (eta - 1) / ((eta + 1) * (eta + 1)),
               a = alpha < 1 ? (double)alpha : 1;
  const double e = (0.0575 - 0.0555 * a + 0.0147 * a * a) * f0 / 0.04 *
                   (double)vl_export_number(x, &p->specular);
  return (float)(e > 0 ? e < 1 ? e : 1 : 0);
}

/* The materials of pbrt that stand for the non-metallic part of the principled material. */
typedef enum Stand {
  STAND_GLASS,
  STAND_LEAF,
  STAND_MATTE, /* pbrt's rough coats lose energy; diffuse is the closer approximation */
  STAND_COATED
} Stand;

static void put_clear(vlExport *x, const vlMaterialDef *m, float transmission, double eta,
                      const vlPbrtInput *alpha) {
  const vlPrincipledDef *p = &m->principled;
  if (!vl_export_is_white(x, &m->reflectance))
    vl_export_lose(x, "colour of glass at its surface: left out");
  if (transmission < 1 || p->transmission.texture.index)
    vl_export_lose(x, "surfaces that pass a part of light: glass");
  PUT("\"%s\" \"float eta\" [%.9g]", p->thin_walled ? "thindielectric" : "dielectric", eta);
  if (!p->thin_walled) {
    vl_pbrt_put_number(x, "roughness", alpha);
    PUT(" \"bool remaproughness\" false");
  } else if (alpha->texture[0] || alpha->number > 1e-4f) {
    vl_export_lose(x, "rough sheets of glass: smooth");
  }
}

static void put_half_leaf(vlExport *x, const vlPbrtInput *color, const vlPbrtInput *passed) {
  vl_export_lose(x,
                 "diffuse transmission: without reflection at the surface, halves of the "
                 "light each way");
  PUT("\"diffusetransmission\"");
  vl_pbrt_put_color(x, "reflectance", color);
  vl_pbrt_put_color(x, "transmittance", passed);
  PUT(" \"float scale\" [0.5]");
}

static void put_coat(vlExport *x, float transmission, double eta, const vlPbrtInput *color,
                     const vlPbrtInput *alpha) {
  vl_export_lose(x, "principled dielectrics: as coateddiffuse, brighter below the coat");
  if (transmission > 0)
    vl_export_lose(x, "surfaces that pass a part of light: opaque");
  PUT("\"coateddiffuse\"");
  vl_pbrt_put_color(x, "reflectance", color);
  vl_pbrt_put_number(x, "roughness", alpha);
  PUT(" \"bool remaproughness\" false \"float eta\" [%.9g] \"float thickness\" [0] "
      "\"integer maxdepth\" [100]",
      eta);
}

/* The non-metallic part of the principled material. name: the material's. */
static bool put_dielectric(vlExport *x, const vlMaterialDef *m, const char *name) {
  const vlPrincipledDef *p = &m->principled;
  vlPbrtInput color, passed, alpha, height;
  const float transmission = vl_export_number(x, &p->transmission);
  double eta = (double)vl_export_eta(&m->eta.value);
  eta = eta > 1 ? eta : 1.5;
  const bool reflects = p->specular.texture.index || p->specular.value != 0;
  float mean_alpha = 0;
  Stand stand = STAND_COATED;
  if (transmission >= 0.5f) {
    stand = STAND_GLASS;
  } else if (vl_export_is_on(&p->diffuse_transmission)) {
    stand = STAND_LEAF;
  } else {
    mean_alpha = vl_export_mean_square(x, &p->roughness);
    if (!reflects || mean_alpha > 0.15f)
      stand = STAND_MATTE;
  }
  /* the albedo of the reflection that a diffuse surface lacks is added to its colour */
  const float white =
      stand == STAND_MATTE && reflects ? specular_albedo(x, p, eta, mean_alpha) : 0;
  bool fine = stand == STAND_COATED
                  ? vl_pbrt_prepare_under_coat(x, &m->reflectance, eta, &color)
                  : vl_pbrt_prepare_raised(x, &m->reflectance, white, &color);
  fine = fine && vl_pbrt_prepare_color(x, &p->diffuse_transmission_color, &passed) &&
         vl_pbrt_prepare_number(x, &p->roughness, true, &alpha) &&
         vl_pbrt_prepare_number(x, &m->displacement, false, &height);
  if (!fine)
    return false;
  PUT("MakeNamedMaterial \"%s\" \"string type\" ", name);
  switch (stand) {
    case STAND_GLASS:
      put_clear(x, m, transmission, eta, &alpha);
      break;
    case STAND_LEAF:
      put_half_leaf(x, &color, &passed);
      break;
    case STAND_MATTE:
      if (reflects)
        vl_export_lose(x, "rough principled dielectrics: as diffuse of the same albedo");
      PUT("\"diffuse\"");
      vl_pbrt_put_color(x, "reflectance", &color);
      break;
    case STAND_COATED:
      put_coat(x, transmission, eta, &color, &alpha);
      break;
  }
  fine = put_bumps(x, m, &height);
  PUT("\n");
  return fine;
}

static bool put_metal_part(vlExport *x, const vlMaterialDef *m, const char *name) {
  vlPbrtInput color, alpha, height;
  if (!vl_pbrt_prepare_metal(x, &m->reflectance,
                             vl_export_mean_square(x, &m->principled.roughness), &color) ||
      !vl_pbrt_prepare_number(x, &m->principled.roughness, true, &alpha) ||
      !vl_pbrt_prepare_number(x, &m->displacement, false, &height))
    return false;
  vl_export_lose(x, "principled metals: as conductors of that mean reflectance");
  PUT("MakeNamedMaterial \"%s\" \"string type\" \"conductor\"", name);
  vl_pbrt_put_color(x, "reflectance", &color);
  vl_pbrt_put_number(x, "roughness", &alpha);
  PUT(" \"bool remaproughness\" false");
  bool fine = put_bumps(x, m, &height);
  PUT("\n");
  return fine;
}

static bool put_principled(vlExport *x, const vlMaterialDef *m, uint32_t id) {
  char name[64], a[64], b[64];
  const vlFloatInput *metallic = &m->principled.metallic;
  count_losses(x, m);
  snprintf(name, sizeof name, "material%u", id);
  const vlTextureDef *t = vl_export_texture(x, metallic->texture);
  bool textured = metallic->texture.index &&
                  !(t && t->bias == 0 && t->channel >= 0 && t->tint[t->channel] == 0);
  float value = metallic->texture.index ? vl_export_number(x, metallic) : metallic->value;
  if (!textured && value <= 0)
    return put_dielectric(x, m, name);
  if (!textured && value >= 1)
    return put_metal_part(x, m, name);
  vlPbrtInput amount;
  snprintf(a, sizeof a, "material%u-dielectric", id);
  snprintf(b, sizeof b, "material%u-metal", id);
  if (!put_dielectric(x, m, a) || !put_metal_part(x, m, b) ||
      !vl_pbrt_prepare_number(x, metallic, false, &amount))
    return false;
  PUT("MakeNamedMaterial \"%s\" \"string type\" \"mix\" \"string materials\" [\"%s\" \"%s\"]",
      name, a, b);
  vl_pbrt_put_number(x, "amount", &amount);
  PUT("\n");
  return true;
}

/* ---- pbrt's own -------------------------------------------------------------------------- */

/* Of alternative parameters, only the one that has an effect is written, even if it has its
 * default. */
static vlPbrtWished one_of(bool counts) {
  return counts ? VL_PBRT_ALWAYS : VL_PBRT_NEVER;
}

static vlPbrtWished metal_wish(const void *def, const vlParameter *p) {
  const vlMaterialDef *m = def;
  if (p->offset == offsetof(vlMaterialDef, reflectance))
    return one_of(m->use_reflectance);
  if (p->offset == offsetof(vlMaterialDef, eta) || p->offset == offsetof(vlMaterialDef, k))
    return one_of(!m->use_reflectance);
  return VL_PBRT_UNLESS_DEFAULT;
}

static vlPbrtWished hair_wish(const void *def, const vlParameter *p) {
  vlHairColor color = ((const vlMaterialDef *)def)->hair.color;
  if (p->offset == offsetof(vlMaterialDef, hair.sigma_a))
    return one_of(color == VL_HAIR_SIGMA_A);
  if (p->offset == offsetof(vlMaterialDef, reflectance))
    return one_of(color == VL_HAIR_REFLECTANCE);
  if (p->offset == offsetof(vlMaterialDef, hair.eumelanin) ||
      p->offset == offsetof(vlMaterialDef, hair.pheomelanin))
    return one_of(color == VL_HAIR_MELANIN);
  return VL_PBRT_UNLESS_DEFAULT;
}

static vlPbrtWished subsurface_wish(const void *def, const vlParameter *p) {
  bool from_reflectance = ((const vlMaterialDef *)def)->subsurface.from_reflectance;
  if (p->offset == offsetof(vlMaterialDef, reflectance) ||
      p->offset == offsetof(vlMaterialDef, subsurface.mfp))
    return one_of(from_reflectance);
  if (p->offset == offsetof(vlMaterialDef, subsurface.sigma_a) ||
      p->offset == offsetof(vlMaterialDef, subsurface.sigma_s))
    return one_of(!from_reflectance);
  return VL_PBRT_UNLESS_DEFAULT;
}

static vlPbrtWish *const wishes[0 VL_MATERIAL_KINDS(VL_COUNT_KIND)] = {
    [VL_MATERIAL_CONDUCTOR] = metal_wish,
    [VL_MATERIAL_COATED_CONDUCTOR] = metal_wish,
    [VL_MATERIAL_HAIR] = hair_wish,
    [VL_MATERIAL_SUBSURFACE] = subsurface_wish};

static bool put_own(vlExport *x, const vlMaterialDef *m, uint32_t id) {
  vlPbrtParameter list[VL_PBRT_PARAMETERS];
  const vlKindRow *row = vl_kind_row(&vl_material_family, (int)m->kind);
  if (!vl_pbrt_prepare(x, row, m, true, wishes[m->kind], 0, list))
    return false;
  PUT("MakeNamedMaterial \"material%u\" \"string type\" \"%s\"", id, row->name);
  if (m->kind == VL_MATERIAL_MIX)
    PUT(" \"string materials\" [\"material%u\" \"material%u\"]", m->materials[0].index,
        m->materials[1].index);
  vl_pbrt_put(x, row, m, true, list);
  PUT("\n");
  return true;
}

bool vl_pbrt_material(vlExport *x, uint32_t id) {
  const vlMaterialDef *m = &x->scene->materials.items[id - 1];
  return m->kind == VL_MATERIAL_PRINCIPLED ? put_principled(x, m, id) : put_own(x, m, id);
}
