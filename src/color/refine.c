/* color/refine.c: exact conversion of single RGB values to spectra: the table's result refined
 * by Newton's method. It serves constants and lights; texels use the table directly. Only + - *
 * / and sqrt in double are used, so the results have the same bits on every machine. */
#include <string.h>

#include "color/rgb_table.h"
#include "color/tables.h"
#include "math/double3.h"

/* Sums are accumulated in four fixed parts, so that the compiler may vectorise them without
 * reassociation. */
enum { PARTS = 4, PADDED = (VL_LAMBDA_COUNT + PARTS - 1) / PARTS * PARTS };

static double dot(const double *a, const double *b) {
  double sum[PARTS] = {0};
  for (int i = 0; i < PADDED; i += PARTS)
    for (int k = 0; k < PARTS; k++)
      sum[k] += a[i + k] * b[i + k];
  return (sum[0] + sum[1]) + (sum[2] + sum[3]);
}

/* Computes the colour under the space's illuminant and its derivatives by c0, c1, c2 (the
 * Jacobian, one row per colour component). Weights are padded with zeros. */
static void shown(const double weight[3][PADDED], const double c[3], double rgb[3],
                  double jacobian[9]) {
  double s[PADDED], slope[3][PADDED];
  for (int i = 0; i < PADDED; i++) {
    double t = i * (1.0 / (VL_LAMBDA_COUNT - 1)), x = (c[0] * t + c[1]) * t + c[2];
    double inv = 1 / __builtin_sqrt(1 + x * x), d = 0.5 * inv * inv * inv;
    s[i] = 0.5 + 0.5 * x * inv;
    slope[0][i] = d * t * t;
    slope[1][i] = d * t;
    slope[2][i] = d;
  }
  for (int k = 0; k < 3; k++) {
    rgb[k] = dot(weight[k], s);
    for (int j = 0; j < 3; j++)
      jacobian[3 * k + j] = dot(weight[k], slope[j]);
  }
}

static double worst_of(const double a[3], const double b[3]) {
  double worst = 0;
  for (int k = 0; k < 3; k++) {
    double e = a[k] > b[k] ? a[k] - b[k] : b[k] - a[k];
    worst = e > worst ? e : worst;
  }
  return worst;
}

/* The error of the spectrum as computed in float. */
static double error_of(const double weight[3][PADDED], vlSigmoid s, const double target[3]) {
  double rgb[3], v[PADDED];
  for (int i = 0; i < PADDED; i++)
    v[i] = (double)vl_sigmoid(s, (float)(VL_LAMBDA_MIN + i));
  for (int k = 0; k < 3; k++)
    rgb[k] = dot(weight[k], v);
  return worst_of(rgb, target);
}

/* Solves a 3x3 system by Cramer's rule. */
static bool solve(const double m[9], const double b[3], double x[3]) {
  double c0 = m[4] * m[8] - m[5] * m[7], c1 = m[5] * m[6] - m[3] * m[8],
         c2 = m[3] * m[7] - m[4] * m[6];
  double det = m[0] * c0 + m[1] * c1 + m[2] * c2;
  if (!(det > 1e-30 || det < -1e-30))
    return false;
  x[0] = (b[0] * c0 + b[1] * (m[2] * m[7] - m[1] * m[8]) + b[2] * (m[1] * m[5] - m[2] * m[4])) /
         det;
  x[1] = (b[0] * c1 + b[1] * (m[0] * m[8] - m[2] * m[6]) + b[2] * (m[2] * m[3] - m[0] * m[5])) /
         det;
  x[2] = (b[0] * c2 + b[1] * (m[1] * m[6] - m[0] * m[7]) + b[2] * (m[0] * m[4] - m[1] * m[3])) /
         det;
  return true;
}

vlSigmoid vl_sigmoid_from_rgb(vlColorSpace space, float r, float g, float b) {
  if ((unsigned)space > VL_SPACE_ACES2065_1)
    space = VL_SPACE_SRGB;
  vlSigmoid s = vl_rgb_table_lookup(vl_rgb_table(space), r, g, b);
  if (s.c0 == 0 && s.c1 == 0)
    return s; /* the table is exact for greys */

  const vlSpaceTable *table = &vl_table_spaces[space];
  const float *light = vl_table_named[table->illuminant].values, rgb[3] = {r, g, b};
  double weight[3][PADDED], target[3];
  for (int k = 0; k < 3; k++) {
    const double *m = table->rgb_from_xyz + 3 * k;
    target[k] = rgb[k] > 0 ? (rgb[k] < 1 ? (double)rgb[k] : 1.0) : 0.0;
    for (int i = VL_LAMBDA_COUNT; i < PADDED; i++)
      weight[k][i] = 0;
    for (int i = 0; i < VL_LAMBDA_COUNT; i++) {
      weight[k][i] = (m[0] * (double)vl_table_cie[0][i] + m[1] * (double)vl_table_cie[1][i] +
                      m[2] * (double)vl_table_cie[2][i]) *
                     (double)light[i] / vl_table_y_integral;
    }
  }
  double c[3] = {(double)s.c0, (double)s.c1, (double)s.c2}, value[3], jacobian[9];
  shown(weight, c, value, jacobian);
  double error = worst_of(value, target);
  /* Colours that no reflectance can have keep the spectrum from the table. */
  double factor = 1;
  for (int round = 0; round < 12 && error < 3e-3 && error > 1e-9 && factor > 0.05; round++) {
    double miss[3], step[3], next[3], next_value[3], next_jacobian[9];
    vl_sub3(target, value, miss);
    if (!solve(jacobian, miss, step))
      break;
    vl_along3(c, factor, step, next);
    shown(weight, next, next_value, next_jacobian);
    double next_error = worst_of(next_value, target);
    if (!(next_error < error)) {
      factor *= 0.5;
      continue;
    }
    factor = 1;
    error = next_error;
    memcpy(c, next, sizeof c);
    memcpy(value, next_value, sizeof value);
    memcpy(jacobian, next_jacobian, sizeof jacobian);
  }
  /* rounding to float may lose the gain if coefficients nearly cancel */
  vlSigmoid refined = {(float)c[0], (float)c[1], (float)c[2]};
  return error_of(weight, refined, target) < error_of(weight, s, target) ? refined : s;
}
