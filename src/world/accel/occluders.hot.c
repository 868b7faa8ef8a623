/* world/accel/occluders.hot.c: tests blocks of shadow rays against single triangles (Moeller
 * and Trumbore 1997, "Fast, minimum storage ray/triangle intersection", without its
 * division). */
#include "world/accel/occluders.h"
#include "math/vec.h"

enum { BLOCK = 128 };

/* A block of rays; the rows are padded with copies of the last ray. */
typedef struct Block {
  uint32_t padded;
  _Alignas(64) float ox[BLOCK], oy[BLOCK], oz[BLOCK], dx[BLOCK], dy[BLOCK], dz[BLOCK];
  _Alignas(64) float low[BLOCK], high[BLOCK]; /* the part of the ray that counts */
  _Alignas(64) float steep[BLOCK];            /* the least |d . normal| */
  _Alignas(64) int32_t blocked[BLOCK];
} Block;

/* A ray is steep enough if |d . normal| is at least STEEP |d|. Then the distance of a ray's
 * ends from the triangle's plane is wrong by at most about 2^-21 of the reach, here and in
 * Embree; it must be CLEAR times the reach. */
static const float STEEP = 0x1p-5f, CLEAR = 0x1p-17f;

/* Rays first to first + n - 1. A ray that begins too far away has no part that counts. */
static void load(Block *k, const vlOccluders *o, const vlRays *r, uint32_t first, uint32_t n) {
  vlVec3 center = vl_load3(o->center);
  float reach2 = o->reach * o->reach;
  uint32_t padded = k->padded = VL_PAD(n);
  float *const rows[8] = {k->ox, k->oy, k->oz, k->dx, k->dy, k->dz, k->low, k->high};
  vl_load_rays(r, first, n, padded, rows);
  /* must vectorise */
  VL_SIMD for (uint32_t i = 0; i < padded; i++) {
    vlVec3 d = vl_vec3(k->dx[i], k->dy[i], k->dz[i]),
           from = vl_sub(vl_vec3(k->ox[i], k->oy[i], k->oz[i]), center);
    k->steep[i] = STEEP * __builtin_sqrtf(vl_length2(d));
    k->high[i] = vl_length2(from) < reach2 ? k->high[i] : -1.0f;
    k->blocked[i] = 0;
  }
}

/* Marks the rays that a triangle blocks. clear: the least distance of a ray's ends from the
 * triangle's plane. */
static void test_face(Block *k, const vlOccluder *f, float clear) {
  vlVec3 corner = vl_load3(f->corner);
  vlVec3 normal = vl_load3(f->normal);
  vlVec3 e1 = vl_load3(f->edge[0]);
  vlVec3 e2 = vl_load3(f->edge[1]);
  float inside = f->inside;
  uint32_t padded = k->padded;
  /* must vectorise */
  VL_SIMD for (uint32_t i = 0; i < padded; i++) {
    vlVec3 d = vl_vec3(k->dx[i], k->dy[i], k->dz[i]),
           from = vl_sub(vl_vec3(k->ox[i], k->oy[i], k->oz[i]), corner);
    vlVec3 q = vl_cross(from, d);
    float facing = vl_dot(normal, d), sign = facing < 0.0f ? -1.0f : 1.0f,
          speed = sign * facing;
    float u = -sign * vl_dot(e2, q), v = sign * vl_dot(e1, q),
          height = -sign * vl_dot(normal, from);
    float min = inside * speed;
    int hit = (speed > k->steep[i]) & (u > min) & (v > min) & (u + v < speed - min) &
              (height > k->low[i] * speed + clear) & (height + clear < k->high[i] * speed);
    k->blocked[i] |= hit;
  }
}

static void test(const vlOccluders *o, uint32_t n, const vlRays *rays, uint8_t *blocked) {
  Block k;
  for (uint32_t first = 0; first < n; first += BLOCK) {
    uint32_t count = n - first < BLOCK ? n - first : BLOCK;
    load(&k, o, rays, first, count);
    for (uint32_t j = 0; j < o->count; j++)
      test_face(&k, &o->faces[j], CLEAR * o->reach);
    for (uint32_t i = 0; i < count; i++)
      blocked[first + i] = k.blocked[i] != 0;
  }
}

const vlOccluderKernels vl_occluder_kernel_table = {test};
