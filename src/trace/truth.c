/* trace/truth.c: the tables of the instruction sets. */
#include "trace/truth.h"

#include "trace/truth_scratch.h"

size_t vl_truth_scratch_size(void) {
  return sizeof(struct vlTruthScratch);
}

const vlTruthKernels *vl_truth_kernels(vlIsa isa) {
  return isa == VL_ISA_V4 ? &vl_truth_kernels_v4 : isa == VL_ISA_V3 ? &vl_truth_kernels_v3 : &vl_truth_kernels_v2;
}
