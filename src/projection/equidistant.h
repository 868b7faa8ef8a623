/* projection/equidistant.h: the equidistant fisheye: a direction at angle theta from the view
 * axis is at radius theta. (Ray, Applied Photographic Optics, 3rd ed., ch. 28; Miyamoto, "Fish
 * eye lens", 1964). */
#ifndef PROJECTION_EQUIDISTANT_H
#define PROJECTION_EQUIDISTANT_H

#include "camera/plane.h"
#include "camera/rays.h"
#include "math/approx_double.h"

/* The domain is all directions except straight back. */
VL_INLINE vlDirection vl_unproject_equidistant(VL_UNPROJECT_INPUT) {
  double r = vl_not_tiny(vl_length_2d(x, y));
  vlSinCosDouble a = vl_sincos_double(r < 4.0 ? r : 4.0);
  double k = a.sin / r;
  return (vlDirection){x * k, y * k, a.cos, r <= 3.14159265358979323846 ? 1.0 : 0.0};
}
VL_INLINE vlPlanePoint vl_project_equidistant(VL_PROJECT_INPUT) {
  double across = vl_length_2d(x, y), r = vl_not_tiny(across);
  double k = vl_atan2_double(r, z) / r;
  return (vlPlanePoint){x * k, y * k, across > 0.0 || z > 0.0 ? 1.0 : 0.0};
}

VL_INLINE vlPlaneDerivatives vl_derive_equidistant(VL_PROJECT_INPUT) {
  double across2 = x * x + y * y, all2 = across2 + z * z;
  double r = vl_not_tiny(vl_length_2d(x, y));
  double k = vl_atan2_double(r, z) / r;
  double g = (z / all2 - k) / (r * r);
  const double by[5] = {x * g, y * g, -1.0 / all2, 0.0, 0.0};
  return vl_derive_factor(x, y, k, by);
}

#endif
