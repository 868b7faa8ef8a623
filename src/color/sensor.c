/* color/sensor.c: see sensor.h. Matches pbrt-v4's PixelSensor, so that its scenes keep their
 * colours. */
#include "color/sensor.h"

#include "base/text.h"
#include "color/tables.h"
#include "math/elementary.h"
#include "math/transform.h"
#include "velo/render.h"

const vlSensorCurves *vl_sensor_find(const char *name) {
  for (uint32_t i = 0; name && i < vl_sensor_count; i++)
    if (vl_text_is(vl_sensor_curves[i].name, name))
      return &vl_sensor_curves[i];
  return NULL;
}

const char *vl_sensor_name(uint32_t index) {
  if (index == 0)
    return "cie1931";
  return index <= vl_sensor_count ? vl_sensor_curves[index - 1].name : NULL;
}

/* Interpolates samples every 10 nm from 380 nm on: linear between, 0 outside. */
static double sampled(const float *v, int count, int stride, int lambda) {
  int i = (lambda - 380) / 10;
  if (lambda < 380 || i > count - 1 || (i == count - 1 && lambda % 10))
    return 0.0;
  double t = (lambda - 380) % 10 / 10.0, a = (double)v[i * stride];
  return t > 0.0 ? a + t * ((double)v[(i + 1) * stride] - a) : a;
}

/* ---- daylight ---------------------------------------------------------------------------- */

/* CIE 15; pbrt's DenselySampledSpectrum::D. */
void vl_daylight_xy(double t, double xy[2]) {
  double x = t <= 7000.0
                 ? -4.6070e9 / (t * t * t) + 2.9678e6 / (t * t) + 0.09911e3 / t + 0.244063
                 : -2.0064e9 / (t * t * t) + 1.9018e6 / (t * t) + 0.24748e3 / t + 0.237040;
  xy[0] = x;
  xy[1] = -3.0 * x * x + 2.870 * x - 0.275;
}

void vl_daylight(double kelvin, double light[VL_LAMBDA_COUNT]) {
  /* second radiation constant of Planck's law: today's over that of 1968, when CIE defined
   * daylight */
  double t = kelvin * 1.4388 / 1.4380, xy[2];
  if (t < 4000.0) { /* daylight is not defined: Planck's law, up to a factor */
    for (int i = 0; i < VL_LAMBDA_COUNT; i++) {
      double metres = (VL_LAMBDA_MIN + i) * 1e-9;
      light[i] =
          vl_precise_pow(metres * 1e7, -5.0) / vl_precise_expm1(1.438776877e-2 / (metres * t));
    }
    return;
  }
  vl_daylight_xy(t, xy);
  double m = 0.0241 + 0.2562 * xy[0] - 0.7341 * xy[1];
  double m1 = (-1.3515 - 1.7703 * xy[0] + 5.9114 * xy[1]) / m;
  double m2 = (0.0300 - 31.4424 * xy[0] + 30.0717 * xy[1]) / m;
  for (int i = 0; i < VL_LAMBDA_COUNT; i++) { /* the table has a row every 10 nm */
    int j = i / 10 < VL_DAYLIGHT_COUNT - 2 ? i / 10 : VL_DAYLIGHT_COUNT - 2;
    double f = (i - 10 * j) / 10.0, at[2];
    for (int k = 0; k < 2; k++)
      at[k] = vl_table_daylight[0][j + k] + m1 * vl_table_daylight[1][j + k] +
              m2 * vl_table_daylight[2][j + k];
    light[i] = at[0] + f * (at[1] - at[0]);
  }
}

/* ---- the matrix -------------------------------------------------------------------------- */

/* Response of three curves to a patch (null: white) under a light; curve k's value at nm i is
 * curves[k][i * stride]. */
static void project(const float *patch, const double light[VL_LAMBDA_COUNT],
                    const float *const curves[3], int stride, double seen[3]) {
  memset(seen, 0, 3 * sizeof *seen);
  for (int i = 0; i < VL_LAMBDA_COUNT; i++) {
    double r = patch ? sampled(patch, VL_CHECKER_SAMPLES, 1, VL_LAMBDA_MIN + i) : 1.0;
    double w = r * light[i];
    for (int k = 0; k < 3; k++)
      seen[k] += w * (double)curves[k][i * stride];
  }
}

void vl_sensor_make(const vlSensorCurves *sensor, double kelvin, vlColorSpace space,
                    float *observer, double xyz_from_sensor[9]) {
  double light[VL_LAMBDA_COUNT], white[VL_LAMBDA_COUNT];
  /* of a white patch: what the sensor and the eye see in the light, and the eye in white */
  double lit[3], shown[3], output[3];
  double inverse[9], transposed[9];
  const float *const eye[3] = {vl_cie_x(), vl_cie_y(), vl_cie_z()};
  const float *const own[3] = {observer, observer + 1, observer + 2};
  const float *illuminant = vl_space_illuminant(space);
  for (int i = 0; i < VL_LAMBDA_COUNT; i++) {
    for (int k = 0; k < 3; k++)
      observer[4 * i + k] =
          (float)sampled(sensor->rgb + k, VL_SENSOR_SAMPLES, 3, VL_LAMBDA_MIN + i);
    observer[4 * i + 3] = 0.0f;
    white[i] = (double)illuminant[i];
  }
  vl_daylight(kelvin, light);
  project(NULL, light, own, 4, lit);
  project(NULL, light, eye, 1, shown);
  project(NULL, white, eye, 1, output);
  /* the least-squares matrix from the sensor's values of the chart's patches to XYZ */
  double scale = shown[1] / lit[1], squares[9] = {0}, products[9] = {0};
  for (int p = 0; p < VL_CHECKER_PATCHES; p++) {
    double rgb[3], xyz[3];
    project(vl_checker_patches[p], light, own, 4, rgb);
    project(vl_checker_patches[p], white, eye, 1, xyz);
    for (int i = 0; i < 3; i++)
      for (int k = 0; k < 3; k++) {
        squares[3 * i + k] += rgb[i] / lit[1] * (rgb[k] / lit[1]);
        products[3 * i + k] += rgb[i] / lit[1] * (scale * xyz[k] / output[1]);
      }
  }
  vl_mat3_inverse(squares, inverse);
  vl_mat3_multiply(inverse, products, transposed);
  for (int i = 0; i < 9; i++)
    xyz_from_sensor[i] = transposed[3 * (i % 3) + i / 3];
}
