/* projection/double_sphere.h: the double sphere model and its domain (Usenko, Demmel, Cremers,
 * "The Double Sphere Camera Model", 2018). */
#ifndef PROJECTION_DOUBLE_SPHERE_H
#define PROJECTION_DOUBLE_SPHERE_H

#include "camera/plane.h"
#include "camera/rays.h"

/* m = X / (a d2 + (1 - a)(xi d1 + Z)), d1 = |P|, d2 = sqrt(R^2 + (xi d1 + Z)^2). The points
 * that it takes back are those with xi d1 + Z > -w1 d2, which is the unified model's condition
 * on the second sphere; the paper's Z > -w2 d1 leaves out a part of them at the rim. */
VL_INLINE vlDirection vl_unproject_double_sphere(VL_UNPROJECT_INPUT) {
  double xi = c->shape[0], a = c->shape[1];
  double r2 = x * x + y * y, root = 1.0 - (2.0 * a - 1.0) * r2;
  double z = (1.0 - a * a * r2) / (a * vl_root(root) + (1.0 - a));
  double second = z * z + (1.0 - xi * xi) * r2, k = (z * xi + vl_root(second)) / (z * z + r2);
  return (vlDirection){x * k, y * k, k * z - xi,
                       root >= 0.0 && second >= 0.0 && r2 < 1e24 ? 1.0 : 0.0};
}
VL_INLINE vlPlanePoint vl_project_double_sphere(VL_PROJECT_INPUT) {
  double xi = c->shape[0], a = c->shape[1];
  double across2 = x * x + y * y, d1 = __builtin_sqrt(across2 + z * z), shifted = xi * d1 + z;
  double d2 = __builtin_sqrt(across2 + shifted * shifted), under = a * d2 + (1.0 - a) * shifted;
  double k = 1.0 / vl_not_tiny(under), w1 = a > 0.5 ? (1.0 - a) / a : a / (1.0 - a);
  return (vlPlanePoint){x * k, y * k,
                        shifted > -w1 * d2 && under > VL_HORIZON * d1 ? 1.0 : 0.0};
}

VL_INLINE vlPlaneDerivatives vl_derive_double_sphere(VL_PROJECT_INPUT) {
  double xi = c->shape[0], a = c->shape[1], d1 = vl_length_3d(x, y, z), shifted = xi * d1 + z;
  double d2 = vl_length_3d(x, y, shifted), divisor = a * d2 + (1.0 - a) * shifted;
  double of_shifted = a * shifted / d2 + (1.0 - a); /* the divisor's, by `shifted` */
  double side = a / d2 + of_shifted * xi / d1;
  const double by[5] = {side * x, side * y, of_shifted * (xi * z / d1 + 1.0), of_shifted * d1,
                        d2 - shifted};
  return vl_derive_quotient(x, y, divisor, by);
}

#endif
