/* image/denoise/fit.hot.c: fits the window around each pixel by a weighted linear function of
 * the features and the position; its value at the pixel is the result (Bitterli et al. 2016,
 * "Nonlinearly weighted first-order regression"). The weights depend on the distance of patches
 * relative to their variance (Rousselle et al. 2012, "Adaptive rendering with non-local means
 * filtering", equations 1 to 4). */
#include <string.h>

#include "image/denoise/denoise.h"

enum {
  X = VL_DENOISE_TILE_X,
  Y = VL_DENOISE_TILE_Y,
  R = VL_DENOISE_RADIUS,
  P = VL_DENOISE_PATCH,
  SIDE = 2 * P + 1,
  F = VL_DENOISE_FEATURES,
  U = VL_DENOISE_UNKNOWNS, /* the most; without features that are the same in a window, fewer */
  TERMS = U * (U + 1) / 2,
  N = VL_LANES, /* pixels whose equations are added up at once */
  G = 8         /* neighbours added at once */
};
_Static_assert((int)VL_DENOISE_TILE_X % (int)N == 0, "tiles are divided into runs of N pixels");
_Static_assert((int)VL_DENOISE_BORDER >= (int)R + (int)N,
               "windows, rounded up to N pixels, end in the border");

/* factor on the distance between the two single pixels */
static const float PIXEL_SHARE = 0.02f;
#define FARTHEST 8.0f /* distance from which on the weight is 0 */
/* ridge terms lambda of features and positions, per unit of weight */
static const float RIDGE_FEATURE = 1e-3f, RIDGE_PLACE = 3e-2f;
/* Features that differ by less in all pixels that a run may use are left out. Their slope would
 * be driven to 0 by the ridge. */
static const float SAME = 1e-2f;
/* The least divisor of a distance. It decides only where values and noise are 0. */
static const float TINY = 1e-37f;

/* ---- weights ----------------------------------------------------------------------------- */

/* The squared difference of two values minus its variance, divided by a multiple of this
 * variance. */
static inline float distance(float a, float b, float va, float vb, float bandwidth2) {
  float d = a - b, sum = a + b, v = va + vb, scale = 1e-6f * sum * sum + bandwidth2 * v;
  return (d * d - v) / (scale > TINY ? scale : TINY);
}

/* Pixels whose neighbours at one offset are compared: from (x, y) on, `width` in a row, a
 * multiple of N. */
typedef struct Area {
  ptrdiff_t x, y;
  int width, height;
} Area;

/* For each pixel of the area and of a margin of P pixels, its distance from the pixel at the
 * offset (dx, dy), summed over the channels. The margin on the right is rounded up to whole
 * vectors. */
static void pixel_distances(const vlDenoisePlanes *p, vlDenoiseScratch *s, const Area *area,
                            int dx, int dy) {
  float bandwidth2 = p->bandwidth2;
  const int width = area->width + N;
  for (int j = 0; j < area->height + 2 * P; j++) {
    ptrdiff_t at = (area->y + j - P) * p->stride + area->x - P, to = at + dy * p->stride + dx;
    const float *r = p->color[0] + at, *g = p->color[1] + at, *b = p->color[2] + at;
    const float *vr = p->variance[0] + at, *vg = p->variance[1] + at, *vb = p->variance[2] + at;
    ptrdiff_t off = to - at;
    float *restrict row = s->distance[j];
    /* must vectorise */
    VL_SIMD for (int i = 0; i < width; i++) {
      row[i] = distance(r[i], r[i + off], vr[i], vr[i + off], bandwidth2) +
               distance(g[i], g[i + off], vg[i], vg[i + off], bandwidth2) +
               distance(b[i], b[i + off], vb[i], vb[i + off], bandwidth2);
    }
  }
}

/* For each pixel of the area, the weight of its neighbour at the offset (dx, dy) if that is
 * valid, to s->near: (1 - distance / FARTHEST)^8, which is nearly exp(-distance), and 0 from
 * FARTHEST on, since neighbours without weight cost nothing. The distance is the larger of the
 * mean over the patches and PIXEL_SHARE times the distance between the two single pixels. The
 * latter excludes a neighbour that clearly differs, as the test of Sakai et al. 2024 does,
 * although the patches are similar: a pixel at the edge of a lamp has so large a variance that
 * the patches hardly differ. */
static void weights(const vlDenoisePlanes *p, vlDenoiseScratch *s, const Area *area, int dx,
                    int dy) {
  enum { WIDTH = X + N };
  const int width = area->width;
  pixel_distances(p, s, area, dx, dy);
  for (int j = 0; j < area->height + 2 * P; j++) {
    const float *row = s->distance[j];
    /* must vectorise (gcc) */
    VL_SIMD for (int i = 0; i < width; i++) {
      float t = row[i];
      for (int k = 1; k < SIDE; k++)
        t += row[i + k];
      s->sums[j][i] = t;
    }
  }
  for (int j = 0; j < area->height; j++) {
    const float *a = s->sums[j], *far = s->distance[j + P] + P;
    /* must vectorise */
    VL_SIMD for (int i = 0; i < width; i++) {
      float own = far[i] * PIXEL_SHARE, d = a[i];
      for (int k = 1; k < SIDE; k++)
        d += a[i + k * WIDTH];
      d *= 1.0f / (3 * SIDE * SIDE);
      d = d > own ? d : own;
      float t = 1.0f - d * (1.0f / FARTHEST);
      t = t > 0.0f ? t : 0.0f;
      t = t < 1.0f ? t : 1.0f;
      t *= t;
      t *= t;
      s->near[j][i] = t * t;
    }
  }
}

/* Copies the weights of the tile's pixels, from element (i, j) of s->near on, where the
 * neighbours at (x, y) and behind it are valid. */
static void copy_weights(const vlDenoisePlanes *p, const vlDenoiseScratch *s, int i, int j,
                         ptrdiff_t x, ptrdiff_t y, float *to) {
  for (int row = 0; row < Y; row++) {
    const float *valid = p->valid + (y + row) * p->stride + x, *from = s->near[j + row] + i;
    float *restrict own = to + row * X;
    /* must vectorise */
    VL_SIMD for (int k = 0; k < X; k++) own[k] = valid[k] * from[k];
  }
}

/* Weights of the tile's pixels for neighbour k of the list, at the offset (dx, dy), and for the
 * one at the opposite offset, `opposite`: a pixel's weight for the one is the other's for the
 * pixel, so both are those of the tile and of the pixels that are the opposite offset away. dy
 * >= 0. */
static void pair_weights(const vlDenoisePlanes *p, vlDenoiseScratch *s, uint32_t x, uint32_t y,
                         int k, int opposite) {
  const int dx = s->dx[k], dy = s->dy[k], left = dx > 0 ? dx : 0, right = dx < 0 ? -dx : 0;
  const ptrdiff_t x0 = x, y0 = y;
  const Area area = {x0 - left, y0 - dy, dx == 0 ? X : X + N, Y + dy};
  weights(p, s, &area, dx, dy);
  copy_weights(p, s, left, dy, x0 + dx, y0 + dy, s->weight[k]);
  if (opposite != k)
    copy_weights(p, s, right, 0, x0 - dx, y0 - dy, s->weight[opposite]);
}

/* ---- the fit ----------------------------------------------------------------------------- */

/* The features that a run's equations have. */
typedef struct Used {
  int index[F], count;
} Used;

/* Normal equations of N pixels of a row. a: the lower triangle of the symmetric matrix, row by
 * row; the unknowns are the slopes of the used features, of x and of y, then the constant. b:
 * the right-hand sides for R, G and B. variance: the weighted sum of the neighbours' variances.
 * squares: the sum of the squared weights. */
typedef struct Equations {
  float a[TERMS][N], b[3][U][N], variance[3][N], squares[N];
} Equations;

/* Up to G neighbours of N pixels: the differences of their features from the pixels', also
 * times the weights; the weights; the offsets in units of the window's radius; their indices in
 * the planes. The equations are read and written once per group. */
typedef struct Group {
  float value[G][F][N], weighted[G][U][N];
  float x[G], y[G];
  ptrdiff_t at[G];
} Group;

/* Finds the features that differ by SAME or more among the pixels in reach of the rows y to y +
 * Y - 1 of N pixels from x on. */
static Used used_features(const vlDenoisePlanes *p, uint32_t x, uint32_t y) {
  Used used = {.count = 0};
  for (int k = 0; k < F; k++) {
    float low[N], high[N];
    const float *from = p->feature[k] + ((ptrdiff_t)y - R) * p->stride + (ptrdiff_t)x - R;
    memcpy(low, from, sizeof low);
    memcpy(high, from, sizeof high);
    for (int j = 0; j < Y + 2 * R; j++, from += p->stride)
      for (int start = 0; start < 2; start++) {
        const float *row = from + start * 2 * R;
        /* must vectorise (gcc) */
        VL_SIMD for (int i = 0; i < N; i++) {
          low[i] = row[i] < low[i] ? row[i] : low[i];
          high[i] = row[i] > high[i] ? row[i] : high[i];
        }
      }
    float min = low[0], max = high[0];
    for (int i = 1; i < N; i++) {
      min = low[i] < min ? low[i] : min;
      max = high[i] > max ? high[i] : max;
    }
    if (!(max - min < SAME))
      used.index[used.count++] = k;
  }
  return used;
}
_Static_assert((int)N >= 2 * (int)R, "two runs of N pixels cover a run and its windows");

/* Sets neighbour g of the group: the pixels at the offset (dx, dy) from the N pixels from index
 * `at` on. */
static void set_neighbour(const vlDenoisePlanes *p, const Used *used, Group *q, int g,
                          const float *w, ptrdiff_t at, int dx, int dy) {
  ptrdiff_t to = at + dy * p->stride + dx;
  int count = used->count;
  for (int k = 0; k < count; k++) {
    const float *f = p->feature[used->index[k]] + at, *h = p->feature[used->index[k]] + to;
    VL_SIMD for (int i = 0; i < N; i++) {
      q->value[g][k][i] = h[i] - f[i];
      q->weighted[g][k][i] = w[i] * q->value[g][k][i];
    }
  }
  q->x[g] = (float)dx * (1.0f / R);
  q->y[g] = (float)dy * (1.0f / R);
  q->at[g] = to;
  VL_SIMD for (int i = 0; i < N; i++) {
    q->weighted[g][count][i] = w[i] * q->x[g];
    q->weighted[g][count + 1][i] = w[i] * q->y[g];
    q->weighted[g][count + 2][i] = w[i];
  }
}

/* N values that are kept in registers while many sums are made of them. */
typedef float Lanes __attribute__((vector_size(N * sizeof(float))));

/* The same in memory, aligned as floats are. A function that returned Lanes would have another
 * ABI for each instruction set. */
typedef float LanesInMemory
    __attribute__((vector_size(N * sizeof(float)), aligned(4), may_alias));
#define LOAD(from) (*(const LanesInMemory *)(from))
static inline void store(float to[N], const Lanes *v) {
  memcpy(to, v, sizeof *v);
}

/* Adds a group of neighbours to the equations of `used` features: for each k, the products of
 * weighted[k] and the features' differences, x and y up to k, and the colours. */
static void add(const vlDenoisePlanes *p, Equations *restrict e, const Group *restrict q,
                int used) {
  int term = 0;
  for (int k = 0; k < used + 3; k++) {
    Lanes w[G], sum;
    for (int g = 0; g < G; g++)
      w[g] = LOAD(q->weighted[g][k]);
    for (int l = 0; l <= k && l < used; l++, term++) {
      sum = LOAD(e->a[term]);
      for (int g = 0; g < G; g++)
        sum += w[g] * LOAD(q->value[g][l]);
      store(e->a[term], &sum);
    }
    for (int c = 0; c < 3; c++) {
      sum = LOAD(e->b[c][k]);
      for (int g = 0; g < G; g++)
        sum += w[g] * LOAD(p->color[c] + q->at[g]);
      store(e->b[c][k], &sum);
    }
    if (k < used)
      continue;
    sum = LOAD(e->a[term]);
    for (int g = 0; g < G; g++)
      sum += w[g] * q->x[g];
    store(e->a[term++], &sum);
    if (k == used)
      continue;
    sum = LOAD(e->a[term]);
    for (int g = 0; g < G; g++)
      sum += w[g] * q->y[g];
    store(e->a[term++], &sum);
    if (k == used + 1)
      continue;
    sum = LOAD(e->a[term]);
    Lanes squares = LOAD(e->squares);
    for (int g = 0; g < G; g++) {
      sum += w[g];
      squares += w[g] * w[g];
    }
    store(e->a[term], &sum);
    store(e->squares, &squares);
    for (int c = 0; c < 3; c++) {
      sum = LOAD(e->variance[c]);
      for (int g = 0; g < G; g++)
        sum += w[g] * LOAD(p->variance[c] + q->at[g]);
      store(e->variance[c], &sum);
    }
  }
}

/* Eliminates the slopes by Gaussian elimination; the last equation then gives the constant. The
 * ridge terms keep the pivots above 0. */
static void solve(const vlDenoisePlanes *p, const Used *used, Equations *e, ptrdiff_t at) {
  int count = used->count + 3;
  float *total = e->a[count * (count + 1) / 2 - 1], sum[N];
  memcpy(sum, total, sizeof sum);
  for (int k = 0; k < count - 1; k++) {
    float *pivot = e->a[k * (k + 1) / 2 + k],
          ridge = k < used->count ? RIDGE_FEATURE : RIDGE_PLACE;
    VL_SIMD for (int i = 0; i < N; i++) pivot[i] = 1.0f / (pivot[i] + ridge * sum[i] + 1e-20f);
    for (int m = k + 1; m < count; m++) {
      const float *lead = e->a[m * (m + 1) / 2 + k];
      float factor[N];
      VL_SIMD for (int i = 0; i < N; i++) factor[i] = lead[i] * pivot[i];
      for (int l = k + 1; l <= m; l++) {
        float *a = e->a[m * (m + 1) / 2 + l];
        const float *b = e->a[l * (l + 1) / 2 + k];
        VL_SIMD for (int i = 0; i < N; i++) a[i] -= factor[i] * b[i];
      }
      for (int c = 0; c < 3; c++) {
        VL_SIMD for (int i = 0; i < N; i++) e->b[c][m][i] -= factor[i] * e->b[c][k][i];
      }
    }
  }
  VL_SIMD for (int i = 0; i < N; i++) total[i] = 1.0f / (total[i] + 1e-20f);
  for (int c = 0; c < 3; c++)
    VL_SIMD for (int i = 0; i < N; i++) p->result[c][at + i] = e->b[c][count - 1][i] * total[i];
  for (int c = 0; c < 3; c++)
    VL_SIMD for (int i = 0; i < N; i++) {
      float all = sum[i] + 1e-20f;
      p->noise[c][at + i] = e->variance[c][i] * e->squares[i] * total[i] / (all * all);
    }
  if (!p->slope[0][0])
    return;
  for (int c = 0; c < 3; c++) {
    float(*b)[N] = e->b[c];
    VL_SIMD for (int i = 0; i < N; i++) b[count - 1][i] *= total[i];
    for (int k = count - 2; k >= 0; k--) {
      for (int m = k + 1; m < count; m++) {
        const float *lead = e->a[m * (m + 1) / 2 + k];
        VL_SIMD for (int i = 0; i < N; i++) b[k][i] -= lead[i] * b[m][i];
      }
      const float *pivot = e->a[k * (k + 1) / 2 + k];
      VL_SIMD for (int i = 0; i < N; i++) b[k][i] *= pivot[i];
    }
    for (int k = 0; k < F; k++)
      memset(p->slope[c][k] + at, 0, N * sizeof(float));
    for (int k = 0; k < count - 1; k++)
      memcpy(p->slope[c][k < used->count ? used->index[k] : F + k - used->count] + at, b[k],
             sizeof b[k]);
  }
}

static bool any(const float w[N]) {
  uint64_t bits[N / 2];
  memcpy(bits, w, sizeof bits);
  for (int half = N / 4; half > 0; half /= 2)
    for (int i = 0; i < half; i++)
      bits[i] |= bits[i + half];
  return bits[0] != 0;
}

/* Fits N pixels from index `at` of the planes and index `first` of the tile on. Neighbours
 * without weight for any of the pixels are left out. */
static void fit(const vlDenoisePlanes *p, const Used *used, const vlDenoiseScratch *s,
                int first, ptrdiff_t at) {
  Equations e = {0};
  Group q;
  int g = 0;
  for (int k = 0; k < s->neighbours; k++) {
    const float *w = s->weight[k] + first;
    if (!any(w))
      continue;
    set_neighbour(p, used, &q, g++, w, at, s->dx[k], s->dy[k]);
    if (g < G)
      continue;
    add(p, &e, &q, used->count);
    g = 0;
  }
  if (g > 0) {
    memset(q.value[g], 0, (size_t)(G - g) * sizeof q.value[g]);
    memset(q.weighted[g], 0, (size_t)(G - g) * sizeof q.weighted[g]);
    for (int k = g; k < G; k++) {
      q.x[k] = q.y[k] = 0.0f;
      q.at[k] = at;
    }
    add(p, &e, &q, used->count);
  }
  solve(p, used, &e, at);
}

/* Lists the neighbours: all up to a distance of 2 in x and y, beyond it every second one of a
 * round window. They are symmetric: the opposite of number k is the k-th from the end. */
static void list_neighbours(vlDenoiseScratch *s) {
  enum { NEAR = 2 };
  s->neighbours = 0;
  for (int dy = -R; dy <= R; dy++)
    for (int dx = -R; dx <= R; dx++) {
      bool near = dx >= -NEAR && dx <= NEAR && dy >= -NEAR && dy <= NEAR;
      if (dx * dx + dy * dy > R * R + R || (!near && ((dx + dy) & 1)))
        continue;
      s->dx[s->neighbours] = (int8_t)dx;
      s->dy[s->neighbours++] = (int8_t)dy;
    }
}

static void tile(const vlDenoisePlanes *p, vlDenoiseScratch *s, uint32_t x, uint32_t y) {
  list_neighbours(s);
  for (int k = s->neighbours / 2; k < s->neighbours; k++)
    pair_weights(p, s, x, y, k, s->neighbours - 1 - k);
  for (int i = 0; i < X && x + (uint32_t)i < p->width; i += N) {
    Used used = used_features(p, x + (uint32_t)i, y);
    for (int j = 0; j < Y && y + (uint32_t)j < p->height; j++)
      fit(p, &used, s, j * X + i, ((ptrdiff_t)y + j) * p->stride + (ptrdiff_t)x + i);
  }
}

const vlDenoiseKernels vl_denoise_kernel_table = {tile, vl_denoise_correct, vl_denoise_cap,
                                                  vl_denoise_raise};
