/* projection/equisolid.h: the equisolid fisheye: a direction at angle theta from the view axis
 * is at radius 2 sin(theta/2). (Ray, Applied Photographic Optics, 3rd ed., ch. 28; Miyamoto,
 * "Fish eye lens", 1964). */
#ifndef PROJECTION_EQUISOLID_H
#define PROJECTION_EQUISOLID_H

#include "camera/plane.h"
#include "camera/rays.h"
#include "projection/fisheye.h"

VL_INLINE vlDirection vl_unproject_equisolid(VL_UNPROJECT_INPUT) {
  double r2 = x * x + y * y, k = vl_root(1.0 - 0.25 * r2);
  return (vlDirection){x * k, y * k, 1.0 - 0.5 * r2, r2 < 4.0 ? 1.0 : 0.0};
}
VL_INLINE vlPlanePoint vl_project_equisolid(VL_PROJECT_INPUT) {
  double scale = 1.0 / vl_not_tiny(vl_length_3d(x, y, z));
  double q = vl_one_plus_cosine(x * scale, y * scale, z * scale);
  double k = scale * __builtin_sqrt(2.0 / vl_not_tiny(q));
  return (vlPlanePoint){x * k, y * k, q > 0.0 ? 1.0 : 0.0};
}

/* k = sqrt(2 / D), D = L (L + z), L the length. */
VL_INLINE vlPlaneDerivatives vl_derive_equisolid(VL_PROJECT_INPUT) {
  double length = vl_length_3d(x, y, z), scale = 1.0 / length;
  double q = vl_one_plus_cosine(x * scale, y * scale, z * scale);
  double k = scale * __builtin_sqrt(2.0 / q), g = -0.5 * k / (length * length * q);
  double side = g * (2.0 + z * scale);
  const double by[5] = {x * side, y * side, g * (2.0 * z + length + z * z * scale), 0.0, 0.0};
  return vl_derive_factor(x, y, k, by);
}

#endif
