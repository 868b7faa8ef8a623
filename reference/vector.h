/* vector.h: points, directions and transforms in double precision. */
#pragma once
#include <math.h>

typedef struct vector {
  double x, y, z;
} vector;

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
  return scale(-1, a);
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
/* The weighted sum wa a + wb b + wc c. */
static inline vector blend(vector a, vector b, vector c, double wa, double wb, double wc) {
  return add(scale(wa, a), add(scale(wb, b), scale(wc, c)));
}
static inline double clamp(double x, double low, double high) {
  return x < low ? low : x > high ? high : x;
}
static inline double square(double x) {
  return x * x;
}

/* A frame is three axes and an origin: the lecture's u, v, w and eye. As a matrix, whose columns they are, it takes
 * local coordinates to the space in which the axes are given: `world_from_shape` takes a point of the shape to the
 * world. */
typedef struct frame {
  vector x, y, z, origin;
} frame;
typedef frame matrix;

/* The library's matrices: 16 numbers, row after row. Their columns are the axes and the origin. */
static inline matrix load_matrix(const double m[16]) {
  return (matrix){{m[0], m[4], m[8]}, {m[1], m[5], m[9]}, {m[2], m[6], m[10]}, {m[3], m[7], m[11]}};
}
static const matrix IDENTITY = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {0, 0, 0}};
static inline vector transform_vector(const matrix *a, vector v) {
  return blend(a->x, a->y, a->z, v.x, v.y, v.z);
}
static inline vector transform_point(const matrix *a, vector p) {
  return add(a->origin, transform_vector(a, p));
}
/* A normal stays perpendicular to its surface by the transpose of the inverse, here given (pbrt book 3.10.3). */
static inline vector transform_normal(const matrix *inverse, vector n) {
  return make_vector(dot(inverse->x, n), dot(inverse->y, n), dot(inverse->z, n));
}
static inline matrix multiply(matrix a, matrix b) {
  return (matrix){transform_vector(&a, b.x), transform_vector(&a, b.y), transform_vector(&a, b.z),
                  transform_point(&a, b.origin)};
}
/* The volume of the unit cube after the transform; negative where the transform mirrors. */
static inline double determinant(const matrix *a) {
  return dot(a->x, cross(a->y, a->z));
}
/* Cramer's rule: the rows of the inverse are cross products of the columns over the determinant. */
static inline matrix invert(const matrix *a) {
  double d = 1 / determinant(a);
  vector row0 = scale(d, cross(a->y, a->z)), row1 = scale(d, cross(a->z, a->x)), row2 = scale(d, cross(a->x, a->y));
  matrix inverse = {{row0.x, row1.x, row2.x}, {row0.y, row1.y, row2.y}, {row0.z, row1.z, row2.z}, {0, 0, 0}};
  inverse.origin = negate(transform_vector(&inverse, a->origin));
  return inverse;
}

/* The lecture's compute_uvw: three axes of length 1, perpendicular to each other. z is the normal n; x is the tangent
 * without its part along n (Gram-Schmidt). Where nothing is left of the tangent, any x perpendicular to n will do. */
static inline frame make_frame(vector n, vector tangent) {
  vector x = subtract(tangent, scale(dot(n, tangent), n));
  if (!(length(x) > 1e-9 * length(tangent)))
    x = cross(n, fabs(n.x) > 0.9 ? make_vector(0, 1, 0) : make_vector(1, 0, 0));
  x = normalize(x);
  return (frame){x, cross(n, x), n, {0, 0, 0}};
}
/* A direction of the world in the axes of an orthonormal frame, and back. */
static inline vector to_local(frame f, vector v) {
  return make_vector(dot(v, f.x), dot(v, f.y), dot(v, f.z));
}
static inline vector from_local(frame f, vector v) {
  return transform_vector(&f, v);
}
