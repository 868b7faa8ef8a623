/* math/noise.case.h: the sums of gradient noise of Ebert et al., "Texturing and Modeling", and
 * of pbrt (3rd edition, 10.6), in double, for the cases of the kinds that are made of noise.
 * The noise itself is the test's (test/world/plain_noise.h). */
#ifndef MATH_NOISE_CASE_H
#define MATH_NOISE_CASE_H

#include <math.h>

typedef double PlainNoise(double x, double y, double z);

/* How many octaves a ray of a width sees; width: of the ray, in the space of the noise. It sees
 * n = -1 - log2(width) octaves: floor(n) whole ones, and of the next the share that a smooth
 * step from 0.3 to 0.7 gives for n - floor(n). */
typedef struct PlainOctaves {
  int whole;
  double part; /* of the octave after these, 0 to 1 */
} PlainOctaves;
static inline PlainOctaves plain_resolved(double width, int octaves) {
  const double seen = fmin(fmax(-1 - log2(width), 0), octaves);
  const double rest = fmin(fmax((seen - floor(seen) - 0.3) / 0.4, 0), 1);
  return (PlainOctaves){(int)seen, rest * rest * (3 - 2 * rest)};
}

/* Octave i has 1.99 times the frequency and omega times the amplitude of the one before. */
static inline double plain_octave(PlainNoise *noise, const double p[3], int i) {
  const double size = pow(1.99, i);
  return noise(size * p[0], size * p[1], size * p[2]);
}

static inline double plain_fractal(PlainNoise *noise, const double p[3], double width,
                                   double omega, int octaves) {
  const PlainOctaves seen = plain_resolved(width, octaves);
  double sum = pow(omega, seen.whole) * seen.part * plain_octave(noise, p, seen.whole);
  for (int i = 0; i < seen.whole; i++)
    sum += pow(omega, i) * plain_octave(noise, p, i);
  return sum;
}

/* pbrt's turbulence: without the signs. What the ray does not see counts with a fifth, and so
 * does one octave that is finer than all. */
static inline double plain_turbulence(PlainNoise *noise, const double p[3], double width,
                                      double omega, int octaves) {
  const PlainOctaves seen = plain_resolved(width, octaves);
  const double next = fabs(plain_octave(noise, p, seen.whole));
  double sum = pow(omega, seen.whole) * (seen.part * next + (1 - seen.part) * 0.2);
  for (int i = 0; i < seen.whole; i++)
    sum += pow(omega, i) * fabs(plain_octave(noise, p, i));
  for (int i = seen.whole; i < octaves; i++)
    sum += pow(omega, i) * 0.2;
  return sum;
}

#endif
