/* distortion/distortion.case.h: what the tests of distortions must know of a kind beyond its
 * row: coefficients, and the published equation, written apart from the library. */
#ifndef DISTORTION_DISTORTION_CASE_H
#define DISTORTION_DISTORTION_CASE_H

#include "velo/distortion.h"

typedef struct DistortionVariant {
  uint32_t count;
  double k[14];
} DistortionVariant;

enum { DISTORTION_VARIANTS = 5 };
typedef struct DistortionCase {
  /* but the first, without coefficients: unused */
  DistortionVariant variants[DISTORTION_VARIANTS];
  /* The distorted point of a point of the plane z = 1. */
  void (*plain)(const DistortionVariant *variant, double x, double y, double at[2]);
} DistortionCase;

/* The radial polynomial, tangential terms p1 and p2, and terms of the squared radius along each
 * axis, which all kinds share. */
static inline void distort_plainly(double radial, double p1, double p2, const double prism[4],
                                   double x, double y, double at[2]) {
  double s = x * x + y * y;
  at[0] = x * radial + 2 * p1 * x * y + p2 * (s + 2 * x * x) + prism[0] * s + prism[1] * s * s;
  at[1] = y * radial + p1 * (s + 2 * y * y) + 2 * p2 * x * y + prism[2] * s + prism[3] * s * s;
}

/* Declares the case of each kind, which is in the file of the kind: distortion/NAME.case.c. */
#define DISTORTION_CASE(kind, name) extern const DistortionCase name##_distortion;
VL_DISTORTION_KINDS(DISTORTION_CASE)
#undef DISTORTION_CASE

#endif
