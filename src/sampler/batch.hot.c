/* sampler/batch.hot.c: fills batches of random numbers for all kinds of samplers. The kind is
 * selected once per batch. */
#include "sampler/kinds.row.h"
#include "sampler/sobol.hot.h"
#include "velo/sampler.h"

#define DECLARE(kind, row, one, two) \
  vlSampler1d one;                   \
  vlSampler2d two;
VL_SAMPLER_FUNCTIONS(DECLARE)

/* v: null for one dimension. */
static void get(VL_SAMPLER_INPUT, float *u, float *v) {
  if (s->own) {
    vl_own_numbers(s, n, px, py, index, dimension, u, v);
    return;
  }
  uint32_t count = VL_PAD(n);
  switch ((vlSamplerKind)s->kind) {
#define CASE(kind, row, one, two)                    \
  case kind:                                         \
    if (v)                                           \
      two(s, count, px, py, index, dimension, u, v); \
    else                                             \
      one(s, count, px, py, index, dimension, u);    \
    return;
    VL_SAMPLER_FUNCTIONS(CASE)
#undef CASE
  }
}

static void get_1d(VL_SAMPLER_INPUT, float *u) {
  get(s, n, px, py, index, dimension, u, NULL);
}

static void get_2d_with(VL_SAMPLER_INPUT, uint32_t with, float *u, float *v) {
  if (s->own || (s->kind != VL_SAMPLER_SOBOL && s->kind != VL_SAMPLER_ZSOBOL)) {
    get(s, n, px, py, index, dimension, u, v);
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

const vlSamplerKernels vl_sampler_kernel_table = {get_1d, get, get_2d_with};
