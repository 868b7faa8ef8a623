/* material/layers.hot.h: the coat, base and medium of one lane of a layered material, for the
 * random walks of layered.hot.c. Scalar code.
 *
 * The outside of the coat is z > 0. Between coat and base, directions may point up or down; the
 * base reflects upwards. "f" is the BSDF's value without the cosine. */
#ifndef MATERIAL_LAYERS_HOT_H
#define MATERIAL_LAYERS_HOT_H

#include "material/local.hot.h"
#include "math/hash.h"
#include "math/vec.h"
#include "trace/medium/phase.h"

typedef struct Layers {
  float ax, ay, eta; /* coat */
  int smooth;
  int metal, mirror; /* kind of the base; a mirror is a smooth metal */
  float bx, by, e[4], k[4], rho[4];
  /* the medium's optical thickness, asymmetry g and single-scattering albedo */
  float thickness, g, albedo[4];
  int scatters;
  uint32_t depth, walks;
} Layers;

static inline Layers layers_of(const vlBsdfParams *p, uint32_t i) {
  Layers l;
  l.ax = p->alpha_x[i];
  l.ay = p->alpha_y[i];
  l.eta = p->eta_s[i];
  l.smooth = vl_ggx_is_smooth(l.ax, l.ay) | (l.eta == 1.0f);
  l.ax = vl_ggx_alpha(l.ax);
  l.ay = vl_ggx_alpha(l.ay);
  l.metal = p->own[VL_L_METAL][i] > 0.0f;
  l.bx = p->own[VL_L_BASE_X][i];
  l.by = p->own[VL_L_BASE_Y][i];
  l.mirror = l.metal & vl_ggx_is_smooth(l.bx, l.by);
  l.bx = vl_ggx_alpha(l.bx);
  l.by = vl_ggx_alpha(l.by);
  l.scatters = 0;
  for (int c = 0; c < 4; c++) {
    l.e[c] = l.metal ? p->eta[c][i] : 0.0f;
    l.k[c] = l.metal ? p->k[c][i] : 0.0f;
    l.rho[c] = l.metal ? 0.0f : p->reflectance[c][i];
    l.albedo[c] = p->own[VL_L_ALBEDO + c][i];
    l.scatters |= l.albedo[c] > 0.0f;
  }
  l.thickness = p->own[VL_L_THICKNESS][i];
  l.g = p->own[VL_L_G][i];
  l.scatters &= l.thickness > 0.0f;
  l.depth = (uint32_t)p->own[VL_L_DEPTH][i];
  l.walks = (uint32_t)p->own[VL_L_WALKS][i];
  l.walks = l.walks > 0 ? l.walks : 1;
  return l;
}

/* Transmittance of a slab in direction w. distance: the slab's optical thickness. */
static inline float layers_pass(float distance, vlVec3 w) {
  float z = vl_abs(w.z);
  return distance > 0.0f ? vl_exp(-distance / vl_max(z, VL_MIN_FRACTION)) : 1.0f;
}

/* ---- the coat ---------------------------------------------------------------------------- */

typedef struct Step {
  vlVec3 w;
  float weight[4]; /* f cos / pdf */
  float pdf;       /* per solid angle; 1 for a delta */
  int valid;
} Step;

/* Samples transmission from outside through the coat, without the factor 1/eta^2 of radiance.
 * Reflection is never sampled. */
static inline Step coat_enter(const Layers *l, vlVec3 o, float u, float v) {
  vlVec3 h = l->smooth ? vl_vec3(0, 0, 1) : vl_ggx_sample(o, l->ax, l->ay, u, v);
  float oh = vl_dot(o, h), inverse = 1.0f / l->eta;
  vlFresnel f = vl_fresnel_dielectric(oh, l->eta);
  float cos_t = f.root * inverse, t = oh * inverse - cos_t, t2 = vl_max(t * t, VL_MIN_POSITIVE);
  Step s;
  s.w = vl_vec3(t * h.x - inverse * o.x, t * h.y - inverse * o.y, t * h.z - inverse * o.z);
  float lo = vl_ggx_length(o, l->ax, l->ay), li = vl_ggx_length(s.w, l->ax, l->ay);
  float through = l->eta == 1.0f ? 1.0f : 1.0f - f.reflected;
  float g = through * (l->smooth ? 1.0f : vl_ggx_shadowing(o.z, lo, vl_abs(s.w.z), li));
  for (int c = 0; c < 4; c++)
    s.weight[c] = g;
  s.pdf = l->smooth ? 1.0f : vl_ggx_visible(h, l->ax, l->ay, o.z, lo) * oh * cos_t / t2;
  s.valid = (oh > 0.0f) & (s.w.z < 0.0f) & (g > 0.0f);
  return s;
}

/* f of transmission through a rough coat, from o outside to w below the coat, and the density
 * with which coat_enter samples w. By reciprocity it is also f of radiance that travels from -w
 * to o. */
static inline float coat_transmit(const Layers *l, vlVec3 o, vlVec3 w, float *pdf) {
  float inverse = 1.0f / l->eta;
  /* away from the denser side */
  vlVec3 h = vl_normalize(vl_vec3(o.x + l->eta * w.x, o.y + l->eta * w.y, o.z + l->eta * w.z));
  if (h.z < 0.0f)
    h = vl_neg(h);
  float oh = vl_dot(o, h), ih = vl_dot(w, h);
  *pdf = 0.0f;
  if (!(oh > 0.0f) || !(ih < 0.0f) || !(w.z < 0.0f))
    return 0.0f;
  float lo = vl_ggx_length(o, l->ax, l->ay), li = vl_ggx_length(w, l->ax, l->ay);
  float t = ih + oh * inverse, jacobian = oh * -ih / vl_max(t * t, VL_MIN_POSITIVE);
  *pdf = vl_ggx_visible(h, l->ax, l->ay, o.z, lo) * jacobian;
  float g = vl_ggx_shadowing(o.z, lo, -w.z, li);
  return (1.0f - vl_fresnel_dielectric(oh, l->eta).reflected) * g * *pdf / -w.z;
}

/* Samples reflection at the coat of a direction from below (w.z > 0) back down. Transmission is
 * never sampled. */
static inline Step coat_back(const Layers *l, vlVec3 w, float u, float v) {
  vlVec3 o = vl_vec3(-w.x, -w.y, w.z); /* mirrored at the surface, as if it came from above */
  vlVec3 h = l->smooth ? vl_vec3(0, 0, 1) : vl_ggx_sample(o, l->ax, l->ay, u, v);
  float oh = vl_dot(o, h);
  vlVec3 r = vl_reflect(o, h, oh);
  float lo = vl_ggx_length(o, l->ax, l->ay), li = vl_ggx_length(r, l->ax, l->ay);
  float f = l->eta == 1.0f ? 0.0f : vl_fresnel_dielectric(oh, 1.0f / l->eta).reflected;
  float g = f * (l->smooth ? 1.0f : vl_ggx_shadowing(o.z, lo, r.z, li));
  Step s = {
      vl_vec3(r.x, r.y, -r.z), {g, g, g, g}, 0.0f, (oh > 0.0f) & (r.z > 0.0f) & (g > 0.0f)};
  return s;
}

/* Reflection at the outside of a rough coat. Returns f cos and sets *pdf to its density. */
static inline float coat_reflection(const Layers *l, vlVec3 o, vlVec3 w, float *pdf) {
  *pdf = 0.0f;
  if (l->smooth)
    return 0.0f;
  vlVec3 h = vl_normalize(vl_add(o, w));
  float lo = vl_ggx_length(o, l->ax, l->ay), li = vl_ggx_length(w, l->ax, l->ay);
  *pdf = 0.25f * vl_ggx_visible(h, l->ax, l->ay, o.z, lo);
  return vl_fresnel_dielectric(vl_dot(o, h), l->eta).reflected * *pdf *
         vl_ggx_shadowing(o.z, lo, w.z, li);
}

/* ---- the base ---------------------------------------------------------------------------- */

/* f of the base between o and i, which both point up. The base must not be a mirror. */
static inline void base_eval(const Layers *l, vlVec3 o, vlVec3 i, float f[4], float *pdf) {
  if (!l->metal) {
    *pdf = i.z * VL_INV_PI;
    for (int c = 0; c < 4; c++)
      f[c] = l->rho[c] * VL_INV_PI;
    return;
  }
  vlVec3 h = vl_normalize(vl_add(o, i));
  float oh = vl_dot(o, h), lo = vl_ggx_length(o, l->bx, l->by),
        li = vl_ggx_length(i, l->bx, l->by);
  *pdf = 0.25f * vl_ggx_visible(h, l->bx, l->by, o.z, lo);
  float g = *pdf * vl_ggx_shadowing(o.z, lo, i.z, li) / vl_max(i.z, VL_MIN_POSITIVE);
  for (int c = 0; c < 4; c++)
    f[c] = g * vl_fresnel_conductor(oh, l->e[c], l->k[c]);
}

static inline Step base_sample(const Layers *l, vlVec3 o, float u, float v) {
  Step s;
  if (!l->metal) {
    s.w = vl_cosine_direction(u, v);
    s.pdf = s.w.z * VL_INV_PI;
    for (int c = 0; c < 4; c++)
      s.weight[c] = l->rho[c];
    s.valid = 1;
    return s;
  }
  vlVec3 h = l->mirror ? vl_vec3(0, 0, 1) : vl_ggx_sample(o, l->bx, l->by, u, v);
  float oh = vl_dot(o, h), lo = vl_ggx_length(o, l->bx, l->by);
  s.w = vl_reflect(o, h, oh);
  float g =
      l->mirror ? 1.0f : vl_ggx_shadowing(o.z, lo, s.w.z, vl_ggx_length(s.w, l->bx, l->by));
  s.pdf = l->mirror ? 1.0f : 0.25f * vl_ggx_visible(h, l->bx, l->by, o.z, lo);
  for (int c = 0; c < 4; c++)
    s.weight[c] = g * vl_fresnel_conductor(oh, l->e[c], l->k[c]);
  s.valid = (oh > 0.0f) & (s.w.z > 0.0f);
  return s;
}

#endif
