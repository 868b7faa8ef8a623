/* medium/nanovdb.c: media from NanoVDB files: computes the box and the majorants of their
 * grids. */
#include <math.h>

#include "base/error.h"
#include "math/transform.h"
#include "math/vec.h"
#include "medium/compile.h"
#include "velo/medium.h"

vlCompileMedium vl_compile_medium_nanovdb;

static void grow_box(const vlSparseGrid *g, vlWorldMedium *m) {
  for (int i = 0; i < 3; i++) {
    m->low[i] = vl_min(m->low[i], (float)g->box_low[i]);
    m->high[i] = vl_max(m->high[i], (float)g->box_high[i]);
  }
}

/* Raises the majorants of all cells in which a lookup can read one of the voxels [a, b]. */
static void raise(const vlWorldMedium *m, float *majorants, const double medium_from_index[12],
                  const int32_t a[3], const int32_t b[3], float value) {
  int32_t first[3], last[3];
  for (int i = 0; i < 3; i++) {
    double low = medium_from_index[4 * i + 3], high = low;
    for (int k = 0; k < 3; k++) {
      double s = medium_from_index[4 * i + k], p = s * (a[k] - 1.001), q = s * (b[k] + 1.001);
      low += p < q ? p : q;
      high += p < q ? q : p;
    }
    /* 1.001 voxels and 1e-3 of a cell: more than the rounding of lookups in float */
    double scale = m->cells[i] / ((double)m->high[i] - (double)m->low[i]);
    low = floor((low - (double)m->low[i]) * scale - 1e-3);
    high = floor((high - (double)m->low[i]) * scale + 1e-3);
    if (high < 0 || low > m->cells[i] - 1)
      return;
    first[i] = low > 0 ? (int32_t)low : 0;
    last[i] = high < m->cells[i] - 1 ? (int32_t)high : (int32_t)m->cells[i] - 1;
  }
  for (int32_t z = first[2]; z <= last[2]; z++)
    for (int32_t y = first[1]; y <= last[1]; y++)
      for (int32_t x = first[0]; x <= last[0]; x++) {
        float *to = majorants + ((size_t)z * m->cells[1] + (size_t)y) * m->cells[0] + (size_t)x;
        *to = vl_max(*to, value);
      }
}

/* Raises the majorants by a brick, octant by octant, which gives tighter bounds. */
static void raise_brick(const vlWorldMedium *m, float *majorants,
                        const double medium_from_index[12], const float *values,
                        const int32_t corner[3]) {
  for (int part = 0; part < 8; part++) {
    int x0 = part & 1 ? 4 : 0, y0 = part & 2 ? 4 : 0, z0 = part & 4 ? 4 : 0;
    float max = 0;
    for (int z = z0; z < z0 + 4; z++)
      for (int y = y0; y < y0 + 4; y++)
        for (int x = x0; x < x0 + 4; x++)
          max = vl_max(max, values[(z * 8 + y) * 8 + x]);
    int32_t a[3] = {corner[0] + x0, corner[1] + y0, corner[2] + z0},
            b[3] = {a[0] + 3, a[1] + 3, a[2] + 3};
    if (max > 0)
      raise(m, majorants, medium_from_index, a, b, max);
  }
}

static void bound_sparse(const vlWorldMedium *m, float *majorants,
                         const double medium_from_index[12]) {
  const vlSparseGrid *g = m->sparse;
  size_t cells = (size_t)m->cells[0] * m->cells[1] * m->cells[2];
  for (size_t i = 0; i < cells; i++)
    majorants[i] = vl_max(0, g->tiles[0]);
  for (uint32_t i = 0; i < g->size[0] * g->size[1] * g->size[2]; i++) {
    uint32_t at[3] = {i % g->size[0], i / g->size[0] % g->size[1], i / g->size[0] / g->size[1]},
             block = g->blocks[i];
    int32_t corner[3], end[3];
    for (int k = 0; k < 3; k++) {
      corner[k] = g->low[k] + (int32_t)at[k] * VL_BLOCK;
      end[k] = corner[k] + VL_BLOCK - 1;
    }
    if (block & VL_SPARSE_TILE) {
      float value = g->tiles[block & ~VL_SPARSE_TILE];
      if (value > 0)
        raise(m, majorants, medium_from_index, corner, end, value);
      continue;
    }
    for (uint32_t j = 0; j < VL_BLOCK_BRICKS; j++) {
      uint32_t brick = g->bricks[(size_t)block * VL_BLOCK_BRICKS + j];
      const uint32_t step[3] = {j & 15, j >> 4 & 15, j >> 8};
      int32_t c[3], e[3];
      for (int k = 0; k < 3; k++) {
        c[k] = corner[k] + (int32_t)step[k] * VL_BRICK;
        e[k] = c[k] + VL_BRICK - 1;
      }
      if (!(brick & VL_SPARSE_TILE)) {
        raise_brick(m, majorants, medium_from_index,
                    g->values + (size_t)brick * VL_BRICK_VALUES, c);
      } else if (g->tiles[brick & ~VL_SPARSE_TILE] > 0) {
        raise(m, majorants, medium_from_index, c, e, g->tiles[brick & ~VL_SPARSE_TILE]);
      }
    }
  }
}

vlResult vl_compile_medium_nanovdb(vlWorld *world, const vlMediumDef *def, vlWorldMedium *m,
                                   vlError *error) {
  const char *name = def->grid ? def->grid : "density", *heat = def->temperature_grid;
  m->emits = false;
  VL_TRY(vl_nanovdb_read(world, def->path, name, &m->sparse, error));
  if (!m->sparse)
    return vl_fail(error, VL_ERROR_SCENE, "%s: it has no grid \"%s\"", def->path,
                   vl_short_text(name).text);
  VL_TRY(vl_nanovdb_read(world, def->path, heat ? heat : "temperature", &m->sparse_temperature,
                         error));
  if (heat && !m->sparse_temperature)
    return vl_fail(error, VL_ERROR_SCENE, "%s: it has no grid \"%s\"", def->path,
                   vl_short_text(heat).text);
  for (int i = 0; i < 3; i++) {
    m->low[i] = INFINITY;
    m->high[i] = -INFINITY;
  }
  grow_box(m->sparse, m);
  if (m->sparse_temperature)
    grow_box(m->sparse_temperature, m);
  for (int i = 0; i < 3; i++)
    if (!(m->low[i] < m->high[i]) || !isfinite(m->high[i] - m->low[i]))
      return vl_fail(error, VL_ERROR_SCENE, "%s: grid \"%s\" is empty", def->path,
                     vl_short_text(name).text);
  vlMat4 index_from_medium = vl_mat4_identity(), inverse;
  for (int i = 0; i < 12; i++)
    index_from_medium.m[i] = (double)m->sparse->index_from_medium[i];
  if (!vl_mat4_inverse(index_from_medium, &inverse))
    return vl_fail(error, VL_ERROR_SCENE, "%s: the map of grid \"%s\" is singular", def->path,
                   vl_short_text(name).text);
  float *majorants = vl_medium_majorants(world, m, 64, 64, 64);
  if (!majorants)
    return vl_fail_memory(error);
  bound_sparse(m, majorants, inverse.m);
  return m->sparse_temperature ? vl_medium_temperature(world, def, m, error) : VL_OK;
}
