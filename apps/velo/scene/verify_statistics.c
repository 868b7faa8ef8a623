/* scene/verify_statistics.c: see verify_statistics.h. */
#include "scene/verify_statistics.h"

#include <math.h>

enum { MAX_TERMS = 400 };

/* Lentz's continued fraction of the incomplete beta function (Numerical Recipes 6.4; DLMF
 * 8.17.22). */
static double beta_fraction(double x, double a, double b) {
  const double tiny = 1e-300;
  double c = 1, d = 1 - (a + b) * x / (a + 1);
  d = 1 / (fabs(d) < tiny ? tiny : d);
  double h = d;
  for (int m = 1; m < MAX_TERMS; m++) {
    const double even = m * (b - m) * x / ((a + 2 * m - 1) * (a + 2 * m));
    const double odd = -(a + m) * (a + b + m) * x / ((a + 2 * m) * (a + 2 * m + 1));
    double step = 1;
    for (int k = 0; k < 2; k++) {
      const double term = k ? odd : even;
      d = 1 + term * d;
      d = 1 / (fabs(d) < tiny ? tiny : d);
      c = 1 + term / c;
      c = fabs(c) < tiny ? tiny : c;
      step = c * d;
      h *= step;
    }
    if (fabs(step - 1) < 1e-15)
      break;
  }
  return h;
}

/* The regularised incomplete beta function I_x(a, b). y: 1 - x, exactly where x is close to
 * 1. */
static double incomplete_beta(double x, double y, double a, double b) {
  if (x <= 0)
    return 0;
  if (y <= 0)
    return 1;
  const double front = exp(lgamma(a + b) - lgamma(a) - lgamma(b) + a * log(x) + b * log(y));
  if (x < (a + 1) / (a + b + 2))
    return front * beta_fraction(x, a, b) / a;
  return 1 - front * beta_fraction(y, b, a) / b;
}

double verify_student_p(double t, double freedom) {
  if (!(t > 0))
    return 1;
  if (isinf(t))
    return 0;
  const double x = freedom / (freedom + t * t), y = t * t / (freedom + t * t);
  return incomplete_beta(x, y, 0.5 * freedom, 0.5);
}

double verify_normal_z(double p) {
  double low = 0, high = 37;
  if (!(p < 1))
    return 0;
  for (int i = 0; i < 60; i++) {
    const double middle = 0.5 * (low + high);
    if (erfc(middle * M_SQRT1_2) > p)
      low = middle;
    else
      high = middle;
  }
  return 0.5 * (low + high);
}

static double mean_of(const double *a, uint32_t replicates, size_t stride) {
  double sum = 0;
  for (uint32_t r = 0; r < replicates; r++)
    sum += a[r * stride];
  return sum / replicates;
}

double verify_variance(const double *a, const double *b, uint32_t replicates, size_t stride) {
  const double mean = mean_of(a, replicates, stride) - mean_of(b, replicates, stride);
  double squares = 0;
  for (uint32_t r = 0; r < replicates; r++) {
    const double off = a[r * stride] - b[r * stride] - mean;
    squares += off * off;
  }
  return squares / (replicates - 1);
}

VerifyDifference verify_compare(const double *a, const double *b, uint32_t replicates,
                                size_t stride, double min, double min_error) {
  VerifyDifference result = {.a = mean_of(a, replicates, stride),
                             .b = mean_of(b, replicates, stride)};
  const double own = sqrt(verify_variance(a, b, replicates, stride) / replicates);
  const double beyond = fabs(result.a - result.b) - min;
  result.error = fmax(own, min_error);
  result.p = beyond > 0 ? verify_student_p(beyond / result.error, replicates - 1) : 1;
  result.z = copysign(verify_normal_z(result.p), result.a - result.b);
  return result;
}

double verify_first_p(uint32_t of_family, uint32_t families) {
  return VERIFY_FIRST_LEVEL / ((double)families * of_family);
}

double verify_second_p(uint32_t marked) {
  /* only one direction counts: half of the two-sided probability */
  return 2 * VERIFY_SECOND_LEVEL / marked;
}
