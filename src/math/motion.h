/* math/motion.h: interpolation between two matrices. Each matrix is decomposed to M = T R S.
 * Translation and stretch are interpolated linearly, rotation along the shortest arc at
 * constant angular speed (pbrt's AnimatedTransform: book 3rd ed. 2.9.3; polar decomposition:
 * Shoemake and Duff, "Matrix animation and polar decomposition", 1992). All computations are in
 * double. vl_motion_between is written for batch loops; all other code calls it too, so that
 * the bits agree. */
#ifndef MATH_MOTION_H
#define MATH_MOTION_H

#include "math/approx_double.h"
#include "math/transform.h"

/* Two decomposed poses. Quaternions are x y z w, with q1 in q0's hemisphere. */
typedef struct vlMotion {
  double t0[3], t1[3];    /* translations */
  double q0[4], q1[4];    /* rotations */
  double s0[9], s1[9];    /* stretches; negative if the matrix mirrors */
  double angle, inv_sine; /* angle between q0 and q1, radians; inv_sine 0: negligible angle */
} vlMotion;

/* An affine map without its last row. */
typedef struct vlAffine {
  double m[9], p[3];
} vlAffine;

/* False if one of the matrices is singular or not affine, or if exactly one of them mirrors (no
 * rotation connects them). */
bool vl_motion_make(const double open[16], const double close[16], vlMotion *motion);

/* The pose at f in [0, 1]. */
static inline vlAffine vl_motion_between(const vlMotion *a, double f) {
  double g = 1.0 - f;
  double sine_g = vl_sincos_double(g * a->angle).sin,
         sine_f = vl_sincos_double(f * a->angle).sin;
  int turns = a->inv_sine > 0.0;
  double w0 = turns ? sine_g * a->inv_sine : g, w1 = turns ? sine_f * a->inv_sine : f;
  double x = w0 * a->q0[0] + w1 * a->q1[0], y = w0 * a->q0[1] + w1 * a->q1[1];
  double z = w0 * a->q0[2] + w1 * a->q1[2], w = w0 * a->q0[3] + w1 * a->q1[3];
  double n = 2.0 / (x * x + y * y + z * z + w * w);
  double xx = n * x * x, yy = n * y * y, zz = n * z * z, xy = n * x * y, xz = n * x * z,
         yz = n * y * z;
  double wx = n * w * x, wy = n * w * y, wz = n * w * z;
  double r0 = 1.0 - (yy + zz), r1 = xy - wz, r2 = xz + wy;
  double r3 = xy + wz, r4 = 1.0 - (xx + zz), r5 = yz - wx;
  double r6 = xz - wy, r7 = yz + wx, r8 = 1.0 - (xx + yy);
  double s0 = g * a->s0[0] + f * a->s1[0], s1 = g * a->s0[1] + f * a->s1[1],
         s2 = g * a->s0[2] + f * a->s1[2];
  double s3 = g * a->s0[3] + f * a->s1[3], s4 = g * a->s0[4] + f * a->s1[4],
         s5 = g * a->s0[5] + f * a->s1[5];
  double s6 = g * a->s0[6] + f * a->s1[6], s7 = g * a->s0[7] + f * a->s1[7],
         s8 = g * a->s0[8] + f * a->s1[8];
  vlAffine out;
  out.m[0] = r0 * s0 + r1 * s3 + r2 * s6;
  out.m[1] = r0 * s1 + r1 * s4 + r2 * s7;
  out.m[2] = r0 * s2 + r1 * s5 + r2 * s8;
  out.m[3] = r3 * s0 + r4 * s3 + r5 * s6;
  out.m[4] = r3 * s1 + r4 * s4 + r5 * s7;
  out.m[5] = r3 * s2 + r4 * s5 + r5 * s8;
  out.m[6] = r6 * s0 + r7 * s3 + r8 * s6;
  out.m[7] = r6 * s1 + r7 * s4 + r8 * s7;
  out.m[8] = r6 * s2 + r7 * s5 + r8 * s8;
  for (int c = 0; c < 3; c++)
    out.p[c] = g * a->t0[c] + f * a->t1[c];
  return out;
}

/* The derivative of vl_motion_between by f. */
vlAffine vl_motion_rate(const vlMotion *a, double f);

/* The interpolated pose as a matrix; f <= 0 and f >= 1 give the matrices themselves. False as
 * above. */
bool vl_motion_at(const double open[16], const double close[16], double f, double result[16]);

#endif
