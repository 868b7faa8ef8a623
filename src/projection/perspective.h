/* projection/perspective.h: the perspective projection: all projectors meet in the centre of
 * projection, the view plane is flat. (The lecture's "pinhole camera"; Suffern, Ray Tracing
 * from the Ground Up, ch. 8 and 9.) */
#ifndef PROJECTION_PERSPECTIVE_H
#define PROJECTION_PERSPECTIVE_H

#include "camera/plane.h"
#include "camera/rays.h"

/* x, y: pixels from the principal point. The direction has the form of the lecture, (x_v, y_v,
 * d), with the view plane at distance d = fx and pixels of size 1. It is not divided by d, so
 * that it has no rounding error beyond that of the lecture's formula. */
static inline vlCameraLocal vl_perspective_unproject(const vlCameraCompiled *c, double x,
                                                     double y) {
  vlCameraLocal r;
  r.ox = 0.0;
  r.oy = 0.0;
  r.dx = x - c->skew_ratio * y;
  r.dy = y * c->aspect;
  r.dz = c->focal;
  return r;
}

VL_INLINE vlDirection vl_unproject_perspective(VL_UNPROJECT_INPUT) {
  return (vlDirection){x, y, 1.0, 1.0};
}
VL_INLINE vlPlanePoint vl_project_perspective(VL_PROJECT_INPUT) {
  return (vlPlanePoint){x / z, y / z, z > 0.0 ? 1.0 : 0.0};
}

VL_INLINE vlPlaneDerivatives vl_derive_perspective(VL_PROJECT_INPUT) {
  const double by[5] = {0.0, 0.0, 1.0, 0.0, 0.0};
  return vl_derive_quotient(x, y, z, by);
}

#endif
