/* distortion/opencv.c: OpenCV's distortion: rational radial, tangential, thin prism, and the
 * tilt of the sensor. */
#include <math.h>
#include <string.h>

#include "distortion/compile.h"
#include "math/approx_double.h"
#include "math/transform.h"

vlDistortionCompile vl_distortion_compile_opencv;

/* OpenCV's tilted sensor: rotation about x by tau_x, then y by tau_y, then projection along the
 * axis onto the plane. */
static void tilt(vlDistortionMap *m, double tau_x, double tau_y) {
  vlSinCosDouble x = vl_sincos_double(tau_x), y = vl_sincos_double(tau_y);
  const double about_x[9] = {1, 0, 0, 0, x.cos, x.sin, 0, -x.sin, x.cos};
  const double about_y[9] = {y.cos, 0, -y.sin, 0, 1, 0, y.sin, 0, y.cos};
  double r[9];
  vl_mat3_multiply(about_y, about_x, r);
  const double back[9] = {r[8], 0, -r[2], 0, r[8], -r[5], 0, 0, 1};
  vl_mat3_multiply(back, r, m->tilt);
  vl_mat3_inverse(m->tilt, m->untilt);
}

vlResult vl_distortion_compile_opencv(const double *k, uint32_t n, vlDistortionMap *m,
                                      vlError *error) {
  double c[14] = {0};
  memcpy(c, k, n * sizeof *c);
  m->numerator[0] = c[0];
  m->numerator[1] = c[1];
  m->numerator[2] = c[4];
  for (int i = 0; i < 3; i++)
    m->denominator[i] = c[5 + i];
  m->tangential[0] = c[2];
  m->tangential[1] = c[3];
  for (int i = 0; i < 4; i++)
    m->prism[i] = c[8 + i];
  if (!(fabs(c[12]) < 1.5 && fabs(c[13]) < 1.5))
    return vl_fail_argument(error, "camera: the sensor's tilt %g, %g radians must be below 1.5",
                            c[12], c[13]);
  if (c[12] != 0.0 || c[13] != 0.0)
    tilt(m, c[12], c[13]);
  return VL_OK;
}
