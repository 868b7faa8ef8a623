/* light/coverage.hot.h: the alpha of an area light at a sampled point; private to the hot
 * files of trace/light. */
#ifndef LIGHT_COVERAGE_HOT_H
#define LIGHT_COVERAGE_HOT_H

#include "math/vec.h"
#include "world/world.h"

/* The light's alpha at p, in [0, 1]. It is the share of the radiance that leaves the shape at
 * p, and the probability that a ray hits the shape at p. n: geometric normal; u, v: surface
 * parameters, not used for triangles; weights: barycentric coordinates, used for triangles
 * only. */
static inline float vl_light_coverage(const vlWorld *world, const vlWorldLight *light, vlVec3 p,
                                      vlVec3 n, float u, float v, const float weights[3]) {
  const vlWorldShape *s = &world->shapes.items[light->shape];
  vlTextureCorner corner = {s, light->prim, {weights[0], weights[1], weights[2]}};
  vlTextureQuery at = {u, v, p, n, &corner};
  /* for triangles, the arguments u and v belong to the emission's image */
  if (s->triangles) {
    vlVec2 uv = vl_triangle_uv(s->uvs, s->indices + 3 * (size_t)light->prim, weights);
    at.u = uv.x;
    at.v = uv.y;
  }
  return vl_clamp(vl_texture_float_at(world, s->alpha, &at), 0.0f, 1.0f);
}

#endif
