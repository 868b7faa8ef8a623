/* world/accel/local_ray.h: rays transformed to the space of a group, and decisions about their
 * hits, in velo's own arithmetic, for both accelerators: Embree's own numbers differ between
 * instruction sets. */
#ifndef WORLD_ACCEL_LOCAL_RAY_H
#define WORLD_ACCEL_LOCAL_RAY_H

#include <string.h>

#include "shape/surface_point.h"
#include "world/accel/accel.h"
#include "world/world.h"

typedef struct vlLocalRay {
  uint32_t instance;
  float time;
  float world_o[3], world_d[3];
  double o[3], d[3];
} vlLocalRay;

/* Ray i in the space of the instance's group; If instance is VL_NONE, in world space. */
vlLocalRay vl_local_ray(const vlWorld *world, const vlRays *rays, uint32_t i,
                        uint32_t instance);

/* Computes where the ray intersects triangle prim. `at` receives uv, position and normal (its
 * member corner is not set); b receives the barycentric coordinates. Returns true if the ray
 * comes from behind. */
bool vl_local_triangle(const vlWorldShape *s, uint32_t prim, const vlLocalRay *r,
                       vlTextureQuery *at, float b[3]);

/* Whether ray i passes through triangle prim where it meets it: because of the shape's alpha or
 * its one side, or, for shadow rays, because of an interface. instance: index, or VL_NONE. */
bool vl_triangle_lets_pass(const vlWorld *world, const vlRays *rays, uint32_t i,
                           uint32_t instance, const vlWorldShape *shape, uint32_t prim,
                           bool shadow);

/* Whether the alpha of a shape of another kind lets ray i pass at a hit. */
bool vl_shape_lets_pass(const vlWorld *world, const vlRays *rays, uint32_t i, uint32_t instance,
                        const vlWorldShape *shape, uint32_t prim, bool shadow,
                        const vlShapeHit *hit);

/* Whether ray i meets primitive prim of such a shape between t_min and t_max, at a point that
 * does not let it pass, and at which distance. */
static inline bool vl_ray_meets_shape(const vlWorld *world, const vlRays *rays, uint32_t i,
                                      uint32_t instance, const vlWorldShape *shape,
                                      uint32_t prim, bool shadow, double t_min, double t_max,
                                      double *t) {
  if (shadow && shape->pass_shadow)
    return false;
  double o[3] = {rays->ox[i], rays->oy[i], rays->oz[i]},
         d[3] = {rays->dx[i], rays->dy[i], rays->dz[i]};
  if (instance != VL_NONE) {
    vlLocalRay r = vl_local_ray(world, rays, i, instance);
    memcpy(o, r.o, sizeof o);
    memcpy(d, r.d, sizeof d);
  }
  vlShapeHit hit;
  while (vl_shape_intersect(shape, prim, o, d, t_min, t_max, &hit)) {
    if (shape->alpha >= 0 &&
        vl_shape_lets_pass(world, rays, i, instance, shape, prim, shadow, &hit)) {
      /* past this hit, by several thousand rounding errors of a double */
      t_min = hit.t * (1 + 1e-12);
      continue;
    }
    *t = hit.t;
    return true;
  }
  return false;
}

#endif
