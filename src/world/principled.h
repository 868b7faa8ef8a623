/* world/principled.h: what the principled material needs of tables: how much a rough layer reflects in all directions
 * together, so that what lies below gets the rest and nothing is lost or won.
 *
 *   specular  E(w) = F0 a(w) + F90 b(w): GGX with single scattering and Schlick's Fresnel term, split into its two ends
 *             (Karis 2013, "Real Shading in Unreal Engine 4"); a + b: for F = 1
 *   sheen     the "Charlie" distribution with its shadowing (Estevez and Kulla 2017, "Production Friendly Microfacet
 *             Sheen BRDF")
 * Means are over the cosine-weighted hemisphere: int E 2 cos dcos (Kulla and Conty 2017). */
#ifndef WORLD_PRINCIPLED_H
#define WORLD_PRINCIPLED_H

#include "math/approx.h"
#include "math/vec.h"

enum { VL_ALBEDO_COS = 64, VL_ALBEDO_ALPHA = 32 };

/* Row: sqrt(alpha) in equal steps over [0, 1]; column: sqrt(cos) likewise. Linear between. */
typedef struct vlPrincipledTables {
  float a[VL_ALBEDO_ALPHA][VL_ALBEDO_COS], b[VL_ALBEDO_ALPHA][VL_ALBEDO_COS];
  float a_mean[VL_ALBEDO_ALPHA], b_mean[VL_ALBEDO_ALPHA];
  float sheen[VL_ALBEDO_ALPHA][VL_ALBEDO_COS], sheen_mean[VL_ALBEDO_ALPHA];
} vlPrincipledTables;

/* Computed by tools/albedo_tables as the library is built. The sheen's exceeds 1 where it is narrow and light grazes:
 * there it must be scaled down; its mean is of min(E, 1). */
extern const vlPrincipledTables vl_principled_tables;

/* Where a value lies between two entries. */
typedef struct vlAlbedoPlace {
  uint32_t first;
  float t;
} vlAlbedoPlace;
static inline vlAlbedoPlace vl_albedo_place(float x, uint32_t count) {
  float c = x > 0.0f ? x : 0.0f; /* NaN to 0 too */
  c = __builtin_sqrtf(c < 1.0f ? c : 1.0f) * (float)(count - 1);
  uint32_t first = (uint32_t)c;
  first = first < count - 2 ? first : count - 2;
  return (vlAlbedoPlace){first, c - (float)first};
}
static inline float vl_albedo_at(const float table[][VL_ALBEDO_COS], vlAlbedoPlace alpha, vlAlbedoPlace cosine) {
  const float *p = table[alpha.first] + cosine.first, *q = p + VL_ALBEDO_COS;
  float low = p[0] + cosine.t * (p[1] - p[0]), high = q[0] + cosine.t * (q[1] - q[0]);
  return low + alpha.t * (high - low);
}
static inline float vl_albedo_mean(const float *mean, vlAlbedoPlace alpha) {
  return mean[alpha.first] + alpha.t * (mean[alpha.first + 1] - mean[alpha.first]);
}

static inline float vl_schlick_weight(float cosine) {
  float m = 1.0f - cosine;
  m = m > 0.0f ? m : 0.0f;
  float m2 = m * m;
  return m2 * m2 * m;
}

/* ---- sheen ------------------------------------------------------------------------------------------------------- */

/* Narrower is not told apart from none. */
#define VL_SHEEN_ALPHA 0.005f

/* ln of 1 + Lambda's fit, L(x) of Estevez and Kulla: curves for alpha 0 and 1, mixed by (1 - alpha)^2. */
static inline float vl_sheen_curve(float x, float alpha) {
  float s = (1.0f - alpha) * (1.0f - alpha), t = 1.0f - s;
  float a = 25.3245f * s + 21.5473f * t, b = 3.32435f * s + 3.82987f * t, c = 0.16801f * s + 0.19823f * t;
  float d = -1.27393f * s - 1.97760f * t, e = -4.85967f * s - 4.32054f * t;
  return a / (1.0f + b * vl_pow(x, c)) + d * x + e;
}
static inline float vl_sheen_lambda(float cosine, float alpha) {
  float half = vl_sheen_curve(0.5f, alpha), c = cosine < 0.5f ? cosine : 1.0f - cosine;
  float curve = vl_sheen_curve(c > 1e-6f ? c : 1e-6f, alpha);
  return vl_exp(cosine < 0.5f ? curve : 2.0f * half - curve);
}
/* f cos_i for cosines > 0; h: cosine of the half vector. */
static inline float vl_sheen(float o, float i, float h, float alpha) {
  alpha = alpha > VL_SHEEN_ALPHA ? alpha : VL_SHEEN_ALPHA;
  float inverse = 1.0f / alpha, sin2 = 1.0f - h * h;
  float d = (2.0f + inverse) * vl_pow(sin2 > 1e-12f ? sin2 : 1e-12f, 0.5f * inverse) * (0.5f * VL_INV_PI);
  float g = 1.0f / (1.0f + vl_sheen_lambda(o, alpha) + vl_sheen_lambda(i, alpha));
  return d * g / (4.0f * (o > 1e-6f ? o : 1e-6f));
}

#endif
