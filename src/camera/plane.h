/* camera/plane.h: what the projections speak in: points of the plane, in pixels divided by the focal length and
 * measured from the principal point (x right, y down), and directions in camera space (x right, y down, z forward).
 * Both carry `valid`, 1 or 0, as a double, so that loops have lanes of one width. Where it is 0 the numbers mean
 * nothing. */
#ifndef CAMERA_PLANE_H
#define CAMERA_PLANE_H

typedef struct vlPlanePoint {
  double x, y, valid;
} vlPlanePoint;

/* Any length. */
typedef struct vlDirection {
  double x, y, z, valid;
} vlDirection;

/* Lengths that are divided by are at least this, so that 0/0 never arises and x/length stays exact for others. */
#define VL_TINY 1e-150

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
