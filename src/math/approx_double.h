/* math/approx_double.h: elementary functions in double, in plain C that compilers vectorise.
 * They use only + - * / sqrt and selections, so they give the same bits on every machine and in
 * every batch. Polynomials after Moshier's Cephes (double precision). Errors below are measured
 * against the C library's long double (test/camera/test_approx_double.c). */
#ifndef MATH_APPROX_DOUBLE_H
#define MATH_APPROX_DOUBLE_H

#include <stdbool.h>
#include <stdint.h>
#include <string.h>

typedef struct vlSinCosDouble {
  double sin, cos;
} vlSinCosDouble;

/* Radians; |x| <= 1000; absolute error < 2e-16. */
static inline vlSinCosDouble vl_sincos_double(double x) {
  double n = __builtin_floor(x * 0.63661977236758134308 + 0.5);
  double r = ((x - n * 1.57079625129699707031) - n * 7.54978941586159635335e-8) -
             n * 5.39030285815811905290e-15;
  double z = r * r;
  double s = 1.58962301576546568060e-10 * z - 2.50507477628578072866e-8;
  s = (((s * z + 2.75573136213857245213e-6) * z - 1.98412698295895385996e-4) * z +
       8.33333333332211858878e-3) *
      z;
  s = r + r * z * (s - 1.66666666666666307295e-1);
  double c = -1.13585365213876817300e-11 * z + 2.08757008419747316778e-9;
  c = ((c * z - 2.75573141792967388112e-7) * z + 2.48015872888517045348e-5) * z -
      1.38888888888730564116e-3;
  c = 1.0 - 0.5 * z + z * z * (c * z + 4.16666666666665929218e-2);
  /* quarter = n modulo 4: 0, 1, 2 or 3 */
  double quarter = n - 4.0 * __builtin_floor(n * 0.25);
  double half = quarter >= 2.0 ? quarter - 2.0 : quarter;
  double sine = half > 0.5 ? c : s, cosine = half > 0.5 ? s : c;
  vlSinCosDouble result;
  result.sin = quarter > 1.5 ? -sine : sine;
  result.cos = quarter > 0.5 && quarter < 2.5 ? -cosine : cosine;
  return result;
}

/* arctan of a >= 0; relative error < 3e-16. Ranges meet at tan(3 pi/8) and 0.66. */
static inline double vl_atan_positive(double a) {
  double base = a > 2.41421356237309504880 ? 1.57079632679489661923
                : a > 0.66                 ? 0.78539816339744830962
                                           : 0.0;
  double rest = a > 2.41421356237309504880 ? 6.123233995736765886130e-17
                : a > 0.66                 ? 3.061616997868382943065e-17
                                           : 0.0;
  double over = a > 2.41421356237309504880 ? -1.0 : a > 0.66 ? a - 1.0 : a;
  double under = a > 2.41421356237309504880 ? a : a > 0.66 ? a + 1.0 : 1.0;
  double t = over / under, z = t * t;
  double p = (((-8.750608600031904122785e-1 * z - 1.615753718733365076637e1) * z -
               7.500855792314704667340e1) *
                  z -
              1.228866684490136173410e2) *
                 z -
             6.485021904942025371773e1;
  double q = ((((z + 2.485846490142306297962e1) * z + 1.650270098316988542046e2) * z +
               4.328810604912902668951e2) *
                  z +
              4.853903996359136964868e2) *
                 z +
             1.945506571482613964425e2;
  return base + (t + (t * (z * (p / q)) + rest));
}

/* Angle of (x, y) in [-pi, pi]; 0 at the origin; relative error < 5e-16. */
static inline double vl_atan2_double(double y, double x) {
  double ax = __builtin_fabs(x), ay = __builtin_fabs(y);
  double high = ax > ay ? ax : ay, low = ax > ay ? ay : ax;
  double t = vl_atan_positive(low / (high > 0.0 ? high : 1.0));
  t = ay > ax ? 1.57079632679489661923 - (t - 6.123233995736765886130e-17) : t;
  t = x < 0.0 ? 3.14159265358979323846 - (t - 1.2246467991473531772e-16) : t;
  return y < 0.0 ? -t : t;
}

/* |x| <= 1; relative error < 1e-15. */
static inline double vl_acos_double(double x) {
  return vl_atan2_double(__builtin_sqrt((1.0 - x) * (1.0 + x)), x);
}

/* Relative error < 4e-16. x is clamped to [-708, 709]. */
static inline double vl_exp_double(double x) {
  x = x < -708.0 ? -708.0 : x > 709.0 ? 709.0 : x;
  double n = __builtin_floor(x * 1.44269504088896340736 + 0.5);
  double r = (x - n * 6.93145751953125e-1) - n * 1.42860682030941723212e-6, z = r * r;
  double p = r * ((1.26177193074810590878e-4 * z + 3.02994407707441961300e-2) * z +
                  9.99999999999999999910e-1);
  double q = ((3.00198505138664455042e-6 * z + 2.52448340349684104192e-3) * z +
              2.27265548208155028766e-1) *
                 z +
             2.0;
  uint64_t bits = (uint64_t)((int64_t)n + 1022) << 52; /* 2^(n - 1): 2^1024 is no double */
  double scale;
  memcpy(&scale, &bits, sizeof scale);
  return (1.0 + 2.0 * (p / (q - p))) * scale * 2.0;
}

/* Natural logarithm of a finite x > 0 that is no denormal; relative error < 4e-16, near 1
 * absolute error < 2e-16. */
static inline double vl_log_double(double x) {
  uint64_t bits;
  memcpy(&bits, &x, sizeof bits);
  double n = (double)((int64_t)(bits >> 52) - 1022);
  bits = (bits & 0x000fffffffffffffu) | 0x3fe0000000000000u; /* to [0.5, 1) */
  memcpy(&x, &bits, sizeof x);
  bool low = x < 0.70710678118654752440;
  n = low ? n - 1.0 : n;
  x = low ? (x - 0.5) + (x - 0.5) : x - 1.0;
  double z = x * x;
  double p = ((((1.01875663804580931796e-4 * x + 4.97494994976747001425e-1) * x +
                4.70579119878881725854e0) *
                   x +
               1.44989225341610930846e1) *
                  x +
              1.79368678507819816313e1) *
                 x +
             7.70838733755885391666e0;
  double q = ((((x + 1.12873587189167450590e1) * x + 4.52279145837532221105e1) * x +
               8.29875266912776603211e1) *
                  x +
              7.11544750618563894466e1) *
                 x +
             2.31251620126765340583e1;
  double y = x * (z * p / q) - n * 2.121944400546905827679e-4;
  return (x + (y - 0.5 * z)) + n * 0.693359375;
}

#endif
