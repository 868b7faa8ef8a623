/* medium/cells.c: media on dense grids: converts the values to the layout for lookups, and
 * computes majorants (pbrt book 11.4). */
#include <math.h>
#include <string.h>

#include "base/error.h"
#include "color/rgb_table.h"
#include "medium/compile.h"
#include "velo/medium.h"

static bool copy_grid(vlWorld *world, const vlMediumDef *def, const float *from,
                      vlDenseGrid *to) {
  if (!from)
    return true;
  size_t cells = (size_t)def->nx * def->ny * def->nz;
  float *values = vl_world_block(world, cells, sizeof *values);
  if (!values)
    return false;
  memcpy(values, from, cells * sizeof *values);
  *to = (vlDenseGrid){def->nx, def->ny, def->nz, values};
  return true;
}

static bool copy_rgb_grid(vlWorld *world, const vlMediumDef *def, const float *from,
                          vlSpectrumRole role, vlDenseGrid *to) {
  if (!from)
    return true;
  size_t cells = (size_t)def->nx * def->ny * def->nz;
  float *values = vl_world_block(world, cells, 4 * sizeof *values);
  if (!values)
    return false;
  const vlRgbTable *table = vl_rgb_table(def->space);
  const vlSrgbMap to_srgb = vl_srgb_map(def->space, role);
  for (size_t i = 0; i < cells; i++) {
    const float *rgb = from + 3 * i;
    float *v = values + 4 * i, high = vl_max(rgb[0], vl_max(rgb[1], rgb[2]));
    if (world->def.color == VL_COLOR_RGB) {
      vl_store3(v, vl_to_srgb(&to_srgb, vl_load3(rgb)));
      v[3] = 0;
      continue;
    }
    float inv = high > 0 ? 0.5f / high : 0;
    vlSigmoid s = vl_rgb_table_lookup(table, rgb[0] * inv, rgb[1] * inv, rgb[2] * inv);
    v[0] = s.c0;
    v[1] = s.c1;
    v[2] = s.c2;
    v[3] = 2 * high;
  }
  *to = (vlDenseGrid){def->nx, def->ny, def->nz, values};
  return true;
}

/* Gives the first and last cell of a grid, along one axis, that a lookup in [low, high] of the
 * unit interval may read. Lookups compute in float: their rounding, 6e-8 of up to 1000 cells,
 * is within 1e-4 of a cell. */
static void reach(double low, double high, uint32_t n, uint32_t *first, uint32_t *last) {
  double a = floor(low * n - 0.5 - 1e-4), b = floor(high * n - 0.5 + 1e-4) + 1;
  *first = a > 0 ? (uint32_t)a : 0;
  *last = b < n - 1 ? (uint32_t)b : n - 1;
}

/* Upper bound of all lookups within a cell of the majorant grid. */
static float dense_bound(const vlDenseGrid *g, const uint32_t cells[3], const uint32_t at[3],
                         bool rgb) {
  const uint32_t n[3] = {g->nx, g->ny, g->nz};
  uint32_t a[3], b[3];
  float max = 0;
  for (int i = 0; i < 3; i++)
    reach((double)at[i] / cells[i], (double)(at[i] + 1) / cells[i], n[i], &a[i], &b[i]);
  for (uint32_t z = a[2]; z <= b[2]; z++)
    for (uint32_t y = a[1]; y <= b[1]; y++)
      for (uint32_t x = a[0]; x <= b[0]; x++) {
        size_t k = ((size_t)z * n[1] + y) * n[0] + x;
        const float *v = g->values + 4 * k;
        /* The scale of a sigmoid spectrum is a bound, but up to twice too large, since it is
         * twice the colour's maximum. The spectrum is therefore sampled. */
        float bound = rgb ? 0 : g->values[k];
        if (rgb && v[3] > 0)
          for (int l = VL_LAMBDA_MIN; l <= VL_LAMBDA_MAX; l += 5)
            bound = vl_max(bound,
                           v[3] * vl_sigmoid((vlSigmoid){v[0], v[1], v[2]}, (float)l) * 1.001f);
        else if (rgb)
          bound = vl_max(v[0], vl_max(v[1], v[2]));
        max = vl_max(max, bound);
      }
  return max;
}

typedef struct Bounding {
  const vlWorldMedium *m;
  float *majorants;
  bool rgb;
} Bounding;

static void bound_slice(void *user, uint32_t z, VL_UNUSED uint32_t worker) {
  const Bounding *b = user;
  const vlWorldMedium *m = b->m;
  for (uint32_t y = 0; y < m->cells[1]; y++)
    for (uint32_t x = 0; x < m->cells[0]; x++) {
      const uint32_t at[3] = {x, y, z};
      float *to = b->majorants + ((size_t)z * m->cells[1] + y) * m->cells[0] + x;
      if (!b->rgb) {
        *to = dense_bound(&m->density, m->cells, at, false);
        continue;
      }
      float absorbed = m->rgb_a.values ? dense_bound(&m->rgb_a, m->cells, at, true) : 1;
      float scattered = m->rgb_s.values ? dense_bound(&m->rgb_s, m->cells, at, true) : 1;
      *to = m->rgb_scale * (absorbed + scattered);
    }
}

vlResult vl_medium_cells(vlWorld *world, const vlMediumDef *def, vlWorldMedium *m,
                         vlError *error) {
  bool rgb = m->own_sigma;
  memcpy(m->low, def->low, sizeof m->low);
  memcpy(m->high, def->high, sizeof m->high);
  if (!copy_grid(world, def, def->density, &m->density) ||
      !copy_grid(world, def, def->emission_scales, &m->emission_scales) ||
      !copy_grid(world, def, def->temperature, &m->temperature) ||
      !copy_rgb_grid(world, def, def->rgb_a, VL_ROLE_UNBOUNDED, &m->rgb_a) ||
      !copy_rgb_grid(world, def, def->rgb_s, VL_ROLE_UNBOUNDED, &m->rgb_s) ||
      !copy_rgb_grid(world, def, def->rgb_emission, VL_ROLE_ILLUMINANT, &m->rgb_emission))
    return vl_fail_memory(error);
  uint32_t cells[3] = {def->nx, def->ny, def->nz};
  for (int i = 0; i < 3; i++)
    cells[i] = cells[i] > 8 ? 16 : 2 * cells[i];
  Bounding bounding = {m, vl_medium_majorants(world, m, cells[0], cells[1], cells[2]), rgb};
  if (!bounding.majorants)
    return vl_fail_memory(error);
  vl_parallel_for(world->context, m->cells[2], bound_slice, &bounding);
  return VL_OK;
}
