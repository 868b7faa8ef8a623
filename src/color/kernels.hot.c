/* color/kernels.hot.c: spectra and colour over batches of paths (color/kernels.h). Compiled
 * once per instruction set. */
#include "color/kernels.h"

/* u + channel / 4, wrapped to [0, 1). */
static inline float turned(float u, int channel) {
  float v = u + 0.25f * (float)channel;
  return v >= 1.0f ? v - 1.0f : v;
}

/* The four wavelengths are u rotated by quarters, so that they stratify the range. */
static void visible_wavelengths(uint32_t n, const float *u, float *const lambda[4],
                                float *const inv_pdf[4]) {
  uint32_t count = VL_PAD(n);
  for (int c = 0; c < 4; c++) {
    float *p = inv_pdf[c];
    /* must vectorise */
    VL_SIMD for (uint32_t i = 0; i < count; i++) lambda[c][i] =
        vl_visible_lambda(turned(u[i], c), &p[i]);
  }
}

static void uniform_wavelengths(float low, float span, uint32_t n, const float *u,
                                float *const lambda[4], float *const inv_pdf[4]) {
  uint32_t count = VL_PAD(n);
  for (int c = 0; c < 4; c++) {
    /* must vectorise */
    VL_SIMD for (uint32_t i = 0; i < count; i++) {
      float v = turned(u[i], c);
      lambda[c][i] = low + span * v;
      inv_pdf[c][i] = span;
    }
  }
}

typedef struct xyz {
  float x, y, z;
} xyz;

static inline xyz add_wavelength(const float *cmf, xyz s, float radiance, float lambda,
                                 float inv_pdf) {
  float p = lambda - 360.0f;
  int j = (int)p;
  j = j < VL_LAMBDA_COUNT - 2 ? j : VL_LAMBDA_COUNT - 2;
  j = j > 0 ? j : 0;
  float t = p - (float)j, w = radiance * inv_pdf;
  j = 4 * j;
  float x = cmf[j], y = cmf[j + 1], z = cmf[j + 2];
  s.x = s.x + w * (x + t * (cmf[j + 4] - x));
  s.y = s.y + w * (y + t * (cmf[j + 5] - y));
  s.z = s.z + w * (z + t * (cmf[j + 6] - z));
  return s;
}

static void rgb_from_radiance(const float *cmf, const float m[9], uint32_t n,
                              const float *const radiance[4], const float *const lambda[4],
                              const float *const inv_pdf[4], float *r, float *g, float *b) {
  uint32_t count = VL_PAD(n);
  float q[9];
  for (int i = 0; i < 9; i++)
    q[i] = 0.25f * m[i];
  /* must vectorise */
  VL_SIMD for (uint32_t i = 0; i < count; i++) {
    xyz s = {0.0f, 0.0f, 0.0f};
    for (int c = 0; c < 4; c++)
      s = add_wavelength(cmf, s, radiance[c][i], lambda[c][i], inv_pdf[c][i]);
    r[i] = q[0] * s.x + q[1] * s.y + q[2] * s.z;
    g[i] = q[3] * s.x + q[4] * s.y + q[5] * s.z;
    b[i] = q[6] * s.x + q[7] * s.y + q[8] * s.z;
  }
}

/* Sigmoids at one wavelength of each lane, times `scale` and a dense spectrum. Both may be
 * null; callers give constants, so that each loop has what it needs alone. */
static inline __attribute__((always_inline)) void sigmoid_row(uint32_t count, const float *c0,
                                                              const float *c1, const float *c2,
                                                              const float *scale,
                                                              const float *dense,
                                                              const float *l, float *o) {
  /* must vectorise */
  VL_SIMD for (uint32_t i = 0; i < count; i++) {
    float value = vl_sigmoid((vlSigmoid){c0[i], c1[i], c2[i]}, l[i]);
    value = scale ? scale[i] * value : value;
    o[i] = dense ? value * vl_dense_at(dense, l[i]) : value;
  }
}

static inline __attribute__((always_inline)) void light_eval(
    uint32_t n, const float *c0, const float *c1, const float *c2, const float *scale,
    const float *dense, const float *const lambda[4], float *const out[4]) {
  uint32_t count = VL_PAD(n);
  for (int c = 0; c < 4; c++) {
    if (scale)
      sigmoid_row(count, c0, c1, c2, scale, dense, lambda[c], out[c]);
    else
      sigmoid_row(count, c0, c1, c2, NULL, dense, lambda[c], out[c]);
  }
}

static void sigmoid_eval(uint32_t n, const float *c0, const float *c1, const float *c2,
                         const float *scale, const float *const lambda[4],
                         float *const out[4]) {
  light_eval(n, c0, c1, c2, scale, NULL, lambda, out);
}

static void dense_eval(uint32_t n, const float *dense, const float *const lambda[4],
                       float *const out[4]) {
  uint32_t count = VL_PAD(n);
  for (int c = 0; c < 4; c++) {
    /* must vectorise */
    VL_SIMD for (uint32_t i = 0; i < count; i++) out[c][i] = vl_dense_at(dense, lambda[c][i]);
  }
}

static void dense_gather(uint32_t n, const float *dense, const uint32_t *offset,
                         const float *const lambda[4], float *const out[4]) {
  uint32_t count = VL_PAD(n);
  for (int c = 0; c < 4; c++) {
    /* must vectorise */
    VL_SIMD for (uint32_t i = 0; i < count; i++) {
      float x = lambda[c][i] - 360.0f;
      int j = (int)x;
      j = j < VL_LAMBDA_COUNT - 2 ? j : VL_LAMBDA_COUNT - 2;
      j = j > 0 ? j : 0;
      float t = x - (float)j;
      j = j + (int)offset[i];
      float a = dense[j], b = dense[j + 1], value = a + t * (b - a);
      value = x >= 0.0f ? value : 0.0f;
      out[c][i] = x <= 470.0f ? value : 0.0f;
    }
  }
}

static void sigmoid_from_rgb(const vlRgbTable *table, uint32_t n, const float *r,
                             const float *g, const float *b, float *c0, float *c1, float *c2) {
  uint32_t count = VL_PAD(n);
  /* must vectorise */
  VL_SIMD for (uint32_t i = 0; i < count; i++) {
    vlRgbPoint at = vl_rgb_point(r[i], g[i], b[i]);
    c0[i] = vl_rgb_coefficient(table->coefficients, 0, at);
    c1[i] = vl_rgb_coefficient(table->coefficients, 1, at);
    c2[i] = vl_rgb_coefficient(table->coefficients, 2, at);
  }
}

static void sigmoid_from_light(const vlRgbTable *table, uint32_t n, const float *r,
                               const float *g, const float *b, float *scale, float *c0,
                               float *c1, float *c2) {
  uint32_t count = VL_PAD(n);
  /* must vectorise */
  VL_SIMD for (uint32_t i = 0; i < count; i++) {
    float high = r[i] > g[i] ? r[i] : g[i];
    high = high > b[i] ? high : b[i];
    float m = high > 0.0f ? 2.0f * high : 0.0f;
    float inv = high > 0.0f ? 1.0f / m : 0.0f;
    vlRgbPoint at = vl_rgb_point(r[i] * inv, g[i] * inv, b[i] * inv);
    scale[i] = m;
    c0[i] = vl_rgb_coefficient(table->coefficients, 0, at);
    c1[i] = vl_rgb_coefficient(table->coefficients, 1, at);
    c2[i] = vl_rgb_coefficient(table->coefficients, 2, at);
  }
}

const vlColorKernels vl_color_kernel_table = {
    visible_wavelengths, uniform_wavelengths, rgb_from_radiance, sigmoid_eval,       light_eval,
    dense_eval,          dense_gather,        sigmoid_from_rgb,  sigmoid_from_light,
};
