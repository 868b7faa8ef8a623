/* material/hair.hot.c: the BSDF of a hair, an absorbing dielectric cylinder with a rough
 * surface of tilted scales (Chiang, Bitterli, Tappan, Burley 2016; pbrt book 9.9). Its four
 * lobes are reflection, transmission, one internal reflection, and all paths with more. Each
 * lobe is a product of a longitudinal part M (von Mises-Fisher), an attenuation A and an
 * azimuthal part N (trimmed logistic).
 *
 * The x axis runs along the hair; h in [-1, 1] is the offset from the hair's axis. In this
 * far-field model of curves, f is not symmetric in the two directions, and transmission does
 * not depend on the side of the surface. */
#include "material/local.hot.h"

vlBsdfEval vl_bsdf_hair_eval;
vlBsdfSample vl_bsdf_hair_sample;

enum { LOBES = 4 }; /* p = 0, 1, 2 internal segments, and all larger p */

/* The parameters of a lane's hair for wo. */
typedef struct Hair {
  float sin_o, cos_o, phi_o;
  float gamma_o, gamma_t;
  float s, norm, low; /* of the logistic distribution: scale, 1 / (its mass in one turn),
                         cumulative value at -pi */
  float v[LOBES];     /* variances */
  float sin_p[LOBES], cos_p[LOBES]; /* wo tilted by the cuticle scales */
  float a[LOBES][4];                /* attenuations */
  float share[LOBES];               /* probabilities of the lobes */
} Hair;

static inline float square(float x) {
  return x * x;
}

/* ln I0(x), x >= 0 (Abramowitz and Stegun 9.8.1, 9.8.2). */
static inline float ln_bessel(float x) {
  float t = x * (1.0f / 3.75f);
  t = t * t;
  float near =
      1.0f +
      t * (3.5156229f +
           t * (3.0899424f +
                t * (1.2067492f + t * (0.2659732f + t * (0.0360768f + t * 0.0045813f)))));
  float y = 3.75f / (x > 3.75f ? x : 3.75f);
  float far =
      0.39894228f +
      y * (0.01328592f +
           y * (0.00225319f +
                y * (-0.00157565f +
                     y * (0.00916281f +
                          y * (-0.02057706f +
                               y * (0.02635537f + y * (-0.01647633f + y * 0.00392377f)))))));
  float large = x > 3.75f ? x : 3.75f;
  float a = vl_ln(x > 3.75f ? 1.0f : near), b = large - 0.5f * vl_ln(large) + vl_ln(far);
  return x > 3.75f ? b : a;
}

/* M: density of sin theta_i along the hair (d'Eon et al. 2011). */
static inline float longitudinal(float cos_i, float cos_o, float sin_i, float sin_o, float v) {
  float inverse = 1.0f / v;
  float e = ln_bessel(cos_i * cos_o * inverse) - sin_i * sin_o * inverse - inverse;
  return vl_exp(e > -80.0f ? e : -80.0f) * inverse / (1.0f - vl_exp(-2.0f * inverse));
}

static inline float turned(float x) { /* wraps an angle to [-pi, pi] */
  return x - 2.0f * VL_PI * __builtin_floorf(x * (0.5f * VL_INV_PI) + 0.5f);
}
/* Azimuth of lobe p of a smooth hair. */
static inline float azimuth(int p, const Hair *h) {
  return 2.0f * (float)p * h->gamma_t - 2.0f * h->gamma_o + (float)p * VL_PI;
}
static inline float logistic(const Hair *h, float x) {
  float a = vl_abs(x) / h->s, e = vl_exp(a < 80.0f ? -a : -80.0f);
  return e * h->norm / (h->s * (1.0f + e) * (1.0f + e));
}

/* Lower bound of both roughnesses. At 0.01 the variance v is 5e-5, and exponents of size 1 / v
 * have a rounding error of 1e-3. */
#define MIN_BETA 1e-2f
/* Lower bound of the cosine between a direction and the fibre's cross-section. It is reached
 * 0.006 degrees from the fibre's direction. */
#define ALONG 1e-4f

static inline Hair hair_of(const vlBsdfParams *q, uint32_t i, vlVec3 wo) {
  Hair r;
  float h = vl_clamp(q->own[VL_H_ACROSS][i], -1.0f, 1.0f), eta = q->eta_s[i];
  float bm = vl_clamp(q->own[VL_H_BETA_M][i], MIN_BETA, 1.0f);
  float bn = vl_clamp(q->own[VL_H_BETA_N][i], MIN_BETA, 1.0f);
  r.sin_o = vl_clamp(wo.x, -1.0f, 1.0f);
  r.cos_o = __builtin_sqrtf((1.0f - r.sin_o) * (1.0f + r.sin_o));
  r.phi_o = vl_atan2(wo.z, wo.y);
  /* roughness to variance and scale (Chiang et al., equations 7 and 8) */
  float bm2 = bm * bm, bm4 = bm2 * bm2, bm16 = square(square(bm4));
  float bn2 = bn * bn, bn4 = bn2 * bn2, bn16 = square(square(bn4));
  r.v[0] = square(0.726f * bm + 0.812f * bm2 + 3.7f * bm16 * bm4);
  r.v[1] = 0.25f * r.v[0];
  r.v[2] = r.v[3] = 4.0f * r.v[0];
  r.s = 0.626657069f * (0.265f * bn + 1.194f * bn2 + 5.372f * bn16 * bn4 * bn2);
  float edge = VL_PI / r.s;
  r.low = 1.0f / (1.0f + vl_exp(edge < 80.0f ? edge : 80.0f));
  r.norm = 1.0f / (1.0f - 2.0f * r.low);
  /* the refracted direction */
  float sin_t = r.sin_o / eta,
        cos_t = __builtin_sqrtf(vl_max(1.0f - sin_t * sin_t, VL_MIN_FRACTION));
  float etap =
      __builtin_sqrtf(vl_max(eta * eta - r.sin_o * r.sin_o, 0.0f)) / vl_max(r.cos_o, ALONG);
  float sin_gt = vl_clamp(h / vl_max(etap, ALONG), -1.0f, 1.0f);
  float cos_gt = __builtin_sqrtf((1.0f - sin_gt) * (1.0f + sin_gt));
  r.gamma_o = vl_asin(h);
  r.gamma_t = vl_asin(sin_gt);
  float f =
      vl_fresnel_dielectric(r.cos_o * __builtin_sqrtf((1.0f - h) * (1.0f + h)), eta).reflected;
  float way = 2.0f * cos_gt / cos_t, total = 0.0f;
  for (int p = 0; p < LOBES; p++)
    r.share[p] = 0.0f;
  for (int c = 0; c < 4; c++) {
    float t = vl_exp(-vl_min(vl_max(q->own[VL_H_SIGMA_A + c][i], 0.0f) * way, 80.0f));
    r.a[0][c] = f;
    r.a[1][c] = square(1.0f - f) * t;
    r.a[2][c] = r.a[1][c] * t * f;
    r.a[3][c] = r.a[2][c] * t * f / vl_max(1.0f - t * f, VL_MIN_FRACTION);
    for (int p = 0; p < LOBES; p++) {
      r.share[p] += r.a[p][c];
      total += r.a[p][c];
    }
  }
  total = total > 0.0f ? 1.0f / total : 0.0f;
  for (int p = 0; p < LOBES; p++)
    r.share[p] *= total;
  /* cuticle scales tilt each lobe by a multiple of alpha: -2, 1, 4 */
  vlSinCos tilt = vl_sincos(q->own[VL_H_ALPHA][i]);
  float s2 = 2.0f * tilt.cos * tilt.sin, c2 = square(tilt.cos) - square(tilt.sin);
  float s4 = 2.0f * c2 * s2, c4 = square(c2) - square(s2);
  r.sin_p[0] = r.sin_o * c2 - r.cos_o * s2;
  r.cos_p[0] = vl_abs(r.cos_o * c2 + r.sin_o * s2);
  r.sin_p[1] = r.sin_o * tilt.cos + r.cos_o * tilt.sin;
  r.cos_p[1] = vl_abs(r.cos_o * tilt.cos - r.sin_o * tilt.sin);
  r.sin_p[2] = r.sin_o * c4 + r.cos_o * s4;
  r.cos_p[2] = vl_abs(r.cos_o * c4 - r.sin_o * s4);
  r.sin_p[3] = r.sin_o;
  r.cos_p[3] = r.cos_o;
  return r;
}

/* f cos and the density of wi. */
static inline float hair_value(const Hair *h, vlVec3 wi, float value[4]) {
  float sin_i = vl_clamp(wi.x, -1.0f, 1.0f),
        cos_i = __builtin_sqrtf((1.0f - sin_i) * (1.0f + sin_i));
  float phi = vl_atan2(wi.z, wi.y) - h->phi_o, pdf = 0.0f;
  for (int c = 0; c < 4; c++)
    value[c] = 0.0f;
  for (int p = 0; p < LOBES; p++) {
    float m = longitudinal(cos_i, h->cos_p[p], sin_i, h->sin_p[p], h->v[p]);
    m *= p < 3 ? logistic(h, turned(phi - azimuth(p, h))) : 0.5f * VL_INV_PI;
    pdf += m * h->share[p];
    for (int c = 0; c < 4; c++)
      value[c] += m * h->a[p][c];
  }
  return pdf;
}

void vl_bsdf_hair_eval(uint32_t n, const vlBsdfParams *params, vlBsdfDirections wo,
                       vlBsdfDirections wi, float *const value[4], float *pdf) {
  for (uint32_t i = 0; i < n; i++) {
    Hair h = hair_of(params, i, vl_lane3(wo.x, wo.y, wo.z, i));
    float f[4], p = hair_value(&h, vl_lane3(wi.x, wi.y, wi.z, i), f);
    float on = (wo.z[i] != 0.0f) & (wi.z[i] != 0.0f) ? 1.0f : 0.0f;
    for (int c = 0; c < 4; c++)
      value[c][i] = f[c] * on;
    pdf[i] = p * on;
  }
}

void vl_bsdf_hair_sample(uint32_t n, const vlBsdfParams *params, vlBsdfDirections wo,
                         vlBsdfRandom random, vlBsdfSampled out) {
  for (uint32_t i = 0; i < n; i++) {
    Hair h = hair_of(params, i, vl_lane3(wo.x, wo.y, wo.z, i));
    int p = 0;
    float lobe = random.lobe[i];
    for (; p < LOBES - 1 && !(lobe < h.share[p]); p++)
      lobe -= h.share[p];
    /* the rest of the random number, uniform in [0, 1) again */
    lobe = vl_clamp(lobe / vl_max(h.share[p], VL_MIN_POSITIVE), 0.0f, VL_ONE_MINUS_EPSILON);
    float e = vl_exp(-2.0f / h.v[p]);
    float cosine = vl_clamp(
        1.0f + h.v[p] * vl_ln(vl_max(random.u[i] + (1.0f - random.u[i]) * e, VL_MIN_POSITIVE)),
        -1.0f, 1.0f);
    float sine = __builtin_sqrtf((1.0f - cosine) * (1.0f + cosine));
    float sin_i = -cosine * h.sin_p[p] + sine * vl_sincos_turn(random.v[i]).cos * h.cos_p[p];
    sin_i = vl_clamp(sin_i, -1.0f, 1.0f);
    float cos_i = __builtin_sqrtf((1.0f - sin_i) * (1.0f + sin_i));
    float x =
        vl_clamp(lobe * (1.0f - 2.0f * h.low) + h.low, VL_MIN_POSITIVE, VL_ONE_MINUS_EPSILON);
    float phi = p < 3 ? azimuth(p, &h) + vl_clamp(-h.s * vl_ln(1.0f / x - 1.0f), -VL_PI, VL_PI)
                      : 2.0f * VL_PI * lobe;
    vlSinCos at = vl_sincos(turned(h.phi_o + phi));
    vlVec3 w = vl_normalize(vl_vec3(sin_i, cos_i * at.cos, cos_i * at.sin));
    float f[4], d = hair_value(&h, w, f);
    bool valid = wo.z[i] != 0.0f && w.z != 0.0f && d > VL_MIN_POSITIVE;
    vl_set_lane3(out.wi.x, out.wi.y, out.wi.z, i, w);
    for (int c = 0; c < 4; c++)
      out.weight[c][i] = valid ? f[c] / d : 0.0f;
    out.pdf[i] = valid ? d : 0.0f;
    out.flags[i] = !valid                 ? (uint32_t)VL_SAMPLED_NONE
                   : w.z * wo.z[i] < 0.0f ? (uint32_t)VL_SAMPLED_TRANSMISSION
                                          : 0u;
    out.eta_scale[i] = 1.0f;
  }
}
