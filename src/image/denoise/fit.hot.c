/* image/denoise/fit.hot.c: fits the window around each pixel by a weighted linear function of
 * the features and the position; its value at the pixel is the result (Bitterli et al. 2016,
 * "Nonlinearly weighted first-order regression"). The weights depend on the distance of patches
 * relative to their variance (Rousselle et al. 2012, "Adaptive rendering with non-local means
 * filtering", equations 1 to 4). */
#include <string.h>

#include "image/denoise/denoise.h"
#include "math/approx.h"

enum {
  X = VL_DENOISE_TILE_X,
  Y = VL_DENOISE_TILE_Y,
  R = VL_DENOISE_RADIUS,
  P = VL_DENOISE_PATCH,
  SIDE = 2 * P + 1,
  U = VL_DENOISE_UNKNOWNS,
  F = VL_DENOISE_FEATURES,
  TERMS = U * (U + 1) / 2,
  N = VL_LANES, /* pixels whose equations are added up at once */
  G = 8         /* neighbours added at once */
};
_Static_assert((int)VL_DENOISE_TILE_X % (int)N == 0, "tiles are divided into runs of N pixels");

static const float BANDWIDTH2 = 0.36f; /* square of k in docs/denoising.md */
static const float PIXEL_SHARE =
    0.02f;                          /* factor on the distance between the two single pixels */
static const float FARTHEST = 6.0f; /* distance from which on the weight is 0 */
static const float
    RIDGE_FEATURE = 1e-3f,
    RIDGE_PLACE = 3e-2f; /* ridge terms lambda of features and positions, per unit of weight */

/* ---- weights ----------------------------------------------------------------------------- */

/* For each pixel of the tile and of a margin of P pixels: the squared difference from the pixel
 * at the offset (dx, dy) minus the variance of that difference, divided by a multiple of this
 * variance and summed over the channels. */
static void pixel_distances(const vlDenoisePlanes *p, vlDenoiseScratch *s, uint32_t x,
                            uint32_t y, int dx, int dy) {
  for (int j = 0; j < Y + 2 * P; j++) {
    ptrdiff_t at = ((ptrdiff_t)y + j - P) * p->stride + (ptrdiff_t)x - P,
              to = at + dy * p->stride + dx;
    float *row = s->distance[j];
    for (int i = 0; i < X + 2 * P; i++)
      row[i] = 0.0f;
    for (int c = 0; c < 3; c++) {
      const float *a = p->color[c] + at, *b = p->color[c] + to, *va = p->variance[c] + at,
                  *vb = p->variance[c] + to;
      /* must vectorise */
      VL_SIMD for (int i = 0; i < X + 2 * P; i++) {
        float d = a[i] - b[i], sum = a[i] + b[i], v = va[i] + vb[i];
        row[i] += (d * d - v) / (1e-10f + 1e-6f * sum * sum + BANDWIDTH2 * v);
      }
    }
  }
}

/* For each pixel of the tile, the weight of its neighbour at the offset (dx, dy):
 * exp(-distance), and 0 from FARTHEST on, since neighbours without weight cost nothing and
 * products of tiny weights are subnormal numbers, which processors multiply slowly. The
 * distance is the larger of the mean over the patches and PIXEL_SHARE times the distance
 * between the two single pixels. The latter excludes a neighbour that clearly differs, as the
 * test of Sakai et al. 2024 does, although the patches are similar: a pixel at the edge of a
 * lamp has so large a variance that the patches hardly differ. */
static void weights(const vlDenoisePlanes *p, vlDenoiseScratch *s, uint32_t x, uint32_t y,
                    int dx, int dy, float *to) {
  pixel_distances(p, s, x, y, dx, dy);
  for (int j = 0; j < Y + 2 * P; j++) {
    const float *row = s->distance[j];
    float *sum = s->sums[j];
    /* must vectorise (gcc) */
    VL_SIMD for (int i = 0; i < X; i++) {
      float t = row[i];
      for (int k = 1; k < SIDE; k++)
        t += row[i + k];
      sum[i] = t;
    }
  }
  for (int j = 0; j < Y; j++) {
    const float *a = s->sums[j], *far = s->distance[j + P] + P;
    const float *valid = p->valid + ((ptrdiff_t)y + j + dy) * p->stride + (ptrdiff_t)x + dx;
    float *row = to + j * X;
    /* must vectorise */
    VL_SIMD for (int i = 0; i < X; i++) {
      float own = far[i] * PIXEL_SHARE, d = a[i];
      for (int k = 1; k < SIDE; k++)
        d += a[i + k * X];
      d *= 1.0f / (3 * SIDE * SIDE);
      d = d > own ? d : own;
      float w = valid[i] * vl_exp(d > 0.0f ? -d : 0.0f);
      row[i] = d < FARTHEST ? w : 0.0f;
    }
  }
}

/* ---- the fit ----------------------------------------------------------------------------- */

/* Normal equations of N pixels of a row. a: the lower triangle of the symmetric matrix, row by
 * row; the unknowns are the slopes of the features, of x and of y, then the constant. b: the
 * right-hand sides for R, G and B. */
typedef struct Equations {
  float a[TERMS][N], b[3][U][N];
} Equations;

/* Up to G neighbours of N pixels: their differences from the pixels and their colours, and the
 * differences times the weights. The equations are read and written once per group. */
typedef struct Group {
  float value[G][U + 3][N], weighted[G][U][N];
} Group;

/* Sets neighbour g of the group: the pixels at the offset (dx, dy) from the N pixels from index
 * `at` on. */
static void set_neighbour(const vlDenoisePlanes *p, Group *q, int g, const float *w,
                          ptrdiff_t at, int dx, int dy) {
  ptrdiff_t to = at + dy * p->stride + dx;
  for (int k = 0; k < F; k++) {
    const float *f = p->feature[k] + at, *h = p->feature[k] + to;
    VL_SIMD for (int i = 0; i < N; i++) {
      q->value[g][k][i] = h[i] - f[i];
      q->weighted[g][k][i] = w[i] * q->value[g][k][i];
    }
  }
  float ox = (float)dx * (1.0f / R), oy = (float)dy * (1.0f / R);
  VL_SIMD for (int i = 0; i < N; i++) {
    q->value[g][F][i] = ox;
    q->value[g][F + 1][i] = oy;
    q->value[g][F + 2][i] = 1.0f;
    q->weighted[g][F][i] = w[i] * ox;
    q->weighted[g][F + 1][i] = w[i] * oy;
    q->weighted[g][F + 2][i] = w[i];
  }
  for (int c = 0; c < 3; c++)
    memcpy(q->value[g][U + c], p->color[c] + to, N * sizeof(float));
}

/* Adds a group of neighbours to the equations. */
static void add(Equations *restrict e, const Group *restrict q) {
  for (int k = 0, term = 0; k < U; k++) {
    for (int l = 0; l <= k; l++, term++) {
      /* must vectorise */
      VL_SIMD for (int i = 0; i < N; i++) {
        float sum = e->a[term][i];
        for (int g = 0; g < G; g++)
          sum += q->weighted[g][k][i] * q->value[g][l][i];
        e->a[term][i] = sum;
      }
    }
    for (int c = 0; c < 3; c++) {
      /* must vectorise */
      VL_SIMD for (int i = 0; i < N; i++) {
        float sum = e->b[c][k][i];
        for (int g = 0; g < G; g++)
          sum += q->weighted[g][k][i] * q->value[g][U + c][i];
        e->b[c][k][i] = sum;
      }
    }
  }
}

/* Eliminates the slopes by Gaussian elimination; the last equation then gives the constant. The
 * ridge terms keep the pivots above 0. */
static void solve(const vlDenoisePlanes *p, Equations *e, ptrdiff_t at) {
  const float *total = e->a[TERMS - 1];
  float sum[N];
  for (int i = 0; i < N; i++)
    sum[i] = total[i];
  for (int k = 0; k < U - 1; k++) {
    float *pivot = e->a[k * (k + 1) / 2 + k], ridge = k < F ? RIDGE_FEATURE : RIDGE_PLACE;
    VL_SIMD for (int i = 0; i < N; i++) pivot[i] = 1.0f / (pivot[i] + ridge * sum[i] + 1e-20f);
    for (int m = k + 1; m < U; m++) {
      const float *lead = e->a[m * (m + 1) / 2 + k];
      float factor[N];
      VL_SIMD for (int i = 0; i < N; i++) factor[i] = lead[i] * pivot[i];
      for (int l = k + 1; l <= m; l++) {
        float *a = e->a[m * (m + 1) / 2 + l];
        const float *b = e->a[l * (l + 1) / 2 + k];
        VL_SIMD for (int i = 0; i < N; i++) a[i] -= factor[i] * b[i];
      }
      for (int c = 0; c < 3; c++) {
        float *a = e->b[c][m];
        const float *b = e->b[c][k];
        VL_SIMD for (int i = 0; i < N; i++) a[i] -= factor[i] * b[i];
      }
    }
  }
  for (int c = 0; c < 3; c++)
    for (int i = 0; i < N; i++)
      p->result[c][at + i] = e->b[c][U - 1][i] / (total[i] + 1e-20f);
}

static bool any(const float w[N]) {
  uint32_t bits = 0;
  for (int i = 0; i < N; i++)
    bits |= vl_float_bits(w[i]);
  return bits != 0;
}

/* Fits N pixels from index `at` of the planes and index `first` of the tile on. Neighbours
 * without weight for any of the pixels are left out. */
static void fit(const vlDenoisePlanes *p, float (*weight)[VL_DENOISE_TILE], int first,
                ptrdiff_t at) {
  Equations e = {0};
  Group q;
  int g = 0;
  for (int dy = -R, k = 0; dy <= R; dy++)
    for (int dx = -R; dx <= R; dx++, k++) {
      const float *w = weight[k] + first;
      if (!any(w))
        continue;
      set_neighbour(p, &q, g++, w, at, dx, dy);
      if (g < G)
        continue;
      add(&e, &q);
      g = 0;
    }
  if (g > 0) {
    memset(q.value[g], 0, (size_t)(G - g) * sizeof q.value[g]);
    memset(q.weighted[g], 0, (size_t)(G - g) * sizeof q.weighted[g]);
    add(&e, &q);
  }
  solve(p, &e, at);
}

static void tile(const vlDenoisePlanes *p, vlDenoiseScratch *s, uint32_t x, uint32_t y) {
  for (int dy = -R, k = 0; dy <= R; dy++)
    for (int dx = -R; dx <= R; dx++, k++)
      weights(p, s, x, y, dx, dy, s->weight[k]);
  for (int j = 0; j < Y && y + (uint32_t)j < p->height; j++)
    for (int i = 0; i < X && x + (uint32_t)i < p->width; i += N)
      fit(p, s->weight, j * X + i, ((ptrdiff_t)y + j) * p->stride + (ptrdiff_t)x + i);
}

const vlDenoiseKernels vl_denoise_kernel_table = {tile};
