/* camera/fisheye.h: the four classical fisheye projections, projection and inverse. They differ
 * in the radius r of a direction at angle theta from the view axis: equidistant theta,
 * equisolid 2 sin(theta/2), stereographic 2 tan(theta/2), orthographic sin(theta). Each has
 * scale 1 at the centre (Ray, Applied Photographic Optics, 3rd ed., ch. 28; Miyamoto, "Fish eye
 * lens", 1964). The focal length and the image circle decide whether the image is circular,
 * cropped or diagonal. */
#ifndef CAMERA_FISHEYE_H
#define CAMERA_FISHEYE_H

#include "camera/plane.h"
#include "math/approx_double.h"

/* The domain is all directions except straight back. */
static inline vlDirection vl_equidistant_unproject(double x, double y) {
  double r = vl_not_tiny(vl_length2(x, y));
  vlSinCosDouble a = vl_sincos_double(r < 4.0 ? r : 4.0);
  double k = a.sin / r;
  return (vlDirection){x * k, y * k, a.cos, r <= 3.14159265358979323846 ? 1.0 : 0.0};
}
static inline vlPlanePoint vl_equidistant_project(double x, double y, double z) {
  double across = vl_length2(x, y), r = vl_not_tiny(across);
  double k = vl_atan2_double(r, z) / r;
  return (vlPlanePoint){x * k, y * k, across > 0.0 || z > 0.0 ? 1.0 : 0.0};
}

/* 1 + cos(theta) for a unit direction, without cancellation near straight back. */
static inline double vl_one_plus_cosine(double x, double y, double z) {
  double back = (x * x + y * y) / (1.0 + __builtin_fabs(z));
  return z < 0.0 ? back : 1.0 + z;
}

static inline vlDirection vl_equisolid_unproject(double x, double y) {
  double r2 = x * x + y * y, k = vl_root(1.0 - 0.25 * r2);
  return (vlDirection){x * k, y * k, 1.0 - 0.5 * r2, r2 < 4.0 ? 1.0 : 0.0};
}
static inline vlPlanePoint vl_equisolid_project(double x, double y, double z) {
  double scale = 1.0 / vl_not_tiny(vl_length3(x, y, z));
  double q = vl_one_plus_cosine(x * scale, y * scale, z * scale);
  double k = scale * __builtin_sqrt(2.0 / vl_not_tiny(q));
  return (vlPlanePoint){x * k, y * k, q > 0.0 ? 1.0 : 0.0};
}

static inline vlDirection vl_stereographic_unproject(double x, double y) {
  double t = 0.25 * (x * x + y * y), k = 1.0 / (1.0 + t);
  return (vlDirection){x * k, y * k, (1.0 - t) * k, t < 1e30 ? 1.0 : 0.0};
}
static inline vlPlanePoint vl_stereographic_project(double x, double y, double z) {
  double scale = 1.0 / vl_not_tiny(vl_length3(x, y, z));
  double q = vl_one_plus_cosine(x * scale, y * scale, z * scale);
  double k = 2.0 * scale / vl_not_tiny(q);
  /* q = 1 + cosine is about angle^2 / 2, so the domain ends 1e-14 radians from straight back,
   * as in the inverse */
  return (vlPlanePoint){x * k, y * k, q > 1e-29 ? 1.0 : 0.0};
}

/* Domain: the half-space z > 0. */
static inline vlDirection vl_sine_unproject(double x, double y) {
  double r2 = x * x + y * y;
  return (vlDirection){x, y, vl_root(1.0 - r2), r2 <= 1.0 ? 1.0 : 0.0};
}
static inline vlPlanePoint vl_sine_project(double x, double y, double z) {
  double length = vl_length3(x, y, z), k = 1.0 / vl_not_tiny(length);
  return (vlPlanePoint){x * k, y * k, z >= 0.0 && length > 0.0 ? 1.0 : 0.0};
}

#endif
