/* world/accel/crossed.h: what a shadow ray has crossed: surfaces with an alpha, each of which
 * lets the share 1 - alpha of the light pass. Their product would have other last bits in
 * another order of traversal. So -ln(1 - alpha) is summed in whole steps: sums of whole numbers
 * do not depend on the order. */
#ifndef WORLD_ACCEL_CROSSED_H
#define WORLD_ACCEL_CROSSED_H

#include <stdbool.h>
#include <stdint.h>

#include "math/approx_double.h"

#define VL_CROSSED_STEPS 16777216.0 /* of an attenuation by e: 2^24 */
/* The largest sum, an attenuation by e^64. Any of the surfaces adds less than e^17: alpha is a
 * float below 1. */
#define VL_MAX_CROSSED (64u << 24)

/* Adds a surface with this alpha to *crossed. False: nothing passes it. */
static inline bool vl_cross_surface(float alpha, uint32_t *crossed) {
  if (!(alpha < 1.0f))
    return false; /* also if it is no number */
  if (!(alpha > 0.0f))
    return true;
  double steps = -vl_log_double(1.0 - (double)alpha) * VL_CROSSED_STEPS + 0.5;
  uint32_t sum = *crossed + (uint32_t)steps;
  *crossed = sum < VL_MAX_CROSSED ? sum : VL_MAX_CROSSED;
  return true;
}

/* The share of the light that passes. */
static inline float vl_crossed_passes(uint32_t crossed) {
  return (float)vl_exp_double((double)crossed * (-1.0 / VL_CROSSED_STEPS));
}

#endif
