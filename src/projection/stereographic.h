/* projection/stereographic.h: the stereographic fisheye: a direction at angle theta from the
 * view axis is at radius 2 tan(theta/2). (Ray, Applied Photographic Optics, 3rd ed., ch. 28;
 * Miyamoto, "Fish eye lens", 1964). */
#ifndef PROJECTION_STEREOGRAPHIC_H
#define PROJECTION_STEREOGRAPHIC_H

#include "camera/plane.h"
#include "camera/rays.h"
#include "projection/fisheye.h"

VL_INLINE vlDirection vl_unproject_stereographic(VL_UNPROJECT_INPUT) {
  double t = 0.25 * (x * x + y * y), k = 1.0 / (1.0 + t);
  return (vlDirection){x * k, y * k, (1.0 - t) * k, t < 1e30 ? 1.0 : 0.0};
}
VL_INLINE vlPlanePoint vl_project_stereographic(VL_PROJECT_INPUT) {
  double scale = 1.0 / vl_not_tiny(vl_length_3d(x, y, z));
  double q = vl_one_plus_cosine(x * scale, y * scale, z * scale);
  double k = 2.0 * scale / vl_not_tiny(q);
  /* q = 1 + cosine is about angle^2 / 2, so the domain ends 1e-14 radians from straight back,
   * as in the inverse */
  return (vlPlanePoint){x * k, y * k, q > 1e-29 ? 1.0 : 0.0};
}

VL_INLINE vlPlaneDerivatives vl_derive_stereographic(VL_PROJECT_INPUT) {
  double length = vl_length_3d(x, y, z), scale = 1.0 / length;
  double q = vl_one_plus_cosine(x * scale, y * scale, z * scale);
  double divisor = 0.5 * length * q, half = 0.5 * scale;
  const double by[5] = {half * x, half * y, 0.5 * q, 0.0, 0.0};
  return vl_derive_quotient(x, y, divisor, by);
}

#endif
