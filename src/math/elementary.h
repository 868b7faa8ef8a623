/* math/elementary.h: elementary functions for what is computed once, while a scene is loaded or a world is built: in
 * pairs of doubles, rounded at the end. Only + - * / sqrt and selections, so the same bits on every machine, which the
 * C library's do not have. The result is the nearest double but for about one case in 2^40 (error below 0.5000001 units
 * in the last place, test/math/test_elementary.c). Some hundred times the cost of math/approx.h and
 * math/approx_double.h, which are for loops over many. Not a number where the function has no value. */
#ifndef MATH_ELEMENTARY_H
#define MATH_ELEMENTARY_H

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
/* Natural; log2: to the base 2. */
double vl_precise_log(double x);
double vl_precise_log2(double x);
double vl_precise_log10(double x);
/* x >= 0, or x < 0 and y whole. */
double vl_precise_pow(double x, double y);
double vl_precise_cbrt(double x);
/* sqrt(x^2 + y^2) of numbers whose squares neither overflow nor underflow. */
double vl_precise_hypot(double x, double y);

#endif
