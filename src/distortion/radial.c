/* distortion/radial.c: a polynomial of the squared radius. */
#include <string.h>

#include "distortion/compile.h"

vlDistortionCompile vl_distortion_compile_radial;

vlResult vl_distortion_compile_radial(const double *k, uint32_t n, vlDistortionMap *m,
                                      VL_UNUSED vlError *error) {
  memcpy(m->numerator, k, n * sizeof *k);
  return VL_OK;
}
