/* render/splats.h: what light's paths leave on the film between two samples of its pixels: sums that are exact, so that
 * neither threads nor order show. */
#ifndef RENDER_SPLATS_H
#define RENDER_SPLATS_H

#include <stdatomic.h>

#include "base/context.h"
#include "film/film.h"

/* 128 bits in two words, so that threads may add without a lock: a carry is what one addition makes. */
typedef struct vlSplatSum {
  atomic_uint_least64_t low, high;
} vlSplatSum;
typedef struct vlSplat {
  vlSplatSum color[3];
} vlSplat;

typedef struct vlSplats {
  vlSplat *pixels; /* of the crop window */
  uint32_t x0, y0, width, height;
  const vlPixelFilter *filter;
  double scale[2]; /* makes the filter's integral 1 */
} vlSplats;

/* film: stays. MEMORY. */
vlResult vl_splats_make(vlContext *context, const vlFilmDef *film, vlSplats *splats);
void vl_splats_free(vlContext *context, vlSplats *splats);
/* All pixels that see the film point x, y add what they see of the color. Any thread. false: not a finite color. */
bool vl_splats_add(vlSplats *splats, float x, float y, const float color[3]);
/* Moves what the pixels got to their samples (of filter weight `weight`): each pixel once a pass, any thread. */
void vl_splats_take(vlSplats *splats, uint32_t n, const int32_t *px, const int32_t *py, const float *weight, float *r,
                    float *g, float *b);
void vl_splats_clear(vlSplats *splats);

#endif
