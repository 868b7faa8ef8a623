/* filter/lanczos.c: a windowed sinc. */
#include "filter/value.h"

vlFilterValue vl_filter_value_lanczos;

double vl_filter_value_lanczos(const vlPixelFilter *filter, vlFilterAt at) {
  return vl_sinc(at.x) * vl_sinc(at.x / filter->tau);
}
