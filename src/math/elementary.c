/* math/elementary.c: see elementary.h. Numbers are pairs of doubles. A pair is the unevaluated
 * sum of its two doubles, with |low| <= half a unit in the last place of high, which gives 106
 * bits. Sums are computed after Knuth, products after Dekker (1971); neither needs a fused
 * multiply-add. */
#include "math/elementary.h"

#include <math.h>
#include <stdbool.h>

#include "math/approx_double.h"

typedef struct Pair {
  double high, low;
} Pair;

/* ---- arithmetic of pairs ----------------------------------------------------------------- */

/* a + b, exactly. Requires |a| >= |b| or a = 0. */
static Pair sum_ordered(double a, double b) {
  double s = a + b;
  return (Pair){s, b - (s - a)};
}

static Pair sum(double a, double b) {
  double s = a + b, t = s - a;
  return (Pair){s, (a - (s - t)) + (b - t)};
}

/* a b, exactly. Requires |a|, |b| < 2^995. */
static Pair product(double a, double b) {
  const double split = 134217729.0; /* 2^27 + 1 */
  double p = a * b, ta = split * a, tb = split * b;
  double ah = ta - (ta - a), al = a - ah, bh = tb - (tb - b), bl = b - bh;
  return (Pair){p, ((ah * bh - p) + ah * bl + al * bh) + al * bl};
}

static Pair add(Pair a, Pair b) {
  Pair s = sum(a.high, b.high), t = sum(a.low, b.low);
  s = sum_ordered(s.high, s.low + t.high);
  return sum_ordered(s.high, s.low + t.low);
}

static Pair negate(Pair a) {
  return (Pair){-a.high, -a.low};
}

static Pair multiply(Pair a, Pair b) {
  Pair p = product(a.high, b.high);
  return sum_ordered(p.high, p.low + (a.high * b.low + a.low * b.high));
}

static Pair divide(Pair a, Pair b) {
  double q = a.high / b.high;
  Pair rest = add(a, negate(multiply(b, (Pair){q, 0.0})));
  double r = rest.high / b.high;
  rest = add(rest, negate(multiply(b, (Pair){r, 0.0})));
  Pair s = sum_ordered(q, r);
  return add(s, (Pair){rest.high / b.high, 0.0});
}

static Pair square_root(Pair a) {
  if (!(a.high > 0.0))
    return (Pair){0.0, 0.0};
  double r = sqrt(a.high);
  Pair rest = add(a, negate(product(r, r)));
  return sum_ordered(r, rest.high / (2.0 * r));
}

static Pair one(double x) {
  return (Pair){x, 0.0};
}

/* ---- exponential and logarithm ----------------------------------------------------------- */

/* ln 2 as the sum of three parts. The first two have 40 bits, so their products with integers
 * below 2^13 are exact. */
static const double ln2[3] = {0x1.62e42fefa2p-1, 0x1.9ef35793c6p-41, 0x1.673007e5ed5e8p-81};

static Pair times_ln2(double whole) {
  return add(sum_ordered(whole * ln2[0], whole * ln2[1]), one(whole * ln2[2]));
}

/* (exp(x) - 1) / x, by the first `terms` terms of its power series. */
static Pair exp_series(Pair x, int terms) {
  Pair s = one(1.0);
  for (int k = terms; k > 1; k--)
    s = add(one(1.0), divide(multiply(x, s), one(k)));
  return s;
}

/* exp(x) = result * 2^*exponent. Requires |x| < 2^12. */
static Pair exp_pair(Pair x, int *exponent) {
  double n = floor(x.high * 1.4426950408889634 + 0.5);
  Pair r = add(x, negate(times_ln2(n)));
  r.high *= 0x1p-6;
  r.low *= 0x1p-6; /* |r| is now below 0.0055, so terms after the 14th are smaller than the last
                      bit */
  Pair e = add(one(1.0), multiply(r, exp_series(r, 14)));
  for (int k = 0; k < 6; k++)
    e = multiply(e, e);
  *exponent = (int)n;
  return e;
}

static double exp_of(Pair x) {
  if (isnan(x.high))
    return x.high;
  if (x.high > 710.0)
    return INFINITY;
  if (x.high < -746.0)
    return 0.0;
  int exponent;
  Pair e = exp_pair(x, &exponent);
  return ldexp(e.high, exponent);
}

/* Natural logarithm of a finite x > 0. x = m 2^exponent with m in [sqrt(1/2), sqrt 2); ln m = 2
 * artanh((m - 1) / (m + 1)). */
static Pair log_pair(double x) {
  int exponent;
  double m = frexp(x, &exponent);
  if (m < 0.70710678118654752) {
    m *= 2.0;
    exponent--;
  }
  Pair s = divide(one(m - 1.0), sum(m, 1.0)), z = multiply(s, s), t = one(0.0);
  for (int k = 24; k >= 0; k--)
    t = add(multiply(t, z), divide(one(2.0), one(2 * k + 1)));
  return add(times_ln2(exponent), multiply(s, t));
}

/* Returns whether the logarithm of x is infinite or NaN, and then sets *value to it. */
static bool log_special(double x, double *value) {
  if (x > 0.0 && !isinf(x))
    return false;
  *value = x == 0.0 ? -INFINITY : x > 0.0 ? INFINITY : NAN;
  return true;
}

double vl_precise_exp(double x) {
  return exp_of(one(x));
}

double vl_precise_exp2(double x) {
  if (!(fabs(x) < 1100.0))
    return isnan(x) ? x : x > 0.0 ? INFINITY : 0.0;
  double n = floor(x + 0.5);
  int exponent;
  Pair e = exp_pair(multiply(one(x - n), times_ln2(1.0)), &exponent);
  return ldexp(e.high, (int)n + exponent);
}

double vl_precise_expm1(double x) {
  if (isnan(x) || x == 0.0)
    return x;
  if (fabs(x) < 0.25)
    return multiply(one(x), exp_series(one(x), 26)).high;
  if (x > 60.0 || x < -60.0)
    return exp_of(one(x)) - 1.0;
  int exponent;
  Pair e = exp_pair(one(x), &exponent);
  return add((Pair){ldexp(e.high, exponent), ldexp(e.low, exponent)}, one(-1.0)).high;
}

double vl_precise_log(double x) {
  double value;
  return log_special(x, &value) ? value : log_pair(x).high;
}

double vl_precise_log2(double x) {
  double value;
  return log_special(x, &value) ? value : divide(log_pair(x), times_ln2(1.0)).high;
}

double vl_precise_log10(double x) {
  double value;
  return log_special(x, &value) ? value : divide(log_pair(x), log_pair(10.0)).high;
}

double vl_precise_pow(double x, double y) {
  if (y == 0.0 || x == 1.0)
    return 1.0;
  if (isnan(x) || isnan(y))
    return NAN;
  bool odd = floor(y) == y && fabs(y) < 0x1p53 && floor(0.5 * y) != 0.5 * y;
  if (x < 0.0 && floor(y) != y)
    return NAN;
  double a = fabs(x), sign = signbit(x) && odd ? -1.0 : 1.0;
  if (a == 0.0 || isinf(a))
    return sign * ((a == 0.0) == (y > 0.0) ? 0.0 : INFINITY);
  Pair l = log_pair(a);
  if (fabs(y) > 0x1p70)
    return a == 1.0 ? 1.0 : (l.high > 0.0) == (y > 0.0) ? INFINITY : 0.0;
  return sign * exp_of(multiply(l, one(y)));
}

double vl_precise_cbrt(double x) {
  if (x == 0.0 || !isfinite(x))
    return x;
  return copysign(exp_of(divide(log_pair(fabs(x)), one(3.0))), x);
}

double vl_precise_hypot(double x, double y) {
  return square_root(add(product(x, x), product(y, y))).high;
}

/* ---- angles ------------------------------------------------------------------------------ */

/* pi / 2 as the sum of four parts. The first three have 33 bits, so their products with
 * integers up to 2^20 are exact. */
static const double half_pi[4] = {0x1.921fb544p+0, 0x1.0b4611a6p-34, 0x1.3198a2ep-69,
                                  0x1.b839a252049c1p-104};

typedef struct SinCos {
  Pair sin, cos;
} SinCos;

static SinCos sincos_pair(double x) {
  double n = floor(x * 0.63661977236758134308 + 0.5);
  Pair r = add(one(x), one(-n * half_pi[0]));
  for (int k = 1; k < 4; k++)
    r = add(r, one(-n * half_pi[k]));
  Pair z = negate(multiply(r, r)), s = one(1.0), c = one(1.0);
  for (int k = 28; k > 1; k -= 2) {
    s = add(one(1.0), divide(multiply(z, s), one((double)k * (k + 1))));
    c = add(one(1.0), divide(multiply(z, c), one((double)k * (k - 1))));
  }
  s = multiply(r, s);
  switch ((int)(n - 4.0 * floor(0.25 * n))) {
    case 0:
      return (SinCos){s, c};
    case 1:
      return (SinCos){c, negate(s)};
    case 2:
      return (SinCos){negate(s), negate(c)};
    default:
      return (SinCos){negate(c), s};
  }
}

double vl_precise_sin(double x) {
  if (x == 0.0 || !isfinite(x))
    return x == 0.0 ? x : NAN;
  return sincos_pair(x).sin.high;
}

double vl_precise_cos(double x) {
  return isfinite(x) ? sincos_pair(x).cos.high : NAN;
}

double vl_precise_tan(double x) {
  if (x == 0.0 || !isfinite(x))
    return x == 0.0 ? x : NAN;
  SinCos s = sincos_pair(x);
  return divide(s.sin, s.cos).high;
}

/* Angle of (x, y). One step refines the angle a, which is accurate up to its last bits: the
 * remaining angle is (y cos a - x sin a) / (x cos a + y sin a). */
static double angle_of(Pair y, Pair x) {
  double a = vl_atan2_double(y.high, x.high);
  SinCos s = sincos_pair(a);
  Pair over = add(multiply(y, s.cos), negate(multiply(x, s.sin)));
  Pair under = add(multiply(x, s.cos), multiply(y, s.sin));
  return add(one(a), divide(over, under)).high;
}

double vl_precise_atan2(double y, double x) {
  if (isnan(x) || isnan(y))
    return NAN;
  if (isinf(x) || isinf(y)) {
    y = copysign(isinf(y) ? 1.0 : 0.0, y);
    x = copysign(isinf(x) ? 1.0 : 0.0, x);
  }
  if (y == 0.0)
    return signbit(x) ? copysign(2.0 * (half_pi[0] + half_pi[1]), y) : y;
  /* the scale avoids overflow and underflow of products */
  int exponent;
  frexp(fmax(fabs(x), fabs(y)), &exponent);
  return angle_of(one(ldexp(y, -exponent)), one(ldexp(x, -exponent)));
}

double vl_precise_atan(double x) {
  return vl_precise_atan2(x, 1.0);
}

double vl_precise_acos(double x) {
  if (!(fabs(x) <= 1.0))
    return NAN;
  if (x == 1.0)
    return 0.0;
  Pair y = square_root(multiply(sum(1.0, -x), sum(1.0, x)));
  return x == -1.0 ? 2.0 * (half_pi[0] + half_pi[1]) : angle_of(y, one(x));
}
