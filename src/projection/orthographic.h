/* projection/orthographic.h: the orthographic projection: projectors are parallel to the view
 * axis, and size does not depend on distance. fx, fy are pixels per scene unit. */
#ifndef PROJECTION_ORTHOGRAPHIC_H
#define PROJECTION_ORTHOGRAPHIC_H

#include "camera/plane.h"
#include "camera/rays.h"

/* x, y: pixels from the principal point. */
static inline vlCameraLocal vl_orthographic_unproject(const vlCameraCompiled *c, double x,
                                                      double y) {
  vlCameraLocal r;
  r.ox = (x - c->skew_ratio * y) * c->inv_fx;
  r.oy = y * c->inv_fy;
  r.dx = 0.0;
  r.dy = 0.0;
  r.dz = 1.0;
  return r;
}

VL_INLINE vlDirection vl_unproject_orthographic(VL_UNPROJECT_INPUT) {
  return (vlDirection){x, y, 1.0, 1.0};
}
VL_INLINE vlPlanePoint vl_project_orthographic(VL_PROJECT_INPUT) {
  return (vlPlanePoint){x, y, z >= 0.0 ? 1.0 : 0.0};
}

VL_INLINE vlPlaneDerivatives vl_derive_orthographic(VL_PROJECT_INPUT) {
  const double by[5] = {0.0, 0.0, 0.0, 0.0, 0.0};
  return vl_derive_factor(x, y, 1.0, by);
}

#endif
