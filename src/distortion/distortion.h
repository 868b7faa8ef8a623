/* distortion/distortion.h: lens distortion: maps undistorted points of the projection's plane
 * to distorted points, and back. One form covers OpenCV's 14 coefficients (rational radial,
 * tangential, thin prism, tilted sensor), the fisheye polynomials of OpenCV and COLMAP,
 * COLMAP's thin prism, and Project Aria's (OpenCV documentation, "Camera Calibration and 3D
 * Reconstruction"; Brown, "Decentering distortion of lenses", 1966; Weng, Cohen, Herniou 1992;
 * COLMAP, sensor/models.h; Project Aria's documentation, "Camera Intrinsic Models"):
 *
 *     s = x^2 + y^2,  q = (1 + n0 s + n1 s^2 + .. + n5 s^6) / (1 + d0 s + d1 s^2 + d2 s^3)
 *     u = x q + 2 p0 x y + p1 (s + 2 x^2) + t0 s + t1 s^2
 *     v = y q + p0 (s + 2 y^2) + 2 p1 x y + t2 s + t3 s^2,   then the sensor's tilt, a
 *                                                            homography.
 *
 * With radial_first (Project Aria) the terms after the first are those of the point (x q, y q).
 *
 * Within the disc of radius vlDistortionMap.radius the Jacobian determinant is positive: the
 * map does not fold. */
#ifndef DISTORTION_DISTORTION_H
#define DISTORTION_DISTORTION_H

#include "base/attributes.h"
#include "camera/plane.h"
#include "velo/camera.h"

typedef struct vlDistorted {
  double u, v, ux, uy, vx, vy; /* point and derivatives, before the tilt */
} vlDistorted;

/* q: the radial factor; q1: its derivative with respect to s. */
VL_INLINE vlDistorted vl_distort_with(const vlDistortionMap *m, double x, double y, double q,
                                      double q1) {
  const double *t = m->prism;
  double s = x * x + y * y, p0 = m->tangential[0], p1 = m->tangential[1];
  double xy = x * y, tu = 2.0 * (t[0] + 2.0 * t[1] * s), tv = 2.0 * (t[2] + 2.0 * t[3] * s);
  vlDistorted r;
  r.u = x * q + 2.0 * p0 * xy + p1 * (s + 2.0 * x * x) + s * (t[0] + t[1] * s);
  r.v = y * q + p0 * (s + 2.0 * y * y) + 2.0 * p1 * xy + s * (t[2] + t[3] * s);
  r.ux = q + 2.0 * x * x * q1 + 2.0 * p0 * y + 6.0 * p1 * x + x * tu;
  r.uy = 2.0 * xy * q1 + 2.0 * p0 * x + 2.0 * p1 * y + y * tu;
  r.vx = 2.0 * xy * q1 + 2.0 * p0 * x + 2.0 * p1 * y + x * tv;
  r.vy = q + 2.0 * y * y * q1 + 6.0 * p0 * y + 2.0 * p1 * x + y * tv;
  return r;
}

/* radial_first: that of the map. Loops over points pass it as a constant. */
VL_INLINE vlDistorted vl_distort_as(const bool radial_first, const vlDistortionMap *m, double x,
                                    double y) {
  const double *n = m->numerator, *d = m->denominator;
  double s = x * x + y * y;
  double above =
      1.0 + s * (n[0] + s * (n[1] + s * (n[2] + s * (n[3] + s * (n[4] + s * n[5])))));
  double below = 1.0 + s * (d[0] + s * (d[1] + s * d[2]));
  double above1 =
      n[0] + s * (2.0 * n[1] +
                  s * (3.0 * n[2] + s * (4.0 * n[3] + s * (5.0 * n[4] + s * (6.0 * n[5])))));
  double below1 = d[0] + s * (2.0 * d[1] + s * (3.0 * d[2]));
  double q = above / below, q1 = (above1 - q * below1) / below;
  if (!radial_first)
    return vl_distort_with(m, x, y, q, q1);
  vlDistorted r = vl_distort_with(m, x * q, y * q, 1.0, 0.0);
  double xx = q + 2.0 * x * x * q1, xy = 2.0 * x * y * q1, yy = q + 2.0 * y * y * q1;
  return (vlDistorted){.u = r.u,
                       .v = r.v,
                       .ux = r.ux * xx + r.uy * xy,
                       .uy = r.ux * xy + r.uy * yy,
                       .vx = r.vx * xx + r.vy * xy,
                       .vy = r.vx * xy + r.vy * yy};
}

static inline vlDistorted vl_distort(const vlDistortionMap *m, double x, double y) {
  return vl_distort_as(m->radial_first, m, x, y);
}

/* Applies the homography h; w > 0 inside its domain. At w = 1e-9 the point lies 1e9 focal
 * lengths away. */
#define VL_TILT_HORIZON 1e-9
static inline vlPlanePoint vl_tilt(const double h[9], double x, double y) {
  double w = h[6] * x + h[7] * y + h[8], k = 1.0 / vl_not_tiny(w);
  return (vlPlanePoint){(h[0] * x + h[1] * y + h[2]) * k, (h[3] * x + h[4] * y + h[5]) * k,
                        w > VL_TILT_HORIZON ? 1.0 : 0.0};
}

/* Maps an ideal point to its distorted point. */
VL_INLINE vlPlanePoint vl_distortion_apply(const bool radial_first, const vlDistortionMap *m,
                                           double x, double y) {
  vlDistorted d = vl_distort_as(radial_first, m, x, y);
  vlPlanePoint p = vl_tilt(m->tilt, d.u, d.v);
  double det = d.ux * d.vy - d.uy * d.vx;
  p.valid = x * x + y * y <= m->radius * m->radius && det > 0.0 ? p.valid : 0.0;
  return p;
}

/* One Newton step towards the ideal point (x, y) that maps to (u, v) before the tilt; the
 * result is kept inside the disc. */
VL_INLINE vlPlanePoint vl_distortion_step(const bool radial_first, const vlDistortionMap *m,
                                          double x, double y, double u, double v) {
  vlDistorted d = vl_distort_as(radial_first, m, x, y);
  double det = d.ux * d.vy - d.uy * d.vx, eu = u - d.u, ev = v - d.v;
  double k = 1.0 / (det > 1e-12 ? det : 1e-12); /* near a fold the step is bounded;
                                                   vl_distortion_check then tests the result */
  double nx = x + (d.vy * eu - d.uy * ev) * k, ny = y + (d.ux * ev - d.vx * eu) * k;
  double r = vl_length_2d(nx, ny), shrink = r > m->radius ? m->radius / r : 1.0;
  return (vlPlanePoint){nx * shrink, ny * shrink, 1.0};
}

/* Returns the point at which the Newton iteration starts. */
static inline vlPlanePoint vl_distortion_start(const vlDistortionMap *m, double u, double v) {
  double r = vl_length_2d(u, v), k = r > m->radius ? m->radius / r : 1.0;
  return (vlPlanePoint){u * k, v * k, 1.0};
}

/* Returns 1 if the iteration converged, which means that (x, y) maps to (u, v) with a relative
 * error below 1e-12. Otherwise, and for NaN, returns 0. */
VL_INLINE double vl_distortion_check(const bool radial_first, const vlDistortionMap *m,
                                     double x, double y, double u, double v) {
  vlDistorted d = vl_distort_as(radial_first, m, x, y);
  double error = __builtin_fabs(d.u - u) + __builtin_fabs(d.v - v);
  double size = 1.0 + __builtin_fabs(u) + __builtin_fabs(v);
  int inside = x * x + y * y <= m->radius * m->radius && d.ux * d.vy - d.uy * d.vx > 0.0;
  return inside && error <= 1e-12 * size ? 1.0 : 0.0;
}

/* Maps the distorted point (u, v), without its tilt, to its ideal point wherever there is one
 * in the disc; slower than the steps above. valid is 0 if there is none. */
vlPlanePoint vl_distortion_invert(const vlDistortionMap *m, double u, double v);

#endif
