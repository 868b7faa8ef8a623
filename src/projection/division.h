/* projection/division.h: the division model (Fitzgibbon, "Simultaneous linear estimation of
 * multiple view geometry and lens distortion", 2001). */
#ifndef PROJECTION_DIVISION_H
#define PROJECTION_DIVISION_H

#include "camera/plane.h"
#include "camera/rays.h"

/* Undistorted = distorted / (1 + lambda r^2). Domain: barrel (lambda < 0) all directions but
 * straight back; pincushion up to r = 1/sqrt(lambda), where it folds. */
VL_INLINE vlDirection vl_unproject_division(VL_UNPROJECT_INPUT) {
  double lambda = c->shape[0];
  double r2 = x * x + y * y;
  return (vlDirection){x, y, 1.0 + lambda * r2, lambda * r2 <= 1.0 && r2 < 1e30 ? 1.0 : 0.0};
}
VL_INLINE vlPlanePoint vl_project_division(VL_PROJECT_INPUT) {
  double lambda = c->shape[0];
  double across2 = x * x + y * y, root = z * z - 4.0 * lambda * across2, s = vl_root(root);
  /* 2/(z + s) for z >= 0; an equal expression without cancellation for z < 0 (then lambda < 0,
   * s > |z|) */
  double ahead = 2.0 / vl_not_tiny(z + s),
         behind = (s - z) / vl_not_tiny(-2.0 * lambda * across2);
  double k = z < 0.0 ? behind : ahead;
  int valid = root >= 0.0 && (z > 0.0 || (lambda < 0.0 && across2 > 0.0));
  return (vlPlanePoint){x * k, y * k, valid ? 1.0 : 0.0};
}

/* The divisor is (z + s) / 2, s = sqrt(z^2 - 4 lambda R^2). */
VL_INLINE vlPlaneDerivatives vl_derive_division(VL_PROJECT_INPUT) {
  double lambda = c->shape[0], across2 = x * x + y * y;
  double s = vl_root(z * z - 4.0 * lambda * across2);
  double divisor = z < 0.0 ? -2.0 * lambda * across2 / (s - z) : 0.5 * (z + s);
  double side = -2.0 * lambda / s;
  const double by[5] = {side * x, side * y, divisor / s, -across2 / s, 0.0};
  return vl_derive_quotient(x, y, divisor, by);
}

#endif
