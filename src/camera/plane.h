/* camera/plane.h: types of the projections: points of the plane, in pixels divided by the focal length, relative to
 * the principal point (x right, y down), and directions in camera space (x right, y down, z forward). Both have
 * `valid`, 1 or 0, as a double, so that loops have lanes of one width. If it is 0, the other numbers are undefined. */
#ifndef CAMERA_PLANE_H
#define CAMERA_PLANE_H

typedef struct vlPlanePoint {
  double x, y, valid;
} vlPlanePoint;

/* Any length. */
typedef struct vlDirection {
  double x, y, z, valid;
} vlDirection;

/* Lower bound of lengths used as divisors: avoids 0/0, and leaves x/length exact for all larger lengths. */
#define VL_TINY 1e-150
/* A projection's divisor, relative to its length, below which a direction is outside the domain: the point would be
 * 1e12 focal lengths away, and the divisor has 4 correct digits. */
#define VL_HORIZON 1e-12

static inline double vl_length2(double x, double y) {
  return __builtin_sqrt(x * x + y * y);
}
static inline double vl_length3(double x, double y, double z) {
  return __builtin_sqrt(x * x + y * y + z * z);
}
static inline double vl_not_tiny(double length) {
  return length > VL_TINY ? length : VL_TINY;
}
static inline double vl_root(double x) {
  return __builtin_sqrt(x > 0.0 ? x : 0.0);
}

#endif
