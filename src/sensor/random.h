/* sensor/random.h: random numbers of a sensor: each is a function of a key (seed, frame,
 * stage), an index (pixel, row or column) and a counter, so that neither threads nor order
 * matter. Only velo's own elementary functions, so that the bits are the same on every machine.
 */
#ifndef SENSOR_RANDOM_H
#define SENSOR_RANDOM_H

#include "math/hash.h"

/* The steps of a readout that have random numbers of their own. */
typedef enum vlSensorStage {
  VL_STAGE_PRNU, /* fixed patterns, from the seed of the sensor */
  VL_STAGE_DSNU,
  VL_STAGE_DARK_PATTERN,
  VL_STAGE_ELECTRONS, /* of each frame */
  VL_STAGE_READ,
  VL_STAGE_ADC,
  VL_STAGE_ROW,
  VL_STAGE_COLUMN
} vlSensorStage;

/* A sequence of random numbers. */
typedef struct vlRandom {
  uint64_t state;
} vlRandom;

/* The key of a stage. */
static inline uint64_t vl_random_key(uint32_t seed, uint32_t frame, vlSensorStage stage) {
  uint64_t key = vl_hash64(((uint64_t)seed << 32 | frame) + 0x9e3779b97f4a7c15u);
  return vl_hash64(key + ((uint64_t)stage + 1) * 0xd1342543de82ef95u);
}
/* The sequence of that index. */
static inline vlRandom vl_random_at(uint64_t key, uint64_t index) {
  return (vlRandom){vl_hash64(key + index * 0xda942042e4dd58b5u)};
}
/* Uniform in (0, 1): the middles of 2^52 intervals. */
static inline double vl_random_uniform(vlRandom *random) {
  random->state += 0x9e3779b97f4a7c15u; /* SplitMix64 (Steele, Lea, Flood 2014) */
  return ((double)(vl_hash64(random->state) >> 12) + 0.5) * 0x1p-52;
}
/* Standard normal, by the inverse of its distribution. */
double vl_random_normal(vlRandom *random);
/* Poisson of a finite mean >= 0. A mean above 1e10 is returned itself, rounded: its noise is
 * below 1e-5 of it, and no well holds so many. */
double vl_random_poisson(vlRandom *random, double mean);

/* The inverse of the normal distribution, p in (0, 1); relative error 1e-15 (algorithm AS 241:
 * Wichura 1988). */
double vl_normal_inverse(double p);
/* log(k!) for whole k >= 0; relative error < 2e-13, absolute error 4e-14 where it is small. */
double vl_log_factorial(double k);

#endif
