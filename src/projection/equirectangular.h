/* projection/equirectangular.h: the equirectangular projection and its inverse. x is the
 * longitude and y is the latitude, both in radians. The plane's centre is straight ahead. The
 * longitude is in
 * [-pi, pi] and the latitude in [-pi/2, pi/2]; -pi/2 is up. The plane extends by `over_x` and
 * `over_y` (radians) beyond these ranges. There it continues around the sphere and over the
 * poles, so that filters see no edge. The projection returns points within the ranges.
 */
#ifndef PROJECTION_EQUIRECTANGULAR_H
#define PROJECTION_EQUIRECTANGULAR_H

#include "camera/plane.h"
#include "camera/rays.h"
#include "math/approx_double.h"

VL_INLINE vlDirection vl_unproject_equirectangular(VL_UNPROJECT_INPUT) {
  double over_x = c->over_x, over_y = c->over_y;
  int inside = __builtin_fabs(x) <= 3.14159265358979323846 + over_x &&
               __builtin_fabs(y) <= 1.57079632679489661923 + over_y;
  vlSinCosDouble lon = vl_sincos_double(inside ? x : 0.0),
                 lat = vl_sincos_double(inside ? y : 0.0);
  return (vlDirection){lat.cos * lon.sin, lat.sin, lat.cos * lon.cos, inside ? 1.0 : 0.0};
}
VL_INLINE vlPlanePoint vl_project_equirectangular(VL_PROJECT_INPUT) {
  double across = vl_length_2d(x, z);
  return (vlPlanePoint){vl_atan2_double(x, z), vl_atan2_double(y, across),
                        across + __builtin_fabs(y) > 0.0 ? 1.0 : 0.0};
}

VL_INLINE vlPlaneDerivatives vl_derive_equirectangular(VL_PROJECT_INPUT) {
  double across2 = x * x + z * z, across = vl_length_2d(x, z);
  double all2 = across2 + y * y, g = -y / (all2 * across);
  return (vlPlaneDerivatives){{z / across2, 0.0, -x / across2, 0.0, 0.0},
                              {g * x, across / all2, g * z, 0.0, 0.0}};
}

#endif
