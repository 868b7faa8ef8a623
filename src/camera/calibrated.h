/* camera/calibrated.h: closed-form models of calibrated wide-angle lenses, each as projection
 * and inverse. distortion.h adds any other distortion. The comment of each function states its
 * domain.
 *
 *     FOV            Devernay and Faugeras, "Straight lines have to be straight", 2001; w is
 * the field of view division       Fitzgibbon, "Simultaneous linear estimation of multiple view
 * geometry and lens distortion", 2001 unified        Mei and Rives, "Single view point
 * omnidirectional camera calibration from planar grids", 2007 EUCM           Khomutenko,
 * Garcia, Martinet, "An Enhanced Unified Camera Model", 2016 double sphere  Usenko, Demmel,
 * Cremers, "The Double Sphere Camera Model", 2018
 *
 * The domains of EUCM and of the double sphere are from the paper on the double sphere. */
#ifndef CAMERA_CALIBRATED_H
#define CAMERA_CALIBRATED_H

#include "camera/plane.h"
#include "math/approx_double.h"

/* r = atan(2 tan(theta) tan(w/2)) / w; t = 2 tan(w/2). Domain: the half-space z > 0. */
static inline vlDirection vl_fov_unproject(double w, double t, double x, double y) {
  double r = vl_not_tiny(vl_length2(x, y)), angle = r * w;
  vlSinCosDouble a = vl_sincos_double(angle < 4.0 ? angle : 4.0);
  double k = a.sin / r;
  return (vlDirection){x * k, y * k, a.cos * t, angle < 1.57079632679489655 ? 1.0 : 0.0};
}
static inline vlPlanePoint vl_fov_project(double w, double t, double x, double y, double z) {
  double r = vl_not_tiny(vl_length2(x, y)), k = vl_atan2_double(t * r, z) / (w * r);
  return (vlPlanePoint){x * k, y * k, z > 0.0 ? 1.0 : 0.0};
}

/* Undistorted = distorted / (1 + lambda r^2). Domain: barrel (lambda < 0) all directions but
 * straight back; pincushion up to r = 1/sqrt(lambda), where it folds. */
static inline vlDirection vl_division_unproject(double lambda, double x, double y) {
  double r2 = x * x + y * y;
  return (vlDirection){x, y, 1.0 + lambda * r2, lambda * r2 <= 1.0 && r2 < 1e30 ? 1.0 : 0.0};
}
static inline vlPlanePoint vl_division_project(double lambda, double x, double y, double z) {
  double across2 = x * x + y * y, root = z * z - 4.0 * lambda * across2, s = vl_root(root);
  /* 2/(z + s) for z >= 0; an equal expression without cancellation for z < 0 (then lambda < 0,
   * s > |z|) */
  double ahead = 2.0 / vl_not_tiny(z + s),
         behind = (s - z) / vl_not_tiny(-2.0 * lambda * across2);
  double k = z < 0.0 ? behind : ahead;
  int valid = root >= 0.0 && (z > 0.0 || (lambda < 0.0 && across2 > 0.0));
  return (vlPlanePoint){x * k, y * k, valid ? 1.0 : 0.0};
}

/* m = X / (Z + xi |P|). */
static inline vlDirection vl_unified_unproject(double xi, double x, double y) {
  double r2 = x * x + y * y, root = 1.0 + (1.0 - xi * xi) * r2;
  double k = (xi + vl_root(root)) / (r2 + 1.0);
  return (vlDirection){x * k, y * k, k - xi, root >= 0.0 && r2 < 1e24 ? 1.0 : 0.0};
}
static inline vlPlanePoint vl_unified_project(double xi, double x, double y, double z) {
  double length = vl_length3(x, y, z), under = z + xi * length, k = 1.0 / vl_not_tiny(under);
  double edge = xi > 1.0 ? 1.0 / xi : xi;
  return (vlPlanePoint){x * k, y * k,
                        z >= -edge * length && under > VL_HORIZON * length ? 1.0 : 0.0};
}

/* m = X / (a d + (1 - a) Z), d = sqrt(b R^2 + Z^2). */
static inline vlDirection vl_eucm_unproject(double a, double b, double x, double y) {
  double r2 = x * x + y * y, root = 1.0 - (2.0 * a - 1.0) * b * r2;
  double z = (1.0 - b * a * a * r2) / (a * vl_root(root) + (1.0 - a));
  return (vlDirection){x, y, z, root >= 0.0 && r2 < 1e24 ? 1.0 : 0.0};
}
static inline vlPlanePoint vl_eucm_project(double a, double b, double x, double y, double z) {
  double d = __builtin_sqrt(b * (x * x + y * y) + z * z), under = a * d + (1.0 - a) * z,
         k = 1.0 / vl_not_tiny(under);
  double edge = a > 0.5 ? (1.0 - a) / a : a / (1.0 - a);
  return (vlPlanePoint){x * k, y * k, z >= -edge * d && under > VL_HORIZON * d ? 1.0 : 0.0};
}

/* m = X / (a d2 + (1 - a)(xi d1 + Z)), d1 = |P|, d2 = sqrt(R^2 + (xi d1 + Z)^2). */
static inline vlDirection vl_double_sphere_unproject(double xi, double a, double x, double y) {
  double r2 = x * x + y * y, root = 1.0 - (2.0 * a - 1.0) * r2;
  double z = (1.0 - a * a * r2) / (a * vl_root(root) + (1.0 - a));
  double second = z * z + (1.0 - xi * xi) * r2, k = (z * xi + vl_root(second)) / (z * z + r2);
  return (vlDirection){x * k, y * k, k * z - xi,
                       root >= 0.0 && second >= 0.0 && r2 < 1e24 ? 1.0 : 0.0};
}
static inline vlPlanePoint vl_double_sphere_project(double xi, double a, double x, double y,
                                                    double z) {
  double across2 = x * x + y * y, d1 = __builtin_sqrt(across2 + z * z), shifted = xi * d1 + z;
  double d2 = __builtin_sqrt(across2 + shifted * shifted), under = a * d2 + (1.0 - a) * shifted;
  double k = 1.0 / vl_not_tiny(under), w1 = a > 0.5 ? (1.0 - a) / a : a / (1.0 - a);
  double w2 = (w1 + xi) / __builtin_sqrt(2.0 * w1 * xi + xi * xi + 1.0);
  return (vlPlanePoint){x * k, y * k, z > -w2 * d1 && under > VL_HORIZON * d1 ? 1.0 : 0.0};
}

#endif
