/* distortion/radial.case.c: what tests know of radial distortion. */
#include "distortion/distortion.case.h"

static void plain(const DistortionVariant *v, double x, double y, double at[2]) {
  const double *k = v->k;
  const double prism[4] = {0, 0, 0, 0};
  double s = x * x + y * y;
  double radial = 1 + k[0] * s + k[1] * s * s + k[2] * s * s * s + k[3] * s * s * s * s;
  distort_plainly(radial, 0, 0, prism, x, y, at);
}

const DistortionCase radial_distortion = {.variants = {{4, {-.1, .03, .01, -.002}}},
                                          .plain = plain};
