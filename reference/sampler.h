/* sampler.h: the lecture's sampler. It gives numbers in [0, 1) and, from them, points of the unit square, disk and
 * hemisphere. The numbers are independent: that is simple, and needs many samples. */
#pragma once
#include <stdint.h>

#include "vector.h"

typedef struct sampler {
  uint64_t state;
} sampler;

typedef struct square_point {
  double x, y;
} square_point;

/* Where the numbers start: elsewhere for each seed, pixel and sample. The factors are large odd numbers. */
static inline sampler make_sampler(uint64_t seed, uint64_t pixel, uint64_t sample) {
  return (sampler){seed * 0x9e3779b97f4a7c15u ^ pixel * 0xd1b54a32d192ed03u ^ sample * 0x8cb92ba72f3d8dd7u};
}

/* The next number, by splitmix64 (Steele, Lea, Flood 2014): 53 bits, as many as a double holds, as a fraction. */
static inline double next_number(sampler *s) {
  s->state += 0x9e3779b97f4a7c15u;
  uint64_t z = s->state;
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
  z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
  z ^= z >> 31;
  return (double)(z >> 11) * 0x1p-53;
}

/* The lecture's sample_unit_square. */
static inline square_point sample_unit_square(sampler *s) {
  double x = next_number(s);
  double y = next_number(s);
  return (square_point){x, y};
}

/* A point of the unit disk, uniform in area: the area within radius r is r^2 of the whole. */
static inline square_point sample_unit_disk(sampler *s) {
  square_point u = sample_unit_square(s);
  double radius = sqrt(u.x);
  double angle = 2 * PI * u.y;
  return (square_point){radius * cos(angle), radius * sin(angle)};
}

/* A direction around z with density cos(theta) / pi: a point of the disk, projected up (Malley). */
static inline vector sample_cosine_hemisphere(sampler *s) {
  square_point d = sample_unit_disk(s);
  return make_vector(d.x, d.y, sqrt(fmax(0, 1 - d.x * d.x - d.y * d.y)));
}

/* A whole number below `count`. */
static inline uint32_t choose(sampler *s, uint32_t count) {
  return (uint32_t)(next_number(s) * count);
}
