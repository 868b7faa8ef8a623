/* image/denoise/wide.hot.c: moves the denoised pixels to what fits of a much wider window
 * predict for them, as far as the difference may be noise. */
#include "image/denoise/denoise.h"

enum { F = VL_DENOISE_FEATURES, S = VL_DENOISE_STEP, N = VL_LANES };

static const float TINY = 1e-37f;
/* Squared difference, over the noise's variance, from which on a prediction has no weight. */
static const float FARTHEST = 9.0f;

/* Values of one row of N * S pixels, sorted by their position between two points of the
 * lattice.
 */
typedef struct Pixels {
  float feature[F][S][N], result[3][S][N], scale[3][S][N];
} Pixels;

/* Sorts a row of N * S values by their position between two points of the lattice. */
static void sort_row(const float *from, float to[S][N]) {
  for (int i = 0; i < N; i++)
    for (int phase = 0; phase < S; phase++)
      to[phase][i] = from[i * S + phase];
}

static void sort_pixels(const vlDenoisePlanes *p, ptrdiff_t at, Pixels *to) {
  for (int k = 0; k < F; k++)
    sort_row(p->feature[k] + at, to->feature[k]);
  for (int c = 0; c < 3; c++) {
    const float *noise = p->noise[c] + at, *result = p->result[c] + at;
    float scale[N * S];
    /* must vectorise */
    VL_SIMD for (int i = 0; i < N * S; i++) {
      float r = result[i], s = noise[i] * VL_DENOISE_CORRELATION + 1e-6f * r * r;
      scale[i] = 1.0f / (s > TINY ? s : TINY);
    }
    sort_row(scale, to->scale[c]);
    sort_row(result, to->result[c]);
  }
}

/* Adds sorted values to a row of N * S pixels. */
static void add_sorted(float from[S][N], float *to) {
  float row[N * S];
  for (int i = 0; i < N; i++)
    for (int phase = 0; phase < S; phase++)
      row[i * S + phase] = from[phase][i];
  /* must vectorise */
  VL_SIMD for (int i = 0; i < N * S; i++) to[i] += row[i];
}

/* Adds to sum[] the difference of the predictions of the lattice's points from index `at` on, N
 * of them, from the pixels' values, times weights. dx, dy: where the pixels are, seen from the
 * points, in units of the window's radius. share: the points' share in the interpolation. */
static void add_prediction(const vlDenoisePlanes *lattice, ptrdiff_t at, const Pixels *pixels,
                           int phase, float dx, float dy, float share, float sum[3][S][N]) {
  float difference[3][N];
  for (int c = 0; c < 3; c++) {
    const float *a = lattice->result[c] + at, *bx = lattice->slope[c][F] + at,
                *by = lattice->slope[c][F + 1] + at;
    float *restrict to = difference[c];
    const float *slope[F];
    for (int k = 0; k < F; k++)
      slope[k] = lattice->slope[c][k] + at;
    /* must vectorise (gcc) */
    VL_SIMD for (int i = 0; i < N; i++) {
      float d = a[i] + bx[i] * dx + by[i] * dy - pixels->result[c][phase][i];
      for (int k = 0; k < F; k++)
        d += slope[k][i] * pixels->feature[k][phase][i];
      to[i] = d;
    }
  }
  const float *gain = lattice->noise[0] + at;
  /* must vectorise */
  VL_SIMD for (int i = 0; i < N; i++) {
    float d = difference[0][i] * difference[0][i] * pixels->scale[0][phase][i] +
              difference[1][i] * difference[1][i] * pixels->scale[1][phase][i] +
              difference[2][i] * difference[2][i] * pixels->scale[2][phase][i];
    float t = 1.0f - d * (1.0f / (3.0f * FARTHEST));
    t = t > 0.0f ? t : 0.0f;
    float w = share * gain[i] * t * t;
    for (int c = 0; c < 3; c++)
      sum[c][phase][i] += w * difference[c][i];
  }
}

/* Corrects the S rows of pixels from the lattice's row j on, N * S pixels from column i on. */
void vl_denoise_correct(const vlDenoisePlanes *p, const vlDenoisePlanes *lattice, int32_t i,
                        int32_t j) {
  const float unit = 1.0f / VL_DENOISE_RADIUS, part = 1.0f / S;
  for (int row = 0; row < S; row++) {
    int32_t y = j * S + S / 2 + row;
    if (y < 0 || y >= (int32_t)p->height)
      continue;
    ptrdiff_t at = (ptrdiff_t)y * p->stride + i * S + S / 2;
    Pixels pixels;
    sort_pixels(p, at, &pixels);
    float sum[3][S][N] = {{{0}}};
    for (int phase = 0; phase < S; phase++)
      for (int corner = 0; corner < 4; corner++) {
        int cx = corner & 1, cy = corner >> 1;
        float dx = (float)phase * part - (float)cx, dy = (float)row * part - (float)cy;
        float share = (cx ? dx + 1.0f : 1.0f - dx) * (cy ? dy + 1.0f : 1.0f - dy);
        if (share > 0.0f)
          add_prediction(lattice, (j + cy) * lattice->stride + i + cx, &pixels, phase,
                         dx * unit, dy * unit, share, sum);
      }
    for (int c = 0; c < 3; c++)
      add_sorted(sum[c], p->result[c] + at);
  }
}
