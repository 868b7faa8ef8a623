/* render/tails.c: see tails.h. */
#include "render/tails.h"

#include <math.h>
#include <stddef.h>

/* Sums of colors are exact from 2^-50 to 2^35 (splats.c). */
static const double MAX_TAIL = 0x1p30, SQUARES = VL_TAIL_SQUARES;

static uint32_t pixel_at(float x, uint32_t size) {
  return x > 0.0f ? ((double)x < size ? (uint32_t)x : size - 1) : 0;
}

static double measure(const vlTails *t, float x, float y, double odds, const double color[3]) {
  if (!(odds > 0))
    return 0; /* camera paths never find it: light that is missing, not noise */
  const double *base =
      t->base + 3 * ((size_t)pixel_at(y, t->height) * t->width + pixel_at(x, t->width));
  double largest = 0, squared = 0, both = 0, grows = (1 + odds) / odds;
  for (int c = 0; c < 3; c++)
    largest = fmax(largest, fabs(color[c]) * grows);
  double limit = largest > t->max ? t->max / largest : 1;
  for (int c = 0; c < 3; c++) {
    double sample = color[c] * grows * limit, part = 1 / (3 * (base[c] * base[c] + t->min));
    squared += sample * sample * part;
    both += color[c] * (1 + odds) * limit * sample * part;
  }
  return squared > t->rare * t->rare ? fmin(both, MAX_TAIL) : 0;
}

void vl_tails_measure(const vlTails *tails, uint32_t n, const float *x, const float *y,
                      const float *odds, float *const color[3]) {
  for (uint32_t i = 0; i < n; i++) {
    const double rgb[3] = {(double)color[0][i], (double)color[1][i], (double)color[2][i]};
    double moment = measure(tails, x[i], y[i], (double)odds[i], rgb);
    color[0][i] = (float)moment;
    color[1][i] = (float)(moment * moment * SQUARES);
    color[2][i] = 0.0f;
  }
}
