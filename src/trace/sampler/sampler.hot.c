/* trace/sampler/sampler.hot.c: all kinds of samplers in batches. Compiled once per instruction set. The kind is
 * selected once per batch; kinds with several loops work in chunks. */
#include "trace/sampler/cells.h"
#include "trace/sampler/halton.h"
#include "trace/sampler/sobol.h"

static void independent_1d(const vlSampler *s, uint32_t n, const int32_t *px, const int32_t *py, const uint32_t *index,
                           uint32_t dimension, float *u) {
  uint32_t seed = vl_dimension_seed(s, dimension, 0);
  /* must vectorise */
  VL_SIMD for (uint32_t i = 0; i < n; i++) {
    u[i] = vl_fraction_float(vl_hash2(vl_pixel_key(px[i], py[i], seed), index[i]));
  }
}

static void independent_2d(const vlSampler *s, uint32_t n, const int32_t *px, const int32_t *py, const uint32_t *index,
                           uint32_t dimension, float *u, float *v) {
  uint32_t seed = vl_dimension_seed(s, dimension, 0);
  /* must vectorise */
  VL_SIMD for (uint32_t i = 0; i < n; i++) {
    uint32_t key = vl_pixel_key(px[i], py[i], seed);
    u[i] = vl_fraction_float(vl_hash2(key, index[i]));
    v[i] = vl_fraction_float(vl_hash2(vl_hash(key + 0x68e31da4u), index[i]));
  }
}

static void get_1d(const vlSampler *s, uint32_t n, const int32_t *px, const int32_t *py, const uint32_t *index,
                   uint32_t dimension, float *u) {
  uint32_t count = VL_PAD(n);
  switch (s->kind) {
    case VL_SAMPLER_INDEPENDENT: independent_1d(s, count, px, py, index, dimension, u); return;
    case VL_SAMPLER_SOBOL: vl_sobol_pixel(0, s, count, px, py, index, dimension, u, u); return;
    case VL_SAMPLER_ZSOBOL: vl_zsobol(0, s, count, px, py, index, dimension, u, u); return;
    case VL_SAMPLER_REGULAR:
    case VL_SAMPLER_STRATIFIED:
    case VL_SAMPLER_NROOKS:
    case VL_SAMPLER_MULTI_JITTERED:
    case VL_SAMPLER_HAMMERSLEY:
    case VL_SAMPLER_HALTON: break; /* in chunks, below */
  }
  uint32_t seed = vl_dimension_seed(s, dimension, 0);
  vlSamplerChunk chunk;
  for (uint32_t k = 0; k < count; k += VL_SAMPLER_CHUNK) {
    uint32_t m = count - k < VL_SAMPLER_CHUNK ? count - k : VL_SAMPLER_CHUNK;
    vl_sampler_chunk(s, m, px + k, py + k, index + k, seed, &chunk);
    switch (s->kind) {
      case VL_SAMPLER_REGULAR: vl_cells_1d(0, s, &chunk, u + k); break;
      case VL_SAMPLER_HALTON: vl_halton_1d(s, &chunk, dimension, u + k); break;
      case VL_SAMPLER_STRATIFIED:
      case VL_SAMPLER_NROOKS:
      case VL_SAMPLER_MULTI_JITTERED:
      case VL_SAMPLER_HAMMERSLEY: vl_cells_1d(1, s, &chunk, u + k); break;
      case VL_SAMPLER_INDEPENDENT:
      case VL_SAMPLER_SOBOL:
      case VL_SAMPLER_ZSOBOL: break; /* above */
    }
  }
}

static void get_2d(const vlSampler *s, uint32_t n, const int32_t *px, const int32_t *py, const uint32_t *index,
                   uint32_t dimension, float *u, float *v) {
  uint32_t count = VL_PAD(n);
  switch (s->kind) {
    case VL_SAMPLER_INDEPENDENT: independent_2d(s, count, px, py, index, dimension, u, v); return;
    case VL_SAMPLER_SOBOL: vl_sobol_pixel(1, s, count, px, py, index, dimension, u, v); return;
    case VL_SAMPLER_ZSOBOL: vl_zsobol(1, s, count, px, py, index, dimension, u, v); return;
    case VL_SAMPLER_HALTON:
      get_1d(s, n, px, py, index, dimension, u);
      get_1d(s, n, px, py, index, dimension + 1, v);
      return;
    case VL_SAMPLER_REGULAR:
    case VL_SAMPLER_STRATIFIED:
    case VL_SAMPLER_NROOKS:
    case VL_SAMPLER_MULTI_JITTERED:
    case VL_SAMPLER_HAMMERSLEY: break; /* in chunks, below */
  }
  uint32_t seed = vl_dimension_seed(s, dimension, 0);
  vlSamplerChunk chunk;
  for (uint32_t k = 0; k < count; k += VL_SAMPLER_CHUNK) {
    uint32_t m = count - k < VL_SAMPLER_CHUNK ? count - k : VL_SAMPLER_CHUNK;
    vl_sampler_chunk(s, m, px + k, py + k, index + k, seed, &chunk);
    switch (s->kind) {
      case VL_SAMPLER_REGULAR: vl_grid_2d(0, s, &chunk, u + k, v + k); break;
      case VL_SAMPLER_NROOKS: vl_nrooks_2d(s, &chunk, u + k, v + k); break;
      case VL_SAMPLER_MULTI_JITTERED: vl_multi_jittered_2d(s, &chunk, u + k, v + k); break;
      case VL_SAMPLER_HAMMERSLEY: vl_hammersley_2d(s, &chunk, u + k, v + k); break;
      case VL_SAMPLER_STRATIFIED: vl_grid_2d(1, s, &chunk, u + k, v + k); break;
      case VL_SAMPLER_INDEPENDENT:
      case VL_SAMPLER_SOBOL:
      case VL_SAMPLER_ZSOBOL:
      case VL_SAMPLER_HALTON: break; /* above */
    }
  }
}

const vlSamplerKernels vl_sampler_kernel_table = {get_1d, get_2d};
