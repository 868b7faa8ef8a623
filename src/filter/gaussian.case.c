/* filter/gaussian.case.c: the formula of the pixel filter gaussian. */
#include "filter/filter.case.h"

double gaussian_filter(double x, double radius) {
  return exp(-x * x / (2 * .5 * .5)) - exp(-radius * radius / (2 * .5 * .5));
}
