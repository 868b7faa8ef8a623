/* film/white.c: see white.h. */
#include "film/white.h"

#include "color/sensor.h"
#include "math/double3.h"
#include "math/transform.h"

/* Lam, "Metamerism and colour constancy" (Bradford, 1985): XYZ to the responses of sharpened
 * cones. */
static const double cones[9] = {0.8951, 0.2664, -0.1614, -0.7502, 1.7135,
                                0.0367, 0.0389, -0.0685, 1.0296};

/* The chromaticity of vl_daylight, without the rounding of its table. */
static void chromaticity(double kelvin, double xy[2]) {
  double t = kelvin * 1.4388 / 1.4380, sum[3] = {0, 0, 0}, light[VL_LAMBDA_COUNT];
  if (t >= 4000.0) {
    vl_daylight_xy(t, xy);
    return;
  }
  vl_daylight(kelvin, light);
  for (int i = 0; i < VL_LAMBDA_COUNT; i++) {
    sum[0] += light[i] * (double)vl_cie_x()[i];
    sum[1] += light[i] * (double)vl_cie_y()[i];
    sum[2] += light[i] * (double)vl_cie_z()[i];
  }
  xy[0] = sum[0] / (sum[0] + sum[1] + sum[2]);
  xy[1] = sum[1] / (sum[0] + sum[1] + sum[2]);
}

static void response(double x, double y, double lms[3]) {
  double xyz[3] = {x / y, 1.0, (1.0 - x - y) / y};
  vl_mat3_vector(cones, xyz, lms);
}

void vl_white_balance(double kelvin, vlColorSpace space, float m[9]) {
  float primaries[8];
  double source[2], from[3], to[3], scaled[9], back[9], whole[9];
  vl_space_chromaticities(space, primaries);
  chromaticity(kelvin, source);
  response(source[0], source[1], from);
  response((double)primaries[6], (double)primaries[7], to);
  for (int i = 0; i < 9; i++)
    scaled[i] = cones[i] * to[i / 3] / from[i / 3];
  vl_mat3_inverse(cones, back);
  vl_mat3_multiply(back, scaled, whole);
  for (int i = 0; i < 9; i++)
    m[i] = (float)whole[i];
}
