/* raw/white.c: the matrix from a camera's numbers to linear sRGB, from the two matrices of a
 * raw image and its neutral, as the DNG specification describes it (Adobe, DNG 1.4, chapter 6,
 * "Mapping camera color space to CIE XYZ space"). */
#include <math.h>

#include "color/color.h"
#include "math/transform.h"
#include "raw/raw.h"

enum { COLORS = VL_RAW_MAX_COLORS, MAX_STEPS = 30 };

/* Temperatures of the illuminants A and D65, kelvin. */
static const double kelvin_a = 2856.0, kelvin_d65 = 6504.0;

/* Correlated colour temperature of a chromaticity (McCamy 1992); within 10 K of CIE's between A
 * and D65. */
static double temperature(const double xyz[3]) {
  double sum = xyz[0] + xyz[1] + xyz[2];
  double x = xyz[0] / sum, y = xyz[1] / sum;
  double n = (x - 0.3320) / (y - 0.1858);
  return 5520.33 - 6823.3 * n + 3525.0 * n * n - 449.0 * n * n * n;
}

/* The matrix for a temperature: linear in 1 / kelvin between the two, constant beyond. */
static void matrix_at(const vlRawDef *def, uint32_t count, double kelvin, double *matrix) {
  double share = (1.0 / kelvin - 1.0 / kelvin_d65) / (1.0 / kelvin_a - 1.0 / kelvin_d65);
  if (!(kelvin < kelvin_d65))
    share = 0.0;
  if (kelvin < kelvin_a)
    share = 1.0;
  for (uint32_t i = 0; i < 3 * count; i++)
    matrix[i] =
        share * (double)def->matrices[0][i] + (1.0 - share) * (double)def->matrices[1][i];
}

/* The 3 x count matrix from the camera's numbers to XYZ: (M^T M)^-1 M^T, which is the inverse
 * for three colours. */
static bool invert(const double *m, uint32_t count, double *xyz_from_camera) {
  double squares[9] = {0}, transposed[3 * COLORS];
  for (uint32_t i = 0; i < 3; i++)
    for (uint32_t k = 0; k < count; k++) {
      transposed[i * count + k] = m[3 * k + i];
      for (uint32_t j = 0; j < 3; j++)
        squares[3 * i + j] += m[3 * k + i] * m[3 * k + j];
    }
  return count >= 3 && vl_raw_solve(3, squares, count, transposed, xyz_from_camera);
}

static void apply(const double *matrix, uint32_t columns, const double *v, double result[3]) {
  for (uint32_t i = 0; i < 3; i++) {
    result[i] = 0.0;
    for (uint32_t k = 0; k < columns; k++)
      result[i] += matrix[i * columns + k] * v[k];
  }
}

/* Bradford's adaptation of one white to another, both XYZ with Y 1 (Lam 1985; DNG 1.4, chapter
 * 6). */
static void adapt(const double from[3], const double to[3], double result[9]) {
  static const double cones[9] = {0.8951, 0.2664, -0.1614, -0.7502, 1.7135,
                                  0.0367, 0.0389, -0.0685, 1.0296};
  double inverse[9], scaled[9], a[3], b[3];
  vl_mat3_inverse(cones, inverse);
  apply(cones, 3, from, a);
  apply(cones, 3, to, b);
  for (int i = 0; i < 9; i++)
    scaled[i] = cones[i] * (b[i / 3] / a[i / 3]);
  vl_mat3_multiply(inverse, scaled, result);
}

/* Writes the row-major matrix from XYZ to linear sRGB. */
static void srgb_matrix(double rgb_from_xyz[9]) {
  float matrix[9];
  vl_rgb_from_xyz(VL_SPACE_SRGB, matrix);
  for (int i = 0; i < 9; i++)
    rgb_from_xyz[i] = (double)matrix[i];
}

/* The white of sRGB, D65. */
static void white_d65(double xyz[3]) {
  static const double ones[3] = {1.0, 1.0, 1.0};
  double rgb_from_xyz[9], xyz_from_rgb[9];
  srgb_matrix(rgb_from_xyz);
  vl_mat3_inverse(rgb_from_xyz, xyz_from_rgb);
  apply(xyz_from_rgb, 3, ones, xyz);
}

/* Finds the white whose temperature's matrix maps it to the neutral: XYZ with Y 1, and the
 * matrix to XYZ. */
static bool find_white(const vlRawDef *def, uint32_t count, const double *neutral,
                       double white[3], double *xyz_from_camera, double *kelvin) {
  double matrix[3 * COLORS];
  *kelvin = 5003.0; /* D50, where the specification begins */
  for (int step = 0; step < MAX_STEPS; step++) {
    double before = *kelvin;
    matrix_at(def, count, before, matrix);
    if (!invert(matrix, count, xyz_from_camera))
      return false;
    apply(xyz_from_camera, count, neutral, white);
    *kelvin = temperature(white);
    if (!(white[1] > 0.0) || !(fabs(*kelvin) < 1e9))
      return false;
    if (fabs(*kelvin - before) < 1e-6)
      break;
  }
  double y = white[1];
  for (int i = 0; i < 3; i++)
    white[i] /= y;
  for (uint32_t i = 0; i < 3 * count; i++)
    xyz_from_camera[i] /= y;
  return true;
}

void vl_raw_neutral(const vlRawDef *def, double neutral[VL_RAW_MAX_COLORS]) {
  uint8_t colors[COLORS];
  uint32_t count = vl_raw_colors(def, colors);
  double xyz[3], seen[COLORS], greatest = 0.0;
  white_d65(xyz);
  for (uint32_t k = 0; k < count; k++) {
    const float *row = def->matrices[1] + 3 * k;
    seen[k] = (double)row[0] * xyz[0] + (double)row[1] * xyz[1] + (double)row[2] * xyz[2];
    greatest = fmax(greatest, seen[k]);
  }
  for (uint32_t k = 0; k < count; k++) {
    neutral[k] = def->neutral[k] > 0.0f ? (double)def->neutral[k] : seen[k] / greatest;
    if (!(neutral[k] > 0.0))
      neutral[k] = 1.0;
  }
}

bool vl_raw_color_matrix(const vlRawDef *def, double rgb_from_camera[3 * VL_RAW_MAX_COLORS],
                         double *kelvin) {
  double neutral[COLORS], white[3], xyz_from_camera[3 * COLORS], adapted[9], whole[9], d65[3];
  double rgb_from_xyz[9];
  uint8_t colors[COLORS];
  uint32_t count = vl_raw_colors(def, colors);
  vl_raw_neutral(def, neutral);
  if (!vl_raw_has_matrices(def) ||
      !find_white(def, count, neutral, white, xyz_from_camera, kelvin))
    return false;
  srgb_matrix(rgb_from_xyz);
  white_d65(d65);
  adapt(white, d65, adapted);
  vl_mat3_multiply(rgb_from_xyz, adapted, whole);
  for (uint32_t i = 0; i < 3; i++)
    for (uint32_t k = 0; k < count; k++) {
      double sum = 0.0;
      for (uint32_t j = 0; j < 3; j++)
        sum += whole[3 * i + j] * xyz_from_camera[j * count + k];
      rgb_from_camera[i * count + k] = sum;
      if (!isfinite(sum))
        return false;
    }
  return true;
}
