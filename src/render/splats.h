/* render/splats.h: radiance that light paths add to the film, collected between two samples of
 * its pixels. The sums are exact, so that neither threads nor order change the result. */
#ifndef RENDER_SPLATS_H
#define RENDER_SPLATS_H

#include <stdatomic.h>

#include "base/context.h"
#include "film/film.h"

/* A sum of 128 bits in two words. Threads add without a lock: each addition carries into the
 * high word itself. */
typedef struct vlSplatSum {
  atomic_uint_least64_t low, high;
} vlSplatSum;
typedef struct vlSplat {
  vlSplatSum color[3];
} vlSplat;

typedef struct vlSplats {
  vlSplat *pixels; /* by pixel of the crop window */
  uint32_t x0, y0, width, height;
  const vlFilterTable *filter;
} vlSplats;

/* film must outlive the splats. Error: MEMORY. */
vlResult vl_splats_make(vlContext *context, const vlFilm *film, vlSplats *splats);
void vl_splats_free(vlContext *context, vlSplats *splats);
/* Adds n colors, times the filter, to all pixels whose filter covers the film points x, y
 * (pixels). Any thread. Returns how many of the colors are not finite; these are left out. */
uint32_t vl_splats_add(vlSplats *splats, uint32_t n, const float *x, const float *y,
                       float *const color[3]);
/* Moves the sums of n pixels to their samples, whose filter weights are `weight`, and clears
 * the sums. To be called once per pixel and pass, on any thread. */
void vl_splats_take(vlSplats *splats, uint32_t n, const int32_t *px, const int32_t *py,
                    const float *weight, float *r, float *g, float *b);
void vl_splats_clear(vlSplats *splats);

#endif
