/* filter/triangle.c: weight that falls linearly to the edge. */
#include "filter/value.h"

vlFilterValue vl_filter_value_triangle;

double vl_filter_value_triangle(VL_UNUSED const vlPixelFilter *filter, vlFilterAt at) {
  return 1.0 - at.t;
}
