/* filter/triangle.case.c: the formula of the pixel filter triangle. */
#include "filter/filter.case.h"

double triangle_filter(double x, double radius) {
  return radius - x;
}
