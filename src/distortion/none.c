/* distortion/none.c: no distortion. */
#include "distortion/compile.h"

vlDistortionCompile vl_distortion_compile_none;

vlResult vl_distortion_compile_none(const double *k, uint32_t n, vlDistortionMap *m,
                                    vlError *error) {
  (void)k;
  (void)n;
  (void)m;
  (void)error;
  return VL_OK;
}
