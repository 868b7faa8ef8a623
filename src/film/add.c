/* film/add.c: adds samples to the exact sums, with integers only. The product of the float's
 * mantissa and the weight's is exact; one multiplication shifts it to its bits of the 128-bit
 * sum. There are no branches on the colours. */
#include "film/sums.h"

/* Copies a pixel's sums from the front when it is new in the pass. */
static inline void begin_pixel(vlFilm *film, size_t at) {
  static const vlFilmPixel zero = {{0, 0, 0}, 0, 0};
  if (film->stamp[at] == film->pass)
    return;
  film->stamp[at] = film->pass;
  film->back[at] = film->front ? film->front[at] : zero;
  if (film->def.errors)
    vl_film_begin_moments(film, at);
}

void vl_film_miss(vlFilm *film, int32_t px, int32_t py) {
  uint32_t x = (uint32_t)px - film->def.crop[0], y = (uint32_t)py - film->def.crop[1];
  if (x < film->width && y < film->height && film->in_pass)
    begin_pixel(film, (size_t)y * film->width + x);
}

/* Whether a sample's numbers fit into the sums. */
static inline bool fits(const vlFilmSamples *s, uint32_t i) {
  uint32_t r = vl_float_bits(s->r[i]) & 0x7fffffffu, g = vl_float_bits(s->g[i]) & 0x7fffffffu;
  uint32_t b = vl_float_bits(s->b[i]) & 0x7fffffffu, largest = r > g ? r : g;
  largest = largest > b ? largest : b;
  float a = s->a[i];
  return largest < VL_MAX_COLOR_FLOAT &&
         (vl_float_bits(s->weight[i]) & 0x7fffffffu) < VL_MAX_WEIGHT_FLOAT && a - a == 0.0f;
}

/* Adds a sample to a pixel's moments. `weighted`: its colour times its weight. Most filters
 * give all samples the weight 1. Not inlined: the loop over the samples of other films would
 * have fewer registers. */
VL_NOINLINE void add_moments(vlFilmMoments *m, const float color[3], const vlInt128 weighted[3],
                             int64_t weight, bool is_first) {
  const int64_t one = INT64_C(1) << VL_WEIGHT_BITS;
  for (int c = 0; c < 3; c++) {
    m->plain[c] += weight == one ? weighted[c] : vl_film_product(color[c], one);
    vl_film_add_square(m->squares[c], color[c]);
  }
  m->samples++;
  if (is_first) {
    for (int c = 0; c < 3; c++)
      m->first[c] += weighted[c];
    m->first_weight += weight;
  }
}

uint32_t vl_film_add(vlFilm *film, const vlFilmSamples *s, int32_t *bad_x, int32_t *bad_y) {
  uint32_t bad = 0, width = film->width, height = film->in_pass ? film->height : 0;
  uint32_t x0 = film->def.crop[0], y0 = film->def.crop[1], part = s->index ? film->part : 0;
  for (uint32_t i = 0; i < s->n; i++) {
    uint32_t x = (uint32_t)s->px[i] - x0, y = (uint32_t)s->py[i] - y0;
    if (!(fits(s, i) && x < width && y < height)) {
      if (bad++ == 0) {
        if (bad_x)
          *bad_x = s->px[i];
        if (bad_y)
          *bad_y = s->py[i];
      }
      vl_film_miss(film, s->px[i], s->py[i]);
      continue;
    }
    size_t at = (size_t)y * width + x;
    begin_pixel(film, at);
    vlFilmPixel *p = film->back + at;
    float color[3] = {s->r[i], s->g[i], s->b[i]}, a = s->a[i], w = s->weight[i];
    int64_t weight = (int64_t)((double)w * (1 << VL_WEIGHT_BITS) + (w < 0.0f ? -0.5 : 0.5));
    vlInt128 weighted[3];
    for (int c = 0; c < 3; c++) {
      weighted[c] = vl_film_product(color[c], weight);
      p->color[c] += weighted[c];
    }
    if (film->def.errors)
      add_moments(&film->moments[1][at], color, weighted, weight,
                  part > 0 && s->index[i] < part);
    a = a > 0.0f ? (a < 1.0f ? a : 1.0f) : 0.0f;
    int64_t alpha = (int64_t)(a * 0x1p24f) * weight; /* units of 2^-48 */
    p->alpha += (alpha + (INT64_C(1) << 19)) >> 20;
    p->weight += weight;
  }
  return bad;
}
