/* medium/grid_lookup.h: interpolated lookups in dense and sparse grids. The functions are
 * inline and take values, for the hot files of trace. */
#ifndef MEDIUM_GRID_LOOKUP_H
#define MEDIUM_GRID_LOOKUP_H

#include "math/vec.h"
#include "medium/medium.h"

/* The eight cells around a point, and the weights of trilinear interpolation. */
typedef struct vlTrilinear {
  int32_t x, y, z;
  float fx, fy, fz;
} vlTrilinear;
static inline vlTrilinear vl_trilinear(float x, float y, float z) {
  float ix = __builtin_floorf(x), iy = __builtin_floorf(y), iz = __builtin_floorf(z);
  return (vlTrilinear){(int32_t)ix, (int32_t)iy, (int32_t)iz, x - ix, y - iy, z - iz};
}
static inline float vl_trilinear_weight(vlTrilinear at, int k) {
  return (k & 1 ? at.fx : 1.0f - at.fx) * (k & 2 ? at.fy : 1.0f - at.fy) *
         (k & 4 ? at.fz : 1.0f - at.fz);
}
/* Index of the cell of neighbour k; (size_t)-1 outside of the grid. */
static inline size_t vl_dense_cell(const vlDenseGrid *g, vlTrilinear at, int k) {
  int32_t x = at.x + (k & 1), y = at.y + (k >> 1 & 1), z = at.z + (k >> 2);
  bool inside = x >= 0 && y >= 0 && z >= 0 && x < (int32_t)g->nx && y < (int32_t)g->ny &&
                z < (int32_t)g->nz;
  return inside ? ((size_t)z * g->ny + (size_t)y) * g->nx + (size_t)x : (size_t)-1;
}
/* q: position in the unit cube, which is the grid's box. */
static inline vlTrilinear vl_dense_at_point(const vlDenseGrid *g, vlVec3 q) {
  return vl_trilinear(q.x * (float)g->nx - 0.5f, q.y * (float)g->ny - 0.5f,
                      q.z * (float)g->nz - 0.5f);
}
static inline float vl_dense_lookup(const vlDenseGrid *g, vlVec3 q) {
  vlTrilinear at = vl_dense_at_point(g, q);
  float sum = 0;
  for (int k = 0; k < 8; k++) {
    size_t cell = vl_dense_cell(g, at, k);
    if (cell != (size_t)-1)
      sum += vl_trilinear_weight(at, k) * g->values[cell];
  }
  return sum;
}

static inline float vl_sparse_value(const vlSparseGrid *g, int32_t x, int32_t y, int32_t z) {
  int64_t bx = (int64_t)x - g->low[0], by = (int64_t)y - g->low[1], bz = (int64_t)z - g->low[2];
  bx >>= 7;
  by >>= 7;
  bz >>= 7;
  if (bx < 0 || by < 0 || bz < 0 || bx >= g->size[0] || by >= g->size[1] || bz >= g->size[2])
    return g->tiles[0];
  uint32_t block = g->blocks[((size_t)bz * g->size[1] + (size_t)by) * g->size[0] + (size_t)bx];
  if (block & VL_SPARSE_TILE)
    return g->tiles[block & ~VL_SPARSE_TILE];
  uint32_t ux = (uint32_t)x & 127u, uy = (uint32_t)y & 127u, uz = (uint32_t)z & 127u;
  uint32_t brick = g->bricks[(size_t)block * VL_BLOCK_BRICKS +
                             ((size_t)(uz >> 3) * 16 + (uy >> 3)) * 16 + (ux >> 3)];
  if (brick & VL_SPARSE_TILE)
    return g->tiles[brick & ~VL_SPARSE_TILE];
  return g->values[(size_t)brick * VL_BRICK_VALUES + ((uz & 7) * 8 + (uy & 7)) * 8 + (ux & 7)];
}
/* Trilinear lookup at p, in medium space. */
static inline float vl_sparse_lookup(const vlSparseGrid *g, vlVec3 p) {
  vlVec3 q = vl_affine_point(g->index_from_medium, p);
  float limit = 1e9f;
  if (!(vl_abs(q.x) < limit && vl_abs(q.y) < limit && vl_abs(q.z) < limit))
    return g->tiles[0];
  vlTrilinear at = vl_trilinear(q.x, q.y, q.z);
  float sum = 0;
  for (int k = 0; k < 8; k++)
    sum += vl_trilinear_weight(at, k) *
           vl_sparse_value(g, at.x + (k & 1), at.y + (k >> 1 & 1), at.z + (k >> 2));
  return sum;
}

#endif
