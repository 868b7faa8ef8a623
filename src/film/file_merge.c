/* film/file_merge.c: adds blocks of sums. The sums are integers, so the order does not matter.
 * The reader has checked that no sum can overflow. */
#include "film/file.h"

void vl_film_add_block(const vlFilmDef *def, size_t pixels, void *to, uint32_t to_end,
                       const void *from, uint32_t from_end) {
  vlFilmPixel *p = to;
  const vlFilmPixel *q = from;
  vlFilmMoments *m = (void *)(p + pixels);
  const vlFilmMoments *n = (const void *)(q + pixels);
  size_t moments = def->errors ? pixels : 0, cells = pixels * def->buckets;
  uint32_t part = vl_first_part(to_end > from_end ? to_end : from_end);
  for (size_t i = 0; i < moments; i++) {
    vlFilmMoments more = n[i];
    if (vl_first_part(to_end) != part)
      vl_film_join_parts(&m[i], &p[i]);
    if (vl_first_part(from_end) != part)
      vl_film_join_parts(&more, &q[i]);
    vl_film_sum_moments(&m[i], &more);
  }
  for (size_t i = 0; i < pixels; i++) {
    for (int c = 0; c < 3; c++)
      p[i].color[c] += q[i].color[c];
    p[i].alpha += q[i].alpha;
    p[i].weight += q[i].weight;
  }
  vlPackedInt128 *sums = (void *)(m + moments);
  const vlPackedInt128 *more = (const void *)(n + moments);
  for (size_t i = 0; i < cells; i++)
    sums[i] += more[i];
  int64_t *weights = (void *)(sums + cells);
  const int64_t *other = (const void *)(more + cells);
  for (size_t i = 0; i < cells; i++)
    weights[i] += other[i];
}
