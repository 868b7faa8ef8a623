/* math/transform.c: see transform.h. */
#include "math/transform.h"

#include <math.h>

#include "math/elementary.h"

vlMat4 vl_mat4_identity(void) {
  return (vlMat4){{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1}};
}

vlMat4 vl_mat4_load(const double m[16]) {
  vlMat4 r;
  for (int i = 0; i < 16; i++)
    r.m[i] = m[i];
  return r;
}

vlMat4 vl_mat4_axes(const double x[3], const double y[3], const double z[3],
                    const double origin[3]) {
  vlMat4 r = vl_mat4_identity();
  for (int i = 0; i < 3; i++) {
    r.m[4 * i] = x[i];
    r.m[4 * i + 1] = y[i];
    r.m[4 * i + 2] = z[i];
    r.m[4 * i + 3] = origin[i];
  }
  return r;
}

vlMat4 vl_mat4_multiply(vlMat4 a, vlMat4 b) {
  vlMat4 r;
  for (int i = 0; i < 4; i++)
    for (int j = 0; j < 4; j++) {
      double s = 0;
      for (int k = 0; k < 4; k++)
        s += a.m[4 * i + k] * b.m[4 * k + j];
      r.m[4 * i + j] = s;
    }
  return r;
}

bool vl_mat4_inverse(vlMat4 a, vlMat4 *inverse) {
  /* Gauss-Jordan elimination with row pivoting. */
  double w[4][8];
  for (int i = 0; i < 4; i++)
    for (int j = 0; j < 8; j++)
      w[i][j] = j < 4 ? a.m[4 * i + j] : (j - 4 == i);
  *inverse = vl_mat4_identity();
  for (int c = 0; c < 4; c++) {
    int pivot = c;
    for (int r = c + 1; r < 4; r++)
      if (fabs(w[r][c]) > fabs(w[pivot][c]))
        pivot = r;
    if (!(fabs(w[pivot][c]) > 0) || !isfinite(w[pivot][c]))
      return false;
    for (int j = 0; j < 8; j++) {
      double t = w[c][j];
      w[c][j] = w[pivot][j];
      w[pivot][j] = t;
    }
    double scale = 1 / w[c][c];
    for (int j = 0; j < 8; j++)
      w[c][j] *= scale;
    for (int r = 0; r < 4; r++) {
      double f = w[r][c];
      if (r == c || f == 0)
        continue;
      for (int j = 0; j < 8; j++)
        w[r][j] -= f * w[c][j];
    }
  }
  for (int i = 0; i < 4; i++)
    for (int j = 0; j < 4; j++)
      inverse->m[4 * i + j] = w[i][j + 4];
  return vl_mat4_is_finite(*inverse);
}

vlMat4 vl_mat4_translate(double x, double y, double z) {
  return (vlMat4){{1, 0, 0, x, 0, 1, 0, y, 0, 0, 1, z, 0, 0, 0, 1}};
}

vlMat4 vl_mat4_scale(double x, double y, double z) {
  return (vlMat4){{x, 0, 0, 0, 0, y, 0, 0, 0, 0, z, 0, 0, 0, 0, 1}};
}

vlMat4 vl_mat4_rotate(double radians, double x, double y, double z) {
  double length = sqrt(x * x + y * y + z * z);
  if (!(length > 0))
    return vl_mat4_identity();
  x /= length;
  y /= length;
  z /= length;
  double s = vl_precise_sin(radians), c = vl_precise_cos(radians), t = 1 - c;
  return (vlMat4){{x * x * t + c, x * y * t - z * s, x * z * t + y * s, 0, x * y * t + z * s,
                   y * y * t + c, y * z * t - x * s, 0, x * z * t - y * s, y * z * t + x * s,
                   z * z * t + c, 0, 0, 0, 0, 1}};
}

bool vl_mat4_is_finite(vlMat4 a) {
  for (int i = 0; i < 16; i++)
    if (!isfinite(a.m[i]))
      return false;
  return true;
}

bool vl_mat4_is_identity(const double m[16]) {
  for (int i = 0; i < 16; i++)
    if (m[i] != (i % 5 == 0 ? 1.0 : 0.0))
      return false;
  return true;
}

void vl_mat4_vector(const vlMat4 *a, const double v[3], double result[3]) {
  double r[3];
  vl_map_vector(a->m, v, r);
  for (int i = 0; i < 3; i++)
    result[i] = r[i];
}

void vl_mat4_normal(const vlMat4 *inverse, const double n[3], double result[3]) {
  double r[3];
  vl_map_normal(inverse->m, n, r);
  for (int i = 0; i < 3; i++)
    result[i] = r[i];
}

double vl_mat4_scale_of(const vlMat4 *a) {
  return vl_precise_cbrt(fabs(vl_determinant3(a->m)));
}

bool vl_mat4_points(const vlMat4 *a, size_t count, const float *from, float *to) {
  bool finite = true;
  for (size_t i = 0; i < 3 * count; i += 3) {
    double p[3] = {from[i], from[i + 1], from[i + 2]}, q[3];
    vl_mat4_point(a, p, q);
    for (size_t k = 0; k < 3; k++) {
      to[i + k] = (float)q[k];
      finite = finite && isfinite(to[i + k]);
    }
  }
  return finite;
}

/* The normal of a mesh's vertex. Its length is a weight where normals are interpolated, as in
 * pbrt: a mesh looks the same whether it or its instance is stretched. scale: the transform's
 * mean factor on lengths, which keeps unit normals near length 1. A length of 1 but for
 * rounding becomes 1, and so do lengths whose square a float cannot hold. */
static void vertex_normal(const vlMat4 *inverse, double scale, const float n[3],
                          float result[3]) {
  const double rounding = 1e-4, max = 1e12;
  double given[3] = {(double)n[0], (double)n[1], (double)n[2]}, q[3];
  vl_mat4_normal(inverse, given, q);
  double length = vl_norm3(q), weight = length * scale;
  if (fabs(weight - 1) <= rounding || !(weight >= 1 / max && weight <= max))
    weight = 1;
  double factor = length > 0 ? weight / length : 0;
  for (int k = 0; k < 3; k++)
    result[k] = (float)(q[k] * factor);
}

void vl_mat4_vertex_normals(const vlMat4 *a, const vlMat4 *inverse, bool flip, size_t count,
                            const float *from, float *to) {
  double scale = vl_mat4_scale_of(a);
  for (size_t i = 0; i < 3 * count; i += 3) {
    vertex_normal(inverse, scale, from + i, to + i);
    for (size_t k = 0; flip && k < 3; k++)
      to[i + k] = -to[i + k];
  }
}

void vl_mat3_multiply(const double a[9], const double b[9], double r[9]) {
  for (int i = 0; i < 3; i++)
    for (int j = 0; j < 3; j++)
      r[3 * i + j] = a[3 * i] * b[j] + a[3 * i + 1] * b[3 + j] + a[3 * i + 2] * b[6 + j];
}

void vl_mat3_inverse(const double a[9], double r[9]) {
  double det = vl_mat3_determinant(a);
  for (int i = 0; i < 3; i++)
    for (int j = 0; j < 3; j++) {
      int i1 = (j + 1) % 3, i2 = (j + 2) % 3, j1 = (i + 1) % 3, j2 = (i + 2) % 3;
      r[3 * i + j] = (a[3 * i1 + j1] * a[3 * i2 + j2] - a[3 * i1 + j2] * a[3 * i2 + j1]) / det;
    }
}
