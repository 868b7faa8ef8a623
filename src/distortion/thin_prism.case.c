/* distortion/thin_prism.case.c: what tests know of COLMAP's thin prism. */
#include "distortion/distortion.case.h"

static void plain(const DistortionVariant *v, double x, double y, double at[2]) {
  const double *k = v->k;
  const double prism[4] = {k[6], 0, k[7], 0};
  double s = x * x + y * y;
  double radial = 1 + k[0] * s + k[1] * s * s + k[4] * s * s * s + k[5] * s * s * s * s;
  distort_plainly(radial, k[2], k[3], prism, x, y, at);
}

const DistortionCase thin_prism_distortion = {
    .variants = {{8, {-.1, .02, .003, -.004, .01, .002, .005, -.006}}}, .plain = plain};
