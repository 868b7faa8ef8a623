/* own_sampler: a sampler of one's own: in each dimension the samples of a pixel go round by steps of one angle (a
 * Kronecker sequence); each pixel starts elsewhere (docs/own-code.md).
 *
 *   own_sampler SCENE IMAGE
 *   build/release/bin/example_own_sampler examples/corner.pbrt examples/own_sampler.jpg
 */
#include <math.h>

#include "example.h"

static double hash(uint32_t a, uint32_t b, uint32_t c, uint32_t d) {
  uint32_t h = a * 0x9e3779b9u ^ (b + 0x7f4a7c15u) * 0x85ebca6bu ^ (c + 0x165667b1u) * 0xc2b2ae35u ^ d * 0x27d4eb2fu;
  h = (h ^ h >> 16) * 0x7feb352du;
  h = (h ^ h >> 15) * 0x846ca68bu;
  return (h ^ h >> 16) * 0x1p-32;
}

static float number(const vlOwnSamples *s, uint32_t i, uint32_t dimension) {
  double start = hash((uint32_t)s->x[i], (uint32_t)s->y[i], dimension, s->seed);
  double u = start + s->index[i] * hash(dimension, s->seed, 0, 0);
  return fminf((float)(u - floor(u)), 0x1.fffffep-1f); /* at most the largest float below 1 */
}

static void numbers_of(void *user, const vlOwnSamples *s) {
  (void)user;
  for (uint32_t i = 0; i < s->count; i++) s->u[i] = number(s, i, s->dimension);
  for (uint32_t i = 0; s->v && i < s->count; i++) s->v[i] = number(s, i, s->dimension + 1);
}

int main(int count, char **arguments) {
  static const vlOwnSampler sampler = {.name = "Kronecker", .numbers = numbers_of};
  Example e = example_open(count, arguments, NULL);
  e.defs->render.own_sampler = &sampler;
  example_render(&e);
  example_write(&e, arguments[2]);
  return example_close(&e);
}
