/* filter/box.case.c: the formula of the pixel filter box. */
#include "filter/filter.case.h"

double box_filter(double x, double radius) {
  (void)x;
  (void)radius;
  return 1;
}
