/* image/denoise/outlier.hot.c: finds outliers: pixels whose value comes from few samples (the
 * standard error is above half of the value), and whose light the fit would spread over the
 * whole window. They are scaled to at most 4 times the third largest neighbour. */
#include <string.h>

#include "image/denoise/denoise.h"

enum { REACH = 3, RANK = 3, N = VL_LANES };
_Static_assert((int)VL_DENOISE_BORDER >= (int)REACH + (int)N,
               "neighbours, rounded up to N pixels, end in the border");

/* The third largest of the 24 values of the ring at a distance of 3 around a pixel (7 x 7), but
 * at least 0, for N pixels. Nearer pixels may have counted the same samples as the pixel
 * itself. */
static void third_neighbour(const float *from, ptrdiff_t stride, float to[N]) {
  float top[RANK][N];
  memset(top, 0, sizeof top);
  for (int dy = -REACH; dy <= REACH; dy++)
    for (int dx = -REACH; dx <= REACH; dx += dy == -REACH || dy == REACH ? 1 : 2 * REACH) {
      const float *around = from + dy * stride + dx;
      /* must vectorise (gcc) */
      VL_SIMD for (int i = 0; i < N; i++) {
        float v = around[i];
        for (int r = 0; r < RANK; r++) {
          float high = v > top[r][i] ? v : top[r][i], low = v > top[r][i] ? top[r][i] : v;
          top[r][i] = high;
          v = low;
        }
      }
    }
  memcpy(to, top[RANK - 1], N * sizeof(float));
}

void vl_denoise_cap(const vlDenoisePlanes *p, uint32_t y) {
  for (uint32_t x = 0; x < p->width; x += N) {
    ptrdiff_t at = (ptrdiff_t)y * p->stride + (ptrdiff_t)x;
    const float *r = p->color[0] + at, *g = p->color[1] + at, *b = p->color[2] + at;
    const float *vr = p->variance[0] + at, *vg = p->variance[1] + at, *vb = p->variance[2] + at;
    float *restrict to = p->result[0] + at;
    float third[N];
    third_neighbour(p->result[1] + at, p->stride, third);
    /* must vectorise (gcc) */
    VL_SIMD for (int i = 0; i < N; i++) {
      float v = (r[i] + g[i] + b[i]) * (1.0f / 3.0f), max = 4.0f * third[i];
      float variance = (vr[i] + vg[i] + vb[i]) * (1.0f / 3.0f);
      float factor = max < v ? max / v : 1.0f;
      to[i] = variance > 0.25f * v * v ? factor : 1.0f;
    }
  }
}
