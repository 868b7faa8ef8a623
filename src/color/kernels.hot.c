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

/* A colour of the CIE's standard observer. */
typedef struct Xyz {
  float x, y, z;
} Xyz;

/* Adds one wavelength's share to a colour. cmf: the colour matching functions, 4 numbers for
 * each nanometre from 360 on; between two they are linear. */
static inline Xyz add_wavelength(const float *cmf, Xyz s, float radiance, float lambda,
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
    Xyz s = {0.0f, 0.0f, 0.0f};
    for (int c = 0; c < 4; c++)
      s = add_wavelength(cmf, s, radiance[c][i], lambda[c][i], inv_pdf[c][i]);
    r[i] = q[0] * s.x + q[1] * s.y + q[2] * s.z;
    g[i] = q[3] * s.x + q[4] * s.y + q[5] * s.z;
    b[i] = q[6] * s.x + q[7] * s.y + q[8] * s.z;
  }
}

const vlColorKernels vl_color_kernel_table = {visible_wavelengths, uniform_wavelengths,
                                              rgb_from_radiance};
