/* camera/plane.h: types of the projections: points of the plane and directions in camera space.
 * Plane points are offsets from the principal point in pixels divided by the focal length, with
 * x right and y down. Camera space has x right, y down and z forward. In both types `valid` is
 * 1 or 0; it is a double, so that all lanes of a loop have the same width. If `valid` is 0, the
 * other numbers are undefined. */
#ifndef CAMERA_PLANE_H
#define CAMERA_PLANE_H

typedef struct vlPlanePoint {
  double x, y, valid;
} vlPlanePoint;

/* A direction of any length. */
typedef struct vlDirection {
  double x, y, z, valid;
} vlDirection;

/* Lower bound of lengths that are used as divisors. It avoids 0/0, and x/length is exact for
 * all larger lengths. */
#define VL_TINY 1e-150
/* A direction is outside the domain if the projection's divisor is below this fraction of the
 * direction's length. At the limit the point is 1e12 focal lengths away, and the divisor has 4
 * correct digits. */
#define VL_HORIZON 1e-12

static inline double vl_length_2d(double x, double y) {
  return __builtin_sqrt(x * x + y * y);
}
static inline double vl_length_3d(double x, double y, double z) {
  return __builtin_sqrt(x * x + y * y + z * z);
}
static inline double vl_not_tiny(double length) {
  return length > VL_TINY ? length : VL_TINY;
}
static inline double vl_root(double x) {
  return __builtin_sqrt(x > 0.0 ? x : 0.0);
}

#endif
