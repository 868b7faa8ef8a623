/* math/elementary.c: see elementary.h. Numbers are pairs of doubles. A pair is the unevaluated
 * sum of its two doubles, with |low| <= half a unit in the last place of high, which gives 106
 * bits. Sums are computed after Knuth, products after Dekker (1971); neither needs a fused
 * multiply-add. */
#include "math/elementary.h"

#include <math.h>
#include <stdbool.h>

#include "math/approx_double.h"

const double vl_powers_of_ten[VL_EXACT_POWER + 1] = {
    1e0,  1e1,  1e2,  1e3,  1e4,  1e5,  1e6,  1e7,  1e8,  1e9,  1e10, 1e11,
    1e12, 1e13, 1e14, 1e15, 1e16, 1e17, 1e18, 1e19, 1e20, 1e21, 1e22};

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

/* ---- coefficients of power series -------------------------------------------------------- */

enum { FACTORIALS = 30, ODD = 25 };

/* 1 / n! */
static const Pair factorials[FACTORIALS] = {
    {0x1p+0, 0.0},
    {0x1p+0, 0.0},
    {0x1p-1, 0.0},
    {0x1.5555555555555p-3, 0x1.5555555555555p-57},
    {0x1.5555555555555p-5, 0x1.5555555555555p-59},
    {0x1.1111111111111p-7, 0x1.1111111111111p-63},
    {0x1.6c16c16c16c17p-10, -0x1.f49f49f49f49fp-65},
    {0x1.a01a01a01a01ap-13, 0x1.a01a01a01a01ap-73},
    {0x1.a01a01a01a01ap-16, 0x1.a01a01a01a01ap-76},
    {0x1.71de3a556c734p-19, -0x1.c154f8ddc6c00p-73},
    {0x1.27e4fb7789f5cp-22, 0x1.cbbc05b4fa99ap-76},
    {0x1.ae64567f544e4p-26, -0x1.c062e06d1f209p-80},
    {0x1.1eed8eff8d898p-29, -0x1.2aec959e14c06p-83},
    {0x1.6124613a86d09p-33, 0x1.f28e0cc748ebep-87},
    {0x1.93974a8c07c9dp-37, 0x1.05d6f8a2efd1fp-92},
    {0x1.ae7f3e733b81fp-41, 0x1.1d8656b0ee8cbp-97},
    {0x1.ae7f3e733b81fp-45, 0x1.1d8656b0ee8cbp-101},
    {0x1.952c77030ad4ap-49, 0x1.ac981465ddc6cp-103},
    {0x1.6827863b97d97p-53, 0x1.eec01221a8b0bp-107},
    {0x1.2f49b46814157p-57, 0x1.2650f61dbdcb4p-112},
    {0x1.e542ba4020225p-62, 0x1.ea72b4afe3c2fp-120},
    {0x1.71b8ef6dcf572p-66, -0x1.d043ae40c4647p-120},
    {0x1.0ce396db7f853p-70, -0x1.aebcdbd20331cp-124},
    {0x1.761b41316381ap-75, -0x1.3423c7d91404fp-130},
    {0x1.f2cf01972f578p-80, -0x1.9ada5fcc1ab14p-135},
    {0x1.3f3ccdd165fa9p-84, -0x1.58ddadf344487p-139},
    {0x1.88e85fc6a4e5ap-89, -0x1.71c37ebd16540p-143},
    {0x1.d1ab1c2dccea3p-94, 0x1.054d0c78aea14p-149},
    {0x1.0a18a2635085dp-98, 0x1.b9e2e28e1aa54p-153},
    {0x1.259f98b4358adp-103, 0x1.eaf8c39dd9bc5p-157},
};

/* 1 / (2 k + 1) */
static const Pair odd_reciprocals[ODD] = {
    {0x1p+0, 0.0},
    {0x1.5555555555555p-2, 0x1.5555555555555p-56},
    {0x1.999999999999ap-3, -0x1.999999999999ap-57},
    {0x1.2492492492492p-3, 0x1.2492492492492p-57},
    {0x1.c71c71c71c71cp-4, 0x1.c71c71c71c71cp-58},
    {0x1.745d1745d1746p-4, -0x1.745d1745d1746p-59},
    {0x1.3b13b13b13b14p-4, -0x1.3b13b13b13b14p-58},
    {0x1.1111111111111p-4, 0x1.1111111111111p-60},
    {0x1.e1e1e1e1e1e1ep-5, 0x1.e1e1e1e1e1e1ep-61},
    {0x1.af286bca1af28p-5, 0x1.af286bca1af28p-59},
    {0x1.8618618618618p-5, 0x1.8618618618618p-59},
    {0x1.642c8590b2164p-5, 0x1.642c8590b2164p-60},
    {0x1.47ae147ae147bp-5, -0x1.eb851eb851eb8p-61},
    {0x1.2f684bda12f68p-5, 0x1.2f684bda12f68p-59},
    {0x1.1a7b9611a7b96p-5, 0x1.1a7b9611a7b96p-61},
    {0x1.0842108421084p-5, 0x1.0842108421084p-60},
    {0x1.f07c1f07c1f08p-6, -0x1.f07c1f07c1f08p-61},
    {0x1.d41d41d41d41dp-6, 0x1.0750750750750p-60},
    {0x1.bacf914c1bad0p-6, -0x1.bacf914c1bad0p-60},
    {0x1.a41a41a41a41ap-6, 0x1.0690690690690p-60},
    {0x1.8f9c18f9c18fap-6, -0x1.f3831f3831f38p-61},
    {0x1.7d05f417d05f4p-6, 0x1.7d05f417d05f4p-62},
    {0x1.6c16c16c16c17p-6, -0x1.f49f49f49f49fp-61},
    {0x1.5c9882b931057p-6, 0x1.310572620ae4cp-61},
    {0x1.4e5e0a72f0539p-6, 0x1.e0a72f0539783p-60},
};

/* Sum of coefficients[i * step] x^i over `terms` terms, by Horner's rule. */
static Pair series(Pair x, const Pair *coefficients, int step, int terms) {
  Pair s = coefficients[step * (terms - 1)];
  for (int i = terms - 2; i >= 0; i--)
    s = add(coefficients[step * i], multiply(x, s));
  return s;
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
  return series(x, factorials + 1, 1, terms);
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
  Pair s = divide(one(m - 1.0), sum(m, 1.0));
  Pair t = series(multiply(s, s), odd_reciprocals, 1, ODD);
  return add(times_ln2(exponent), multiply(add(s, s), t));
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
  return copysign(exp_of(multiply(log_pair(fabs(x)), odd_reciprocals[1])), x);
}

double vl_precise_hypot(double x, double y) {
  return square_root(add(product(x, x), product(y, y))).high;
}

/* ---- angles ------------------------------------------------------------------------------ */

/* pi / 2 as the sum of four parts. The first three have 33 bits, so their products with
 * integers up to 2^20 are exact. */
static const double half_pi[4] = {0x1.921fb544p+0, 0x1.0b4611a6p-34, 0x1.3198a2ep-69,
                                  0x1.b839a252049c1p-104};

/* rest + quarters pi / 2 */
typedef struct Angle {
  Pair rest;
  int quarters; /* 0 to 3 */
} Angle;

static Angle reduce(double x) {
  double n = floor(x * 0.63661977236758134308 + 0.5);
  Pair r = add(one(x), one(-n * half_pi[0]));
  for (int k = 1; k < 4; k++)
    r = add(r, one(-n * half_pi[k]));
  return (Angle){r, (int)(n - 4.0 * floor(0.25 * n))};
}

static Pair sine(Angle a) {
  enum { TERMS = 15 };
  Pair z = negate(multiply(a.rest, a.rest)), s;
  if (a.quarters & 1)
    s = series(z, factorials, 2, TERMS); /* the cosine of the rest: terms z^k / (2 k)! */
  else
    s = multiply(a.rest, series(z, factorials + 1, 2, TERMS)); /* z^k / (2 k + 1)! */
  return a.quarters & 2 ? negate(s) : s;
}

static Pair cosine(Angle a) {
  a.quarters++;
  return sine(a);
}

double vl_precise_sin(double x) {
  if (x == 0.0 || !isfinite(x))
    return x == 0.0 ? x : NAN;
  return sine(reduce(x)).high;
}

double vl_precise_cos(double x) {
  return isfinite(x) ? cosine(reduce(x)).high : NAN;
}

double vl_precise_tan(double x) {
  if (x == 0.0 || !isfinite(x))
    return x == 0.0 ? x : NAN;
  Angle a = reduce(x);
  return divide(sine(a), cosine(a)).high;
}

/* Angle of (x, y). One step refines the angle a, which is accurate up to its last bits: the
 * remaining angle is (y cos a - x sin a) / (x cos a + y sin a). */
static double angle_of(Pair y, Pair x) {
  double a = vl_atan2_double(y.high, x.high);
  Angle angle = reduce(a);
  Pair s = sine(angle), c = cosine(angle);
  Pair over = add(multiply(y, c), negate(multiply(x, s)));
  Pair under = add(multiply(x, c), multiply(y, s));
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
