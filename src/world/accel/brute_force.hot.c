/* world/accel/brute_force.hot.c: every ray against every primitive of a small world. Rays of a
 * block are tested against one face at a time; a few single rays are tested against many faces
 * at a time, by the same operations. */
#include "world/accel/brute_force.h"

#include "math/vec.h"
#include "shape/surface_point.h"

enum { BLOCK = 128, FEW_RAYS = 4, NO_HIT = -1 };

static inline vlVec3 at3(const float rows[3][VL_BRUTE_FACES], uint32_t j) {
  return vl_vec3(rows[0][j], rows[1][j], rows[2][j]);
}

/* On which side a ray passes an edge (vlBruteForce). m: moment of the ray, o x d relative to
 * the centre. */
static inline float side_of(vlVec3 edge, vlVec3 moment, vlVec3 d, vlVec3 m) {
  return vl_dot(d, moment) + vl_dot(m, edge);
}

/* Where a ray crosses the plane of a face: at the distance height / speed, in units of the
 * ray's direction; speed is not negative. speed 0: the ray does not cross the face. */
typedef struct Crossing {
  float height, speed;
} Crossing;

/* a, b, c, e: the sides on which the ray passes the edges. */
static inline Crossing cross(float a, float b, float c, float e, vlVec3 normal, vlVec3 corner,
                             float tolerance, vlVec3 o, vlVec3 d) {
  float min = vl_min(vl_min(a, b), vl_min(c, e)), max = vl_largest4(a, b, c, e);
  float speed = vl_dot(normal, d), height = vl_dot(normal, vl_sub(corner, o));
  float wide = tolerance * vl_abs(speed);
  int inside = (min >= -wide) | (max <= wide);
  Crossing at = {speed < 0.0f ? -height : height, inside ? vl_abs(speed) : 0.0f};
  return at;
}

/* The constants of a face. */
typedef struct Face {
  vlVec3 edge[4], moment[4], normal, corner;
  float tolerance;
} Face;

static Face face_at(const vlBruteForce *b, uint32_t j) {
  Face q = {
      .normal = at3(b->normal, j), .corner = at3(b->corner, j), .tolerance = b->tolerance[j]};
  for (int k = 0; k < 4; k++) {
    q.edge[k] = at3(b->edge[k], j);
    q.moment[k] = at3(b->moment[k], j);
  }
  return q;
}

static inline Crossing cross_face(Face q, vlVec3 o, vlVec3 d, vlVec3 m) {
  return cross(side_of(q.edge[0], q.moment[0], d, m), side_of(q.edge[1], q.moment[1], d, m),
               side_of(q.edge[2], q.moment[2], d, m), side_of(q.edge[3], q.moment[3], d, m),
               q.normal, q.corner, q.tolerance, o, d);
}

/* Whether the distance is above `low` and below near.height / near.speed. */
static inline int is_between(Crossing at, float low, Crossing near) {
  return (at.height > low * at.speed) & (at.height * near.speed < near.height * at.speed);
}

/* A block of rays. Unless they are few, the rows are padded with copies of the last ray. */
typedef struct Block {
  uint32_t n, padded;
  _Alignas(64) float ox[BLOCK], oy[BLOCK], oz[BLOCK], dx[BLOCK], dy[BLOCK], dz[BLOCK];
  _Alignas(64) float mx[BLOCK], my[BLOCK], mz[BLOCK]; /* moments */
  _Alignas(64) float low[BLOCK];                      /* start of the ray */
  /* the nearest crossing; at first the end of the ray */
  _Alignas(64) float height[BLOCK], speed[BLOCK];
  _Alignas(64) int32_t id[BLOCK];
} Block;

/* Rays first to first + n - 1. */
static void load(Block *k, const vlBruteForce *b, const vlRays *r, uint32_t first, uint32_t n) {
  k->n = n;
  vlVec3 center = vl_load3(b->center);
  uint32_t padded = k->padded = n <= FEW_RAYS ? n : VL_PAD(n);
  float *const rows[8] = {k->ox, k->oy, k->oz, k->dx, k->dy, k->dz, k->low, k->height};
  vl_load_rays(r, first, n, padded, rows);
  for (uint32_t i = 0; i < padded; i++) {
    k->speed[i] = 1.0f;
    k->id[i] = NO_HIT;
  }
  /* must vectorise */
  VL_SIMD for (uint32_t i = 0; i < padded; i++) {
    vlVec3 m = vl_cross(vl_sub(vl_vec3(k->ox[i], k->oy[i], k->oz[i]), center),
                        vl_vec3(k->dx[i], k->dy[i], k->dz[i]));
    k->mx[i] = m.x;
    k->my[i] = m.y;
    k->mz[i] = m.z;
  }
}

/* The nearest crossing of each ray with face j, if it is nearer than that so far. any: only
 * marks the rays that the face blocks by id 0. */
VL_INLINE void cross_many(Block *k, const vlBruteForce *b, uint32_t j, bool any) {
  Face q = face_at(b, j);
  uint32_t padded = k->padded;
  const int32_t found = any ? 0 : (int32_t)j;
  /* must vectorise */
  VL_SIMD for (uint32_t i = 0; i < padded; i++) {
    Crossing at = cross_face(q, vl_vec3(k->ox[i], k->oy[i], k->oz[i]),
                             vl_vec3(k->dx[i], k->dy[i], k->dz[i]),
                             vl_vec3(k->mx[i], k->my[i], k->mz[i]));
    Crossing near = {k->height[i], any ? 1.0f : k->speed[i]};
    int nearer = is_between(at, k->low[i], near);
    k->id[i] = nearer ? found : k->id[i];
    if (!any) {
      k->height[i] = nearer ? at.height : near.height;
      k->speed[i] = nearer ? at.speed : near.speed;
    }
  }
}

/* The same for few rays: each against all faces, many at a time. */
static void cross_few(Block *k, const vlBruteForce *b, bool any) {
  _Alignas(64) float height[VL_BRUTE_FACES], speed[VL_BRUTE_FACES];
  uint32_t padded = VL_PAD(b->faces);
  for (uint32_t i = 0; i < k->n; i++) {
    vlVec3 o = vl_vec3(k->ox[i], k->oy[i], k->oz[i]), d = vl_vec3(k->dx[i], k->dy[i], k->dz[i]),
           m = vl_vec3(k->mx[i], k->my[i], k->mz[i]);
    /* must vectorise */
    VL_SIMD for (uint32_t j = 0; j < padded; j++) {
      Crossing at = cross(side_of(at3(b->edge[0], j), at3(b->moment[0], j), d, m),
                          side_of(at3(b->edge[1], j), at3(b->moment[1], j), d, m),
                          side_of(at3(b->edge[2], j), at3(b->moment[2], j), d, m),
                          side_of(at3(b->edge[3], j), at3(b->moment[3], j), d, m),
                          at3(b->normal, j), at3(b->corner, j), b->tolerance[j], o, d);
      height[j] = at.height;
      speed[j] = at.speed;
    }
    Crossing near = {k->height[i], k->speed[i]};
    for (uint32_t j = 0; j < b->faces; j++) {
      Crossing at = {height[j], speed[j]};
      if ((any && b->pass_shadow[j]) || !is_between(at, k->low[i], near))
        continue;
      k->id[i] = any ? 0 : (int32_t)j;
      if (any)
        break;
      near = at;
    }
    k->height[i] = near.height;
    k->speed[i] = near.speed;
  }
}

/* Which rays come near the bounding sphere of a primitive: 1. The bounds are wider than the
 * rounding errors, which grow with the distance. */
static void approach(const Block *k, const float sphere[4], int32_t *near) {
  vlVec3 c = vl_load3(sphere);
  uint32_t padded = k->padded;
  /* must vectorise */
  VL_SIMD for (uint32_t i = 0; i < padded; i++) {
    vlVec3 d = vl_vec3(k->dx[i], k->dy[i], k->dz[i]),
           w = vl_sub(c, vl_vec3(k->ox[i], k->oy[i], k->oz[i]));
    float away = vl_length2(w), radius2 = 1.002f * sphere[3] + 1e-10f * away;
    int meets = vl_length2(vl_cross(w, d)) <= radius2 * vl_length2(d);
    near[i] = meets & ((vl_dot(w, d) >= 0.0f) | (away <= radius2));
  }
}

/* Whether ray i, which meets the quadrilateral j, does so in its second triangle. */
static bool is_second(const Block *k, const vlBruteForce *b, uint32_t j, uint32_t i) {
  const float *e = b->diagonal_edge[j], *m = b->diagonal_moment[j];
  vlVec3 d = vl_vec3(k->dx[i], k->dy[i], k->dz[i]);
  float side = side_of(vl_load3(e), vl_load3(m), d, vl_vec3(k->mx[i], k->my[i], k->mz[i]));
  float facing = vl_dot(at3(b->normal, j), d);
  return facing < 0.0f ? side < 0.0f : side > 0.0f;
}

static bool meets_other(const Block *k, const vlWorldShape *s, uint32_t prim, uint32_t i,
                        float t_max, double *t) {
  double o[3] = {k->ox[i], k->oy[i], k->oz[i]}, d[3] = {k->dx[i], k->dy[i], k->dz[i]};
  vlShapeHit hit;
  if (!vl_shape_intersect(s, prim, o, d, k->low[i], t_max, &hit))
    return false;
  *t = hit.t;
  return true;
}

/* What the rays of a block meet: the ids of the nearest crossings, and their distances in
 * `height`. any: id 0 for the rays that something blocks. */
VL_INLINE void meet(const vlWorld *world, const vlBruteForce *b, Block *k, bool any) {
  _Alignas(64) int32_t near[BLOCK];
  if (k->n <= FEW_RAYS)
    cross_few(k, b, any);
  else
    for (uint32_t j = 0; j < b->faces; j++)
      if (!any || !b->pass_shadow[j])
        cross_many(k, b, j, any);
  for (uint32_t i = 0; i < k->n; i++)
    k->height[i] /= k->speed[i];
  for (uint32_t id = b->faces; id < b->faces + b->others; id++) {
    double met;
    if (any && b->pass_shadow[id])
      continue;
    approach(k, b->sphere[id - b->faces], near);
    for (uint32_t i = 0; i < k->n; i++)
      if (near[i] && !(any && k->id[i] != NO_HIT) &&
          meets_other(k, &world->shapes.items[b->shape[id]], b->prim[id], i, k->height[i],
                      &met)) {
        k->height[i] = (float)met;
        k->id[i] = any ? 0 : (int32_t)id;
      }
  }
}

static void closest(const vlWorld *world, const vlBruteForce *b, uint32_t n, const vlRays *rays,
                    uint32_t *shape, uint32_t *prim, uint32_t *instance, float *t) {
  Block k;
  for (uint32_t first = 0; first < n; first += BLOCK) {
    load(&k, b, rays, first, n - first < BLOCK ? n - first : BLOCK);
    meet(world, b, &k, false);
    for (uint32_t i = 0; i < k.n; i++) {
      bool hit = k.id[i] != NO_HIT;
      uint32_t face = (uint32_t)k.id[i],
               second = hit && face < b->faces && b->pair[face] && is_second(&k, b, face, i);
      shape[first + i] = hit ? b->shape[k.id[i]] : VL_NONE;
      prim[first + i] = hit ? b->prim[k.id[i]] + second : VL_NONE;
      instance[first + i] = VL_NONE;
      t[first + i] = k.height[i];
    }
  }
}

static void occluded(const vlWorld *world, const vlBruteForce *b, uint32_t n,
                     const vlRays *rays, uint8_t *blocked) {
  Block k;
  for (uint32_t first = 0; first < n; first += BLOCK) {
    load(&k, b, rays, first, n - first < BLOCK ? n - first : BLOCK);
    meet(world, b, &k, true);
    for (uint32_t i = 0; i < k.n; i++)
      blocked[first + i] = k.id[i] != NO_HIT;
  }
}

const vlBruteForceKernels vl_brute_force_kernel_table = {closest, occluded};
