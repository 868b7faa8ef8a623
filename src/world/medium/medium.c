/* world/medium/medium.c: scene media -> world media: spectra, grids in the layout for lookups, majorants (pbrt book
 * 11.4). Only media that are in use are compiled. */
#include "world/medium/medium.h"

#include <math.h>
#include <string.h>

#include "base/error.h"
#include "color/rgb_table.h"
#include "math/elementary.h"
#include "math/transform.h"
#include "scene/scene.h"
#include "world/medium/medium_lookup.h"
#include "world/world.h"

/* ---- spectra ----------------------------------------------------------------------------------------------------- */

static bool is_zero(const vlSpectral *s) {
  if (s->scale == 0) return true;
  if (s->kind == VL_SPECTRAL_RGB) return s->rgb[0] == 0 && s->rgb[1] == 0 && s->rgb[2] == 0;
  if (s->kind != VL_SPECTRAL_DENSE) return false;
  for (int i = 0; i < VL_LAMBDA_COUNT; i++)
    if (s->dense[i] != 0) return false;
  return true;
}

static bool is_grey(const vlSpectral *s) {
  return s->kind == VL_SPECTRAL_CONSTANT || is_zero(s) ||
         (s->kind == VL_SPECTRAL_RGB && s->rgb[0] == s->rgb[1] && s->rgb[0] == s->rgb[2]);
}

static vlResult compile_sigma(vlWorld *world, const vlMediumDef *def, const vlSpectrum *from, vlSpectral *to,
                              vlError *error) {
  vlSpectrum s = *from;
  /* Equal components become a constant, which saves lookups per flight. */
  if (s.kind == VL_SPECTRUM_RGB && s.rgb[0] == s.rgb[1] && s.rgb[0] == s.rgb[2])
    s = (vlSpectrum){.kind = VL_SPECTRUM_CONSTANT, .scale = s.scale, .value = s.rgb[0]};
  vlResult r = vl_spectral_compile(world, &s, VL_ROLE_UNBOUNDED, to, error);
  to->scale *= def->scale;
  return r;
}

/* Absorption by channel of linear sRGB is kept apart from the spectra: flights are sampled by sigma_s alone, and
 * absorption along the way becomes path weight. In RGB mode, and if all channels are equal, sigma_a is used instead. */
static vlResult compile_absorption(vlWorld *world, const vlMediumDef *def, vlWorldMedium *m, vlError *error) {
  if (!def->rgb_absorption || world->def.color == VL_COLOR_RGB || def->sigma_a.kind != VL_SPECTRUM_RGB ||
      (def->sigma_a.rgb[0] == def->sigma_a.rgb[1] && def->sigma_a.rgb[0] == def->sigma_a.rgb[2]))
    return compile_sigma(world, def, &def->sigma_a, &m->sigma_a, error);
  vlSpectrum none = vl_spectrum_constant(0.0f);
  vlResult r = vl_spectrum_to_rgb(&def->sigma_a, VL_ROLE_UNBOUNDED, VL_SPACE_SRGB, m->sigma_rgb, error);
  for (int c = 0; c < 3; c++) m->sigma_rgb[c] *= def->scale;
  m->by_channel = world->absorbs_by_channel = true;
  return r == VL_OK ? compile_sigma(world, def, &none, &m->sigma_a, error) : r;
}

static vlResult compile_emission(vlWorld *world, const vlMediumDef *def, vlWorldMedium *m, vlError *error) {
  vlResult r = vl_spectral_compile(world, &def->emission, VL_ROLE_ILLUMINANT, &m->emission, error);
  if (r != VL_OK) return r;
  m->emission.scale *= def->emission_scale;
  if (world->def.color != VL_COLOR_RGB && !is_zero(&m->emission)) {
    double photometric = vl_spectrum_photometric(&def->emission, error);
    m->emission.scale = photometric > 0 ? (float)(m->emission.scale / photometric) : 0.0f;
  }
  m->emits = !is_zero(&m->emission);
  return VL_OK;
}

/* Temperature: black bodies as in pbrt-v4, normalised to a maximum of 1, not to a luminance. */
static vlResult compile_temperature(vlWorld *world, const vlMediumDef *def, vlWorldMedium *m, vlError *error) {
  m->emits = def->emission_scale > 0;
  m->temperature_offset = def->temperature_offset;
  m->temperature_scale = def->temperature_scale;
  m->temperature_emission = def->emission_scale;
  if (world->def.color != VL_COLOR_RGB) return VL_OK;
  float *table = vl_world_block(world, (size_t)VL_BLACKBODY_STEPS * 3, sizeof *table);
  if (!table) return vl_fail_memory(error);
  for (int k = 0; k < VL_BLACKBODY_STEPS; k++) {
    vlSpectrum body = vl_spectrum_blackbody((float)(VL_BLACKBODY_LOW * vl_precise_exp2(k / 32.0)));
    vlResult r = vl_spectrum_to_rgb(&body, VL_ROLE_ILLUMINANT, VL_SPACE_SRGB, table + 3 * k, error);
    if (r != VL_OK) return r;
    for (int c = 0; c < 3; c++) table[3 * k + c] *= (float)vl_spectrum_photometric(&body, error);
  }
  m->blackbody_rgb = table;
  return VL_OK;
}

/* ---- grids ------------------------------------------------------------------------------------------------------- */

static bool copy_grid(vlWorld *world, const vlMediumDef *def, const float *from, vlDenseGrid *to) {
  if (!from) return true;
  size_t cells = (size_t)def->nx * def->ny * def->nz;
  float *values = vl_world_block(world, cells, sizeof *values);
  if (!values) return false;
  memcpy(values, from, cells * sizeof *values);
  *to = (vlDenseGrid){def->nx, def->ny, def->nz, values};
  return true;
}

static bool copy_rgb_grid(vlWorld *world, const vlMediumDef *def, const float *from, vlDenseGrid *to) {
  if (!from) return true;
  size_t cells = (size_t)def->nx * def->ny * def->nz;
  float *values = vl_world_block(world, cells, 4 * sizeof *values);
  if (!values) return false;
  const vlRgbTable *table = vl_rgb_table(def->space);
  for (size_t i = 0; i < cells; i++) {
    const float *rgb = from + 3 * i;
    float *v = values + 4 * i, high = vl_max(rgb[0], vl_max(rgb[1], rgb[2]));
    if (world->def.color == VL_COLOR_RGB) {
      for (int c = 0; c < 3; c++) v[c] = rgb[c];
      v[3] = 0;
      continue;
    }
    float inv = high > 0 ? 0.5f / high : 0;
    vlSigmoid s = vl_rgb_table_lookup(table, rgb[0] * inv, rgb[1] * inv, rgb[2] * inv);
    v[0] = s.c0, v[1] = s.c1, v[2] = s.c2, v[3] = 2 * high;
  }
  *to = (vlDenseGrid){def->nx, def->ny, def->nz, values};
  return true;
}

/* First and last cell of a grid that a lookup in [low, high] of the unit interval may read. */
static void reach(double low, double high, uint32_t n, uint32_t *first, uint32_t *last) {
  double a = floor(low * n - 0.5 - 1e-4), b = floor(high * n - 0.5 + 1e-4) + 1;
  *first = a > 0 ? (uint32_t)a : 0;
  *last = b < n - 1 ? (uint32_t)b : n - 1;
}

/* Upper bound of all lookups within a cell of the majorant grid. */
static float dense_bound(const vlDenseGrid *g, const uint32_t cells[3], const uint32_t at[3], bool rgb) {
  const uint32_t n[3] = {g->nx, g->ny, g->nz};
  uint32_t a[3], b[3];
  float most = 0;
  for (int i = 0; i < 3; i++) reach((double)at[i] / cells[i], (double)(at[i] + 1) / cells[i], n[i], &a[i], &b[i]);
  for (uint32_t z = a[2]; z <= b[2]; z++)
    for (uint32_t y = a[1]; y <= b[1]; y++)
      for (uint32_t x = a[0]; x <= b[0]; x++) {
        size_t k = ((size_t)z * n[1] + y) * n[0] + x;
        const float *v = g->values + 4 * k;
        /* The scale of a sigmoid is twice the colour's maximum, so the scale alone would be a bound up to twice too
         * large. The spectrum is sampled instead. */
        float bound = rgb ? 0 : g->values[k];
        if (rgb && v[3] > 0)
          for (int l = VL_LAMBDA_MIN; l <= VL_LAMBDA_MAX; l += 5)
            bound = vl_max(bound, v[3] * vl_sigmoid((vlSigmoid){v[0], v[1], v[2]}, (float)l) * 1.001f);
        else if (rgb)
          bound = vl_max(v[0], vl_max(v[1], v[2]));
        most = vl_max(most, bound);
      }
  return most;
}

typedef struct Bounding {
  const vlWorldMedium *m;
  float *majorants;
  bool rgb;
} Bounding;

static void bound_slice(void *user, uint32_t z, uint32_t worker) {
  const Bounding *b = user;
  const vlWorldMedium *m = b->m;
  (void)worker;
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

static float *new_majorants(vlWorld *world, vlWorldMedium *m, uint32_t x, uint32_t y, uint32_t z) {
  m->cells[0] = x, m->cells[1] = y, m->cells[2] = z;
  float *majorants = vl_world_block(world, (size_t)x * y * z, sizeof *majorants);
  m->majorants = majorants;
  return majorants;
}

static vlResult compile_cells(vlWorld *world, const vlMediumDef *def, vlWorldMedium *m, vlError *error) {
  bool rgb = m->own_sigma;
  memcpy(m->low, def->low, sizeof m->low);
  memcpy(m->high, def->high, sizeof m->high);
  if (!copy_grid(world, def, def->density, &m->density) ||
      !copy_grid(world, def, def->emission_scales, &m->emission_scales) ||
      !copy_grid(world, def, def->temperature, &m->temperature) || !copy_rgb_grid(world, def, def->rgb_a, &m->rgb_a) ||
      !copy_rgb_grid(world, def, def->rgb_s, &m->rgb_s) ||
      !copy_rgb_grid(world, def, def->rgb_emission, &m->rgb_emission))
    return vl_fail_memory(error);
  if (rgb) {
    /* pbrt-v4 multiplies by the illuminant of the colour space, scaled to the luminance of a constant spectrum of 1. */
    double sum = 0, whole = 0;
    const float *y = vl_cie_y(), *illuminant = vl_space_illuminant(def->space);
    for (int i = 0; i < VL_LAMBDA_COUNT; i++) sum += (double)y[i] * (double)illuminant[i], whole += (double)y[i];
    m->grey = m->scatters = true;
    m->emits = def->rgb_emission && def->emission_scale > 0;
    m->rgb_scale = def->scale;
    m->rgb_emission_scale = def->emission_scale;
    if (world->def.color == VL_COLOR_RGB)
      m->illuminant = (vlSpectral){.kind = VL_SPECTRAL_RGB, .scale = (float)whole, .rgb = {1, 1, 1}};
    else
      m->illuminant = (vlSpectral){.kind = VL_SPECTRAL_DENSE, .scale = (float)(whole / sum), .dense = illuminant};
  }
  uint32_t cells[3] = {def->nx, def->ny, def->nz};
  for (int i = 0; i < 3; i++) cells[i] = cells[i] > 8 ? 16 : 2 * cells[i];
  Bounding bounding = {m, new_majorants(world, m, cells[0], cells[1], cells[2]), rgb};
  if (!bounding.majorants) return vl_fail_memory(error);
  vl_parallel_for(world->context, m->cells[2], bound_slice, &bounding);
  return VL_OK;
}

static vlResult compile_grid(vlWorld *world, const vlMediumDef *def, vlWorldMedium *m, vlError *error) {
  vlResult r = compile_cells(world, def, m, error);
  return r == VL_OK && def->temperature ? compile_temperature(world, def, m, error) : r;
}

static vlResult compile_rgb_grid(vlWorld *world, const vlMediumDef *def, vlWorldMedium *m, vlError *error) {
  m->own_sigma = true;
  return compile_cells(world, def, m, error);
}

/* Cloud density decreases with height: one majorant per slab. Noise is at most 1.04, the sum of its five octaves at
 * most 1.01. */
static vlResult compile_cloud(vlWorld *world, const vlMediumDef *def, vlWorldMedium *m, vlError *error) {
  enum { SLABS = 16 };
  memcpy(m->low, def->low, sizeof m->low);
  memcpy(m->high, def->high, sizeof m->high);
  m->emits = false;
  m->cloud_density = def->cloud_density;
  m->wispiness = def->wispiness;
  m->frequency = def->frequency;
  float *majorants = new_majorants(world, m, 1, SLABS, 1);
  if (!majorants) return vl_fail_memory(error);
  for (int i = 0; i < SLABS; i++) {
    float y = m->low[1] + (m->high[1] - m->low[1]) * (float)i / SLABS - 1e-5f;
    float d = vl_clamp((1 - y) * 4.5f * m->cloud_density * 1.01f, 0, 1) + 2 * vl_max(0, 0.5f - y);
    majorants[i] = vl_clamp(d, 0, 1);
  }
  return VL_OK;
}

/* ---- NanoVDB ----------------------------------------------------------------------------------------------------- */

static void grow_box(const vlSparseGrid *g, vlWorldMedium *m) {
  for (int i = 0; i < 3; i++) {
    m->low[i] = vl_min(m->low[i], (float)g->box_low[i]);
    m->high[i] = vl_max(m->high[i], (float)g->box_high[i]);
  }
}

/* Raises the majorants of all cells that a lookup near voxels [a, b] can fall into. */
static void raise(const vlWorldMedium *m, float *majorants, const double medium_from_index[12], const int32_t a[3],
                  const int32_t b[3], float value) {
  int32_t first[3], last[3];
  for (int i = 0; i < 3; i++) {
    double low = medium_from_index[4 * i + 3], high = low;
    for (int k = 0; k < 3; k++) {
      double s = medium_from_index[4 * i + k], p = s * (a[k] - 1.001), q = s * (b[k] + 1.001);
      low += p < q ? p : q;
      high += p < q ? q : p;
    }
    double scale = m->cells[i] / ((double)m->high[i] - (double)m->low[i]);
    low = floor((low - (double)m->low[i]) * scale - 1e-3), high = floor((high - (double)m->low[i]) * scale + 1e-3);
    if (high < 0 || low > m->cells[i] - 1) return;
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

/* Bounds a brick in octants, for tighter majorants. */
static void raise_brick(const vlWorldMedium *m, float *majorants, const double medium_from_index[12],
                        const float *values, const int32_t corner[3]) {
  for (int part = 0; part < 8; part++) {
    int x0 = part & 1 ? 4 : 0, y0 = part & 2 ? 4 : 0, z0 = part & 4 ? 4 : 0;
    float most = 0;
    for (int z = z0; z < z0 + 4; z++)
      for (int y = y0; y < y0 + 4; y++)
        for (int x = x0; x < x0 + 4; x++) most = vl_max(most, values[(z * 8 + y) * 8 + x]);
    int32_t a[3] = {corner[0] + x0, corner[1] + y0, corner[2] + z0}, b[3] = {a[0] + 3, a[1] + 3, a[2] + 3};
    if (most > 0) raise(m, majorants, medium_from_index, a, b, most);
  }
}

static void bound_sparse(const vlWorldMedium *m, float *majorants, const double medium_from_index[12]) {
  const vlSparseGrid *g = m->sparse;
  size_t cells = (size_t)m->cells[0] * m->cells[1] * m->cells[2];
  for (size_t i = 0; i < cells; i++) majorants[i] = vl_max(0, g->tiles[0]);
  for (uint32_t i = 0; i < g->size[0] * g->size[1] * g->size[2]; i++) {
    uint32_t at[3] = {i % g->size[0], i / g->size[0] % g->size[1], i / g->size[0] / g->size[1]}, block = g->blocks[i];
    int32_t corner[3], end[3];
    for (int k = 0; k < 3; k++) corner[k] = g->low[k] + (int32_t)at[k] * VL_BLOCK, end[k] = corner[k] + VL_BLOCK - 1;
    if (block & VL_SPARSE_TILE) {
      float value = g->tiles[block & ~VL_SPARSE_TILE];
      if (value > 0) raise(m, majorants, medium_from_index, corner, end, value);
      continue;
    }
    for (uint32_t j = 0; j < VL_BLOCK_BRICKS; j++) {
      uint32_t brick = g->bricks[(size_t)block * VL_BLOCK_BRICKS + j];
      const uint32_t step[3] = {j & 15, j >> 4 & 15, j >> 8};
      int32_t c[3], e[3];
      for (int k = 0; k < 3; k++) c[k] = corner[k] + (int32_t)step[k] * VL_BRICK, e[k] = c[k] + VL_BRICK - 1;
      if (!(brick & VL_SPARSE_TILE)) {
        raise_brick(m, majorants, medium_from_index, g->values + (size_t)brick * VL_BRICK_VALUES, c);
      } else if (g->tiles[brick & ~VL_SPARSE_TILE] > 0) {
        raise(m, majorants, medium_from_index, c, e, g->tiles[brick & ~VL_SPARSE_TILE]);
      }
    }
  }
}

static vlResult compile_nanovdb(vlWorld *world, const vlMediumDef *def, vlWorldMedium *m, vlError *error) {
  const char *name = def->grid ? def->grid : "density", *heat = def->temperature_grid;
  m->emits = false;
  vlResult r = vl_nanovdb_read(world, def->path, name, &m->sparse, error);
  if (r == VL_OK && !m->sparse)
    return vl_fail(error, VL_ERROR_SCENE, "%s: it has no grid \"%s\"", def->path, vl_short_text(name).text);
  if (r == VL_OK) r = vl_nanovdb_read(world, def->path, heat ? heat : "temperature", &m->sparse_temperature, error);
  if (r != VL_OK) return r;
  if (heat && !m->sparse_temperature)
    return vl_fail(error, VL_ERROR_SCENE, "%s: it has no grid \"%s\"", def->path, vl_short_text(heat).text);
  for (int i = 0; i < 3; i++) m->low[i] = INFINITY, m->high[i] = -INFINITY;
  grow_box(m->sparse, m);
  if (m->sparse_temperature) grow_box(m->sparse_temperature, m);
  for (int i = 0; i < 3; i++)
    if (!(m->low[i] < m->high[i]) || !isfinite(m->high[i] - m->low[i]))
      return vl_fail(error, VL_ERROR_SCENE, "%s: grid \"%s\" is empty", def->path, vl_short_text(name).text);
  vlMat4 index_from_medium = vl_mat4_identity(), inverse;
  for (int i = 0; i < 12; i++) index_from_medium.m[i] = (double)m->sparse->index_from_medium[i];
  if (!vl_mat4_inverse(index_from_medium, &inverse))
    return vl_fail(error, VL_ERROR_SCENE, "%s: the map of grid \"%s\" is singular", def->path,
                   vl_short_text(name).text);
  float *majorants = new_majorants(world, m, 64, 64, 64);
  if (!majorants) return vl_fail_memory(error);
  bound_sparse(m, majorants, inverse.m);
  return m->sparse_temperature ? compile_temperature(world, def, m, error) : VL_OK;
}

/* ---- all --------------------------------------------------------------------------------------------------------- */

static vlResult compile_homogeneous(vlWorld *world, const vlMediumDef *def, vlWorldMedium *m, vlError *error) {
  (void)world, (void)def, (void)error;
  m->uniform = true;
  m->extinction = vl_medium_mean_extinction(m);
  return VL_OK;
}

typedef vlResult CompileMedium(vlWorld *world, const vlMediumDef *def, vlWorldMedium *m, vlError *error);
#define COMPILE(K, k) [VL_MEDIUM_##K] = compile_##k,
static CompileMedium *const compile_kind[] = {VL_MEDIUM_KINDS(COMPILE)};
#undef COMPILE

static vlResult compile(vlWorld *world, const vlMediumDef *def, vlWorldMedium *m, vlError *error) {
  vlMat4 inverse;
  m->kind = def->kind;
  m->g = vl_clamp(def->g, -0.99f, 0.99f); /* as in pbrt-v4; beyond that, float directions are too coarse */
  if (!vl_mat4_inverse(vl_mat4_load(def->world_from_medium), &inverse))
    return vl_fail(error, VL_ERROR_SCENE, "the medium's transform is singular");
  for (int i = 0; i < 12; i++) m->medium_from_world[i] = (float)inverse.m[i];
  vlResult r = compile_absorption(world, def, m, error);
  if (r == VL_OK) r = compile_sigma(world, def, &def->sigma_s, &m->sigma_s, error);
  if (r == VL_OK) r = compile_emission(world, def, m, error);
  if (r != VL_OK) return r;
  m->scatters = !is_zero(&m->sigma_s);
  m->grey = is_grey(&m->sigma_a) && is_grey(&m->sigma_s);
  m->temperature_emission = 1;
  return compile_kind[def->kind](world, def, m, error);
}

/* Returns the index in world->media of a scene's medium, which is compiled at its first use. */
static vlResult use(vlWorld *world, const vlScene *scene, uint32_t *compiled, vlMediumId id, uint32_t *index,
                    vlError *error) {
  *index = VL_NONE;
  if (id.index == 0) return VL_OK;
  if (!compiled[id.index - 1]) {
    const vlMediumDef *def = &scene->media.items[id.index - 1];
    vlWorldMedium *m = VL_PUSH(world->context, &world->media);
    if (!m) return vl_fail_memory(error);
    memset(m, 0, sizeof *m);
    vlResult r = compile(world, def, m, error);
    if (r != VL_OK) return vl_world_placed(def->source, error, r);
    compiled[id.index - 1] = (uint32_t)world->media.count;
  }
  *index = compiled[id.index - 1] - 1;
  return VL_OK;
}

vlResult vl_world_add_media(vlWorld *world, const vlScene *scene, vlError *error) {
  world->camera_medium = VL_NONE;
  uint32_t *compiled = vl_world_block(world, scene->media.count + 1, sizeof *compiled);
  if (!compiled) return vl_fail_memory(error);
  memset(compiled, 0, (scene->media.count + 1) * sizeof *compiled);
  vlResult r = use(world, scene, compiled, scene->defs.camera_medium, &world->camera_medium, error);
  for (size_t i = 0; r == VL_OK && i < scene->shapes.count; i++) {
    const vlShapeDef *def = &scene->shapes.items[i];
    vlWorldShape *shape = &world->shapes.items[i];
    shape->inside = shape->outside = VL_NONE;
    if (def->inside.index == def->outside.index) continue;
    r = use(world, scene, compiled, def->inside, &shape->inside, error);
    if (r == VL_OK) r = use(world, scene, compiled, def->outside, &shape->outside, error);
  }
  return r;
}
