/* distortion/none.c: no distortion. */
#include "distortion/compile.h"

vlDistortionCompile vl_distortion_compile_none;

vlResult vl_distortion_compile_none(VL_UNUSED const double *k, VL_UNUSED uint32_t n,
                                    VL_UNUSED vlDistortionMap *m, VL_UNUSED vlError *error) {
  return VL_OK;
}
