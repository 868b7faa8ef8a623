/* tracer/shade.hot.c: sorts hits by material and shades each run of lanes that have the
 * same material. */
#include <stddef.h>
#include <string.h>

#include "material/inputs.hot.h"

/* ---- sorting ----------------------------------------------------------------------------- */

enum {
  BLOCK = 8,
  PATH_ROWS = offsetof(vlPaths, time) / sizeof(float[VL_ROW_SIZE]),
  LAMBDA_ROW = offsetof(vlPaths, lambda) / sizeof(float[VL_ROW_SIZE]), /* 4 rows */
  PIXEL_ROW = offsetof(vlPaths, px) / sizeof(float[VL_ROW_SIZE])       /* px, py, index, lane */
};
_Static_assert(PATH_ROWS * sizeof(float[VL_ROW_SIZE]) == offsetof(vlPaths, time),
               "rows of 4 bytes without gaps");
_Static_assert(PIXEL_ROW + 4 == PATH_ROWS && offsetof(vlPaths, lane) - offsetof(vlPaths, px) ==
                                                 3 * sizeof(float[VL_ROW_SIZE]),
               "px, py, index and lane are the last rows");

/* Whether a block of the order is a block of neighbours, as most blocks of the first bounces
 * are. */
static inline bool neighbours(const uint32_t *order) {
  uint32_t different = 0;
  for (uint32_t j = 1; j < BLOCK; j++)
    different |= order[j] ^ (order[0] + j);
  return !different;
}

/* Copies `rows` rows of a block of neighbours, from row `first` on. */
static inline void copy_block(const vlPaths *a, uint32_t i, vlPaths *b, uint32_t k,
                              size_t first, size_t rows) {
  for (size_t row = first; row < first + rows; row++)
    memcpy((char *)b + row * sizeof b->o.x + k * sizeof(float),
           (const char *)a + row * sizeof a->o.x + i * sizeof(float), BLOCK * sizeof(float));
}

/* Copies blocks of neighbours row by row. Copies others path by path, because a gather
 * instruction per row takes longer than single moves. constants: only what stays the same along
 * a path. */
static inline void copy_paths(const vlPaths *a, vlPaths *b, const uint32_t *order, uint32_t n,
                              bool constants) {
  uint32_t k = 0;
  while (k < n) {
    if (n - k >= BLOCK && neighbours(order + k)) {
      if (constants) {
        copy_block(a, order[k], b, k, LAMBDA_ROW, 4);
        copy_block(a, order[k], b, k, PIXEL_ROW, 4);
      } else {
        copy_block(a, order[k], b, k, 0, PATH_ROWS);
      }
      k += BLOCK;
      continue;
    }
    for (uint32_t last = n - k < BLOCK ? n : k + BLOCK; k < last; k++) {
      vl_path_copy_constants(a, order[k], b, k);
      if (!constants)
        vl_path_copy_ray(a, order[k], b, k);
    }
  }
}

void vl_permute_paths(const vlPaths *a, vlPaths *b, const uint32_t *order, uint32_t n) {
  copy_paths(a, b, order, n, false);
}
static void permute_hits(const vlHits *a, vlHits *b, const uint32_t *order, uint32_t n) {
  for (uint32_t k = 0; k < n; k++)
    vl_hit_copy(a, order[k], b, k);
}

void vl_gather_rays(const vlPaths *p, const uint32_t *order, uint32_t n, vlPaths *to) {
  for (uint32_t k = 0; k < n; k++)
    if (order[k] != k)
      vl_path_copy_ray(to, order[k], to, k);
  copy_paths(p, to, order, n, true);
}

/* A counting sort by the material's rank (materials of one kind are adjacent) that keeps the
 * order of the tile. */
uint32_t vl_stage_sort(const vlWorld *world, uint32_t n, const vlPaths *rays,
                       const vlHits *hits, uint32_t *order, vlVertices *at) {
  uint32_t materials = (uint32_t)world->materials.count, count = 0;
  if (materials <= VL_BATCH) {
    uint32_t start[VL_BATCH]; /* where each material's lanes start */
    for (uint32_t m = 0; m < materials; m++)
      start[m] = 0;
    uint32_t total = 0;
    for (uint32_t i = 0; i < n; i++)
      if (hits->shape[i] != VL_NONE)
        start[world->rank[hits->material[i]]]++;
    for (uint32_t m = 0; m < materials; m++) {
      uint32_t c = start[m];
      start[m] = total;
      total += c;
    }
    for (uint32_t i = 0; i < n; i++)
      if (hits->shape[i] != VL_NONE)
        order[start[world->rank[hits->material[i]]]++] = i;
    count = total;
  } else { /* more materials than lanes: insertion by rank, stable */
    for (uint32_t i = 0; i < n; i++) {
      if (hits->shape[i] == VL_NONE)
        continue;
      uint32_t k = count++, rank = world->rank[hits->material[i]];
      for (; k > 0 && world->rank[hits->material[order[k - 1]]] > rank; k--)
        order[k] = order[k - 1];
      order[k] = i;
    }
  }
  vl_permute_paths(rays, &at->paths, order, count);
  permute_hits(hits, &at->hits, order, count);
  return count;
}

/* ---- shading ----------------------------------------------------------------------------- */

void vl_stage_shade(const vlTracing *t, uint32_t n, vlVertices *at) {
  vlTraceScratch *s = t->s;
  const vlHits *h = &at->hits;
  vl_stage_surface(t->world, n, &at->paths, h, &s->corners, &at->surface);
  for (uint32_t first = 0, last; first < n; first = last) {
    uint32_t material = h->material[first];
    for (last = first + 1; last < n && h->material[last] == material;)
      last++;
    vl_stage_material(t->world, first, last, material, at, s);
  }
  vl_stage_frames(n, &at->paths, &at->surface, &at->shade);
  for (uint32_t first = 0, last; first < n; first = last) {
    const vlWorldMaterial *m = &t->world->materials.items[h->material[first]];
    for (last = first + 1; last < n && h->material[last] == h->material[first];)
      last++;
    if (m->principled && m->principled->has_coat)
      vl_stage_coat_frames(&at->surface, &at->shade, first, last);
  }
}
