/* distortion/thin_prism.c: COLMAP's thin prism: radial, tangential, and a term along each
 * axis. */
#include "distortion/compile.h"

vlDistortionCompile vl_distortion_compile_thin_prism;

vlResult vl_distortion_compile_thin_prism(const double *k, VL_UNUSED uint32_t n,
                                          vlDistortionMap *m, VL_UNUSED vlError *error) {
  m->numerator[0] = k[0];
  m->numerator[1] = k[1];
  m->numerator[2] = k[4];
  m->numerator[3] = k[5];
  m->tangential[0] = k[2];
  m->tangential[1] = k[3];
  m->prism[0] = k[6];
  m->prism[2] = k[7];
  return VL_OK;
}
