/* sampler/own.c: numbers of a sampler of one's own (velo/own.h): calls its function and
 * checks what it gives. */
#include <math.h>

#include "math/vec.h"
#include "sampler/sampler.h"

/* Replaces numbers outside [0, 1). Returns how many of the first n there were. */
static uint32_t repair(uint32_t n, uint32_t padded, float *u) {
  uint32_t bad = 0;
  for (uint32_t i = 0; i < padded; i++) {
    if (u[i] >= 0.0f && u[i] < 1.0f)
      continue;
    if (i < n)
      bad++;
    u[i] = u[i] < 0.0f ? 0.0f : u[i] >= 1.0f ? VL_ONE_MINUS_EPSILON : 0.5f;
  }
  return bad;
}

void vl_own_numbers(const vlSampler *s, uint32_t n, const int32_t *px, const int32_t *py,
                    const uint32_t *index, uint32_t dimension, float *u, float *v) {
  for (uint32_t i = 0; i < VL_PAD(n); i++) {
    u[i] = (float)NAN;
    if (v)
      v[i] = (float)NAN;
  }
  const vlOwnSamples samples = {n, px, py, index, dimension, v ? 2 : 1, s->seed, u, v};
  s->own->numbers(s->own->user, &samples);
  uint32_t bad = repair(n, VL_PAD(n), u) + (v ? repair(n, VL_PAD(n), v) : 0);
  if (bad && s->own_bad)
    atomic_fetch_add(s->own_bad, bad);
}
