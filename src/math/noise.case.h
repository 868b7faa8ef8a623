/* math/noise.case.h: the sums of gradient noise of Ebert et al., "Texturing and Modeling", and
 * of pbrt (3rd edition, 10.6), in double, for the cases of the kinds that are made of noise.
 * The noise itself is the test's (test/world/plain_noise.h). */
#ifndef MATH_NOISE_CASE_H
#define MATH_NOISE_CASE_H

#include <math.h>

typedef double PlainNoise(double x, double y, double z);

/* The sum of whole octaves: each has 1.99 times the frequency and omega times the amplitude of
 * the one before. `strength` receives the amplitude that the next would have. */
static inline double plain_octaves(PlainNoise *noise, const double p[3], double omega,
                                   int octaves, int absolute, double *strength) {
  double sum = 0;
  double size = 1;
  *strength = 1;
  for (int i = 0; i < octaves; i++) {
    const double value = noise(size * p[0], size * p[1], size * p[2]);
    sum += *strength * (absolute ? fabs(value) : value);
    size *= 1.99;
    *strength *= omega;
  }
  return sum;
}

static inline double plain_fractal(PlainNoise *noise, const double p[3], double omega,
                                   int octaves) {
  double next;
  return plain_octaves(noise, p, omega, octaves, 0, &next);
}

/* pbrt's turbulence: what is finer than the octaves counts with a fifth of the next one. */
static inline double plain_turbulence(PlainNoise *noise, const double p[3], double omega,
                                      int octaves) {
  double next;
  const double sum = plain_octaves(noise, p, omega, octaves, 1, &next);
  return sum + 0.2 * next;
}

#endif
