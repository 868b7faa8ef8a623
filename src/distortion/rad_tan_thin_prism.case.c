/* distortion/rad_tan_thin_prism.case.c: what tests know of Project Aria's distortion. */
#include <math.h>

#include "distortion/distortion.case.h"

/* With (a, b) the point after its radial distortion, and r its radius. */
static void plain(const DistortionVariant *v, double x, double y, double at[2]) {
  const double *k = v->k, *p = v->k + 6, *s = v->k + 8;
  double theta = sqrt(x * x + y * y);
  double r = theta;
  for (int i = 0; i < 6; i++)
    r += k[i] * pow(theta, 3 + 2 * i);
  double a = theta > 0 ? x / theta * r : 0;
  double b = theta > 0 ? y / theta * r : 0;
  at[0] = a + p[0] * (2 * a * a + r * r) + 2 * p[1] * a * b + s[0] * r * r + s[1] * pow(r, 4);
  at[1] = b + p[1] * (2 * b * b + r * r) + 2 * p[0] * a * b + s[2] * r * r + s[3] * pow(r, 4);
}

const DistortionCase rad_tan_thin_prism_distortion = {
    .variants = {{12, {.4, -.5, .35, -.15, .03, -.002, .003, -.004, .002, .001, -.003, .002}},
                 {12, {-.03, .02, -.01, .004, -.002, .0005, .02, -.01, .01, -.004, .02, .003}}},
    .plain = plain};
