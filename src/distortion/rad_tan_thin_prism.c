/* distortion/rad_tan_thin_prism.c: Project Aria's six radial, two tangential and four thin
 * prism terms; the radial ones come first (Project Aria's documentation, "Camera Intrinsic
 * Models", FisheyeRadTanThinPrism; COLMAP, sensor/models.h, RAD_TAN_THIN_PRISM_FISHEYE). */
#include <string.h>

#include "distortion/compile.h"

vlDistortionCompile vl_distortion_compile_rad_tan_thin_prism;

vlResult vl_distortion_compile_rad_tan_thin_prism(const double *k, VL_UNUSED uint32_t n,
                                                  vlDistortionMap *m,
                                                  VL_UNUSED vlError *error) {
  m->radial_first = true;
  memcpy(m->numerator, k, sizeof m->numerator);
  /* p0 belongs to the x axis: the other way round than in OpenCV */
  m->tangential[0] = k[7];
  m->tangential[1] = k[6];
  memcpy(m->prism, k + 8, sizeof m->prism);
  return VL_OK;
}
