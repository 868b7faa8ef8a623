/* world/accel/packet_rays.h: packets of rays in Embree's layout, filled from rows. It needs no
 * header of Embree. */
#ifndef WORLD_ACCEL_PACKET_RAYS_H
#define WORLD_ACCEL_PACKET_RAYS_H

#include <math.h>
#include <stdint.h>
#include <string.h>

#include "world/accel/nearest_packet.h"

/* Embree's accessors for packets of any size exist in C++ only. These are the rows of a packet
 * of N rays in the layout of Embree's manual: row k holds N values. */
enum {
  ORIGIN = 0,
  TNEAR = 3,
  DIRECTION = 4,
  TIME = 7,
  TFAR = 8,
  MASK = 9,
  ID = 10,
  FLAGS = 11,
  NORMAL = 0,
  PRIM = 5,
  GEOM = 6,
  INST = 7,
  HIT = 12
};
static inline float *ray_row(void *ray, unsigned n, int row, unsigned i) {
  return (float *)ray + (size_t)row * n + i;
}
static inline unsigned *hit_row(void *hit, unsigned n, int row, unsigned i) {
  return (unsigned *)hit + (size_t)row * n + i;
}

/* Embree accepts neither NaN nor origins beyond its range, and may end the process. Such rays
 * miss everything. Only cameras, and media around them, can be that far away, because the
 * extent of the world is limited (shapes.c); directions that are NaN come from cameras whose
 * numbers are too large for a double. */
#define VL_RAY_FAR 1.8e18f
static inline bool vl_ray_is_sound(const vlRays *r, uint32_t i) {
  const float far = VL_RAY_FAR;
  bool near = fabsf(r->ox[i]) < far && fabsf(r->oy[i]) < far && fabsf(r->oz[i]) < far;
  bool turned = fabsf(r->dx[i]) < far && fabsf(r->dy[i]) < far && fabsf(r->dz[i]) < far;
  bool from = !r->t_min || r->t_min[i] >= 0.0f;
  bool to = !r->t_max || r->t_max[i] == r->t_max[i];
  return near && turned && from && to;
}

/* Whether all of n rays are sound: loops that vectorise. */
static inline bool vl_rays_are_sound(const vlRays *r, uint32_t n) {
  const float far = VL_RAY_FAR, *const rows[6] = {r->ox, r->oy, r->oz, r->dx, r->dy, r->dz};
  int unsound = 0;
  for (int j = 0; j < 6; j++)
    for (uint32_t i = 0; i < n; i++)
      unsound |= !(fabsf(rows[j][i]) < far);
  for (uint32_t i = 0; r->t_min && i < n; i++)
    unsound |= !(r->t_min[i] >= 0.0f);
  for (uint32_t i = 0; r->t_max && i < n; i++)
    unsound |= r->t_max[i] != r->t_max[i];
  return !unsound;
}

/* Whether all rays of a packet are sound. The bits of positive numbers are in their order, and
 * those of NaN behind all others. */
static inline bool vl_packet_is_sound(void *q) {
  const int axes[6] = {ORIGIN, ORIGIN + 1, ORIGIN + 2, DIRECTION, DIRECTION + 1, DIRECTION + 2};
  const float far = VL_RAY_FAR, *from = ray_row(q, VL_PACKET, TNEAR, 0),
              *to = ray_row(q, VL_PACKET, TFAR, 0);
  int32_t limit, max[VL_PACKET] = {0}, bits[VL_PACKET];
  memcpy(&limit, &far, sizeof limit);
  for (int j = 0; j < 6; j++) {
    memcpy(bits, ray_row(q, VL_PACKET, axes[j], 0), sizeof bits);
    for (int k = 0; k < VL_PACKET; k++) {
      int32_t size = bits[k] & INT32_MAX;
      max[k] = max[k] > size ? max[k] : size;
    }
  }
  int wrong = 0;
  VL_SIMD
  for (int k = 0; k < VL_PACKET; k++)
    wrong |= (max[k] >= limit) | !(from[k] >= 0.0f) | (to[k] != to[k]);
  return !wrong;
}

/* A ray that hits nothing in place of lane k. Embree may check lanes that are not valid. */
static inline void vl_packet_take_out(void *q, int valid[VL_PACKET], uint32_t k) {
  valid[k] = 0;
  for (int j = 0; j < 3; j++) {
    *ray_row(q, VL_PACKET, ORIGIN + j, k) = 0.0f;
    *ray_row(q, VL_PACKET, DIRECTION + j, k) = 1.0f;
  }
  *ray_row(q, VL_PACKET, TNEAR, k) = *ray_row(q, VL_PACKET, TFAR, k) = INFINITY;
  *ray_row(q, VL_PACKET, TIME, k) = 0.0f;
}

static inline void vl_packet_copy_row(void *q, int row, const float *from) {
  memcpy(ray_row(q, VL_PACKET, row, 0), from, VL_PACKET * sizeof(float));
}

/* The rays of a packet that begins at `first` and of which all are there. */
static inline void vl_packet_fill_whole(void *q, int valid[VL_PACKET], const vlRays *r,
                                        uint32_t first) {
  static const float zeros[VL_PACKET];
  static const float infinities[VL_PACKET] = {INFINITY, INFINITY, INFINITY, INFINITY,
                                              INFINITY, INFINITY, INFINITY, INFINITY};
  vl_packet_copy_row(q, ORIGIN, r->ox + first);
  vl_packet_copy_row(q, ORIGIN + 1, r->oy + first);
  vl_packet_copy_row(q, ORIGIN + 2, r->oz + first);
  vl_packet_copy_row(q, DIRECTION, r->dx + first);
  vl_packet_copy_row(q, DIRECTION + 1, r->dy + first);
  vl_packet_copy_row(q, DIRECTION + 2, r->dz + first);
  vl_packet_copy_row(q, TNEAR, r->t_min ? r->t_min + first : zeros);
  vl_packet_copy_row(q, TFAR, r->t_max ? r->t_max + first : infinities);
  vl_packet_copy_row(q, TIME, r->time ? r->time + first : zeros);
  for (uint32_t k = 0; k < VL_PACKET; k++) {
    valid[k] = -1;
    *hit_row(q, VL_PACKET, ID, k) = first + k;
  }
  if (vl_packet_is_sound(q))
    return;
  for (uint32_t k = 0; k < VL_PACKET; k++)
    if (!vl_ray_is_sound(r, first + k))
      vl_packet_take_out(q, valid, k);
}

/* One ray as lane k. */
static inline void vl_packet_put(void *q, const vlRays *r, uint32_t i, uint32_t k) {
  const float *const o[3] = {r->ox, r->oy, r->oz};
  const float *const d[3] = {r->dx, r->dy, r->dz};
  for (int j = 0; j < 3; j++) {
    *ray_row(q, VL_PACKET, ORIGIN + j, k) = o[j][i];
    *ray_row(q, VL_PACKET, DIRECTION + j, k) = d[j][i];
  }
  *ray_row(q, VL_PACKET, TNEAR, k) = r->t_min ? r->t_min[i] : 0.0f;
  *ray_row(q, VL_PACKET, TFAR, k) = r->t_max ? r->t_max[i] : INFINITY;
  *ray_row(q, VL_PACKET, TIME, k) = r->time ? r->time[i] : 0.0f;
}

/* What is the same for all packets of a call. q: RTCRay8. */
static inline void vl_packet_begin(void *q) {
  for (unsigned k = 0; k < VL_PACKET; k++) {
    *hit_row(q, VL_PACKET, MASK, k) = (unsigned)-1;
    *hit_row(q, VL_PACKET, FLAGS, k) = 0;
  }
}

/* Rays first to first + VL_PACKET - 1 of n as a packet. Lanes past the last ray, and rays that
 * Embree does not accept, are not valid. */
static inline void vl_packet_fill(void *q, int valid[VL_PACKET], const vlRays *r,
                                  uint32_t first, uint32_t n) {
  if (first + VL_PACKET <= n) {
    vl_packet_fill_whole(q, valid, r, first);
    return;
  }
  for (uint32_t k = 0; k < VL_PACKET; k++) {
    uint32_t i = first + k;
    valid[k] = -1;
    *hit_row(q, VL_PACKET, ID, k) = i;
    if (i < n && vl_ray_is_sound(r, i))
      vl_packet_put(q, r, i, k);
    else
      vl_packet_take_out(q, valid, k);
  }
}

#endif
