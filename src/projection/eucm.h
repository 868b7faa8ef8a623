/* projection/eucm.h: the enhanced unified model (Khomutenko, Garcia, Martinet, "An Enhanced
 * Unified Camera Model", 2016). The domain is from the paper on the double sphere (Usenko,
 * Demmel, Cremers, 2018). */
#ifndef PROJECTION_EUCM_H
#define PROJECTION_EUCM_H

#include "camera/plane.h"
#include "camera/rays.h"

/* m = X / (a d + (1 - a) Z), d = sqrt(b R^2 + Z^2). */
VL_INLINE vlDirection vl_unproject_eucm(VL_UNPROJECT_INPUT) {
  double a = c->shape[0], b = c->shape[1];
  double r2 = x * x + y * y, root = 1.0 - (2.0 * a - 1.0) * b * r2;
  double z = (1.0 - b * a * a * r2) / (a * vl_root(root) + (1.0 - a));
  return (vlDirection){x, y, z, root >= 0.0 && r2 < 1e24 ? 1.0 : 0.0};
}
VL_INLINE vlPlanePoint vl_project_eucm(VL_PROJECT_INPUT) {
  double a = c->shape[0], b = c->shape[1];
  double d = __builtin_sqrt(b * (x * x + y * y) + z * z), under = a * d + (1.0 - a) * z,
         k = 1.0 / vl_not_tiny(under);
  double edge = a > 0.5 ? (1.0 - a) / a : a / (1.0 - a);
  return (vlPlanePoint){x * k, y * k, z >= -edge * d && under > VL_HORIZON * d ? 1.0 : 0.0};
}

VL_INLINE vlPlaneDerivatives vl_derive_eucm(VL_PROJECT_INPUT) {
  double a = c->shape[0], b = c->shape[1], across2 = x * x + y * y;
  double d = __builtin_sqrt(b * across2 + z * z), divisor = a * d + (1.0 - a) * z;
  double side = a * b / d;
  const double by[5] = {side * x, side * y, a * z / d + (1.0 - a), d - z,
                        0.5 * a * across2 / d};
  return vl_derive_quotient(x, y, divisor, by);
}

#endif
