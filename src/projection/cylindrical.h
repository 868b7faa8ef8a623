/* projection/cylindrical.h: the cylindrical projection and its inverse. The cylinder's axis is
 * the camera's vertical axis. x is the longitude (radians, -pi to pi); y is the tangent of the
 * latitude and points down. Vertical lines and the horizon stay straight. The plane wraps
 * around: it extends by `over` (radians) beyond -pi and pi, so that filters see no edge. */
#ifndef PROJECTION_CYLINDRICAL_H
#define PROJECTION_CYLINDRICAL_H

#include "camera/plane.h"
#include "camera/rays.h"
#include "math/approx_double.h"

VL_INLINE vlDirection vl_unproject_cylindrical(VL_UNPROJECT_INPUT) {
  double over = c->over_x;
  int inside = __builtin_fabs(x) <= 3.14159265358979323846 + over;
  vlSinCosDouble lon = vl_sincos_double(inside ? x : 0.0);
  return (vlDirection){lon.sin, y, lon.cos, inside ? 1.0 : 0.0};
}
/* The domain is all directions except straight up and straight down. */
VL_INLINE vlPlanePoint vl_project_cylindrical(VL_PROJECT_INPUT) {
  double across = vl_length_2d(x, z);
  return (vlPlanePoint){vl_atan2_double(x, z), y / vl_not_tiny(across),
                        across > 0.0 ? 1.0 : 0.0};
}

VL_INLINE vlPlaneDerivatives vl_derive_cylindrical(VL_PROJECT_INPUT) {
  double across2 = x * x + z * z, across = vl_length_2d(x, z), g = -y / (across2 * across);
  return (vlPlaneDerivatives){{z / across2, 0.0, -x / across2, 0.0, 0.0},
                              {g * x, 1.0 / across, g * z, 0.0, 0.0}};
}

#endif
