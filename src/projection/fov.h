/* projection/fov.h: the FOV model of wide-angle lenses, by its field of view w (Devernay and
 * Faugeras, "Straight lines have to be straight", 2001). */
#ifndef PROJECTION_FOV_H
#define PROJECTION_FOV_H

#include "camera/plane.h"
#include "camera/rays.h"
#include "math/approx_double.h"

/* r = atan(2 tan(theta) tan(w/2)) / w; t = 2 tan(w/2). Domain: the half-space z > 0. */
VL_INLINE vlDirection vl_unproject_fov(VL_UNPROJECT_INPUT) {
  double w = c->shape[0], t = c->shape[1];
  double r = vl_not_tiny(vl_length_2d(x, y)), angle = r * w;
  vlSinCosDouble a = vl_sincos_double(angle < 4.0 ? angle : 4.0);
  double k = a.sin / r;
  return (vlDirection){x * k, y * k, a.cos * t, angle < 1.57079632679489655 ? 1.0 : 0.0};
}
VL_INLINE vlPlanePoint vl_project_fov(VL_PROJECT_INPUT) {
  double w = c->shape[0], t = c->shape[1];
  double r = vl_not_tiny(vl_length_2d(x, y)), k = vl_atan2_double(t * r, z) / (w * r);
  return (vlPlanePoint){x * k, y * k, z > 0.0 ? 1.0 : 0.0};
}

/* t = 2 tan(w/2) depends on w: its derivative is 1 + t^2/4. */
VL_INLINE vlPlaneDerivatives vl_derive_fov(VL_PROJECT_INPUT) {
  double w = c->shape[0], t = c->shape[1];
  double r = vl_not_tiny(vl_length_2d(x, y)), k = vl_atan2_double(t * r, z) / (w * r);
  double all2 = t * t * r * r + z * z, g = (t * z / (w * all2) - k) / (r * r);
  double by_w = (1.0 + 0.25 * t * t) * z / (w * all2) - k / w;
  const double by[5] = {x * g, y * g, -t / (w * all2), by_w, 0.0};
  return vl_derive_factor(x, y, k, by);
}

#endif
