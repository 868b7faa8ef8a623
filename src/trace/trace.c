/* trace/trace.c: the tables of the instruction sets. */
#include "trace/trace.h"

#include "trace/stages.h"

size_t vl_trace_scratch_size(void) {
  return sizeof(struct vlTraceScratch);
}

const vlTraceKernels *vl_trace_kernels(vlIsa isa) {
  return isa == VL_ISA_V4 ? &vl_trace_kernels_v4 : isa == VL_ISA_V3 ? &vl_trace_kernels_v3 : &vl_trace_kernels_v2;
}
