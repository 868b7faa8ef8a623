/* material/table.hot.c: the tables of the BSDF kernels and names by kind, one table per
 * instruction set. */
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

#define NAME(kind, name, parameters, eval, sample) [kind] = name,
static const char *const names[] = {VL_BSDF_KINDS(NAME)};

const vlBsdfKernels vl_bsdf_kernel_table = {evals, samples, names};
