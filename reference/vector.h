/* vector.h: points, directions and transforms in double precision. A 4 x 4 matrix is row-major; `world_from_shape`
 * takes a point of the shape's space to the world. */
#ifndef REFERENCE_VECTOR_H
#define REFERENCE_VECTOR_H

#include <math.h>

typedef struct vector {
  double x, y, z;
} vector;

typedef struct matrix {
  double m[16];
} matrix;

static const double PI = 3.14159265358979323846;

static inline vector make_vector(double x, double y, double z) {
  return (vector){x, y, z};
}
static inline vector from_floats(const float *a) {
  return (vector){(double)a[0], (double)a[1], (double)a[2]};
}
static inline vector add(vector a, vector b) {
  return (vector){a.x + b.x, a.y + b.y, a.z + b.z};
}
static inline vector subtract(vector a, vector b) {
  return (vector){a.x - b.x, a.y - b.y, a.z - b.z};
}
static inline vector scale(double s, vector a) {
  return (vector){s * a.x, s * a.y, s * a.z};
}
static inline vector negate(vector a) {
  return (vector){-a.x, -a.y, -a.z};
}
static inline double dot(vector a, vector b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}
static inline vector cross(vector a, vector b) {
  return (vector){a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
static inline double length(vector a) {
  return sqrt(dot(a, a));
}
static inline vector normalize(vector a) {
  double l = length(a);
  return l > 0 ? scale(1 / l, a) : a;
}
/* a on the side of b: negated where they point apart. */
static inline vector face_forward(vector a, vector b) {
  return dot(a, b) < 0 ? negate(a) : a;
}
static inline vector least(vector a, vector b) {
  return (vector){fmin(a.x, b.x), fmin(a.y, b.y), fmin(a.z, b.z)};
}
static inline vector greatest(vector a, vector b) {
  return (vector){fmax(a.x, b.x), fmax(a.y, b.y), fmax(a.z, b.z)};
}
static inline double clamp(double x, double low, double high) {
  return x < low ? low : x > high ? high : x;
}
static inline double square(double x) {
  return x * x;
}

/* The weighted sum of three corners. */
static inline vector blend(vector a, vector b, vector c, double wa, double wb, double wc) {
  return add(scale(wa, a), add(scale(wb, b), scale(wc, c)));
}

/* ---- transforms -------------------------------------------------------------------------------------------------- */

static inline matrix load_matrix(const double m[16]) {
  matrix result;
  for (int i = 0; i < 16; i++) result.m[i] = m[i];
  return result;
}
static inline matrix identity_matrix(void) {
  return (matrix){{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1}};
}
static inline matrix multiply(matrix a, matrix b) {
  matrix c;
  for (int row = 0; row < 4; row++) {
    for (int column = 0; column < 4; column++) {
      double sum = 0;
      for (int k = 0; k < 4; k++) sum += a.m[4 * row + k] * b.m[4 * k + column];
      c.m[4 * row + column] = sum;
    }
  }
  return c;
}
static inline vector transform_point(const matrix *a, vector p) {
  const double *m = a->m;
  return (vector){m[0] * p.x + m[1] * p.y + m[2] * p.z + m[3], m[4] * p.x + m[5] * p.y + m[6] * p.z + m[7],
                  m[8] * p.x + m[9] * p.y + m[10] * p.z + m[11]};
}
static inline vector transform_vector(const matrix *a, vector v) {
  const double *m = a->m;
  return (vector){m[0] * v.x + m[1] * v.y + m[2] * v.z, m[4] * v.x + m[5] * v.y + m[6] * v.z,
                  m[8] * v.x + m[9] * v.y + m[10] * v.z};
}
/* Normals are transformed by the inverse transposed; `inverse` is the inverse of the transform. */
static inline vector transform_normal(const matrix *inverse, vector n) {
  const double *m = inverse->m;
  return (vector){m[0] * n.x + m[4] * n.y + m[8] * n.z, m[1] * n.x + m[5] * n.y + m[9] * n.z,
                  m[2] * n.x + m[6] * n.y + m[10] * n.z};
}
/* The determinant of the linear part; negative where the transform mirrors. */
static inline double determinant(const matrix *a) {
  const double *m = a->m;
  return m[0] * (m[5] * m[10] - m[6] * m[9]) - m[1] * (m[4] * m[10] - m[6] * m[8]) + m[2] * (m[4] * m[9] - m[5] * m[8]);
}
/* The inverse of an affine transform (last row 0 0 0 1), by Cramer's rule. */
static inline matrix invert(const matrix *a) {
  const double *m = a->m;
  double d = 1 / determinant(a);
  matrix r = identity_matrix();
  for (int i = 0; i < 3; i++) {
    for (int j = 0; j < 3; j++) {
      int a1 = (j + 1) % 3, a2 = (j + 2) % 3, b1 = (i + 1) % 3, b2 = (i + 2) % 3;
      r.m[4 * i + j] = d * (m[4 * a1 + b1] * m[4 * a2 + b2] - m[4 * a1 + b2] * m[4 * a2 + b1]);
    }
  }
  vector back = transform_vector(&r, make_vector(m[3], m[7], m[11]));
  r.m[3] = -back.x;
  r.m[7] = -back.y;
  r.m[11] = -back.z;
  return r;
}

/* ---- frames ------------------------------------------------------------------------------------------------------ */

/* An orthonormal frame around a normal n: the local z axis. Local directions of a BSDF are in it. */
typedef struct frame {
  vector s, t, n;
} frame;

/* s follows the tangent as far as it can (Gram-Schmidt); any s will do where the tangent is parallel to n. */
static inline frame make_frame(vector n, vector tangent) {
  vector s = subtract(tangent, scale(dot(n, tangent), n));
  if (!(length(s) > 1e-9 * length(tangent))) {
    vector other = fabs(n.x) > 0.9 ? make_vector(0, 1, 0) : make_vector(1, 0, 0);
    s = cross(n, other);
  }
  s = normalize(s);
  return (frame){s, cross(n, s), n};
}
static inline vector to_local(frame f, vector v) {
  return (vector){dot(v, f.s), dot(v, f.t), dot(v, f.n)};
}
static inline vector from_local(frame f, vector v) {
  return blend(f.s, f.t, f.n, v.x, v.y, v.z);
}

#endif
