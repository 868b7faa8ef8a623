/* image/denoise/variance.hot.c: raises variances that are too small by chance. Where a pixel
 * happens to lack the samples with much light, both its value and its variance are too small.
 * It would seem to differ clearly from its neighbours, and remain as a dark speck. */
#include "image/denoise/denoise.h"

enum { REACH = 3, RANK = 4, N = VL_LANES };
_Static_assert((int)VL_DENOISE_RADIUS + (int)VL_DENOISE_PATCH >= (int)REACH,
               "the mirrored border has the pixels around");

/* The fourth smallest of the 8 values at a distance of REACH in x, y or both, for N pixels:
 * also at a straight edge, one of the pixel's own side. */
static void surrounding(const float *from, ptrdiff_t stride, float to[N]) {
  float min[RANK][N];
  for (int r = 0; r < RANK; r++)
    for (int i = 0; i < N; i++)
      min[r][i] = 0x1p127f;
  for (int k = 0; k < 9; k++) {
    const float *around = from + (k / 3 - 1) * REACH * stride + (k % 3 - 1) * REACH;
    if (k == 4)
      continue;
    /* must vectorise (gcc) */
    VL_SIMD for (int i = 0; i < N; i++) {
      float v = around[i];
      for (int r = 0; r < RANK; r++) {
        float low = v < min[r][i] ? v : min[r][i], high = v < min[r][i] ? min[r][i] : v;
        min[r][i] = low;
        v = high;
      }
    }
  }
  for (int i = 0; i < N; i++)
    to[i] = min[RANK - 1][i];
}

/* Standard errors become at least 0.9 of those around, but not for that more than 0.63 of the
 * pixel's value: a dark pixel between the stripes of a shadow stays dark. */
void vl_denoise_raise(const vlDenoisePlanes *p, uint32_t y) {
  for (int c = 0; c < 3; c++)
    for (uint32_t x = 0; x < p->width; x += N) {
      ptrdiff_t at = (ptrdiff_t)y * p->stride + (ptrdiff_t)x;
      const float *own = p->variance[c] + at, *value = p->color[c] + at;
      float *restrict to = p->result[c] + at;
      float around[N];
      surrounding(own, p->stride, around);
      /* must vectorise (gcc) */
      VL_SIMD for (int i = 0; i < N; i++) {
        float min = 0.8f * around[i], max = 0.4f * value[i] * value[i];
        min = min < max ? min : max;
        to[i] = own[i] > min ? own[i] : min;
      }
    }
}
