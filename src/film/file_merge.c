/* film/file_merge.c: adds blocks of sums. The sums are integers, so the order does not matter. The reader has
 * checked that no sum can overflow. */
#include "film/file.h"

static void add_squares(uint64_t to[3], const uint64_t from[3]) {
  uint64_t carry = 0;
  for (int k = 0; k < 3; k++) {
    uint64_t sum = to[k] + from[k], more = sum + carry;
    carry = (sum < from[k]) | (more < sum);
    to[k] = more;
  }
}

void vl_film_add_block(const vlFilmDef *def, size_t pixels, void *to, const void *from) {
  vlFilmPixel *p = to;
  const vlFilmPixel *q = from;
  for (size_t i = 0; i < pixels; i++) {
    for (int c = 0; c < 3; c++) p[i].color[c] += q[i].color[c];
    p[i].alpha += q[i].alpha;
    p[i].weight += q[i].weight;
  }
  vlFilmMoments *m = (void *)(p + pixels);
  const vlFilmMoments *n = (const void *)(q + pixels);
  size_t moments = def->errors ? pixels : 0, cells = pixels * def->buckets;
  for (size_t i = 0; i < moments; i++) {
    for (int c = 0; c < 3; c++) {
      m[i].plain[c] += n[i].plain[c];
      add_squares(m[i].squares[c], n[i].squares[c]);
    }
    m[i].samples += n[i].samples;
  }
  vlInt128 *sums = (void *)(m + moments);
  const vlInt128 *more = (const void *)(n + moments);
  for (size_t i = 0; i < cells; i++) sums[i] += more[i];
  int64_t *weights = (void *)(sums + cells);
  const int64_t *other = (const void *)(more + cells);
  for (size_t i = 0; i < cells; i++) weights[i] += other[i];
}
