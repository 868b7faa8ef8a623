/* camera/plane.h: what the functions of projections are given and give: points of the plane and
 * directions in camera space.
 * Plane points are offsets from the principal point in pixels divided by the focal length, with
 * x right and y down. Camera space has x right, y down and z forward. In both types `valid` is
 * 1 or 0; it is a double, so that all lanes of a loop have the same width. If `valid` is 0, the
 * other numbers are undefined. */
#ifndef CAMERA_PLANE_H
#define CAMERA_PLANE_H

#include "base/attributes.h"

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

/* ---- a projection's functions ----------------------------------------------------------- */

/* A projection need not use all of its arguments. These are those of vl_unproject_NAME: the
 * compiled camera (camera/rays.h), whose member `shape` holds the numbers of the projection;
 * for VL_PROJECTION_CUBE the `cell`; a point of the plane. */
#define VL_UNPROJECT_INPUT                                                        \
  VL_UNUSED const vlCameraCompiled *c, VL_UNUSED double cell, VL_UNUSED double x, \
      VL_UNUSED double y
/* The arguments of vl_project_NAME: the compiled camera, a point in camera space. */
#define VL_PROJECT_INPUT                                                       \
  VL_UNUSED const vlCameraCompiled *c, VL_UNUSED double x, VL_UNUSED double y, \
      VL_UNUSED double z

/* Derivatives of a plane point: by x, y, z of the point in camera space, then by the two
 * numbers of vlCamera.shape. */
typedef struct vlPlaneDerivatives {
  double x[5], y[5];
} vlPlaneDerivatives;

/* The derivatives of (x k, y k); by: those of k. */
static inline vlPlaneDerivatives vl_derive_factor(double x, double y, double k,
                                                  const double by[5]) {
  vlPlaneDerivatives d;
  for (int i = 0; i < 5; i++) {
    d.x[i] = x * by[i];
    d.y[i] = y * by[i];
  }
  d.x[0] += k;
  d.y[1] += k;
  return d;
}
/* The derivatives of (x, y) / divisor; by: those of the divisor. */
static inline vlPlaneDerivatives vl_derive_quotient(double x, double y, double divisor,
                                                    const double by[5]) {
  double k = 1.0 / divisor, of_k[5];
  for (int i = 0; i < 5; i++)
    of_k[i] = -by[i] * k * k;
  return vl_derive_factor(x, y, k, of_k);
}

#endif
