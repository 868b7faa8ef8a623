/* world/accel/local_ray.h: rays in the space of the group that they meet, and what is decided there in velo's own
 * arithmetic, for accel.c: Embree's own numbers differ between instruction sets. */
#ifndef WORLD_ACCEL_LOCAL_RAY_H
#define WORLD_ACCEL_LOCAL_RAY_H

#include "world/accel/accel.h"
#include "world/shape/surface_point.h"
#include "world/world.h"

typedef struct vlLocalRay {
  uint32_t instance;
  float time;
  float world_o[3], world_d[3];
  double o[3], d[3];
} vlLocalRay;

/* Ray i in the space of the instance's group; VL_NONE: of the world. */
vlLocalRay vl_local_ray(const vlWorld *world, const vlRays *rays, uint32_t i, uint32_t instance);

/* Whether a shape lets the ray through, by a hash of ray and primitive, so that the order of traversal does not matter.
 * t: of shapes that a ray can meet twice, so that each crossing is decided for itself; 0 of triangles. */
bool vl_alpha_passes(const vlWorld *world, const vlWorldShape *shape, const vlLocalRay *ray, uint32_t prim, float t,
                     const vlTextureQuery *at);

/* Where the ray meets triangle prim: uv, position and normal (at, its corner excepted), and the weights of the
 * triangle's corners. true: from behind. */
bool vl_local_triangle(const vlWorldShape *s, uint32_t prim, const vlLocalRay *r, vlTextureQuery *at, float b[3]);

#endif
