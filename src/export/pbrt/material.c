/* export/pbrt/material.c: materials as pbrt-v4's: its own as they are, the principled one as the nearest. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "export/pbrt/pbrt.h"

typedef struct Inputs {
  vlPbrtInput color, second, albedo, u, v, coat_u, coat_v, thickness, g, amount, relief, sigma_a, sigma_s, mfp;
} Inputs;

/* "" for what has no texture, else its directives are written here, before the material's. */
static bool prepare(vlExport *x, const vlMaterialDef *m, Inputs *in) {
  return vl_pbrt_prepare_color(x, &m->reflectance, &in->color) &&
         vl_pbrt_prepare_color(x, &m->transmittance, &in->second) &&
         vl_pbrt_prepare_color(x, &m->albedo, &in->albedo) &&
         vl_pbrt_prepare_number(x, &m->u_roughness, false, &in->u) &&
         vl_pbrt_prepare_number(x, &m->v_roughness, false, &in->v) &&
         vl_pbrt_prepare_number(x, &m->coat_u_roughness, false, &in->coat_u) &&
         vl_pbrt_prepare_number(x, &m->coat_v_roughness, false, &in->coat_v) &&
         vl_pbrt_prepare_number(x, &m->thickness, false, &in->thickness) &&
         vl_pbrt_prepare_number(x, &m->g, false, &in->g) && vl_pbrt_prepare_number(x, &m->amount, false, &in->amount) &&
         vl_pbrt_prepare_color(x, &m->subsurface.sigma_a, &in->sigma_a) &&
         vl_pbrt_prepare_color(x, &m->subsurface.sigma_s, &in->sigma_s) &&
         vl_pbrt_prepare_color(x, &m->subsurface.mfp, &in->mfp);
}

static void put_eta(vlExport *x, const char *name, const vlSpectrum *eta) {
  if (eta->kind == VL_SPECTRUM_CONSTANT)
    PUT(" \"float %s\" [%.9g]", name, (double)eta->value * (double)eta->scale);
  else
    vl_pbrt_spectrum(x, name, eta);
}

static void put_roughness(vlExport *x, const vlMaterialDef *m, const Inputs *in) {
  vl_pbrt_put_number(x, "uroughness", &in->u);
  vl_pbrt_put_number(x, "vroughness", &in->v);
  PUT(" \"bool remaproughness\" %s", m->remap_roughness ? "true" : "false");
}

static void put_coat(vlExport *x, const vlMaterialDef *m, const Inputs *in) {
  vl_pbrt_put_number(x, "thickness", &in->thickness);
  vl_pbrt_put_number(x, "g", &in->g);
  vl_pbrt_put_color(x, "albedo", &in->albedo);
  PUT(" \"integer maxdepth\" [%u] \"integer nsamples\" [%u]", m->max_depth, m->samples);
  if (m->conserve_energy) PUT(" \"bool conserveenergy\" true");
}

static void put_metal(vlExport *x, const vlMaterialDef *m, const Inputs *in, const char *eta, const char *k) {
  if (m->use_reflectance) {
    vl_pbrt_put_color(x, "reflectance", &in->color);
    return;
  }
  if (m->eta.texture.index || m->k.texture.index) vl_export_lose(x, "textured eta and k: values stand in");
  vl_pbrt_spectrum(x, eta, &m->eta.value);
  vl_pbrt_spectrum(x, k, &m->k.value);
}

/* ---- principled -------------------------------------------------------------------------------------------------- */

static bool is_on(const vlFloatInput *input) {
  return input->texture.index || input->value > 0;
}

static void count_losses(vlExport *x, const vlMaterialDef *m) {
  const vlPrincipledDef *p = &m->principled;
  float rgb[3];
  if (is_on(&p->clearcoat)) vl_export_lose(x, "clear coats: left out");
  vl_export_rgb(x, &p->sheen_color, rgb);
  if (p->sheen_color.texture.index || rgb[0] + rgb[1] + rgb[2] > 0) vl_export_lose(x, "sheen: left out");
  if (is_on(&p->iridescence)) vl_export_lose(x, "iridescence: left out");
  if (is_on(&p->anisotropy)) vl_export_lose(x, "anisotropy of principled materials: left out");
  if (p->dispersion > 0) vl_export_lose(x, "dispersion: left out");
  vl_export_rgb(x, &p->specular_color, rgb);
  if (p->specular_color.texture.index || rgb[0] != 1 || rgb[1] != 1 || rgb[2] != 1 || p->specular.texture.index ||
      (p->specular.value != 1 && p->specular.value != 0))
    vl_export_lose(x, "strength and colour of dielectrics' reflection: left out");
  if (p->clearcoat_normal.index || (p->normal.index && p->normal_scale != 1))
    vl_export_lose(x, "normal maps' scale, and those of coats: left out");
}

static bool put_normal(vlExport *x, const vlMaterialDef *m) {
  const vlTextureDef *t = vl_export_texture(x, m->principled.normal);
  char name[300];
  if (!t) return true;
  if (!vl_pbrt_image(x, t, false, name)) return false;
  PUT(" \"string normalmap\" \"%s\"", name);
  return true;
}

/* The part that is no metal. name: of the material. */
static bool put_dielectric(vlExport *x, const vlMaterialDef *m, const char *name) {
  const vlPrincipledDef *p = &m->principled;
  vlPbrtInput color, passed, alpha;
  float transmission = vl_export_number(x, &p->transmission), rgb[3];
  double eta = (double)vl_export_eta(&m->eta.value);
  vl_export_rgb(x, &m->reflectance, rgb);
  eta = eta > 1 ? eta : 1.5;
  bool clear = transmission >= 0.5f, leaf = is_on(&p->diffuse_transmission);
  bool bare = (!p->specular.texture.index && p->specular.value == 0) ||
              (!p->roughness.texture.index && p->roughness.value * p->roughness.value > 0.15f);
  bool coated = !clear && !leaf && !bare;
  if (!(coated ? vl_pbrt_prepare_under_coat(x, &m->reflectance, eta, &color)
               : vl_pbrt_prepare_color(x, &m->reflectance, &color)) ||
      !vl_pbrt_prepare_color(x, &p->diffuse_transmission_color, &passed) ||
      !vl_pbrt_prepare_number(x, &p->roughness, true, &alpha))
    return false;
  PUT("MakeNamedMaterial \"%s\" \"string type\" ", name);
  if (clear) {
    if (m->reflectance.texture.index || rgb[0] != 1 || rgb[1] != 1 || rgb[2] != 1)
      vl_export_lose(x, "colour of glass at its surface: left out");
    if (transmission < 1 || p->transmission.texture.index)
      vl_export_lose(x, "surfaces that pass a part of light: glass");
    PUT("\"%s\" \"float eta\" [%.9g]", p->thin_walled ? "thindielectric" : "dielectric", eta);
    if (!p->thin_walled) {
      vl_pbrt_put_number(x, "roughness", &alpha);
      PUT(" \"bool remaproughness\" false");
    } else if (alpha.texture[0] || alpha.number > 1e-4f) {
      vl_export_lose(x, "rough sheets of glass: smooth");
    }
  } else if (leaf) {
    vl_export_lose(x, "diffuse transmission: without reflection at the surface, halves of the light each way");
    PUT("\"diffusetransmission\"");
    vl_pbrt_put_color(x, "reflectance", &color);
    vl_pbrt_put_color(x, "transmittance", &passed);
    PUT(" \"float scale\" [0.5]");
  } else if (bare) {
    /* pbrt's coats lose light when they are rough; plain diffuse is nearer */
    if (p->specular.texture.index || p->specular.value != 0)
      vl_export_lose(x, "rough principled dielectrics: as diffuse");
    PUT("\"diffuse\"");
    vl_pbrt_put_color(x, "reflectance", &color);
  } else {
    vl_export_lose(x, "principled dielectrics: as coateddiffuse, brighter below the coat");
    if (transmission > 0) vl_export_lose(x, "surfaces that pass a part of light: opaque");
    PUT("\"coateddiffuse\"");
    vl_pbrt_put_color(x, "reflectance", &color);
    vl_pbrt_put_number(x, "roughness", &alpha);
    PUT(" \"bool remaproughness\" false \"float eta\" [%.9g] \"float thickness\" [0] \"integer maxdepth\" [100]", eta);
  }
  bool fine = put_normal(x, m);
  PUT("\n");
  return fine;
}

static bool put_metal_part(vlExport *x, const vlMaterialDef *m, const char *name) {
  vlPbrtInput color, alpha;
  if (!vl_pbrt_prepare_color(x, &m->reflectance, &color) ||
      !vl_pbrt_prepare_number(x, &m->principled.roughness, true, &alpha))
    return false;
  vl_export_lose(x, "principled metals: as conductors of that reflectance");
  PUT("MakeNamedMaterial \"%s\" \"string type\" \"conductor\"", name);
  vl_pbrt_put_color(x, "reflectance", &color);
  vl_pbrt_put_number(x, "roughness", &alpha);
  PUT(" \"bool remaproughness\" false");
  bool fine = put_normal(x, m);
  PUT("\n");
  return fine;
}

static bool put_principled(vlExport *x, const vlMaterialDef *m, uint32_t id) {
  char name[64], a[64], b[64];
  const vlFloatInput *metallic = &m->principled.metallic;
  count_losses(x, m);
  snprintf(name, sizeof name, "material%u", id);
  const vlTextureDef *t = vl_export_texture(x, metallic->texture);
  bool textured = metallic->texture.index && !(t && t->bias == 0 && t->channel >= 0 && t->tint[t->channel] == 0);
  float value = metallic->texture.index ? vl_export_number(x, metallic) : metallic->value;
  if (!textured && value <= 0) return put_dielectric(x, m, name);
  if (!textured && value >= 1) return put_metal_part(x, m, name);
  vlPbrtInput amount;
  snprintf(a, sizeof a, "material%u-dielectric", id);
  snprintf(b, sizeof b, "material%u-metal", id);
  if (!put_dielectric(x, m, a) || !put_metal_part(x, m, b) || !vl_pbrt_prepare_number(x, metallic, false, &amount))
    return false;
  PUT("MakeNamedMaterial \"%s\" \"string type\" \"mix\" \"string materials\" [\"%s\" \"%s\"]", name, a, b);
  vl_pbrt_put_number(x, "amount", &amount);
  PUT("\n");
  return true;
}

/* ---- pbrt's own -------------------------------------------------------------------------------------------------- */

static bool put_own(vlExport *x, const vlMaterialDef *m, uint32_t id) {
  Inputs in;
  char normal[300] = "", measured[300] = "";
  if (!prepare(x, m, &in)) return false;
  if (m->displacement.texture.index && !vl_pbrt_prepare_number(x, &m->displacement, false, &in.relief)) return false;
  if (m->normal_map) {
    vlTextureDef t = vl_default_texture_def(VL_TEXTURE_IMAGE, true);
    t.path = m->normal_map;
    if (!vl_pbrt_image(x, &t, false, normal)) return false;
  }
  if (m->kind == VL_MATERIAL_MEASURED) { /* copied as images are */
    vlTextureDef t = vl_default_texture_def(VL_TEXTURE_IMAGE, true);
    t.path = m->measured;
    if (!vl_pbrt_image(x, &t, false, measured)) return false;
  }
  PUT("MakeNamedMaterial \"material%u\" \"string type\" ", id);
  switch (m->kind) {
    case VL_MATERIAL_DIFFUSE:
      PUT("\"diffuse\"");
      vl_pbrt_put_color(x, "reflectance", &in.color);
      break;
    case VL_MATERIAL_COATED_DIFFUSE:
      PUT("\"coateddiffuse\"");
      vl_pbrt_put_color(x, "reflectance", &in.color);
      put_roughness(x, m, &in);
      put_eta(x, "eta", &m->eta.value);
      put_coat(x, m, &in);
      break;
    case VL_MATERIAL_CONDUCTOR:
      PUT("\"conductor\"");
      put_metal(x, m, &in, "eta", "k");
      put_roughness(x, m, &in);
      break;
    case VL_MATERIAL_COATED_CONDUCTOR:
      PUT("\"coatedconductor\"");
      put_metal(x, m, &in, "conductor.eta", "conductor.k");
      vl_pbrt_put_number(x, "conductor.uroughness", &in.u);
      vl_pbrt_put_number(x, "conductor.vroughness", &in.v);
      vl_pbrt_put_number(x, "interface.uroughness", &in.coat_u);
      vl_pbrt_put_number(x, "interface.vroughness", &in.coat_v);
      PUT(" \"bool remaproughness\" %s", m->remap_roughness ? "true" : "false");
      put_eta(x, "interface.eta", &m->coat_eta.value);
      put_coat(x, m, &in);
      break;
    case VL_MATERIAL_DIELECTRIC:
      PUT("\"dielectric\"");
      put_eta(x, "eta", &m->eta.value);
      put_roughness(x, m, &in);
      break;
    case VL_MATERIAL_THIN_DIELECTRIC:
      PUT("\"thindielectric\"");
      put_eta(x, "eta", &m->eta.value);
      break;
    case VL_MATERIAL_DIFFUSE_TRANSMISSION:
      PUT("\"diffusetransmission\"");
      vl_pbrt_put_color(x, "reflectance", &in.color);
      vl_pbrt_put_color(x, "transmittance", &in.second);
      PUT(" \"float scale\" [%.9g]", (double)m->scale);
      break;
    case VL_MATERIAL_MIX:
      PUT("\"mix\" \"string materials\" [\"material%u\" \"material%u\"]", m->materials[0].index, m->materials[1].index);
      vl_pbrt_put_number(x, "amount", &in.amount);
      break;
    case VL_MATERIAL_MEASURED: PUT("\"measured\" \"string filename\" \"%s\"", measured); break;
    case VL_MATERIAL_SUBSURFACE:
      PUT("\"subsurface\"");
      if (m->subsurface.from_reflectance) {
        vl_pbrt_put_color(x, "reflectance", &in.color);
        vl_pbrt_put_color(x, "mfp", &in.mfp);
      } else {
        vl_pbrt_put_color(x, "sigma_a", &in.sigma_a);
        vl_pbrt_put_color(x, "sigma_s", &in.sigma_s);
      }
      PUT(" \"float scale\" [%.9g]", (double)m->scale);
      vl_pbrt_put_number(x, "g", &in.g);
      put_eta(x, "eta", &m->eta.value);
      put_roughness(x, m, &in);
      break;
    case VL_MATERIAL_INTERFACE: PUT("\"interface\""); break;
    default:
      vl_export_lose(x, "materials of further kinds: grey");
      PUT("\"diffuse\"");
      break;
  }
  if (m->displacement.texture.index && in.relief.texture[0]) vl_pbrt_put_number(x, "displacement", &in.relief);
  if (normal[0]) PUT(" \"string normalmap\" \"%s\"", normal);
  PUT("\n");
  return true;
}

bool vl_pbrt_material(vlExport *x, uint32_t id) {
  const vlMaterialDef *m = &x->scene->materials.items[id - 1];
  return m->kind == VL_MATERIAL_PRINCIPLED ? put_principled(x, m, id) : put_own(x, m, id);
}
