/* world/accel/local_ray.h: rays transformed to the space of a group, and decisions about their
 * hits, in velo's own arithmetic, for both accelerators: Embree's own numbers differ between
 * instruction sets. */
#ifndef WORLD_ACCEL_LOCAL_RAY_H
#define WORLD_ACCEL_LOCAL_RAY_H

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

/* Whether ray i meets primitive prim of a shape of another kind between t_min and t_max, at a
 * point that does not let it pass, and at which distance. */
bool vl_ray_meets_shape(const vlWorld *world, const vlRays *rays, uint32_t i, uint32_t instance,
                        const vlWorldShape *shape, uint32_t prim, bool shadow, double t_min,
                        double t_max, double *t);

#endif
