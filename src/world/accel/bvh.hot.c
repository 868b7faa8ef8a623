/* world/accel/bvh.hot.c: rays through the trees of bvh.h.
 *
 * Triangles: Pluecker coordinates relative to the ray's origin (as Embree's robust intersector;
 * Davidovic et al. 2012, "3D rasterization: a bridge between rasterization and ray tracing").
 * Its sums and products are computed in the order in which Embree computes them without fused
 * multiply-add, so that a ray hits the same triangles. */
#include <math.h>

#include "math/vec.h"
#include "world/accel/bvh.h"
#include "world/accel/local_ray.h"
#include "world/accel/nearest.h"
#include "world/accel/occluders.h"

enum { W = VL_BVH_WIDTH, F = VL_BVH_FOUR };

/* A ray in the space of a tree. */
typedef struct Ray {
  float o[3], d[3];
  /* origins for the sides of boxes where the ray enters, and where it leaves */
  float near[3], far[3];
  float inverse[3]; /* 1 / d; d is at least 1e-18 */
  int side[3];      /* row of vlBvhBoxes that a ray meets first */
} Ray;

/* A ray's way through the world. */
typedef struct Query {
  const vlWorld *world;
  const vlRays *rays;
  vlOccluders *occluders;
  uint32_t id;       /* of the ray */
  uint32_t instance; /* in which the ray is; VL_NONE: in none */
  float t_min, limit, time;
  vlNearest nearest; /* its instance is an index; VL_NONE for none */
} Query;

/* An entry of the stack: the tree below `child` begins at the distance `near`. */
typedef struct StackEntry {
  uintptr_t child;
  float near;
} StackEntry;

/* A triangle that the ray meets by its arithmetic may be beside its box by rounding errors,
 * which grow with the distance from the ray's origin. So boxes are wider by several such
 * errors. */
static Ray ray_of(const vlBvh *tree, const float o[3], const float d[3]) {
  Ray r;
  float far = vl_max(vl_max(fabsf(o[0]), fabsf(o[1])), fabsf(o[2]));
  for (int i = 0; i < 3; i++) {
    float slope = fabsf(d[i]) < 1e-18f ? 1e-18f : d[i], wide = 0x1p-21f * (far + tree->reach);
    r.o[i] = o[i];
    r.d[i] = d[i];
    r.inverse[i] = 1.0f / slope;
    r.near[i] = o[i] + (slope < 0.0f ? -wide : wide);
    r.far[i] = o[i] + (slope < 0.0f ? wide : -wide);
    r.side[i] = 2 * i + (slope < 0.0f);
  }
  return r;
}

/* Rays with NaN or a huge number in their direction, or from too far away, miss everything. */
static bool is_usual(const float o[3], const float d[3], float farthest) {
  for (int i = 0; i < 3; i++)
    if (!(fabsf(o[i]) < farthest) || !(fabsf(d[i]) < 0x1p120f))
      return false;
  return true;
}

/* Bits of children and triangles. (Not every instruction set shifts each lane by its own
 * number.) */
static const uint32_t bits[W] = {1, 2, 4, 8, 16, 32, 64, 128};

/* ---- boxes ------------------------------------------------------------------------------- */

/* The children whose boxes the ray meets, one bit each. begin: where. */
static inline uint32_t meet(const vlBvhBoxes *boxes, const Ray *r, float low, float high,
                            float begin[W]) {
  const float *x0 = (*boxes)[r->side[0]], *y0 = (*boxes)[r->side[1]],
              *z0 = (*boxes)[r->side[2]];
  const float *x1 = (*boxes)[r->side[0] ^ 1], *y1 = (*boxes)[r->side[1] ^ 1],
              *z1 = (*boxes)[r->side[2] ^ 1];
  float nx = r->near[0], ny = r->near[1], nz = r->near[2], fx = r->far[0], fy = r->far[1],
        fz = r->far[2];
  float x = r->inverse[0], y = r->inverse[1], z = r->inverse[2];
  uint32_t met = 0;
  /* must vectorise (32 bytes) */
  VL_SIMD for (uint32_t k = 0; k < W; k++) {
    float from =
        vl_max((x0[k] - nx) * x, vl_max((y0[k] - ny) * y, vl_max((z0[k] - nz) * z, low)));
    float to =
        vl_min((x1[k] - fx) * x, vl_min((y1[k] - fy) * y, vl_min((z1[k] - fz) * z, high)));
    begin[k] = from;
    met |= from <= to ? bits[k] : 0;
  }
  return met;
}

/* Boxes of a node at a time. They are wider than the rounding errors here (bvh_build.c). */
static inline void interpolate(const vlBvhNode *node, float time, vlBvhBoxes *to) {
  const float *from = node->boxes[0], *later = node->later[0][0];
  float *at = (*to)[0];
  /* must vectorise */
  VL_SIMD for (uint32_t k = 0; k < 6 * W; k++) at[k] =
      from[k] * (1.0f - time) + later[k] * time;
}

/* ---- triangles --------------------------------------------------------------------------- */

static inline float dot(float ax, float ay, float az, float bx, float by, float bz) {
  return ax * bx + (ay * by + az * bz);
}

/* Twice the volume of the origin, the edge from q to p, and the direction. */
static inline float side(float px, float py, float pz, float qx, float qy, float qz, float dx,
                         float dy, float dz) {
  float ex = px - qx, ey = py - qy, ez = pz - qz, sx = px + qx, sy = py + qy, sz = pz + qz;
  return dot(ey * sz - ez * sy, ez * sx - ex * sz, ex * sy - ey * sx, dx, dy, dz);
}

/* A component of the normal: of two cross products of edges a, b, c that with the smaller
 * products. */
static inline float normal(float ay, float az, float by, float bz, float cy, float cz) {
  float ab = az * by, bc = bz * cy;
  return fabsf(ab) < fabsf(bc) ? ay * bz - ab : by * cz - bc;
}

/* Which of four triangles the ray meets between low and high, one bit each. t: where. */
static inline uint32_t meet_four(const float c[3][3][F], const Ray *r, float low, float high,
                                 float t[F]) {
  float ox = r->o[0], oy = r->o[1], oz = r->o[2], dx = r->d[0], dy = r->d[1], dz = r->d[2];
  uint32_t met = 0;
  /* must vectorise (16 bytes) */
  VL_SIMD for (uint32_t k = 0; k < F; k++) {
    float ax = c[0][0][k] - ox, ay = c[0][1][k] - oy, az = c[0][2][k] - oz;
    float bx = c[1][0][k] - ox, by = c[1][1][k] - oy, bz = c[1][2][k] - oz;
    float cx = c[2][0][k] - ox, cy = c[2][1][k] - oy, cz = c[2][2][k] - oz;
    float u = side(cx, cy, cz, ax, ay, az, dx, dy, dz);
    float v = side(ax, ay, az, bx, by, bz, dx, dy, dz);
    float w = side(bx, by, bz, cx, cy, cz, dx, dy, dz);
    float wide = 0x1p-23f * fabsf(u + v + w);
    float min = vl_min(vl_min(u, v), w), max = vl_max(vl_max(u, v), w);
    float nx = normal(cy - ay, cz - az, ay - by, az - bz, by - cy, bz - cz);
    float ny = normal(cz - az, cx - ax, az - bz, ax - bx, bz - cz, bx - cx);
    float nz = normal(cx - ax, cy - ay, ax - bx, ay - by, bx - cx, by - cy);
    float speed = dot(nx, ny, nz, dx, dy, dz), height = dot(ax, ay, az, nx, ny, nz),
          at = height / speed;
    t[k] = at;
    int inside = (min >= -wide) | (max <= wide),
        crosses = (speed != 0.0f) & (fabsf(speed) < 0x1p127f);
    met |= inside & crosses & (low <= at) & (at <= high) ? bits[k] : 0;
  }
  return met;
}

static inline void offer(Query *q, float t, uint32_t geometry, uint32_t primitive) {
  vlNearest hit = {
      .t = t, .instance = q->instance, .geometry = geometry, .primitive = primitive};
  if (vl_nearest_offer(&q->nearest, &hit))
    q->limit = t * VL_NEAREST_WINDOW;
}

/* The shape of a primitive where the ray is; *prim becomes that of the shape. */
static const vlWorldShape *shape_of(const Query *q, uint32_t geometry, uint32_t *prim) {
  uint32_t group = q->instance == VL_NONE ? 0 : q->world->instances.items[q->instance].group;
  return vl_accel_group_shape(q->world, group, geometry, prim);
}

/* Takes the hit of a triangle. Returns whether it blocks the ray, if any does. */
static inline bool take(Query *q, uint32_t geometry, uint32_t primitive, float t, bool moving,
                        bool any) {
  bool asks = (geometry & VL_BVH_ASKS) != 0;
  geometry &= ~VL_BVH_ASKS;
  if (asks) {
    uint32_t prim = primitive;
    const vlWorldShape *shape = shape_of(q, geometry, &prim);
    if (vl_triangle_lets_pass(q->world, q->rays, q->id, q->instance, shape, prim, any))
      return false;
  }
  if (!any)
    offer(q, t, geometry, primitive);
  else if (q->occluders && !asks && !moving && q->instance == VL_NONE)
    vl_occluders_learn(q->occluders, geometry, primitive);
  return any;
}

/* Moves triangles to the ray's time. */
VL_NOINLINE void move(const Query *q, vlBvhFour *f) {
  for (uint32_t k = 0; k < F; k++) {
    uint32_t prim = f->primitive[k];
    const vlWorldShape *s = shape_of(q, f->geometry[k] & ~VL_BVH_ASKS, &prim);
    vl_bvh_put_corners(s, prim, q->time, f, k);
  }
}

/* Whether slot k only repeats the first. A surface with an alpha must not be crossed twice. */
static inline bool is_left_over(const vlBvhFour *f, int k) {
  return k > 0 && f->geometry[k] == f->geometry[0] && f->primitive[k] == f->primitive[0];
}

static inline bool meet_triangles(Query *q, const vlBvhFour *f, bool moving, const Ray *r,
                                  bool any) {
  vlBvhFour now;
  float t[F];
  if (moving) {
    now = *f;
    move(q, &now);
    f = &now;
  }
  for (uint32_t met = meet_four(f->corner, r, q->t_min, q->limit, t); met; met &= met - 1) {
    int k = __builtin_ctz(met);
    if (any && is_left_over(f, k))
      continue;
    if (take(q, f->geometry[k], f->primitive[k], t[k], moving, any))
      return true;
  }
  return false;
}

static bool meet_shape(Query *q, vlBvhItem at, bool any) {
  uint32_t prim = at.primitive;
  const vlWorldShape *shape = shape_of(q, at.geometry, &prim);
  double t;
  if (!vl_ray_meets_shape(q->world, q->rays, q->id, q->instance, shape, prim, any,
                          (double)q->t_min, (double)q->limit, &t))
    return false;
  if (!any)
    offer(q, (float)t, at.geometry, at.primitive);
  return any;
}

/* ---- trees ------------------------------------------------------------------------------- */

static bool walk(Query *q, const vlBvh *tree, const float o[3], const float d[3], bool any);

/* The ray in an instance, by the operations of Embree. */
static bool meet_instance(Query *q, const vlBvh *tree, uint32_t index, const Ray *r, bool any) {
  const vlWorldInstance *instance = &q->world->instances.items[index];
  const float *m = tree->maps[index];
  float moved[12], o[3], d[3];
  if (instance->keys) {
    float pose[12];
    vlTimeStep step = vl_time_step(q->time, instance->keys);
    const float *a = instance->path + 12 * (size_t)step.first, *b = a + 12;
    for (int i = 0; i < 12; i++)
      pose[i] = a[i] * (1.0f - step.part) + b[i] * step.part;
    vl_bvh_map(pose, moved);
    m = moved;
  }
  for (int i = 0; i < 3; i++, m += 4) {
    o[i] = r->o[0] * m[0] + (r->o[1] * m[1] + (r->o[2] * m[2] + m[3]));
    d[i] = r->d[0] * m[0] + (r->d[1] * m[1] + r->d[2] * m[2]);
  }
  q->instance = index;
  bool blocked = is_usual(o, d, __builtin_inff()) &&
                 walk(q, q->world->accel.groups[instance->group], o, d, any);
  q->instance = VL_NONE;
  return blocked;
}

static inline bool meet_leaf(Query *q, const vlBvh *tree, uintptr_t child, const Ray *r,
                             bool any) {
  vlBvhKind kind = vl_bvh_kind(child);
  if (kind != VL_BVH_OTHER)
    return meet_triangles(q, vl_bvh_at(child), kind == VL_BVH_FOUR_MOVING, r, any);
  const vlBvhItem *item = vl_bvh_at(child);
  return tree->maps ? meet_instance(q, tree, item->geometry, r, any)
                    : meet_shape(q, *item, any);
}

/* Puts the children that are met on the stack, the nearest last. */
static inline StackEntry *push(StackEntry *top, const vlBvhNode *node, uint32_t met,
                               const float begin[W], bool any) {
  StackEntry *base = top;
  for (; met; met &= met - 1) {
    int k = __builtin_ctz(met);
    StackEntry *at = top++;
    for (; !any && at > base && at[-1].near < begin[k]; at--)
      *at = at[-1];
    *at = (StackEntry){node->child[k], begin[k]};
  }
  return top;
}

/* A ray through a tree. Returns whether it is blocked, if any hit blocks it. */
static bool walk(Query *q, const vlBvh *tree, const float o[3], const float d[3], bool any) {
  StackEntry stack[VL_BVH_STACK], *top = stack;
  Ray r = ray_of(tree, o, d);
  if (tree->root)
    *top++ = (StackEntry){tree->root, 0.0f};
  while (top > stack) {
    StackEntry at = *--top;
    if (!any && at.near > q->limit)
      continue;
    if (vl_bvh_kind(at.child) != VL_BVH_NODE) {
      if (meet_leaf(q, tree, at.child, &r, any))
        return true;
      continue;
    }
    const vlBvhNode *node = vl_bvh_at(at.child);
    vlBvhBoxes now;
    float begin[W];
    if (tree->moves)
      interpolate(node, q->time, &now);
    uint32_t met = meet(tree->moves ? &now : &node->boxes, &r, q->t_min, q->limit, begin);
    top = push(top, node, met, begin, any);
  }
  return false;
}

/* Ray i through the shapes outside of groups, then through the instances. */
static bool trace(Query *q, uint32_t i, bool any) {
  const vlRays *rays = q->rays;
  float o[3] = {rays->ox[i], rays->oy[i], rays->oz[i]},
        d[3] = {rays->dx[i], rays->dy[i], rays->dz[i]};
  q->id = i;
  q->instance = VL_NONE;
  q->t_min = rays->t_min ? rays->t_min[i] : 0.0f;
  q->limit = rays->t_max ? rays->t_max[i] : __builtin_inff();
  q->time = rays->time ? rays->time[i] : 0.0f;
  q->nearest = (vlNearest){
      .t = __builtin_inff(), .instance = VL_NONE, .geometry = VL_NONE, .primitive = VL_NONE};
  if (!is_usual(o, d, 1.8e18f))
    return false;
  const vlBvh *trees[2] = {q->world->accel.groups[0], q->world->accel.scene};
  for (int k = 0; k < 2 && trees[k]; k++)
    if (walk(q, trees[k], o, d, any))
      return true;
  return false;
}

static void closest(const vlWorld *world, uint32_t n, const vlRays *rays, uint32_t *shape,
                    uint32_t *prim, uint32_t *instance, float *t) {
  Query q = {.world = world, .rays = rays};
  for (uint32_t i = 0; i < n; i++) {
    trace(&q, i, false);
    shape[i] = VL_NONE;
    prim[i] = q.nearest.primitive;
    q.instance = instance[i] = q.nearest.instance;
    t[i] = q.nearest.t;
    if (q.nearest.geometry == VL_NONE)
      continue;
    shape[i] = (uint32_t)(shape_of(&q, q.nearest.geometry, &prim[i]) - world->shapes.items);
  }
}

static void occluded(const vlWorld *world, uint32_t n, const vlRays *rays,
                     vlOccluders *occluders, uint8_t *blocked) {
  Query q = {.world = world, .rays = rays, .occluders = occluders};
  for (uint32_t i = 0; i < n; i++)
    if (!blocked[i])
      blocked[i] = trace(&q, i, true);
}

const vlBvhKernels vl_bvh_kernel_table = {closest, occluded};
