/* light/spread.h: the radiance of emissive surfaces over directions (vlEmissionDef.spread):
 * max(0, 1 - tan a / tan h) / (1 - h / tan h) at an angle a from the normal, h half of the
 * spread. A grid of slats lets the share 1 - tan a / tan h pass; the divisor is its mean over
 * the hemisphere, weighted by cosines, so that the power does not depend on the spread. Rays
 * that leave such a surface are sampled evenly among the directions with a < h, which have the
 * projected solid angle pi sin^2 h. */
#ifndef LIGHT_SPREAD_H
#define LIGHT_SPREAD_H

#include "math/vec.h"
#include "world/world.h"

static inline bool vl_has_spread(const vlEmitted *e) {
  return e->spread_cot > 0.0f;
}

/* Factor on the radiance. cosine: of the angle between the direction and the normal, on the
 * side that emits, 0 to 1. 1 without a spread. */
static inline float vl_spread_at(const vlEmitted *e, float cosine) {
  if (!vl_has_spread(e))
    return 1.0f;
  float c = vl_max(cosine, 1e-6f);
  float tangent = vl_safe_sqrt(1.0f - c * c) / c;
  return vl_max(0.0f, 1.0f - tangent * e->spread_cot) * e->spread_scale;
}

/* Applies it to a radiance. */
static inline void vl_spread_radiance(const vlEmitted *e, float cosine, float radiance[4]) {
  if (!vl_has_spread(e))
    return;
  float share = vl_spread_at(e, cosine);
  for (int c = 0; c < 4; c++)
    radiance[c] *= share;
}

#endif
