/* color/kernels.h: batch kernels for colour: wavelengths, spectra at the wavelengths of each
 * path, radiance to RGB. Channel c of path i is stored at [c][i]. All arrays hold VL_PAD(n)
 * elements. Padding elements are computed too, so they must hold finite numbers or, in index
 * arrays, valid offsets. Results have the same bits on every instruction set. Sources: pbrt
 * book 4.5, 4.6. */
#ifndef COLOR_KERNELS_H
#define COLOR_KERNELS_H

#include "base/isa.h"
#include "color/color.h"
#include "color/rgb_table.h"

typedef struct vlColorKernels {
  /* Samples 4 wavelengths per path from u in [0,1), u + 1/4, u + 2/4 and u + 3/4 (mod 1). The
   * density is that of vl_visible_lambda. Also writes 1 / density in nm. */
  void (*visible_wavelengths)(uint32_t n, const float *u, float *const lambda[4],
                              float *const inv_pdf[4]);
  /* Like visible_wavelengths, with a uniform density from low to low + span (nm). */
  void (*uniform_wavelengths)(float low, float span, uint32_t n, const float *u,
                              float *const lambda[4], float *const inv_pdf[4]);
  /* XYZ = 1/4 sum_c cmf(lambda_c) L_c inv_pdf_c, then RGB = m XYZ; m is row-major
   * (vl_rgb_from_xyz). The result is not divided by the integral of Y, since lights already are
   * (vl_spectrum_photometric). cmf holds VL_LAMBDA_COUNT * 4 floats, as vl_cie_xyz0. */
  void (*rgb_from_radiance)(const float *cmf, const float m[9], uint32_t n,
                            const float *const radiance[4], const float *const lambda[4],
                            const float *const inv_pdf[4], float *r, float *g, float *b);
  /* out = scale * sigmoid(c0, c1, c2; lambda), with one set of coefficients per path. A null
   * scale means 1. */
  void (*sigmoid_eval)(uint32_t n, const float *c0, const float *c1, const float *c2,
                       const float *scale, const float *const lambda[4], float *const out[4]);
  /* Like sigmoid_eval, times a dense spectrum such as the illuminant of a colour space. A null
   * scale means 1. */
  void (*light_eval)(uint32_t n, const float *c0, const float *c1, const float *c2,
                     const float *scale, const float *dense, const float *const lambda[4],
                     float *const out[4]);
  /* Evaluates one dense spectrum (VL_LAMBDA_COUNT values) for all paths. */
  void (*dense_eval)(uint32_t n, const float *dense, const float *const lambda[4],
                     float *const out[4]);
  /* Evaluates one dense spectrum per path: the spectrum of path i starts at
   * dense[offset[i]]. */
  void (*dense_gather)(uint32_t n, const float *dense, const uint32_t *offset,
                       const float *const lambda[4], float *const out[4]);
  /* Converts RGB reflectances, clamped to [0,1], to sigmoid coefficients. */
  void (*sigmoid_from_rgb)(const vlRgbTable *table, uint32_t n, const float *r, const float *g,
                           const float *b, float *c0, float *c1, float *c2);
  /* Converts RGB colours of lights to sigmoid coefficients and scale = 2 max(r, g, b). Negative
   * values count as 0. The spectrum of the light is scale * sigmoid times the illuminant of the
   * colour space. */
  void (*sigmoid_from_light)(const vlRgbTable *table, uint32_t n, const float *r,
                             const float *g, const float *b, float *scale, float *c0, float *c1,
                             float *c2);
} vlColorKernels;
VL_KERNEL_TABLE(vlColorKernels, vl_color)

/* The CIE observer for rgb_from_radiance: x, y, z, 0 for each nm, VL_LAMBDA_COUNT * 4
 * floats. */
extern const float vl_cie_xyz0[VL_LAMBDA_COUNT * 4];

#endif
