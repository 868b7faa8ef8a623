/* color/kernels.h: batch kernels for colour: wavelengths, spectra at the wavelengths of each path, radiance to RGB.
 *
 * Channel c of path i is at [c][i]. All arrays hold VL_PAD(n) elements. Padding elements are computed too, so they
 * must hold finite numbers (index arrays: valid offsets). Same bits on every instruction set. Sources: pbrt book
 * 4.5, 4.6. */
#ifndef COLOR_KERNELS_H
#define COLOR_KERNELS_H

#include "base/isa.h"
#include "color/color.h"
#include "color/rgb_table.h"

typedef struct vlColorKernels {
  /* u in [0,1) to the 4 wavelengths of u, u + 1/4, u + 2/4, u + 3/4 (mod 1), with density proportional to the
   * observer's sensitivity (vl_visible_lambda), and 1 / density (nm). */
  void (*visible_wavelengths)(uint32_t n, const float *u, float *const lambda[4], float *const inv_pdf[4]);
  /* The same with uniform density from low to low + span (nm). */
  void (*uniform_wavelengths)(float low, float span, uint32_t n, const float *u, float *const lambda[4],
                              float *const inv_pdf[4]);
  /* XYZ = 1/4 sum_c cmf(lambda_c) L_c inv_pdf_c, then RGB = m XYZ; m row-major (vl_rgb_from_xyz). Not divided by the
   * integral of Y: lights are (vl_spectrum_photometric). cmf: VL_LAMBDA_COUNT * 4, as vl_cie_xyz0. */
  void (*rgb_from_radiance)(const float *cmf, const float m[9], uint32_t n, const float *const radiance[4],
                            const float *const lambda[4], const float *const inv_pdf[4], float *r, float *g, float *b);
  /* out = scale * sigmoid(c0, c1, c2; lambda) with coefficients per path. scale may be null: 1. */
  void (*sigmoid_eval)(uint32_t n, const float *c0, const float *c1, const float *c2, const float *scale,
                       const float *const lambda[4], float *const out[4]);
  /* The same times a dense spectrum (such as the illuminant of a colour space). scale may be null: 1. */
  void (*light_eval)(uint32_t n, const float *c0, const float *c1, const float *c2, const float *scale,
                     const float *dense, const float *const lambda[4], float *const out[4]);
  /* One dense spectrum (VL_LAMBDA_COUNT values) for all paths. */
  void (*dense_eval)(uint32_t n, const float *dense, const float *const lambda[4], float *const out[4]);
  /* A dense spectrum per path: spectrum i starts at dense[offset[i]]. */
  void (*dense_gather)(uint32_t n, const float *dense, const uint32_t *offset, const float *const lambda[4],
                       float *const out[4]);
  /* Converts reflectances in [0,1] (clamped) to coefficients. */
  void (*sigmoid_from_rgb)(const vlRgbTable *table, uint32_t n, const float *r, const float *g, const float *b,
                           float *c0, float *c1, float *c2);
  /* Converts light colours: rgb >= 0 (negative counts as 0) = scale * sigmoid, scale = 2 max(r, g, b), to be
   * multiplied by the illuminant. Also writes scale. */
  void (*sigmoid_from_light)(const vlRgbTable *table, uint32_t n, const float *r, const float *g, const float *b,
                             float *scale, float *c0, float *c1, float *c2);
} vlColorKernels;
VL_KERNEL_TABLE(vlColorKernels, vl_color)

/* The observer interleaved for rgb_from_radiance: x, y, z, 0 per nm, VL_LAMBDA_COUNT * 4 floats. */
extern const float vl_cie_xyz0[VL_LAMBDA_COUNT * 4];

#endif
