/* material/table.hot.c: the tables of the BSDF kernels by kind, one table per instruction
 * set. */
#include "material/kinds.row.h"
#include "material/local.hot.h"

#define DECLARE(kind, name, parameters, eval, sample) \
  vlBsdfEval eval;                                    \
  vlBsdfSample sample;
VL_BSDF_KINDS(DECLARE)

#define EVAL(kind, name, parameters, eval, sample) [kind] = eval,
static vlBsdfEval *const evals[] = {VL_BSDF_KINDS(EVAL)};

#define SAMPLE(kind, name, parameters, eval, sample) [kind] = sample,
static vlBsdfSample *const samples[] = {VL_BSDF_KINDS(SAMPLE)};

static void eval(vlBsdfKind kind, uint32_t n, const vlBsdfParams *params, vlBsdfDirections wo,
                 vlBsdfDirections wi, float *const value[4], float *pdf) {
  evals[kind](n, params, wo, wi, value, pdf);
}

static void sample(vlBsdfKind kind, uint32_t n, const vlBsdfParams *params, vlBsdfDirections wo,
                   const float *u_lobe, const float *u, const float *v, vlBsdfDirections wi,
                   float *const weight[4], float *pdf, uint32_t *flags, float *eta_scale) {
  samples[kind](n, params, wo, u_lobe, u, v, wi, weight, pdf, flags, eta_scale);
}

const vlBsdfKernels vl_bsdf_kernel_table = {eval, sample};
