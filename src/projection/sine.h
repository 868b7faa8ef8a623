/* projection/sine.h: the orthographic fisheye: a direction at angle theta from the view axis is
 * at radius sin(theta). (Ray, Applied Photographic Optics, 3rd ed., ch. 28; Miyamoto, "Fish eye
 * lens", 1964). */
#ifndef PROJECTION_SINE_H
#define PROJECTION_SINE_H

#include "camera/plane.h"
#include "camera/rays.h"

/* Domain: the half-space z > 0. */
VL_INLINE vlDirection vl_unproject_sine(VL_UNPROJECT_INPUT) {
  double r2 = x * x + y * y;
  return (vlDirection){x, y, vl_root(1.0 - r2), r2 <= 1.0 ? 1.0 : 0.0};
}
VL_INLINE vlPlanePoint vl_project_sine(VL_PROJECT_INPUT) {
  double length = vl_length_3d(x, y, z), k = 1.0 / vl_not_tiny(length);
  return (vlPlanePoint){x * k, y * k, z >= 0.0 && length > 0.0 ? 1.0 : 0.0};
}

VL_INLINE vlPlaneDerivatives vl_derive_sine(VL_PROJECT_INPUT) {
  double divisor = vl_length_3d(x, y, z);
  const double by[5] = {x / divisor, y / divisor, z / divisor, 0.0, 0.0};
  return vl_derive_quotient(x, y, divisor, by);
}

#endif
