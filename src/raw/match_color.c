/* raw/match_color.c: the colour matrices and the neutral of a sensor, from its spectral
 * sensitivities. The matrix is fitted by least squares over reflectances, under the constraint
 * that white is exact (Finlayson and Drew 1997, "Constrained least-squares regression in color
 * spaces"). */
#include <math.h>
#include <string.h>

#include "base/error.h"
#include "color/color.h"
#include "color/sensor.h"
#include "raw/raw.h"

enum { COLORS = VL_RAW_MAX_COLORS, WHITE = VL_CHECKER_PATCHES, SURFACES = WHITE + 1 };

/* What an observer of `count` curves sees of the patches and of white. */
typedef struct Seen {
  uint32_t count;
  double of[SURFACES][COLORS];
} Seen;

/* Reflectance of a patch at an integer wavelength: linear between the samples, constant beyond
 * the first and the last. */
static double reflectance(uint32_t patch, int nm) {
  int last = 380 + 10 * (VL_CHECKER_SAMPLES - 1);
  if (patch == WHITE)
    return 1.0;
  const float *v = vl_checker_patches[patch];
  if (nm <= 380)
    return (double)v[0];
  if (nm >= last)
    return (double)v[VL_CHECKER_SAMPLES - 1];
  int i = (nm - 380) / 10;
  double t = (nm - 380) % 10 / 10.0;
  return (double)v[i] + t * ((double)v[i + 1] - (double)v[i]);
}

/* The curves' sums over each surface under a light. */
static void look(const float *const *curves, uint32_t count, const float *light, Seen *seen) {
  memset(seen, 0, sizeof *seen);
  seen->count = count;
  for (uint32_t p = 0; p < SURFACES; p++)
    for (int i = 0; i < VL_LAMBDA_COUNT; i++) {
      double power = reflectance(p, VL_LAMBDA_MIN + i) * (double)light[i];
      for (uint32_t k = 0; k < count; k++)
        seen->of[p][k] += power * (double)curves[k][i];
    }
}

/* Divides all by a number. */
static void divide(Seen *seen, double by) {
  for (uint32_t p = 0; p < SURFACES; p++)
    for (uint32_t k = 0; k < seen->count; k++)
      seen->of[p][k] /= by;
}

static double greatest_of_white(const Seen *seen) {
  double greatest = 0.0;
  for (uint32_t k = 0; k < seen->count; k++)
    greatest = fmax(greatest, seen->of[WHITE][k]);
  return greatest;
}

/* The matrix (to->count x from->count, row-major) that maps `from` to `to` with the least sum
 * of squares over the patches, and white exactly. */
static bool fit(const Seen *from, const Seen *to, double *matrix) {
  uint32_t n = from->count, m = to->count;
  double squares[COLORS * COLORS] = {0}, right[COLORS * (COLORS + 1)] = {0};
  double solved[COLORS * (COLORS + 1)], along = 0.0;
  for (uint32_t p = 0; p < WHITE; p++)
    for (uint32_t i = 0; i < n; i++) {
      for (uint32_t k = 0; k < n; k++)
        squares[i * n + k] += from->of[p][i] * from->of[p][k];
      for (uint32_t k = 0; k < m; k++)
        right[i * (m + 1) + k] += from->of[p][i] * to->of[p][k];
    }
  for (uint32_t i = 0; i < n; i++)
    right[i * (m + 1) + m] = from->of[WHITE][i];
  if (!vl_raw_solve(n, squares, m + 1, right, solved))
    return false;
  /* columns 0 to m - 1: without the constraint; column m: the direction in which the constraint
   * moves each row at least cost */
  for (uint32_t i = 0; i < n; i++)
    along += from->of[WHITE][i] * solved[i * (m + 1) + m];
  for (uint32_t k = 0; k < m; k++) {
    double missing = to->of[WHITE][k];
    for (uint32_t i = 0; i < n; i++)
      missing -= solved[i * (m + 1) + k] * from->of[WHITE][i];
    for (uint32_t i = 0; i < n; i++)
      matrix[k * n + i] = solved[i * (m + 1) + k] + missing / along * solved[i * (m + 1) + m];
  }
  return true;
}

/* A multiple of 2^-20, which files hold exactly; no zero is negative. */
static float rounded(double value) {
  return (float)(rint(value * 0x1p20) * 0x1p-20 + 0.0);
}

/* Writes the matrix from XYZ to the camera's numbers under a light. */
static bool match(const float *const *curves, uint32_t count, const float *light,
                  float matrix[3 * COLORS]) {
  static const double identity[9] = {1, 0, 0, 0, 1, 0, 0, 0, 1};
  const float *const eye[3] = {vl_cie_x(), vl_cie_y(), vl_cie_z()};
  double result[3 * COLORS], inverse[9];
  Seen camera, xyz;
  look(curves, count, light, &camera);
  look(eye, 3, light, &xyz);
  divide(&camera, greatest_of_white(&camera));
  divide(&xyz, xyz.of[WHITE][1]);
  if (count == 3) {
    if (!fit(&camera, &xyz, inverse) || !vl_raw_solve(3, inverse, 3, identity, result))
      return false;
  } else if (!fit(&xyz, &camera, result)) {
    return false;
  }
  for (uint32_t i = 0; i < 3 * count; i++) {
    matrix[i] = rounded(result[i]);
    if (!(fabsf(matrix[i]) <= 1000.0f))
      return false;
  }
  return true;
}

/* Whether the spectra are finite, not negative, and each has a value above 0. */
static bool are_spectra(const float *values, uint32_t count) {
  for (uint32_t k = 0; k < count; k++) {
    bool any = false;
    for (uint32_t i = 0; i < VL_LAMBDA_COUNT; i++) {
      float v = values[k * VL_LAMBDA_COUNT + i];
      if (!(v >= 0.0f && v <= 1e30f))
        return false;
      any |= v > 0.0f;
    }
    if (!any)
      return false;
  }
  return true;
}

static vlResult named_light(const char *name, float light[VL_LAMBDA_COUNT], vlError *error) {
  vlSpectrum spectrum = {.kind = VL_SPECTRUM_NAMED, .scale = 1.0f, .name = name};
  return vl_spectrum_dense(&spectrum, VL_ROLE_UNBOUNDED, light, error);
}

/* The camera's numbers for white in the scene's light. False: there is a colour without any. */
static bool see_neutral(const float *const *curves, uint32_t count, const float *light,
                        float neutral[COLORS]) {
  Seen camera;
  look(curves, count, light, &camera);
  divide(&camera, greatest_of_white(&camera));
  for (uint32_t k = 0; k < count; k++) {
    neutral[k] = rounded(camera.of[WHITE][k]);
    if (!(neutral[k] >= 1e-6f))
      return false;
  }
  return true;
}

vlResult vl_raw_match_color(vlRawDef *def, const float *sensitivities, const float *light,
                            vlError *error) {
  static const char *const lights[2] = {"stdillum-A", "stdillum-D65"};
  const float *curves[COLORS];
  float tables[2][VL_LAMBDA_COUNT];
  vl_error_clear(error);
  if (!sensitivities)
    return vl_fail_argument(error, "colour of a sensor: sensitivities is null");
  VL_TRY(vl_raw_check(def, error));
  vlRawDef changed = *def;
  uint8_t colors[COLORS];
  uint32_t count = vl_raw_colors(def, colors);
  if (!are_spectra(sensitivities, count))
    return vl_fail_argument(
        error, "colour of a sensor: a sensitivity is negative, not finite or 0 everywhere");
  if (light && !are_spectra(light, 1))
    return vl_fail_argument(
        error, "colour of a sensor: the light is negative, not finite or 0 everywhere");
  for (uint32_t k = 0; k < count; k++)
    curves[k] = sensitivities + k * VL_LAMBDA_COUNT;
  memset(changed.matrices, 0, sizeof changed.matrices);
  memset(changed.neutral, 0, sizeof changed.neutral);
  for (int i = 0; i < 2; i++) {
    VL_TRY(named_light(lights[i], tables[i], error));
    if (count > 1 && !match(curves, count, tables[i], changed.matrices[i]))
      return vl_fail_argument(error,
                              "colour of a sensor: its sensitivities are linearly dependent");
  }
  if (!see_neutral(curves, count, light ? light : tables[1], changed.neutral))
    return vl_fail_argument(error,
                            "colour of a sensor: a colour sees nothing of the scene's light");
  *def = changed;
  return VL_OK;
}

/* ---- linear equations -------------------------------------------------------------------- */

enum { MAX_UNKNOWNS = 4 };

/* Swaps row `at` with the row below whose number in column `at` is the greatest, which is
 * returned. */
static double choose_pivot(uint32_t n, uint32_t at, double a[MAX_UNKNOWNS][2 * MAX_UNKNOWNS]) {
  uint32_t best = at;
  double row[2 * MAX_UNKNOWNS];
  for (uint32_t i = at + 1; i < n; i++)
    if (fabs(a[i][at]) > fabs(a[best][at]))
      best = i;
  memcpy(row, a[at], sizeof row);
  memcpy(a[at], a[best], sizeof row);
  memcpy(a[best], row, sizeof row);
  return fabs(a[at][at]);
}

/* Gaussian elimination with row pivots (Golub and Van Loan, Matrix Computations, 3.4). */
bool vl_raw_solve(uint32_t n, const double *a, uint32_t columns, const double *b, double *x) {
  double work[MAX_UNKNOWNS][2 * MAX_UNKNOWNS] = {{0}}, greatest = 0.0;
  for (uint32_t i = 0; i < n; i++) {
    for (uint32_t k = 0; k < n; k++) {
      work[i][k] = a[i * n + k];
      greatest = fmax(greatest, fabs(work[i][k]));
    }
    for (uint32_t k = 0; k < columns; k++)
      work[i][n + k] = b[i * columns + k];
  }
  for (uint32_t at = 0; at < n; at++) {
    if (!(choose_pivot(n, at, work) > 1e-12 * greatest))
      return false;
    for (uint32_t i = 0; i < n; i++) {
      double factor = work[i][at] / work[at][at];
      for (uint32_t k = at; i != at && k < n + columns; k++)
        work[i][k] -= factor * work[at][k];
    }
  }
  for (uint32_t i = 0; i < n; i++)
    for (uint32_t k = 0; k < columns; k++)
      x[i * columns + k] = work[i][n + k] / work[i][i];
  return true;
}
