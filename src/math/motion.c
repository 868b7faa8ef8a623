/* math/motion.c: decomposition of matrices into translation, rotation and stretch. See
 * motion.h. */
#include "math/motion.h"

#include <math.h>
#include <string.h>

#include "math/double3.h"

typedef struct Mat3 {
  double m[9];
} Mat3;

/* Transpose of the inverse: cofactors over the determinant. */
static Mat3 inverse_transpose(const Mat3 *a) {
  const double *m = a->m;
  double d = 1 / vl_mat3_determinant(a->m);
  return (Mat3){{(m[4] * m[8] - m[5] * m[7]) * d, (m[5] * m[6] - m[3] * m[8]) * d,
                 (m[3] * m[7] - m[4] * m[6]) * d, (m[2] * m[7] - m[1] * m[8]) * d,
                 (m[0] * m[8] - m[2] * m[6]) * d, (m[1] * m[6] - m[0] * m[7]) * d,
                 (m[1] * m[5] - m[2] * m[4]) * d, (m[2] * m[3] - m[0] * m[5]) * d,
                 (m[0] * m[4] - m[1] * m[3]) * d}};
}

static double largest(const Mat3 *a) {
  double max = 0;
  for (int i = 0; i < 9; i++)
    max = fmax(max, fabs(a->m[i]));
  return max;
}

/* The nearest rotation (a reflection if the matrix mirrors), by averaging with the inverse
 * transpose until convergence, with scaling at each step so that any stretch converges within
 * about ten steps (Higham 1986). */
static bool nearest_rotation(const Mat3 *a, Mat3 *r) {
  double size = largest(a);
  if (!(size > 0) || !isfinite(size))
    return false;
  for (int i = 0; i < 9; i++)
    r->m[i] = a->m[i] / size;
  for (int step = 0; step < 100; step++) {
    if (!(fabs(vl_mat3_determinant(r->m)) > 1e-30))
      return false; /* singular: entries are 1 at most */
    Mat3 b = inverse_transpose(r);
    double scale = sqrt(largest(&b) / largest(r)), change = 0;
    scale = step < 8 ? scale : 1;
    for (int i = 0; i < 9; i++) {
      double next = 0.5 * (r->m[i] * scale + b.m[i] / scale);
      change = fmax(change, fabs(next - r->m[i]));
      r->m[i] = next;
    }
    if (change < 1e-15)
      return true; /* a few roundings of 1.1e-16 */
  }
  /* a rotation, though the last digits do not settle */
  return fabs(fabs(vl_mat3_determinant(r->m)) - 1) < 1e-9;
}

/* Unit quaternion of a rotation; starts from its largest component (Shepperd 1978). */
static void quaternion(const Mat3 *r, double q[4]) {
  const double *m = r->m;
  double part[4] = {1 + m[0] - m[4] - m[8], 1 - m[0] + m[4] - m[8], 1 - m[0] - m[4] + m[8],
                    1 + m[0] + m[4] + m[8]};
  int k = 0;
  for (int i = 1; i < 4; i++)
    k = part[i] > part[k] ? i : k;
  double s = sqrt(part[k]), f = 0.5 / s;
  q[k] = 0.5 * s;
  double xy = m[3] + m[1], xz = m[6] + m[2], yz = m[7] + m[5];
  double wx = m[7] - m[5], wy = m[2] - m[6], wz = m[3] - m[1];
  const double others[4][4] = {
      {0, xy, xz, wx}, {xy, 0, yz, wy}, {xz, yz, 0, wz}, {wx, wy, wz, 0}};
  for (int i = 0; i < 4; i++)
    if (i != k)
      q[i] = others[k][i] * f;
  double length = 0;
  for (int i = 0; i < 4; i++)
    length += q[i] * q[i];
  length = sqrt(length);
  for (int i = 0; i < 4; i++)
    q[i] /= length;
}

static bool split(const double m[16], double t[3], double q[4], double s[9], bool *mirrors) {
  for (int i = 0; i < 16; i++)
    if (!isfinite(m[i]))
      return false;
  if (!vl_is_affine(m))
    return false;
  Mat3 a, r;
  for (int i = 0; i < 3; i++) {
    t[i] = m[4 * i + 3];
    for (int j = 0; j < 3; j++)
      a.m[3 * i + j] = m[4 * i + j];
  }
  if (!nearest_rotation(&a, &r))
    return false;
  *mirrors = vl_mat3_determinant(r.m) < 0;
  for (int i = 0; i < 9 && *mirrors; i++)
    r.m[i] = -r.m[i];
  quaternion(&r, q);
  for (int i = 0; i < 3; i++)
    for (int j = 0; j < 3; j++)
      s[3 * i + j] = r.m[i] * a.m[j] + r.m[3 + i] * a.m[3 + j] + r.m[6 + i] * a.m[6 + j];
  return true;
}

bool vl_motion_make(const double open[16], const double close[16], vlMotion *motion) {
  bool mirrors[2];
  memset(motion, 0, sizeof *motion);
  if (!split(open, motion->t0, motion->q0, motion->s0, &mirrors[0]) ||
      !split(close, motion->t1, motion->q1, motion->s1, &mirrors[1]) ||
      mirrors[0] != mirrors[1])
    return false;
  double dot = 0;
  for (int i = 0; i < 4; i++)
    dot += motion->q0[i] * motion->q1[i];
  for (int i = 0; i < 4 && dot < 0; i++)
    motion->q1[i] = -motion->q1[i];
  double apart = 0, together = 0;
  for (int i = 0; i < 4; i++) {
    double a = motion->q0[i], b = motion->q1[i];
    apart += (b - a) * (b - a);
    together += (b + a) * (b + a);
  }
  double angle = 2 * vl_atan2_double(sqrt(apart), sqrt(together));
  /* below, linear interpolation errs by angle^2 = 1e-18, less than a rounding */
  bool turns = angle > 1e-9;
  motion->angle = turns ? angle : 0;
  motion->inv_sine = turns ? 1 / vl_sincos_double(angle).sin : 0;
  return true;
}

/* A rotation, less the identity, from the products of the quaternion's numbers times 2 over its
 * squared length. Linear in n. */
static void rotation_of(const double n[4][4], double r[9]) {
  r[0] = -(n[1][1] + n[2][2]);
  r[1] = n[0][1] - n[3][2];
  r[2] = n[0][2] + n[3][1];
  r[3] = n[0][1] + n[3][2];
  r[4] = -(n[0][0] + n[2][2]);
  r[5] = n[1][2] - n[3][0];
  r[6] = n[0][2] - n[3][1];
  r[7] = n[1][2] + n[3][0];
  r[8] = -(n[0][0] + n[1][1]);
}

vlAffine vl_motion_rate(const vlMotion *a, double f) {
  double g = 1.0 - f, q[4], dq[4], square = 0.0, along = 0.0;
  bool turns = a->inv_sine > 0.0;
  vlSinCosDouble at_g = vl_sincos_double(g * a->angle), at_f = vl_sincos_double(f * a->angle);
  double w0 = turns ? at_g.sin * a->inv_sine : g, w1 = turns ? at_f.sin * a->inv_sine : f;
  double d0 = turns ? -a->angle * at_g.cos * a->inv_sine : -1.0;
  double d1 = turns ? a->angle * at_f.cos * a->inv_sine : 1.0;
  for (int i = 0; i < 4; i++) {
    q[i] = w0 * a->q0[i] + w1 * a->q1[i];
    dq[i] = d0 * a->q0[i] + d1 * a->q1[i];
    square += q[i] * q[i];
    along += q[i] * dq[i];
  }
  double n[4][4], dn[4][4], r[9], dr[9], scale = 2.0 / square, less = 2.0 * along / square;
  for (int i = 0; i < 4; i++)
    for (int j = 0; j < 4; j++) {
      n[i][j] = scale * q[i] * q[j];
      dn[i][j] = scale * (dq[i] * q[j] + q[i] * dq[j]) - less * n[i][j];
    }
  rotation_of(n, r);
  rotation_of(dn, dr);
  for (int i = 0; i < 9; i += 4)
    r[i] += 1.0;
  vlAffine rate = {0};
  for (int i = 0; i < 3; i++) {
    rate.p[i] = a->t1[i] - a->t0[i];
    for (int j = 0; j < 3; j++)
      for (int k = 0; k < 3; k++) {
        double s = g * a->s0[3 * k + j] + f * a->s1[3 * k + j];
        double ds = a->s1[3 * k + j] - a->s0[3 * k + j];
        rate.m[3 * i + j] += dr[3 * i + k] * s + r[3 * i + k] * ds;
      }
  }
  return rate;
}

bool vl_motion_at(const double open[16], const double close[16], double f, double result[16]) {
  vlMotion motion;
  if (!vl_motion_make(open, close, &motion))
    return false;
  vlAffine a = vl_motion_between(&motion, f);
  for (int i = 0; i < 3; i++) {
    for (int j = 0; j < 3; j++)
      result[4 * i + j] = a.m[3 * i + j];
    result[4 * i + 3] = a.p[i];
  }
  result[12] = result[13] = result[14] = 0;
  result[15] = 1;
  if (f <= 0)
    memmove(result, open, 16 * sizeof *result);
  if (f >= 1)
    memmove(result, close, 16 * sizeof *result);
  return true;
}
