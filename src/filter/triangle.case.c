/* filter/triangle.case.c: the formula of the pixel filter triangle. */
#include "filter/filter.case.h"

double triangle_filter(const vlPixelFilter *filter, double x, double radius) {
  (void)filter;
  return radius - x;
}
