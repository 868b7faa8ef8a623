/* filter/box.case.c: the formula of the pixel filter box. */
#include "filter/filter.case.h"

double box_filter(const vlPixelFilter *filter, double x, double radius) {
  (void)filter;
  (void)x;
  (void)radius;
  return 1;
}
