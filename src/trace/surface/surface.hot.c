/* trace/surface/surface.hot.c: computes surface points from ids. It does not use Embree's t, u,
 * v, which differ between instruction sets. For triangles, it gathers the corners and then runs
 * one vector loop. Other shapes are computed one by one by shape/surface_point.c. */
#include "math/double3.h"
#include "shape/surface_point.h"
#include "trace/stages.h"
#include "velo/shape.h"
#include "world/moving.h"

static inline float placing_error(const vlWorldInstance *q, const float *x) {
  return q->error[0] * vl_abs(x[0]) + q->error[1] * vl_abs(x[1]) + q->error[2] * vl_abs(x[2]) +
         q->error[3];
}
/* Stores corner k of lane i: a point or a normal. */
static inline void set_corner(float rows[9][VL_ROW_SIZE], int k, uint32_t i, vlVec3 v) {
  vl_set_lane3(rows[3 * k], rows[3 * k + 1], rows[3 * k + 2], i, v);
}

static inline void gather_triangle(const vlWorld *world, const vlHits *hits, uint32_t i,
                                   vlCorners *c) {
  const vlWorldShape *s = &world->shapes.items[hits->shape[i]];
  const uint32_t *f = s->indices + 3 * (size_t)hits->prim[i];
  uint32_t instance = hits->instance[i];
  c->error[i] = 0;
  c->flip[i] = s->flip ? -1.0f : 1.0f;
  for (int k = 0; k < 3; k++) {
    const float *x = s->positions + 3 * (size_t)f[k];
    const float *t = vl_corner_uv(s->uvs, f, k);
    for (int j = 0; j < 3; j++)
      c->p[3 * k + j][i] = x[j];
    c->uv[2 * k][i] = t[0];
    c->uv[2 * k + 1][i] = t[1];
    for (int j = 0; j < 3; j++)
      c->n[3 * k + j][i] = s->normals ? s->normals[3 * (size_t)f[k] + j] : 0.0f;
  }
  if (instance == VL_NONE)
    return;
  const vlWorldInstance *q = &world->instances.items[instance];
  if (q->keys || s->steps > 1)
    return;
  c->flip[i] = s->flip != q->mirrored ? -1.0f : 1.0f;
  for (int k = 0; k < 3; k++) {
    const float *x = s->positions + 3 * (size_t)f[k];
    set_corner(c->p, k, i, vl_affine_point(q->from_group, vl_load3(x)));
    c->error[i] = vl_max(c->error[i], placing_error(q, x));
    if (s->normals)
      set_corner(c->n, k, i,
                 vl_affine_normal(q->to_group, vl_load3(s->normals + 3 * (size_t)f[k])));
  }
}

/* Large meshes are not in the cache: what gather_triangle reads of later lanes is prefetched,
 * first the indices, then the vertices. */
enum { AHEAD = 8, LARGE_MESH = 4096 };
static inline bool in_large_mesh(const vlWorldShape *s) {
  return s->triangles && s->faces >= LARGE_MESH;
}
VL_INLINE void prefetch_indices(const vlWorld *world, const vlHits *hits, uint32_t i) {
  const vlWorldShape *s = &world->shapes.items[hits->shape[i]];
  if (in_large_mesh(s))
    __builtin_prefetch(s->indices + 3 * (size_t)hits->prim[i]);
}
VL_INLINE void prefetch_vertices(const vlWorld *world, const vlHits *hits, uint32_t i) {
  const vlWorldShape *s = &world->shapes.items[hits->shape[i]];
  if (!in_large_mesh(s))
    return;
  const uint32_t *f = s->indices + 3 * (size_t)hits->prim[i];
  for (int k = 0; k < 3; k++) {
    __builtin_prefetch(s->positions + 3 * (size_t)f[k]);
    if (s->normals)
      __builtin_prefetch(s->normals + 3 * (size_t)f[k]);
    if (s->uvs)
      __builtin_prefetch(s->uvs + 2 * (size_t)f[k]);
  }
}

/* Corners of a moving triangle at a time; normals are zero if it has none. */
typedef struct MovedTriangle {
  vlVec3 p[3], n[3];
  float error;
  bool mirrored;
} MovedTriangle;

static MovedTriangle move_triangle(const vlWorldShape *s, const vlWorldInstance *instance,
                                   uint32_t prim, float time) {
  const uint32_t *f = s->indices + 3 * (size_t)prim;
  vlWorldInstance room;
  const vlWorldInstance *q = instance ? vl_instance_at(instance, time, &room) : NULL;
  MovedTriangle r;
  r.error = 0;
  r.mirrored = q && q->mirrored;
  for (int k = 0; k < 3; k++) {
    float point_room[3], normal_room[3];
    const float *x = vl_vertex_at(s, f[k], time, point_room);
    const float *y = s->normals ? vl_normal_at(s, f[k], time, normal_room) : NULL;
    float error = s->steps > 1 ? vl_moving_vertex_error(s, f[k], time) : 0.0f;
    r.p[k] = vl_load3(x);
    r.n[k] = y ? vl_load3(y) : vl_vec3(0, 0, 0);
    if (q) {
      float size = 0;
      for (int i = 0; i < 9; i++)
        size = vl_max(size, vl_abs(q->from_group[i + i / 3]));
      r.p[k] = vl_affine_point(q->from_group, r.p[k]);
      error = placing_error(q, x) + 3.0f * size * error;
      if (y)
        r.n[k] = vl_affine_normal(q->to_group, r.n[k]);
    }
    r.error = vl_max(r.error, error);
  }
  return r;
}

static inline bool triangle_moves(const vlWorld *world, uint32_t shape, uint32_t instance) {
  return world->shapes.items[shape].steps > 1 ||
         (instance != VL_NONE && world->instances.items[instance].keys);
}

/* gather_triangle for moving shapes. */
static void gather_moving(const vlWorld *world, const vlHits *hits, float time, uint32_t i,
                          vlCorners *c) {
  const vlWorldShape *s = &world->shapes.items[hits->shape[i]];
  const vlWorldInstance *q =
      hits->instance[i] == VL_NONE ? NULL : &world->instances.items[hits->instance[i]];
  MovedTriangle r = move_triangle(s, q, hits->prim[i], time);
  for (int k = 0; k < 3; k++) {
    set_corner(c->p, k, i, r.p[k]);
    set_corner(c->n, k, i, r.n[k]);
  }
  c->error[i] = r.error;
  c->flip[i] = s->flip != r.mirrored ? -1.0f : 1.0f;
}

typedef struct TriangleUv {
  float u0, v0, u1, v1, u2, v2;
} TriangleUv;

typedef struct Triangle {
  vlVec3 p, g, n, u, v;
  float s, t, dist, offset, uv_scale, curvature;
} Triangle;

/* Selects each component, because a selection of structs would be compiled to a branch. */
static inline vlVec3 select3(bool which, vlVec3 a, vlVec3 b) {
  return vl_vec3(which ? a.x : b.x, which ? a.y : b.y, which ? a.z : b.z);
}

/* Scales v by the power of two that brings its largest component into [1, 2). Without this,
 * squares of cross products of tiny or huge triangles would leave the range of float. The
 * scaling is exact. */
static inline vlVec3 near_one(vlVec3 v) {
  float largest = vl_max(vl_max(vl_abs(v.x), vl_abs(v.y)), vl_abs(v.z));
  uint32_t exponent = vl_float_bits(largest) & 0x7f800000u;
  float scale = vl_bits_float(0x7f000000u - (exponent < 0x7e800000u ? exponent : 0x7e800000u));
  return vl_mul(v, scale);
}

/* The point at which a ray hits a triangle. Barycentric coordinates are ratios of volumes
 * spanned with the ray (signs as in Woop et al. 2013); points outside by rounding are clamped
 * to the edge. */
VL_INLINE Triangle triangle_point(vlVec3 o, vlVec3 d, vlVec3 p0, vlVec3 p1, vlVec3 p2,
                                  vlVec3 n0, vlVec3 n1, vlVec3 n2, TriangleUv uv,
                                  float corner_error, float flip) {
  vlVec3 a = vl_sub(p0, o), b = vl_sub(p1, o), c = vl_sub(p2, o);
  float b0 = vl_dot(d, vl_cross(b, c)), b1 = vl_dot(d, vl_cross(c, a)),
        b2 = vl_dot(d, vl_cross(a, b));
  float sum = b0 + b1 + b2;
  float sign = sum < 0.0f ? -1.0f : 1.0f;
  b0 = vl_max(b0 * sign, 0.0f);
  b1 = vl_max(b1 * sign, 0.0f);
  b2 = vl_max(b2 * sign, 0.0f);
  sum = b0 + b1 + b2;
  float inv = sum > 0.0f ? 1.0f / sum : 0.0f;
  b0 = sum > 0.0f ? b0 * inv : 1.0f;
  b1 = b1 * inv;
  b2 = b2 * inv;
  Triangle r;
  r.p = vl_add(vl_add(vl_mul(p0, b0), vl_mul(p1, b1)), vl_mul(p2, b2));
  vlVec3 e02 = vl_sub(p0, p2), e12 = vl_sub(p1, p2);
  vlVec3 cross = vl_cross(e02, e12);
  vlVec3 g = vl_normalize(near_one(cross));
  r.offset = vl_triangle_offset(g, r.p, p0, p1, p2, b0, b1, b2, corner_error);
  /* The distance to the triangle's plane. It does not depend on where in the plane p is, which
   * is uncertain in triangles that are thin and far away. */
  vlVec3 way = vl_sub(r.p, o);
  float along = vl_dot(way, d), steep = vl_dot(g, d), height = vl_dot(g, way);
  r.dist = vl_abs(steep) > 0.01f ? height / steep : along;
  vlVec3 ns = vl_add(vl_add(vl_mul(n0, b0), vl_mul(n1, b1)), vl_mul(n2, b2));
  float has_n = vl_length2(ns) > 0.0f ? 1.0f : 0.0f;
  /* Mean curvature, from the change of the normals along the three edges. */
  vlVec3 e01 = vl_sub(p0, p1), n02 = vl_sub(n0, n2), n12 = vl_sub(n1, n2), n01 = vl_sub(n0, n1);
  float k0 = vl_dot(n02, e02) / vl_max(vl_length2(e02), VL_MIN_NORMAL),
        k1 = vl_dot(n12, e12) / vl_max(vl_length2(e12), VL_MIN_NORMAL);
  float k2 = vl_dot(n01, e01) / vl_max(vl_length2(e01), VL_MIN_NORMAL);
  r.curvature = has_n > 0.0f ? (k0 + k1 + k2) / (3.0f * vl_length(ns)) : 0.0f;
  ns = vl_normalize(ns);
  /* The geometric normal is on the side of the vertex normals. Without vertex normals, vertex
   * order and flip decide. */
  float towards = vl_dot(g, ns) < 0.0f ? -1.0f : 1.0f;
  float side = has_n > 0.0f ? towards : flip;
  r.g = vl_mul(g, side);
  r.n = select3(has_n > 0.0f, ns, r.g);
  r.s = b0 * uv.u0 + b1 * uv.u1 + b2 * uv.u2;
  r.t = b0 * uv.v0 + b1 * uv.v1 + b2 * uv.v2;
  float u02 = uv.u0 - uv.u2, v02 = uv.v0 - uv.v2, u12 = uv.u1 - uv.u2, v12 = uv.v1 - uv.v2;
  float det = u02 * v12 - v02 * u12;
  float area2 = vl_length(cross);
  float inv_det = vl_abs(det) > VL_MIN_POSITIVE ? 1.0f / det : 0.0f;
  vlVec3 du = vl_mul(vl_sub(vl_mul(e02, v12), vl_mul(e12, v02)), inv_det);
  vlVec3 dv = vl_mul(vl_sub(vl_mul(e12, u02), vl_mul(e02, u12)), inv_det);
  /* Where the coordinates span no area, the tangent is the edge from the first corner to the
   * second: it turns with the triangle, as one made from the normal alone would not. */
  vlVec3 edge = vl_normalize(near_one(vl_sub(p1, p0)));
  float ok = vl_length2(du) > 0.0f ? 1.0f : 0.0f;
  r.u = select3(ok > 0.0f, du, edge);
  r.v = select3(ok > 0.0f, dv, vl_cross(r.g, edge));
  r.uv_scale = area2 > 0.0f ? __builtin_sqrtf(vl_abs(det) / area2) : 0.0f;
  return r;
}

/* Mean curvature from the derivatives of point and normal (Weingarten's equations). */
static float mean_curvature(const vlSurfacePoint *q) {
  const double *u = q->dpdu, *v = q->dpdv, *a = q->dndu, *b = q->dndv;
  double e = vl_dot3(u, u), f = vl_dot3(u, v), g = vl_dot3(v, v);
  double l = vl_dot3(a, u), n = vl_dot3(b, v), m = vl_dot3(a, v);
  double det = e * g - f * f;
  return det > 0 ? (float)(0.5 * (l * g - 2 * m * f + n * e) / det) : 0.0f;
}

static inline vlVec3 in_single(const double v[3]) {
  return vl_vec3((float)v[0], (float)v[1], (float)v[2]);
}

static void store_point(vlSurface *out, uint32_t i, const vlSurfacePoint *q, float t) {
  vlVec3 u = in_single(q->dpdu), v = in_single(q->dpdv);
  vl_set_row3(&out->p, i, in_single(q->p));
  vl_set_row3(&out->g, i, in_single(q->n));
  vl_set_row3(&out->n, i, in_single(q->ns));
  vl_set_row3(&out->dpdu, i, u);
  vl_set_row3(&out->dpdv, i, v);
  for (int k = 0; k < 3; k++) {
    out->dn[k][i] = (float)q->dndu[k];
    out->dn[3 + k][i] = (float)q->dndv[k];
  }
  out->curvature[i] = mean_curvature(q);
  out->u[i] = q->uv[0];
  out->v[i] = q->uv[1];
  out->t[i] = t;
  out->offset[i] = vl_point_offset(q);
  float area = vl_length(vl_cross(u, v));
  out->uv_scale[i] = area > 0.0f ? 1.0f / __builtin_sqrtf(area) : 0.0f;
}

/* Transforms a point of an instance's group to the world. */
static vlSurfacePoint point_in_world(const vlWorldInstance *q, const vlSurfacePoint *point) {
  double from[12], to[12];
  for (int i = 0; i < 12; i++) {
    from[i] = (double)q->from_group[i];
    to[i] = (double)q->to_group[i];
  }
  const float x[3] = {(float)point->p[0], (float)point->p[1], (float)point->p[2]};
  vlSurfacePoint r = *point;
  vl_map_point(from, point->p, r.p);
  vl_map_vector(from, point->dpdu, r.dpdu);
  vl_map_vector(from, point->dpdv, r.dpdv);
  vl_map_normal(to, point->dndu, r.dndu);
  vl_map_normal(to, point->dndv, r.dndv);
  vl_map_normal(to, point->n, r.n);
  vl_map_normal(to, point->ns, r.ns);
  for (int i = 0; i < 3; i++)
    r.error[i] = __builtin_fabs(from[4 * i]) * point->error[0] +
                 __builtin_fabs(from[4 * i + 1]) * point->error[1] +
                 __builtin_fabs(from[4 * i + 2]) * point->error[2] +
                 (double)placing_error(q, x);
  /* planes perpendicular to n that are off apart are off / length apart when transformed */
  double length = vl_normalize3(r.n);
  r.off /= length > 0 ? length : 1;
  double shading = vl_normalize3(r.ns);
  vl_normal_derivative(r.ns, shading, r.dndu);
  vl_normal_derivative(r.ns, shading, r.dndv);
  return r;
}

/* Computes the surface point of a sphere, disk, cylinder, patch or curve: intersects the shape
 * again in group space and transforms the point to world space. The same arithmetic computed
 * *t, which identifies the crossing. */
static vlSurfacePoint other_point(const vlWorld *world, float time, vlVec3 o, vlVec3 d,
                                  uint32_t shape, uint32_t prim, uint32_t instance, float *t) {
  const vlWorldShape *s = &world->shapes.items[shape];
  double go[3] = {o.x, o.y, o.z}, gd[3] = {d.x, d.y, d.z};
  vlWorldInstance room;
  const vlWorldInstance *q =
      instance == VL_NONE ? NULL
                          : vl_instance_at(&world->instances.items[instance], time, &room);
  if (q)
    vl_ray_to_group(q, go, gd);
  vlShapeHit hit;
  vlSurfacePoint point;
  if (vl_shape_intersect(s, prim, go, gd, *t * (1 - VL_REFIND),
                         *t * (1 + VL_REFIND) + VL_MIN_REFIND, &hit)) {
    *t = (float)hit.t;
    vl_shape_point(s, prim, &hit, &point);
  } else { /* cannot happen: the same ray hit it with the same arithmetic */
    double pdf;
    vl_shape_sample(s, prim, 0.5f, 0.5f, &point, &pdf);
  }
  return q ? point_in_world(q, &point) : point;
}

/* Vertex tangents (pbrt's S), interpolated. */
static void apply_tangents(const vlWorld *world, const vlHits *hits, float time, uint32_t i,
                           const vlCorners *c, vlSurface *out) {
  const vlWorldShape *s = &world->shapes.items[hits->shape[i]];
  const uint32_t *f = s->indices + 3 * (size_t)hits->prim[i];
  vlVec3 p = vl_row3(&out->p, i), k[3];
  for (int j = 0; j < 3; j++)
    k[j] = vl_corner(c->p, j, i);
  vlVec3 g = vl_cross(vl_sub(k[1], k[0]), vl_sub(k[2], k[0]));
  float total = vl_length2(g);
  if (!(total > 0.0f))
    return;
  float b1 = vl_dot(vl_cross(vl_sub(p, k[0]), vl_sub(k[2], k[0])), g) / total;
  float b2 = vl_dot(vl_cross(vl_sub(k[1], k[0]), vl_sub(p, k[0])), g) / total;
  float w[3] = {1.0f - b1 - b2, b1, b2};
  vlVec3 t = vl_vec3(0, 0, 0);
  for (int j = 0; j < 3; j++)
    t = vl_add(t, vl_mul(vl_load3(s->tangents + 3 * (size_t)f[j]), w[j]));
  bool mirrored = false;
  if (hits->instance[i] != VL_NONE) {
    vlWorldInstance room;
    const vlWorldInstance *q =
        vl_instance_at(&world->instances.items[hits->instance[i]], time, &room);
    mirrored = q->mirrored;
    t = vl_affine_vector(q->from_group, t);
  }
  if (!(vl_length2(t) > 0.0f))
    return;
  vlVec3 v = vl_cross(vl_row3(&out->n, i), t);
  if (s->tangent_signs && (s->tangent_signs[f[0]] < 0.0f) != mirrored)
    v = vl_neg(v);
  vl_set_row3(&out->dpdu, i, t);
  vl_set_row3(&out->dpdv, i, v);
}

/* Gathers the corners of the triangles that are hit. Returns whether other shapes are hit, too,
 * or meshes with tangents. */
static bool gather_corners(const vlWorld *world, uint32_t n, const vlPaths *paths,
                           const vlHits *hits, vlCorners *c) {
  bool others = false;
  for (uint32_t i = 0; i < n; i++) {
    if (i + 2 * AHEAD < n)
      prefetch_indices(world, hits, i + 2 * AHEAD); /* must prefetch */
    if (i + AHEAD < n)
      prefetch_vertices(world, hits, i + AHEAD); /* must prefetch */
    const vlWorldShape *s = &world->shapes.items[hits->shape[i]];
    if (s->triangles)
      gather_triangle(world, hits, i, c);
    if (world->moves && s->triangles &&
        triangle_moves(world, hits->shape[i], hits->instance[i]))
      gather_moving(world, hits, vl_path_time(paths, i), i, c);
    others = others || !s->triangles || s->tangents;
  }
  return others;
}

/* Points of lanes that hit shapes other than triangles. */
static void set_other_points(const vlWorld *world, uint32_t n, const vlPaths *paths,
                             const vlHits *hits, vlSurface *out) {
  for (uint32_t i = 0; i < n; i++) {
    if (world->shapes.items[hits->shape[i]].triangles)
      continue;
    vlVec3 o = vl_row3(&paths->o, i), d = vl_row3(&paths->d, i);
    float t = hits->t[i];
    vlSurfacePoint q = other_point(world, vl_path_time(paths, i), o, d, hits->shape[i],
                                   hits->prim[i], hits->instance[i], &t);
    store_point(out, i, &q, t);
  }
}

void vl_stage_surface(const vlWorld *world, uint32_t n, const vlPaths *paths,
                      const vlHits *hits, vlCorners *c, vlSurface *out) {
  const bool others = gather_corners(world, n, paths, hits, c);
  uint32_t padded = VL_PAD(n);
  /* must vectorise */
  VL_SIMD
  for (uint32_t i = 0; i < padded; i++) {
    vlVec3 o = vl_vec3(paths->o.x[i], paths->o.y[i], paths->o.z[i]),
           d = vl_vec3(paths->d.x[i], paths->d.y[i], paths->d.z[i]);
    TriangleUv uv = {c->uv[0][i], c->uv[1][i], c->uv[2][i],
                     c->uv[3][i], c->uv[4][i], c->uv[5][i]};
    Triangle r = triangle_point(o, d, vl_vec3(c->p[0][i], c->p[1][i], c->p[2][i]),
                                vl_vec3(c->p[3][i], c->p[4][i], c->p[5][i]),
                                vl_vec3(c->p[6][i], c->p[7][i], c->p[8][i]),
                                vl_vec3(c->n[0][i], c->n[1][i], c->n[2][i]),
                                vl_vec3(c->n[3][i], c->n[4][i], c->n[5][i]),
                                vl_vec3(c->n[6][i], c->n[7][i], c->n[8][i]), uv, c->error[i],
                                c->flip[i]);
    out->p.x[i] = r.p.x;
    out->p.y[i] = r.p.y;
    out->p.z[i] = r.p.z;
    out->g.x[i] = r.g.x;
    out->g.y[i] = r.g.y;
    out->g.z[i] = r.g.z;
    out->n.x[i] = r.n.x;
    out->n.y[i] = r.n.y;
    out->n.z[i] = r.n.z;
    out->dpdu.x[i] = r.u.x;
    out->dpdu.y[i] = r.u.y;
    out->dpdu.z[i] = r.u.z;
    out->dpdv.x[i] = r.v.x;
    out->dpdv.y[i] = r.v.y;
    out->dpdv.z[i] = r.v.z;
    out->u[i] = r.s;
    out->v[i] = r.t;
    out->t[i] = r.dist;
    out->offset[i] = r.offset;
    out->uv_scale[i] = r.uv_scale;
    out->curvature[i] = r.curvature;
  }
  if (others)
    set_other_points(world, n, paths, hits, out);
  for (uint32_t i = 0; i < padded; i++) {
    out->width[i] = vl_abs(paths->cone[i] + paths->spread[i] * out->t[i]);
    out->no_cosine[i] = 0.0f;
    out->side[i] = 0.0f;
  }
  if (world->images.count)
    vl_stage_footprints(n, paths, out);
  /* This runs after the footprints, which need the point's derivatives; tangents have another
   * length. */
  for (uint32_t i = 0; others && i < n; i++) {
    const vlWorldShape *s = &world->shapes.items[hits->shape[i]];
    if (s->triangles && s->tangents)
      apply_tangents(world, hits, vl_path_time(paths, i), i, c, out);
  }
}

/* Corners of one triangle of a world at a time; normals are zero if it has none. */
typedef struct OneTriangle {
  vlVec3 p[3], n[3];
  TriangleUv uv;
  float error, flip;
} OneTriangle;

static inline OneTriangle one_triangle(const vlWorld *world, float time, uint32_t shape,
                                       uint32_t prim, uint32_t instance) {
  const vlWorldShape *s = &world->shapes.items[shape];
  const uint32_t *f = s->indices + 3 * (size_t)prim;
  const vlWorldInstance *q = instance == VL_NONE ? NULL : &world->instances.items[instance];
  OneTriangle r;
  const float *uv[3];
  r.error = 0;
  for (int k = 0; k < 3; k++) {
    const float *x = s->positions + 3 * (size_t)f[k];
    r.p[k] = vl_load3(x);
    r.n[k] = vl_vec3(0, 0, 0);
    if (q) {
      r.p[k] = vl_affine_point(q->from_group, r.p[k]);
      r.error = vl_max(r.error, placing_error(q, x));
    }
    if (s->normals) {
      const float *y = s->normals + 3 * (size_t)f[k];
      r.n[k] = q ? vl_affine_normal(q->to_group, vl_load3(y)) : vl_load3(y);
    }
    uv[k] = vl_corner_uv(s->uvs, f, k);
  }
  if (world->moves && triangle_moves(world, shape, instance)) {
    MovedTriangle moving = move_triangle(s, q, prim, time);
    for (int k = 0; k < 3; k++) {
      r.p[k] = moving.p[k];
      r.n[k] = moving.n[k];
    }
    r.error = moving.error;
  }
  r.uv = (TriangleUv){uv[0][0], uv[0][1], uv[1][0], uv[1][1], uv[2][0], uv[2][1]};
  r.flip = s->flip != (q && q->mirrored) ? -1.0f : 1.0f;
  return r;
}

static vlPoint point_of(const vlSurfacePoint *q, float t) {
  vlPoint r;
  r.p = in_single(q->p);
  r.g = in_single(q->n);
  r.n = in_single(q->ns);
  r.u = q->uv[0];
  r.v = q->uv[1];
  r.t = t;
  r.offset = vl_point_offset(q);
  return r;
}

vlPoint vl_point_at_time(const vlWorld *world, float time, vlVec3 o, vlVec3 d, uint32_t shape,
                         uint32_t prim, uint32_t instance, float t_hit) {
  if (world->shapes.items[shape].triangles) {
    OneTriangle c = one_triangle(world, time, shape, prim, instance);
    Triangle t = triangle_point(o, d, c.p[0], c.p[1], c.p[2], c.n[0], c.n[1], c.n[2], c.uv,
                                c.error, c.flip);
    return (vlPoint){t.p, t.g, t.n, t.s, t.t, t.dist, t.offset};
  }
  vlSurfacePoint q = other_point(world, time, o, d, shape, prim, instance, &t_hit);
  return point_of(&q, t_hit);
}

/* Gathers the corners of triangles; the points of other shapes are complete. Returns the number
 * of triangles. */
static uint32_t gather_crossings(const vlWorld *world, const vlRays *rays,
                                 const uint32_t *lanes, uint32_t count, vlCrossings *x) {
  uint32_t triangles = 0;
  for (uint32_t k = 0; k < count; k++) {
    uint32_t i = lanes[k];
    float time = rays->time ? rays->time[i] : 0.0f;
    if (!world->shapes.items[x->shape[i]].triangles)
      continue;
    triangles++;
    OneTriangle c = one_triangle(world, time, x->shape[i], x->prim[i], x->instance[i]);
    for (int j = 0; j < 3; j++) {
      vl_set_lane3(x->corner[j][0], x->corner[j][1], x->corner[j][2], i, c.p[j]);
      vl_set_lane3(x->normal[j][0], x->normal[j][1], x->normal[j][2], i, c.n[j]);
    }
    x->error[i] = c.error;
    x->flip[i] = c.flip;
  }
  return triangles;
}

void vl_stage_crossings(const vlWorld *world, uint32_t n, const vlRays *rays,
                        const uint32_t *lanes, uint32_t count, vlCrossings *x) {
  uint32_t padded = VL_PAD(n), triangles = gather_crossings(world, rays, lanes, count, x);
  const TriangleUv no_uv = {0, 0, 1, 0, 1, 1};
  if (triangles) {
    /* must vectorise */
    VL_SIMD for (uint32_t i = 0; i < padded; i++) {
      vlVec3 o = vl_vec3(rays->ox[i], rays->oy[i], rays->oz[i]),
             d = vl_vec3(rays->dx[i], rays->dy[i], rays->dz[i]);
      Triangle r = triangle_point(
          o, d, vl_vec3(x->corner[0][0][i], x->corner[0][1][i], x->corner[0][2][i]),
          vl_vec3(x->corner[1][0][i], x->corner[1][1][i], x->corner[1][2][i]),
          vl_vec3(x->corner[2][0][i], x->corner[2][1][i], x->corner[2][2][i]),
          vl_vec3(x->normal[0][0][i], x->normal[0][1][i], x->normal[0][2][i]),
          vl_vec3(x->normal[1][0][i], x->normal[1][1][i], x->normal[1][2][i]),
          vl_vec3(x->normal[2][0][i], x->normal[2][1][i], x->normal[2][2][i]), no_uv,
          x->error[i], x->flip[i]);
      x->t[i] = r.dist;
      x->gx[i] = r.g.x;
      x->gy[i] = r.g.y;
      x->gz[i] = r.g.z;
      x->offset[i] = r.offset;
    }
  }
  for (uint32_t k = 0; triangles < count && k < count; k++) {
    uint32_t i = lanes[k];
    if (world->shapes.items[x->shape[i]].triangles)
      continue;
    vlVec3 o = vl_ray_origin(rays, i), d = vl_ray_direction(rays, i);
    float t = x->hit[i];
    vlSurfacePoint q = other_point(world, rays->time ? rays->time[i] : 0.0f, o, d, x->shape[i],
                                   x->prim[i], x->instance[i], &t);
    vlPoint at = point_of(&q, t);
    x->t[i] = at.t;
    vl_set_lane3(x->gx, x->gy, x->gz, i, at.g);
    x->offset[i] = at.offset;
  }
}
