/* distortion/opencv.case.c: what tests know of OpenCV's distortion. */
#include "distortion/distortion.case.h"

static void plain(const DistortionVariant *v, double x, double y, double at[2]) {
  const double *k = v->k;
  double s = x * x + y * y;
  double prism[4] = {0, 0, 0, 0};
  double k4 = v->count > 5 ? k[5] : 0;
  double k5 = v->count > 5 ? k[6] : 0;
  double k6 = v->count > 5 ? k[7] : 0;
  double radial = (1 + k[0] * s + k[1] * s * s + k[4] * s * s * s) /
                  (1 + k4 * s + k5 * s * s + k6 * s * s * s);
  for (int i = 0; i < 4 && v->count > 8; i++)
    prism[i] = k[8 + i];
  distort_plainly(radial, k[2], k[3], prism, x, y, at);
}

const DistortionCase opencv_distortion = {
    .variants = {{12, {-.2, .05, .003, -.004, .01, .02, .01, .003, .002, .001, -.003, .002}},
                 {5, {.1, .02, .02, -.01, .01}}},
    .plain = plain};
