/* filter/triangle.c: weight that falls linearly to the edge. */
#include "filter/value.h"

vlFilterValue vl_filter_value_triangle;

double vl_filter_value_triangle(const vlPixelFilter *filter, vlFilterAt at) {
  (void)filter;
  return 1.0 - at.t;
}
