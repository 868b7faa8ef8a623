/* projection/unified.h: the unified model (Mei and Rives, "Single view point omnidirectional
 * camera calibration from planar grids", 2007). */
#ifndef PROJECTION_UNIFIED_H
#define PROJECTION_UNIFIED_H

#include "camera/plane.h"
#include "camera/rays.h"

/* m = X / (Z + xi |P|). */
VL_INLINE vlDirection vl_unproject_unified(VL_UNPROJECT_INPUT) {
  double xi = c->shape[0];
  double r2 = x * x + y * y, root = 1.0 + (1.0 - xi * xi) * r2;
  double k = (xi + vl_root(root)) / (r2 + 1.0);
  return (vlDirection){x * k, y * k, k - xi, root >= 0.0 && r2 < 1e24 ? 1.0 : 0.0};
}
VL_INLINE vlPlanePoint vl_project_unified(VL_PROJECT_INPUT) {
  double xi = c->shape[0];
  double length = vl_length_3d(x, y, z), under = z + xi * length, k = 1.0 / vl_not_tiny(under);
  double edge = xi > 1.0 ? 1.0 / xi : xi;
  return (vlPlanePoint){x * k, y * k,
                        z >= -edge * length && under > VL_HORIZON * length ? 1.0 : 0.0};
}

VL_INLINE vlPlaneDerivatives vl_derive_unified(VL_PROJECT_INPUT) {
  double xi = c->shape[0], length = vl_length_3d(x, y, z), divisor = z + xi * length;
  double side = xi / length;
  const double by[5] = {side * x, side * y, 1.0 + side * z, length, 0.0};
  return vl_derive_quotient(x, y, divisor, by);
}

#endif
