/* material/principled.h: directional albedo tables of the principled material: the share
 * of light that a rough layer reflects into all directions. The layers below it receive the
 * rest, so that energy is conserved.
 *
 *   specular  E(w) = F0 a(w) + F90 b(w): GGX with single scattering and Schlick's Fresnel term,
 *             split-sum form (Karis 2013, "Real Shading in Unreal Engine 4"); a + b is E for
 *             F = 1
 *   sheen     the "Charlie" distribution with its shadowing (Estevez and Kulla 2017,
 *             "Production Friendly Microfacet Sheen BRDF")
 *   loss      share of the light incident on rough glass, from outside or inside, that a
 *             single-scattering model of reflection and refraction loses (Walter et al. 2007
 *             with the Schlick term of that index)
 *
 *   stretched values of an anisotropic layer, divided by those of the isotropic layer whose
 *             alpha is vl_base_alpha (vlStretched)
 *
 * Means are cosine-weighted averages over the hemisphere: int E 2 cos dcos (Kulla and Conty
 * 2017). */
#ifndef MATERIAL_PRINCIPLED_H
#define MATERIAL_PRINCIPLED_H

#include "math/approx.h"
#include "math/vec.h"

enum {
  VL_ALBEDO_COS = 64,
  VL_ALBEDO_ALPHA = 32,
  VL_LOSS_COS = 32,
  VL_LOSS_ALPHA = 16,
  VL_LOSS_ETA = 16,
  VL_STRETCH_RATIO = 5,
  VL_STRETCH_AZIMUTH = 5,
  VL_STRETCH_ALPHA = 8
};
#define VL_LOSS_MAX_ROOT 0.5f /* largest tabulated (eta - 1) / (eta + 1), for eta = 3 */

/* What the tables `stretched` compare: the loss 1 - a - b, b, and the loss of glass of
 * index 1.5 from outside and from inside, which stands for glass of each index. */
typedef enum vlStretched {
  VL_STRETCHED_LOSS,
  VL_STRETCHED_B,
  VL_STRETCHED_OUTSIDE,
  VL_STRETCHED_INSIDE,
  VL_STRETCHED_COUNT
} vlStretched;

/* Rows are equal steps of sqrt(alpha) over [0, 1], columns equal steps of sqrt(cos) over [0,
 * 1]. Lookups interpolate linearly. */
typedef struct vlPrincipledTables {
  float a[VL_ALBEDO_ALPHA][VL_ALBEDO_COS], b[VL_ALBEDO_ALPHA][VL_ALBEDO_COS];
  float a_mean[VL_ALBEDO_ALPHA], b_mean[VL_ALBEDO_ALPHA];
  float sheen[VL_ALBEDO_ALPHA][VL_ALBEDO_COS], sheen_mean[VL_ALBEDO_ALPHA];
  /* First index: side (0 outside, 1 inside). Second index: (eta - 1) / (eta + 1) in equal
   * steps. Then rows and columns as above. */
  float loss[2][VL_LOSS_ETA][VL_LOSS_ALPHA][VL_LOSS_COS],
      loss_mean[2][VL_LOSS_ETA][VL_LOSS_ALPHA];
  /* Indices: what is compared, sqrt of the smaller alpha over the larger one in equal steps,
   * |cos| of the azimuth to the direction of the larger alpha in equal steps, rows of the
   * larger alpha and columns as above. */
  float stretched[VL_STRETCHED_COUNT][VL_STRETCH_RATIO][VL_STRETCH_AZIMUTH][VL_STRETCH_ALPHA]
                 [VL_LOSS_COS],
      stretched_mean[VL_STRETCHED_COUNT][VL_STRETCH_RATIO][VL_STRETCH_ALPHA];
} vlPrincipledTables;

/* tools/albedo_tables computes these tables when the library is built. The sheen's albedo
 * exceeds 1 for narrow lobes at grazing angles, where lookups must scale it down; its mean is
 * that of min(E, 1). */
extern const vlPrincipledTables vl_principled_tables;

/* Position of a value between two entries. */
typedef struct vlAlbedoCell {
  uint32_t first;
  float t;
} vlAlbedoCell;
static inline vlAlbedoCell vl_albedo_cell(float x, uint32_t count) {
  float c = x > 0.0f ? x : 0.0f; /* NaN becomes 0 */
  c = __builtin_sqrtf(c < 1.0f ? c : 1.0f) * (float)(count - 1);
  uint32_t first = (uint32_t)c;
  first = first < count - 2 ? first : count - 2;
  return (vlAlbedoCell){first, c - (float)first};
}
/* Between four entries of rows with that many columns. */
static inline float vl_albedo_between(const float *rows, uint32_t columns, vlAlbedoCell alpha,
                                      vlAlbedoCell cosine) {
  const float *p = rows + alpha.first * columns + cosine.first, *q = p + columns;
  float low = p[0] + cosine.t * (p[1] - p[0]), high = q[0] + cosine.t * (q[1] - q[0]);
  return low + alpha.t * (high - low);
}
static inline float vl_albedo_at(const float table[][VL_ALBEDO_COS], vlAlbedoCell alpha,
                                 vlAlbedoCell cosine) {
  return vl_albedo_between(table[0], VL_ALBEDO_COS, alpha, cosine);
}
static inline float vl_albedo_mean(const float *mean, vlAlbedoCell alpha) {
  return mean[alpha.first] + alpha.t * (mean[alpha.first + 1] - mean[alpha.first]);
}

/* Position of the index in the tables of losses; eta >= 1. */
static inline vlAlbedoCell vl_loss_cell(float eta) {
  float c = (eta - 1.0f) / (eta + 1.0f) * ((float)(VL_LOSS_ETA - 1) / VL_LOSS_MAX_ROOT);
  c = c > 0.0f ? c : 0.0f;
  uint32_t first = c < (float)(VL_LOSS_ETA - 2) ? (uint32_t)c : VL_LOSS_ETA - 2;
  float t = c - (float)first;
  return (vlAlbedoCell){first, t < 1.0f ? t : 1.0f};
}
static inline float vl_loss_row(const float rows[][VL_LOSS_COS], vlAlbedoCell alpha,
                                vlAlbedoCell cosine) {
  return vl_albedo_between(rows[0], VL_LOSS_COS, alpha, cosine);
}
static inline float vl_loss_at(uint32_t side, vlAlbedoCell eta, vlAlbedoCell alpha,
                               vlAlbedoCell cosine) {
  const float(*tables)[VL_LOSS_ALPHA][VL_LOSS_COS] =
      vl_principled_tables.loss[side] + eta.first;
  float low = vl_loss_row(tables[0], alpha, cosine),
        high = vl_loss_row(tables[1], alpha, cosine);
  return low + eta.t * (high - low);
}
static inline float vl_loss_mean(uint32_t side, vlAlbedoCell eta, vlAlbedoCell alpha) {
  const float(*mean)[VL_LOSS_ALPHA] = vl_principled_tables.loss_mean[side] + eta.first;
  float low = vl_albedo_mean(mean[0], alpha), high = vl_albedo_mean(mean[1], alpha);
  return low + eta.t * (high - low);
}

/* The alpha of the isotropic layer whose losses are closest to those of an anisotropic one. */
static inline float vl_base_alpha(float x, float y) {
  return 0.6f * vl_max(x, y) + 0.4f * vl_min(x, y);
}

/* Position in the tables `stretched`. */
typedef struct vlStretch {
  vlAlbedoCell ratio, azimuth, alpha, cosine;
} vlStretch;
static inline vlStretch vl_stretch_of(float alpha_x, float alpha_y, vlVec3 w) {
  float larger = vl_max(alpha_x, alpha_y), along = alpha_x > alpha_y ? w.x : w.y;
  float ratio = vl_min(alpha_x, alpha_y) / vl_max(larger, VL_MIN_POSITIVE),
        across2 = vl_max(w.x * w.x + w.y * w.y, VL_MIN_POSITIVE);
  return (vlStretch){.ratio = vl_albedo_cell(ratio, VL_STRETCH_RATIO),
                     .azimuth = vl_albedo_cell(along * along / across2, VL_STRETCH_AZIMUTH),
                     .alpha = vl_albedo_cell(larger, VL_STRETCH_ALPHA),
                     .cosine = vl_albedo_cell(vl_abs(w.z), VL_LOSS_COS)};
}
static inline float vl_stretched_at(uint32_t kind, vlStretch at) {
  float ends[2];
  for (uint32_t k = 0; k < 2; k++) {
    const float(*rows)[VL_STRETCH_ALPHA][VL_LOSS_COS] =
        vl_principled_tables.stretched[kind][at.ratio.first + k] + at.azimuth.first;
    float low = vl_loss_row(rows[0], at.alpha, at.cosine),
          high = vl_loss_row(rows[1], at.alpha, at.cosine);
    ends[k] = low + at.azimuth.t * (high - low);
  }
  return ends[0] + at.ratio.t * (ends[1] - ends[0]);
}
static inline float vl_stretched_mean(uint32_t kind, vlStretch at) {
  const float(*mean)[VL_STRETCH_ALPHA] =
      vl_principled_tables.stretched_mean[kind] + at.ratio.first;
  float low = vl_albedo_mean(mean[0], at.alpha), high = vl_albedo_mean(mean[1], at.alpha);
  return low + at.ratio.t * (high - low);
}

static inline float vl_schlick_weight(float cosine) {
  float m = 1.0f - cosine;
  m = m > 0.0f ? m : 0.0f;
  float m2 = m * m;
  return m2 * m2 * m;
}

/* ---- sheen ------------------------------------------------------------------------------- */

/* Smaller alphas are clamped to this. */
#define VL_SHEEN_ALPHA 0.005f

/* L(x) of Estevez and Kulla, the fit of ln(1 + Lambda): curves for alpha 0 and 1, interpolated
 * by (1 - alpha)^2. */
static inline float vl_sheen_curve(float x, float alpha) {
  float s = (1.0f - alpha) * (1.0f - alpha), t = 1.0f - s;
  float a = 25.3245f * s + 21.5473f * t, b = 3.32435f * s + 3.82987f * t,
        c = 0.16801f * s + 0.19823f * t;
  float d = -1.27393f * s - 1.97760f * t, e = -4.85967f * s - 4.32054f * t;
  return a / (1.0f + b * vl_pow(x, c)) + d * x + e;
}
static inline float vl_sheen_lambda(float cosine, float alpha) {
  float half = vl_sheen_curve(0.5f, alpha), c = cosine < 0.5f ? cosine : 1.0f - cosine;
  float curve = vl_sheen_curve(c > VL_MIN_FRACTION ? c : VL_MIN_FRACTION, alpha);
  return vl_exp(cosine < 0.5f ? curve : 2.0f * half - curve);
}
/* f cos_i. o, i: cosines of both directions, > 0; h: cosine of the half vector. */
static inline float vl_sheen(float o, float i, float h, float alpha) {
  alpha = alpha > VL_SHEEN_ALPHA ? alpha : VL_SHEEN_ALPHA;
  float inverse = 1.0f / alpha, sin2 = 1.0f - h * h;
  float d = (2.0f + inverse) * vl_pow(sin2 > 1e-12f ? sin2 : 1e-12f, 0.5f * inverse) *
            (0.5f * VL_INV_PI);
  float g = 1.0f / (1.0f + vl_sheen_lambda(o, alpha) + vl_sheen_lambda(i, alpha));
  return d * g / (4.0f * (o > VL_MIN_FRACTION ? o : VL_MIN_FRACTION));
}

#endif
