/* sensor/random.c: see random.h. */
#include "sensor/random.h"

#include "math/approx_double.h"

/* c[0] + c[1] x + ... + c[7] x^7 */
static double polynomial(const double c[8], double x) {
  double sum = c[7];
  for (int i = 6; i >= 0; i--)
    sum = sum * x + c[i];
  return sum;
}

double vl_normal_inverse(double p) {
  static const double a[8] = {3.3871328727963666080e0, 1.3314166789178437745e2,
                              1.9715909503065514427e3, 1.3731693765509461125e4,
                              4.5921953931549871457e4, 6.7265770927008700853e4,
                              3.3430575583588128105e4, 2.5090809287301226727e3};
  static const double b[8] = {1.0,
                              4.2313330701600911252e1,
                              6.8718700749205790830e2,
                              5.3941960214247511077e3,
                              2.1213794301586595867e4,
                              3.9307895800092710610e4,
                              2.8729085735721942674e4,
                              5.2264952788528545610e3};
  static const double c[8] = {1.42343711074968357734e0,  4.63033784615654529590e0,
                              5.76949722146069140550e0,  3.64784832476320460504e0,
                              1.27045825245236838258e0,  2.41780725177450611770e-1,
                              2.27238449892691845833e-2, 7.74545014278341407640e-4};
  static const double d[8] = {1.0,
                              2.05319162663775882187e0,
                              1.67638483018380384940e0,
                              6.89767334985100004550e-1,
                              1.48103976427480074590e-1,
                              1.51986665636164571966e-2,
                              5.47593808499534494600e-4,
                              1.05075007164441684324e-9};
  static const double e[8] = {6.65790464350110377720e0,  5.46378491116411436990e0,
                              1.78482653991729133580e0,  2.96560571828504891230e-1,
                              2.65321895265761230930e-2, 1.24266094738807843860e-3,
                              2.71155556874348757815e-5, 2.01033439929228813265e-7};
  static const double f[8] = {1.0,
                              5.99832206555887937690e-1,
                              1.36929880922735805310e-1,
                              1.48753612908506148525e-2,
                              7.86869131145613259100e-4,
                              1.84631831751005468180e-5,
                              1.42151175831644588870e-7,
                              2.04426310338993978564e-15};
  double q = p - 0.5;
  if (q <= 0.425 && q >= -0.425) {
    double r = 0.180625 - q * q;
    return q * polynomial(a, r) / polynomial(b, r);
  }
  double tail = q < 0.0 ? p : 1.0 - p;
  double r = __builtin_sqrt(-vl_log_double(tail));
  double x = r <= 5.0 ? polynomial(c, r - 1.6) / polynomial(d, r - 1.6)
                      : polynomial(e, r - 5.0) / polynomial(f, r - 5.0);
  return q < 0.0 ? -x : x;
}

double vl_random_normal(vlRandom *random) {
  return vl_normal_inverse(vl_random_uniform(random));
}

double vl_log_factorial(double k) {
  double product = 1.0;
  double x = k + 1.0;
  while (x < 16.0) { /* Stirling's series is exact enough from 16 on */
    product *= x;
    x += 1.0;
  }
  double y = 1.0 / (x * x);
  double series = (((-1.0 / 1680.0 * y + 1.0 / 1260.0) * y - 1.0 / 360.0) * y + 1.0 / 12.0) / x;
  double half_log_two_pi = 0.91893853320467274178;
  return (x - 0.5) * vl_log_double(x) - x + half_log_two_pi + series - vl_log_double(product);
}

/* Inversion: adds the probabilities of 0, 1, 2, ... up to a uniform number. */
static double poisson_small(vlRandom *random, double mean) {
  double left = vl_random_uniform(random);
  double probability = vl_exp_double(-mean);
  double k = 0.0;
  while (left > probability && k < 1000.0) { /* 1000: what rounding leaves of `left` */
    left -= probability;
    k += 1.0;
    probability *= mean / k;
  }
  return k;
}

/* Transformed rejection with squeeze, PTRS (Hoermann 1993, "The transformed rejection method
 * for generating Poisson random variables"). */
static double poisson_large(vlRandom *random, double mean) {
  double root = __builtin_sqrt(mean);
  double log_mean = vl_log_double(mean);
  double b = 0.931 + 2.53 * root;
  double a = -0.059 + 0.02483 * b;
  double inverse_alpha = 1.1239 + 1.1328 / (b - 3.4);
  double squeeze = 0.9277 - 3.6224 / (b - 2.0);
  for (;;) {
    double u = vl_random_uniform(random) - 0.5;
    double v = vl_random_uniform(random);
    double us = 0.5 - __builtin_fabs(u);
    double k = __builtin_floor((2.0 * a / us + b) * u + mean + 0.43);
    if (us >= 0.07 && v <= squeeze)
      return k;
    if (k < 0.0 || (us < 0.013 && v > us))
      continue;
    double density = k * log_mean - mean - vl_log_factorial(k);
    if (vl_log_double(v * inverse_alpha / (a / (us * us) + b)) <= density)
      return k;
  }
}

double vl_random_poisson(vlRandom *random, double mean) {
  if (mean > 1e10)
    return __builtin_floor(mean + 0.5);
  if (mean >= 10.0)
    return poisson_large(random, mean);
  return mean > 0.0 ? poisson_small(random, mean) : 0.0;
}
