/* more/octahedral.h: the equal-area octahedral map (Clarberg 2008) of the sky and of goniometric lights: the upper
 * hemisphere fills the diamond |u| + |v| <= 1 in the middle of the square -1 to 1, the lower one the four corners;
 * equal solid angles fill equal areas. */
#pragma once
#include "sampler.h"

/* The point of the unit square of a direction. */
static inline square_point square_of(vector d) {
  double r = sqrt(fmax(0, 1 - fabs(d.z)));
  double v = r * atan2(fabs(d.y), fabs(d.x)) * 2 / PI;
  double u = r - v;
  if (d.z < 0) return (square_point){(copysign(1 - v, d.x) + 1) / 2, (copysign(1 - u, d.y) + 1) / 2};
  return (square_point){(copysign(u, d.x) + 1) / 2, (copysign(v, d.y) + 1) / 2};
}

static inline vector direction_of(square_point p) {
  double u = 2 * p.x - 1, v = 2 * p.y - 1;
  double side = 1 - (fabs(u) + fabs(v)); /* positive in the diamond */
  double r = 1 - fabs(side);
  double phi = r == 0 ? PI / 4 : ((fabs(v) - fabs(u)) / r + 1) * PI / 4;
  double around = r * sqrt(fmax(0, 2 - r * r));
  return make_vector(copysign(cos(phi), u) * around, copysign(sin(phi), v) * around, copysign(1 - r * r, side));
}
