/* world/accel/local_ray.c: see local_ray.h. */
#include "world/accel/local_ray.h"

#include "math/hash.h"
#include "world/accel/crossed.h"
#include "world/moving.h"

vlLocalRay vl_local_ray(const vlWorld *world, const vlRays *r, uint32_t i, uint32_t instance) {
  vlLocalRay q = {instance,
                  r->time ? r->time[i] : 0,
                  {r->ox[i], r->oy[i], r->oz[i]},
                  {r->dx[i], r->dy[i], r->dz[i]},
                  {r->ox[i], r->oy[i], r->oz[i]},
                  {r->dx[i], r->dy[i], r->dz[i]}};
  if (instance != VL_NONE) {
    vlWorldInstance moved;
    vl_ray_to_group(vl_instance_at(&world->instances.items[instance], q.time, &moved), q.o,
                    q.d);
  }
  return q;
}

static float ray_hash(const vlLocalRay *r, uint32_t shape, uint32_t prim, float t) {
  uint32_t h = vl_hash2(vl_hash2(shape, prim), r->instance);
  for (int i = 0; i < 3; i++) {
    h = vl_hash2(h, vl_float_bits(r->world_o[i]));
    h = vl_hash2(h, vl_float_bits(r->world_d[i]));
  }
  return vl_unit_float(vl_hash2(h, vl_float_bits(t)));
}

/* Textures are placed in the world (vlTextureDef.texture_from_world). */
static vlTextureQuery world_query(const vlWorld *world, const vlLocalRay *r,
                                  const vlTextureQuery *at) {
  vlTextureQuery q = *at;
  vlWorldInstance moved;
  if (r->instance == VL_NONE)
    return q;
  const vlWorldInstance *instance =
      vl_instance_at(&world->instances.items[r->instance], r->time, &moved);
  q.p = vl_affine_point(instance->from_group, at->p);
  q.n = vl_affine_normal(instance->to_group, at->n);
  return q;
}

/* Whether ray i, which is r in the space of the group, passes through a shape because of the
 * shape's alpha. A shadow ray passes wherever some light does, and notes how much. Else a hash
 * of ray and primitive decides, so that the result does not depend on the order of traversal.
 * t: distance of the hit; it enters the hash for shapes that a ray can intersect twice, so that
 * each hit is decided separately; 0 for triangles. at: the point of the hit, in the space of
 * the ray's group. */
static bool alpha_passes(const vlWorld *world, const vlRays *rays, uint32_t i, bool shadow,
                         const vlWorldShape *shape, const vlLocalRay *r, uint32_t prim, float t,
                         const vlTextureQuery *at) {
  const vlTextureQuery q = world_query(world, r, at);
  const float alpha = vl_texture_float_at(world, shape->alpha, &q);
  if (shadow && rays->crossed)
    return vl_cross_surface(alpha, &rays->crossed[i]);
  return ray_hash(r, (uint32_t)(shape - world->shapes.items), prim, t) >= alpha;
}

bool vl_local_triangle(const vlWorldShape *s, uint32_t prim, const vlLocalRay *r,
                       vlTextureQuery *at, float b[3]) {
  const uint32_t *f = s->indices + 3 * (size_t)prim;
  vlVec3 ray_o = vl_vec3((float)r->o[0], (float)r->o[1], (float)r->o[2]);
  vlVec3 ray_d = vl_vec3((float)r->d[0], (float)r->d[1], (float)r->d[2]), c[3];
  float room[3][3];
  const float *corner[3];
  for (int k = 0; k < 3; k++) {
    const float *x = corner[k] = vl_vertex_at(s, f[k], r->time, room[k]);
    c[k] = vl_sub(vl_load3(x), ray_o);
  }
  float b0 = vl_dot(ray_d, vl_cross(c[1], c[2])), b1 = vl_dot(ray_d, vl_cross(c[2], c[0])),
        b2 = vl_dot(ray_d, vl_cross(c[0], c[1]));
  float sum = b0 + b1 + b2, inv = sum != 0 ? 1 / sum : 0;
  b0 *= inv;
  b1 *= inv;
  b2 *= inv;
  b[0] = b0;
  b[1] = b1;
  b[2] = b2;
  vlVec2 uv = vl_triangle_uv(s->uvs, f, b);
  at->u = uv.x;
  at->v = uv.y;
  float p[3];
  for (int i = 0; i < 3; i++)
    p[i] = b0 * corner[0][i] + b1 * corner[1][i] + b2 * corner[2][i];
  at->p = vl_load3(p);
  at->n = vl_cross(vl_sub(c[1], c[0]), vl_sub(c[2], c[0]));
  /* sum is the direction times the normal of the face order */
  return s->flip ? sum < 0 : sum > 0;
}

bool vl_triangle_lets_pass(const vlWorld *world, const vlRays *rays, uint32_t i,
                           uint32_t instance, const vlWorldShape *shape, uint32_t prim,
                           bool shadow) {
  if (shadow && shape->pass_shadow)
    return true;
  if (shape->alpha < 0 && !shape->one_sided)
    return false;
  vlTextureCorner corner = {.shape = shape, .prim = prim};
  vlTextureQuery at = {.corner = &corner};
  vlLocalRay r = vl_local_ray(world, rays, i, instance);
  bool behind = vl_local_triangle(shape, prim, &r, &at, corner.weights);
  if (behind && shape->one_sided)
    return true;
  return shape->alpha >= 0 && alpha_passes(world, rays, i, shadow, shape, &r, prim, 0, &at);
}

bool vl_shape_lets_pass(const vlWorld *world, const vlRays *rays, uint32_t i, uint32_t instance,
                        const vlWorldShape *shape, uint32_t prim, bool shadow,
                        const vlShapeHit *hit) {
  vlLocalRay r = vl_local_ray(world, rays, i, instance);
  vlSurfacePoint point;
  vl_shape_point(shape, prim, hit, &point);
  vlTextureQuery at = {point.uv[0], point.uv[1],
                       vl_vec3((float)point.p[0], (float)point.p[1], (float)point.p[2]),
                       vl_vec3((float)point.n[0], (float)point.n[1], (float)point.n[2]), NULL};
  return alpha_passes(world, rays, i, shadow, shape, &r, prim, (float)hit->t, &at);
}
