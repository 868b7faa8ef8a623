/* distortion/opencv.case.c: what tests know of OpenCV's distortion. */
#include <math.h>

#include "distortion/distortion.case.h"

/* The tilted sensor of OpenCV's documentation, calib3d: R(tau_x, tau_y), then the projection
 * along the axis. */
static void tilt(double tau_x, double tau_y, double at[2]) {
  const double r[3][3] = {{cos(tau_y), sin(tau_y) * sin(tau_x), -sin(tau_y) * cos(tau_x)},
                          {0, cos(tau_x), sin(tau_x)},
                          {sin(tau_y), -cos(tau_y) * sin(tau_x), cos(tau_y) * cos(tau_x)}};
  double v[3];
  for (int i = 0; i < 3; i++)
    v[i] = r[i][0] * at[0] + r[i][1] * at[1] + r[i][2];
  at[0] = (r[2][2] * v[0] - r[0][2] * v[2]) / v[2];
  at[1] = (r[2][2] * v[1] - r[1][2] * v[2]) / v[2];
}

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
  if (v->count > 12)
    tilt(k[12], k[13], at);
}

const DistortionCase opencv_distortion = {
    .variants = {{12, {-.2, .05, .003, -.004, .01, .02, .01, .003, .002, .001, -.003, .002}},
                 {14, {.1, .02, .02, -.01, .01, 0, 0, 0, 0, 0, 0, 0, .1, -.15}},
                 /* a sensor that is tilted about one axis */
                 {14, {0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, .5, 0}},
                 {14, {0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, .5}},
                 {5, {.1, .02, .02, -.01, .01}}},
    .plain = plain};
