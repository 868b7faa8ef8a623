/* trace/ground_truth/exact.h: the distance at which an exact ray meets a surface that its float
 * ray has hit: in double, from the ray and the surface itself. */
#ifndef TRACE_GROUND_TRUTH_EXACT_H
#define TRACE_GROUND_TRUTH_EXACT_H

#include "math/double3.h"
#include "shape/surface_point.h"
#include "trace/stages.h"
#include "world/moving.h"

typedef struct Exact {
  double x, y, z;
} Exact;
static inline Exact exact_sub(Exact a, Exact b) {
  return (Exact){a.x - b.x, a.y - b.y, a.z - b.z};
}
static inline Exact exact_cross(Exact a, Exact b) {
  return (Exact){a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
static inline double exact_dot(Exact a, Exact b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}

static inline Exact exact_corner(const vlWorldShape *s, const vlWorldInstance *q, float time,
                                 uint32_t vertex) {
  float room[3];
  const float *x = vl_vertex_at(s, vertex, time, room);
  if (!q)
    return (Exact){x[0], x[1], x[2]};
  const double own[3] = {x[0], x[1], x[2]};
  double r[3];
  vl_float_map_point(q->from_group, own, r);
  return (Exact){r[0], r[1], r[2]};
}

/* Distance to the plane of the triangle with these corners, clamped to the range of the
 * distances of its corners. At grazing angles the float ray that found the triangle and the
 * exact ray may differ so much that the exact ray meets the plane far outside the triangle.
 * otherwise: the distance where the ray does not meet the plane; NaN: the mean of the
 * corners'. */
VL_INLINE double exact_plane_distance(Exact x, Exact y, Exact z, Exact o, Exact d,
                                      double otherwise) {
  Exact a = exact_sub(x, o), b = exact_sub(y, o), c = exact_sub(z, o);
  Exact n = exact_cross(exact_sub(b, a), exact_sub(c, a));
  double along = exact_dot(d, n), t = exact_dot(a, n) / along;
  double ta = exact_dot(a, d), tb = exact_dot(b, d), tc = exact_dot(c, d);
  double low = ta < tb ? ta : tb, high = ta < tb ? tb : ta;
  low = low < tc ? low : tc;
  high = high > tc ? high : tc;
  double inside = t < low ? low : t;
  inside = inside > high ? high : inside;
  double without = otherwise == otherwise ? otherwise : (ta + tb + tc) / 3.0;
  return along != 0.0 && t - t == 0.0 ? inside : without;
}

static inline double exact_triangle_distance(const vlWorldShape *s, const vlWorldInstance *q,
                                             float time, uint32_t prim, Exact o, Exact d,
                                             double otherwise) {
  const uint32_t *f = s->indices + 3 * (size_t)prim;
  return exact_plane_distance(exact_corner(s, q, time, f[0]), exact_corner(s, q, time, f[1]),
                              exact_corner(s, q, time, f[2]), o, d, otherwise);
}

/* Distance at which the exact ray meets a curved shape, near the distance t that the float ray
 * found. */
static inline double exact_curved_distance(const vlWorldShape *s, const vlWorldInstance *q,
                                           uint32_t prim, Exact o, Exact d, double t) {
  double go[3] = {o.x, o.y, o.z}, gd[3] = {d.x, d.y, d.z};
  if (q)
    vl_ray_to_group(q, go, gd);
  vlShapeHit hit;
  /* At grazing angles rounding moves the intersection further, so the search interval grows in
   * four steps up to 1 / 64. */
  for (double reach = VL_REFIND; reach < 0.01; reach *= 32.0)
    if (vl_shape_intersect(s, prim, go, gd, t * (1.0 - reach),
                           t * (1.0 + reach) + VL_MIN_REFIND, &hit))
      return hit.t;
  return t;
}

/* o, d: the exact ray, world space; d has unit length. time: the world's. hit_t: vlHits.t, for
 * shapes other than triangles. otherwise: as of exact_plane_distance. */
static inline double vl_exact_distance(const vlWorld *world, float time, const double o[3],
                                       const double d[3], uint32_t shape, uint32_t prim,
                                       uint32_t instance, float hit_t, double otherwise) {
  const vlWorldShape *s = &world->shapes.items[shape];
  vlWorldInstance room;
  const vlWorldInstance *q =
      instance == VL_NONE ? NULL
                          : vl_instance_at(&world->instances.items[instance], time, &room);
  Exact from = {o[0], o[1], o[2]}, along = {d[0], d[1], d[2]};
  return s->triangles ? exact_triangle_distance(s, q, time, prim, from, along, otherwise)
                      : exact_curved_distance(s, q, prim, from, along, hit_t);
}

#endif
