/* projection/equal_area.h: the equal-area projection of the whole sphere to a square, and its
 * inverse. Each pixel covers the same solid angle (Clarberg, "Fast Equal-Area Mapping of the
 * (Hemi)Sphere using SIMD", 2008; pbrt book 3.8.3). The plane is [-1, 1]^2. Its centre is
 * straight ahead; its corners are straight back. The plane extends by `over` beyond each edge,
 * where it continues at the mirrored half of that edge, as the sphere does. So filters see no
 * edge. */
#ifndef PROJECTION_EQUAL_AREA_H
#define PROJECTION_EQUAL_AREA_H

#include "camera/plane.h"
#include "camera/rays.h"
#include "math/approx_double.h"

VL_INLINE vlDirection vl_unproject_equal_area(VL_UNPROJECT_INPUT) {
  double over = c->over_x;
  double ax = __builtin_fabs(x), ay = __builtin_fabs(y);
  int inside = ax <= 1.0 + over && ay <= 1.0 + over;
  /* beyond an edge: fold back to the edge's other half */
  double u = ax > 1.0 ? __builtin_copysign(2.0 - ax, x) : x, v = ax > 1.0 ? -y : y;
  double w = ay > 1.0 ? __builtin_copysign(2.0 - ay, v) : v;
  u = ay > 1.0 ? -u : u;
  double up = __builtin_fabs(u), vp = __builtin_fabs(w);
  double depth = 1.0 - (up + vp), r = 1.0 - __builtin_fabs(depth);
  double turn = 0.78539816339744830962 * ((vp - up) / vl_not_tiny(r) + 1.0);
  vlSinCosDouble a = vl_sincos_double(r > 0.0 && inside ? turn : 0.78539816339744830962);
  double f = r * vl_root(2.0 - r * r);
  return (vlDirection){__builtin_copysign(a.cos, u) * f, __builtin_copysign(a.sin, w) * f,
                       __builtin_copysign(1.0 - r * r, depth), inside ? 1.0 : 0.0};
}
VL_INLINE vlPlanePoint vl_project_equal_area(VL_PROJECT_INPUT) {
  double length = vl_length_3d(x, y, z), scale = 1.0 / vl_not_tiny(length);
  double ax = __builtin_fabs(x) * scale, ay = __builtin_fabs(y) * scale,
         az = __builtin_fabs(z) * scale;
  /* sqrt(1 - |z|) without cancellation */
  double r = __builtin_sqrt((ax * ax + ay * ay) / (1.0 + az));
  double phi = vl_atan2_double(ay, ax) * 0.63661977236758134308;
  double v = phi * r, u = r - v;
  double uu = z < 0.0 ? 1.0 - v : u, vv = z < 0.0 ? 1.0 - u : v;
  return (vlPlanePoint){__builtin_copysign(uu, x), __builtin_copysign(vv, y),
                        length > 0.0 ? 1.0 : 0.0};
}

/* For the octant x, y, z >= 0, and the signs of the others: r^2 = 1 - z/L, v = phi r, u = r -
 * v. */
VL_INLINE vlPlaneDerivatives vl_derive_equal_area(VL_PROJECT_INPUT) {
  const double two_over_pi = 0.63661977236758134308;
  double length = vl_length_3d(x, y, z), cube = length * length * length;
  double ax = __builtin_fabs(x), ay = __builtin_fabs(y), az = __builtin_fabs(z);
  double across2 = x * x + y * y, r = vl_root(across2 / (length * (length + az)));
  double phi = two_over_pi * vl_atan2_double(ay, ax);
  const double sign[3] = {__builtin_copysign(1.0, x), __builtin_copysign(1.0, y),
                          __builtin_copysign(1.0, z)};
  const double of_r[3] = {0.5 * az * ax / (cube * r), 0.5 * az * ay / (cube * r),
                          -0.5 * across2 / (cube * r)};
  const double of_phi[3] = {-two_over_pi * ay / across2, two_over_pi * ax / across2, 0.0};
  vlPlaneDerivatives d = {{0.0}, {0.0}};
  for (int i = 0; i < 3; i++) {
    double v = of_phi[i] * r + phi * of_r[i], u = of_r[i] - v;
    d.x[i] = sign[0] * sign[i] * (z < 0.0 ? -v : u);
    d.y[i] = sign[1] * sign[i] * (z < 0.0 ? -u : v);
  }
  return d;
}

#endif
