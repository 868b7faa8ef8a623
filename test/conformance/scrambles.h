/* conformance/scrambles.h: laws of samplers: a sample's numbers do not depend on the others of
 * its batch; numbers that have an interval each stand in it by chance of their own. The mean of
 * n such numbers has the variance 1 / (12 n^3); it has n times that if all stand in the same
 * place of their intervals, as with digits that are scrambled alike in all branches (Owen 1997,
 * "Scrambled net variance for integrals of smooth functions"). */
#ifndef TEST_CONFORMANCE_SCRAMBLES_H
#define TEST_CONFORMANCE_SCRAMBLES_H

#include "conformance.h"
#include "sampler/sampler.h"
#include "sampling.h"
#include "unit.h"

/* ---- lanes ------------------------------------------------------------------------------- */

enum { LANES = 64, LANE_PIXELS = 7 };

typedef struct LaneNumbers {
  float alone[LANES], u[LANES], v[LANES];
} LaneNumbers;

/* Numbers of LANES samples, the first of them in the lane `from`. Only the first one is past
 * the end of the sequence of `count` samples. */
static void numbers_of_lanes(vlSamplerKind kind, uint32_t count, uint32_t from,
                             LaneNumbers *numbers) {
  int32_t px[LANES];
  int32_t py[LANES];
  uint32_t index[LANES];
  vlSampler s;
  vl_sampler_init(&s, kind, 5, 256, 256, count);
  for (uint32_t i = 0; i < LANES; i++) {
    const uint32_t lane = (from + i) % LANES;
    px[lane] = (int32_t)(i % LANE_PIXELS);
    py[lane] = (int32_t)(i / LANE_PIXELS);
    index[lane] = i == 0 ? count + 1 : i % count;
  }
  const vlSamplerKernels *kernels = vl_sampler_kernels(vl_isa_best());
  kernels->get_1d(&s, LANES, px, py, index, 5, numbers->alone);
  kernels->get_2d(&s, LANES, px, py, index, 8, numbers->u, numbers->v);
}

static void lanes_of_samplers(void **state) {
  (void)state;
  enum { COUNT = 12 };
  static LaneNumbers first;
  static LaneNumbers turned;
  const vlKindFamily *family = vl_kind_family_find("samplers");
  for (uint32_t k = 0; k < family->kind_count; k++) {
    uint32_t other = 0;
    numbers_of_lanes((vlSamplerKind)k, COUNT, 0, &first);
    for (uint32_t from = 1; from < LANES; from++) {
      numbers_of_lanes((vlSamplerKind)k, COUNT, from, &turned);
      for (uint32_t i = 0; i < LANES; i++) {
        const uint32_t lane = (from + i) % LANES;
        other += first.alone[i] != turned.alone[lane] || first.u[i] != turned.u[lane] ||
                 first.v[i] != turned.v[lane];
      }
    }
    if (other)
      broken("samplers", family->rows[k]->name, "%u numbers are others in another lane", other);
  }
  expect_no_failures();
}

/* ---- places in intervals ----------------------------------------------------------------- */

/* Adds the mean of the numbers of one dimension in one pixel, with a seed of its own. False:
 * not each interval has one. */
static bool add_mean_number(vlSamplerKind kind, uint32_t dimension, uint32_t count,
                            uint32_t pixel, Mean *mean) {
  float u[VL_ROW_SIZE] = {0};
  int32_t px[VL_ROW_SIZE] = {0};
  int32_t py[VL_ROW_SIZE] = {0};
  uint32_t index[VL_ROW_SIZE] = {0};
  double numbers[SET];
  double sum = 0;
  vlSampler s;
  vl_sampler_init(&s, kind, 7 + 977 * pixel, 4096, 4096, count);
  for (uint32_t i = 0; i < count; i++) {
    px[i] = (int32_t)(61 * (pixel % 32));
    py[i] = (int32_t)(53 * (pixel / 32));
    index[i] = i;
  }
  vl_sampler_kernels(vl_isa_best())->get_1d(&s, count, px, py, index, dimension, u);
  for (uint32_t i = 0; i < count; i++) {
    numbers[i] = (double)u[i];
    sum += numbers[i];
  }
  mean_add(mean, sum / count);
  return one_in_each(numbers, count);
}

/* How many of the dimensions have an interval for each number in all pixels; those must stand
 * there by chance. */
static int check_scramble(vlSamplerKind kind, const char *name, uint32_t count) {
  enum { PIXELS_OF_SCRAMBLE = 512, DIMENSIONS = 8 };
  int even = 0;
  for (uint32_t dimension = 0; dimension < DIMENSIONS; dimension++) {
    Mean mean = {0};
    bool intervals = true;
    for (uint32_t pixel = 0; pixel < PIXELS_OF_SCRAMBLE; pixel++)
      intervals = add_mean_number(kind, dimension, count, pixel, &mean) && intervals;
    if (!intervals)
      continue;
    even++;
    const double ratio = variance_of_mean(&mean) * PIXELS_OF_SCRAMBLE * 12 * pow(count, 3);
    /* of 512 pixels: within 5 standard errors, sqrt(2 / 511) each */
    if (!(fabs(ratio - 1) < 0.35))
      broken("samplers", name,
             "%u numbers of dimension %u: their mean has %.2f of the variance of numbers that "
             "stand anywhere in their intervals",
             count, dimension, ratio);
  }
  return even;
}

static void scrambles_of_samplers(void **state) {
  (void)state;
  /* powers of Halton's first bases, and of Sobol's */
  static const uint32_t counts[] = {4, 9, 16, 25, 27, 49, 64};
  const vlKindFamily *family = vl_kind_family_find("samplers");
  for (uint32_t k = 0; k < family->kind_count; k++) {
    int even = 0;
    if (!sampler_cases[k]->scattered)
      continue;
    for (size_t i = 0; i < sizeof counts / sizeof *counts; i++)
      even += check_scramble((vlSamplerKind)k, family->rows[k]->name, counts[i]);
    if (even < 4)
      broken("samplers", family->rows[k]->name, "intervals with a number each: %d times", even);
  }
  expect_no_failures();
}

#endif
