/* filter/box.c: constant weight in a rectangle. */
#include "filter/value.h"

vlFilterValue vl_filter_value_box;

double vl_filter_value_box(VL_UNUSED const vlPixelFilter *filter, VL_UNUSED vlFilterAt at) {
  return 1.0;
}
