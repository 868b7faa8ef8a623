/* film/moments.c: second moments of a pixel's samples, the sums of its first samples, and the
 * standard error of independent samples. The sums are exact, so that neither order nor grouping
 * of the samples changes the result. */
#include <math.h>

#include "film/sums.h"

static const double SQUARE = 0x1p-80; /* 2^-VL_SQUARE_BITS: the unit of the sums of squares */
_Static_assert((int)VL_SQUARE_BITS == 80, "SQUARE is its power of two");

void vl_film_join_parts(vlFilmMoments *moments, const vlFilmPixel *pixel) {
  for (int c = 0; c < 3; c++)
    moments->first[c] = pixel->color[c];
  moments->first_weight = pixel->weight;
}

void vl_film_begin_moments(vlFilm *film, size_t at) {
  film->moments[1][at] = vl_film_front_moments(film, at);
  if (film->part_moves)
    vl_film_join_parts(&film->moments[1][at], &film->back[at]);
}

static void add_squares(uint64_t to[3], const uint64_t from[3]) {
  uint64_t carry = 0;
  for (int k = 0; k < 3; k++) {
    uint64_t sum = to[k] + from[k], more = sum + carry;
    carry = (sum < from[k]) | (more < sum);
    to[k] = more;
  }
}

void vl_film_sum_moments(vlFilmMoments *to, const vlFilmMoments *from) {
  for (int c = 0; c < 3; c++) {
    to->plain[c] += from->plain[c];
    to->first[c] += from->first[c];
    add_squares(to->squares[c], from->squares[c]);
  }
  to->samples += from->samples;
  to->first_weight += from->first_weight;
}

/* The pixel is sum(w v) / sum(w), and |w| is the same in all samples (filters are
 * importance-sampled). To first order the variance of this ratio is sum(w^2 (v - mean)^2) /
 * sum(w)^2, times n / (n - 1) because the mean is estimated from the same samples. Squares are
 * taken about the unweighted mean first, where cancellation is least. */
double vl_film_independent_error(const vlFilm *film, size_t at, int c) {
  if (!film->front)
    return INFINITY;
  const vlFilmPixel *p = film->front + at;
  const vlFilmMoments *m = film->moments[0] + at;
  double weight = vl_filter_weight(&film->filter);
  if (m->samples < 2 || p->weight <= 0)
    return INFINITY;
  double n = (double)m->samples, plain = (double)m->plain[c] * 0x1p-50 / n;
  double squares = (double)m->squares[c][2] * 0x1p128 * SQUARE +
                   (double)m->squares[c][1] * 0x1p64 * SQUARE +
                   (double)m->squares[c][0] * SQUARE;
  double sum_w = (double)p->weight * 0x1p-24, mean = (double)p->color[c] * 0x1p-50 / sum_w;
  double spread = squares - n * plain * plain;
  if (spread < squares * 0x1p-48)
    spread = 0; /* all samples are equal; the rest is rounding */
  double off = plain - mean, variance = (spread + n * off * off) * (n / (n - 1)) * weight *
                                        weight / (sum_w * sum_w);
  return sqrt(variance);
}

double vl_film_first_share(const vlFilm *film, size_t at) {
  int64_t first = film->moments[0][at].first_weight, all = film->front[at].weight;
  return first > 0 && first < all ? (double)first / (double)all : 0;
}

double vl_film_first_mean(const vlFilm *film, size_t at, int c) {
  const vlFilmMoments *m = film->moments[0] + at;
  return (double)m->first[c] / (double)m->first_weight * 0x1p-26;
}
