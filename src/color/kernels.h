/* color/kernels.h: batch kernels for colour: wavelengths, radiance to RGB. Channel c of path i
 * is stored at [c][i]. All arrays hold VL_PAD(n) elements. Padding elements are computed too,
 * so they must hold finite numbers. Results have the same bits on every instruction set.
 * Sources: pbrt book 4.5, 4.6. */
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
} vlColorKernels;
VL_KERNEL_TABLE(vlColorKernels, vl_color)

/* The CIE observer for rgb_from_radiance: x, y, z, 0 for each nm, VL_LAMBDA_COUNT * 4
 * floats. */
extern const float vl_cie_xyz0[VL_LAMBDA_COUNT * 4];

#endif
