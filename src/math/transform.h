/* math/transform.h: 4x4 matrices, row-major, column vectors, double. Used while building, never
 * in hot loops. */
#ifndef MATH_TRANSFORM_H
#define MATH_TRANSFORM_H

#include "math/double3.h"
#include "velo/base.h"

typedef struct vlMat4 {
  double m[16];
} vlMat4;

vlMat4 vl_mat4_identity(void);
vlMat4 vl_mat4_load(const double m[16]);
/* The columns of the matrix. */
vlMat4 vl_mat4_axes(const double x[3], const double y[3], const double z[3],
                    const double origin[3]);
vlMat4 vl_mat4_multiply(vlMat4 a, vlMat4 b);
/* Inverse. False (and the identity) if the matrix is singular. */
bool vl_mat4_inverse(vlMat4 a, vlMat4 *inverse);
vlMat4 vl_mat4_translate(double x, double y, double z);
vlMat4 vl_mat4_scale(double x, double y, double z);
vlMat4 vl_mat4_rotate(double radians, double x, double y, double z);
bool vl_mat4_is_finite(vlMat4 a);
bool vl_mat4_is_identity(const double m[16]);
/* divides by w if it is not 1 */
static inline void vl_mat4_point(const vlMat4 *a, const double p[3], double result[3]) {
  const double *m = a->m;
  double r[4];
  for (int i = 0; i < 4; i++)
    r[i] = m[4 * i] * p[0] + m[4 * i + 1] * p[1] + m[4 * i + 2] * p[2] + m[4 * i + 3];
  double s = r[3] == 1 ? 1 : 1 / r[3];
  for (int i = 0; i < 3; i++)
    result[i] = r[i] * s;
}
/* The same of a point in single precision. */
static inline void vl_mat4_vertex(const vlMat4 *a, const float p[3], double result[3]) {
  vl_mat4_point(a, (const double[3]){p[0], p[1], p[2]}, result);
}
void vl_mat4_vector(const vlMat4 *a, const double v[3], double result[3]);
/* Transforms a normal by the transpose of the inverse matrix, which the caller passes. The
 * result is not normalised. */
void vl_mat4_normal(const vlMat4 *inverse, const double n[3], double result[3]);
/* All points of a mesh, and all its normals. False: a point leaves the range of floats. flip:
 * normals turn around. */
bool vl_mat4_points(const vlMat4 *a, size_t count, const float *from, float *to);
void vl_mat4_vertex_normals(const vlMat4 *a, const vlMat4 *inverse, bool flip, size_t count,
                            const float *from, float *to);
/* The mean factor of the transform on lengths: the cube root of its determinant's absolute
 * value. */
double vl_mat4_scale_of(const vlMat4 *a);

/* 3x3, row-major. The inverse of a singular matrix is not finite. */
void vl_mat3_multiply(const double a[9], const double b[9], double result[9]);
void vl_mat3_inverse(const double a[9], double result[9]);

#endif
