/* trace/bsdf/bsdf.c: the BSDF kernels of an instruction set. */
#include "trace/bsdf/bsdf.h"

const vlBsdfKernels *vl_bsdf_kernels(vlIsa isa) {
  return isa == VL_ISA_V4 ? &vl_bsdf_kernels_v4 : isa == VL_ISA_V3 ? &vl_bsdf_kernels_v3 : &vl_bsdf_kernels_v2;
}
