/* trace/sampler/batch.hot.c: fills batches of random numbers for all kinds of samplers. The
 * kind is selected once per batch; kinds with several loops work in chunks. n is a multiple of
 * VL_LANES. */
#include "trace/sampler/cells.h"
#include "trace/sampler/halton.h"
#include "trace/sampler/sobol.h"
#include "velo/sampler.h"

static void independent_1d(const vlSampler *s, uint32_t n, const int32_t *px, const int32_t *py,
                           const uint32_t *index, uint32_t dimension, float *u) {
  uint32_t seed = vl_dimension_seed(s, dimension, 0);
  /* must vectorise */
  VL_SIMD for (uint32_t i = 0; i < n; i++) {
    u[i] = vl_fraction_float(vl_hash2(vl_pixel_key(px[i], py[i], seed), index[i]));
  }
}

static void independent_2d(const vlSampler *s, uint32_t n, const int32_t *px, const int32_t *py,
                           const uint32_t *index, uint32_t dimension, float *u, float *v) {
  uint32_t seed = vl_dimension_seed(s, dimension, 0);
  /* must vectorise */
  VL_SIMD for (uint32_t i = 0; i < n; i++) {
    uint32_t key = vl_pixel_key(px[i], py[i], seed);
    u[i] = vl_fraction_float(vl_hash2(key, index[i]));
    v[i] = vl_fraction_float(vl_hash2(vl_hash(key + 0x68e31da4u), index[i]));
  }
}

/* ---- the kinds: functions of one and of two dimensions ----------------------------------- */

#define INPUT                                                                                  \
  const vlSampler *s, uint32_t n, const int32_t *px, const int32_t *py, const uint32_t *index, \
      uint32_t dimension

static void sobol_1d(INPUT, float *u) {
  vl_sobol_pixel(0, s, n, px, py, index, dimension, u, u);
}
static void sobol_2d(INPUT, float *u, float *v) {
  vl_sobol_pixel(1, s, n, px, py, index, dimension, u, v);
}
static void zsobol_1d(INPUT, float *u) {
  vl_zsobol(0, s, n, px, py, index, dimension, u, u);
}
static void zsobol_2d(INPUT, float *u, float *v) {
  vl_zsobol(1, s, n, px, py, index, dimension, u, v);
}

/* Body of a function: in chunks; `call` has the chunk c, whose first lane is k. */
#define IN_CHUNKS(call)                                               \
  uint32_t seed = vl_dimension_seed(s, dimension, 0);                 \
  vlSamplerChunk chunk, *c = &chunk;                                  \
  for (uint32_t k = 0; k < n; k += VL_SAMPLER_CHUNK) {                \
    uint32_t m = n - k < VL_SAMPLER_CHUNK ? n - k : VL_SAMPLER_CHUNK; \
    vl_sampler_chunk(s, m, px + k, py + k, index + k, seed, c);       \
    call;                                                             \
  }
static void regular_1d(INPUT, float *u) {
  IN_CHUNKS(vl_cells_1d(0, s, c, u + k))
}
static void regular_2d(INPUT, float *u, float *v) {
  IN_CHUNKS(vl_grid_2d(0, s, c, u + k, v + k))
}
static void stratified_1d(INPUT, float *u) {
  IN_CHUNKS(vl_cells_1d(1, s, c, u + k))
}
static void stratified_2d(INPUT, float *u, float *v) {
  IN_CHUNKS(vl_grid_2d(1, s, c, u + k, v + k))
}
static void nrooks_1d(INPUT, float *u) {
  IN_CHUNKS(vl_cells_1d(1, s, c, u + k))
}
static void nrooks_2d(INPUT, float *u, float *v) {
  IN_CHUNKS(vl_nrooks_2d(s, c, u + k, v + k))
}
static void multi_jittered_1d(INPUT, float *u) {
  IN_CHUNKS(vl_cells_1d(1, s, c, u + k))
}
static void multi_jittered_2d(INPUT, float *u, float *v) {
  IN_CHUNKS(vl_multi_jittered_2d(s, c, u + k, v + k))
}
static void hammersley_1d(INPUT, float *u) {
  IN_CHUNKS(vl_cells_1d(1, s, c, u + k))
}
static void hammersley_2d(INPUT, float *u, float *v) {
  IN_CHUNKS(vl_hammersley_2d(s, c, u + k, v + k))
}
static void halton_1d(INPUT, float *u) {
  IN_CHUNKS(vl_halton_1d(s, c, dimension, u + k))
}
static void halton_2d(INPUT, float *u, float *v) {
  halton_1d(s, n, px, py, index, dimension, u);
  halton_1d(s, n, px, py, index, dimension + 1, v);
}

static void get_1d(INPUT, float *u) {
  if (s->own) {
    vl_own_numbers(s, n, px, py, index, dimension, u, NULL);
    return;
  }
  uint32_t count = VL_PAD(n);
  switch ((vlSamplerKind)s->kind) {
    case VL_SAMPLER_INDEPENDENT:
      independent_1d(s, count, px, py, index, dimension, u);
      return;
    case VL_SAMPLER_REGULAR:
      regular_1d(s, count, px, py, index, dimension, u);
      return;
    case VL_SAMPLER_STRATIFIED:
      stratified_1d(s, count, px, py, index, dimension, u);
      return;
    case VL_SAMPLER_NROOKS:
      nrooks_1d(s, count, px, py, index, dimension, u);
      return;
    case VL_SAMPLER_MULTI_JITTERED:
      multi_jittered_1d(s, count, px, py, index, dimension, u);
      return;
    case VL_SAMPLER_HAMMERSLEY:
      hammersley_1d(s, count, px, py, index, dimension, u);
      return;
    case VL_SAMPLER_HALTON:
      halton_1d(s, count, px, py, index, dimension, u);
      return;
    case VL_SAMPLER_SOBOL:
      sobol_1d(s, count, px, py, index, dimension, u);
      return;
    case VL_SAMPLER_ZSOBOL:
      zsobol_1d(s, count, px, py, index, dimension, u);
      return;
  }
}

static void get_2d(INPUT, float *u, float *v) {
  if (s->own) {
    vl_own_numbers(s, n, px, py, index, dimension, u, v);
    return;
  }
  uint32_t count = VL_PAD(n);
  switch ((vlSamplerKind)s->kind) {
    case VL_SAMPLER_INDEPENDENT:
      independent_2d(s, count, px, py, index, dimension, u, v);
      return;
    case VL_SAMPLER_REGULAR:
      regular_2d(s, count, px, py, index, dimension, u, v);
      return;
    case VL_SAMPLER_STRATIFIED:
      stratified_2d(s, count, px, py, index, dimension, u, v);
      return;
    case VL_SAMPLER_NROOKS:
      nrooks_2d(s, count, px, py, index, dimension, u, v);
      return;
    case VL_SAMPLER_MULTI_JITTERED:
      multi_jittered_2d(s, count, px, py, index, dimension, u, v);
      return;
    case VL_SAMPLER_HAMMERSLEY:
      hammersley_2d(s, count, px, py, index, dimension, u, v);
      return;
    case VL_SAMPLER_HALTON:
      halton_2d(s, count, px, py, index, dimension, u, v);
      return;
    case VL_SAMPLER_SOBOL:
      sobol_2d(s, count, px, py, index, dimension, u, v);
      return;
    case VL_SAMPLER_ZSOBOL:
      zsobol_2d(s, count, px, py, index, dimension, u, v);
      return;
  }
}

static void get_2d_with(INPUT, uint32_t with, float *u, float *v) {
  if (s->own || (s->kind != VL_SAMPLER_SOBOL && s->kind != VL_SAMPLER_ZSOBOL)) {
    get_2d(s, n, px, py, index, dimension, u, v);
    return;
  }
  vlSobolChunk c;
  for (uint32_t k = 0, count = VL_PAD(n); k < count; k += VL_SAMPLER_CHUNK) {
    uint32_t m = count - k < VL_SAMPLER_CHUNK ? count - k : VL_SAMPLER_CHUNK;
    if (s->kind == VL_SAMPLER_SOBOL)
      vl_sobol_chunk(s, m, px + k, py + k, index + k, dimension, with, &c);
    else
      vl_zsobol_chunk(s, m, px + k, py + k, index + k, dimension, with, &c);
    vl_sobol_number(m, vl_sobol3_columns, c.j, c.x, u + k);
    vl_sobol_number(m, vl_sobol4_columns, c.j, c.y, v + k);
  }
}

const vlSamplerKernels vl_sampler_kernel_table = {get_1d, get_2d, get_2d_with};
