/* math/elementary.h: accurate elementary functions for values that are computed once, while a
 * scene is loaded or a world is built. They compute in pairs of doubles and round at the end.
 * They use only + - * / sqrt and selections, so unlike the C library they give the same bits on
 * every machine. The result is the nearest double except in about one case in 2^40 (error below
 * 0.5000001 units in the last place, test/math/test_elementary.c). They cost some hundred times
 * as much as math/approx.h and math/approx_double.h, which are for loops. The result is NaN
 * where the function has no value. */
#ifndef MATH_ELEMENTARY_H
#define MATH_ELEMENTARY_H

/* 1 to 10^22, the powers of ten that are doubles. */
enum { VL_EXACT_POWER = 22 };
extern const double vl_powers_of_ten[VL_EXACT_POWER + 1];

/* Radians; |x| <= 2^20 for the accuracy above. */
double vl_precise_sin(double x);
double vl_precise_cos(double x);
double vl_precise_tan(double x);
/* |x| <= 1. */
double vl_precise_acos(double x);
double vl_precise_atan(double x);
/* Angle of (x, y) in [-pi, pi], as C's atan2. */
double vl_precise_atan2(double y, double x);
double vl_precise_exp(double x);
double vl_precise_exp2(double x);
/* exp(x) - 1 */
double vl_precise_expm1(double x);
/* log: natural logarithm; log2: logarithm to base 2. */
double vl_precise_log(double x);
double vl_precise_log2(double x);
double vl_precise_log10(double x);
/* x >= 0, or x < 0 with an integer y. */
double vl_precise_pow(double x, double y);
double vl_precise_cbrt(double x);
/* sqrt(x^2 + y^2) of numbers whose squares neither overflow nor underflow. */
double vl_precise_hypot(double x, double y);

#endif
