/* world/accel/occluders.c: learns which triangles block most shadow rays. */
#include "world/accel/occluders.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "math/double3.h"
#include "math/hash.h"
#include "world/world.h"

/* Rays for which a worker learns, and then uses what it has learned, before it learns anew:
 * other parts of the image have other occluders. */
enum { LEARNING = 8192, USING = 16 * LEARNING };
/* A triangle is tested if it blocks at least one ray of so many: Embree needs about this many
 * times as long for a ray as the test of one triangle takes. */
enum { WORTH = 256 };

/* Geometry whose triangles Embree reports: opaque, and always in the same place (embree.c). */
static const vlWorldShape *shape_of(const vlWorld *world, uint32_t geometry) {
  return &world->shapes.items[world->groups.items[0].shapes[geometry]];
}

static void difference(const float *a, const float *b, double to[3]) {
  for (int i = 0; i < 3; i++)
    to[i] = (double)a[i] - (double)b[i];
}

/* False: the triangle is too small, or too thin, to be tested with certainty. The barycentric
 * coordinates of the point where a ray meets it are wrong by at most about 2^-16 distance /
 * height, here and in Embree, if the ray is as steep as the test demands (occluders.hot.c). */
static bool make_occluder(const vlOccluders *o, const vlWorldShape *s, uint32_t prim,
                          vlOccluder *to) {
  const uint32_t *f = s->indices + 3 * (size_t)prim;
  const float *corner[3];
  for (int k = 0; k < 3; k++)
    corner[k] = s->positions + 3 * (size_t)f[k];
  double edge[3][3], normal[3];
  for (int k = 0; k < 3; k++)
    difference(corner[(k + 1) % 3], corner[k], edge[k]);
  vl_cross3(edge[0], edge[1], normal);
  double twice_area = sqrt(vl_dot3(normal, normal)), longest = 0;
  for (int k = 0; k < 3; k++)
    longest = fmax(longest, sqrt(vl_dot3(edge[k], edge[k])));
  double inside = 0x1p-12 + 0x1p-14 * (double)o->reach * longest / twice_area;
  if (!(inside < 0x1p-3))
    return false;
  to->inside = (float)inside;
  for (int i = 0; i < 3; i++) {
    to->corner[i] = corner[0][i];
    to->normal[i] = (float)(normal[i] / twice_area);
    to->edge[0][i] = (float)(edge[0][i] / twice_area);
    to->edge[1][i] = (float)(-edge[2][i] / twice_area);
  }
  return true;
}

/* Within these limits no product of the test overflows or underflows. */
static bool is_usual(float radius) {
  return radius > 1e-6f && radius < 1e6f;
}

static void begin_learning(vlOccluders *o) {
  o->learns = true;
  o->rays = o->count = 0;
  memset(o->table, 0, sizeof o->table);
}

/* Sorts the table: the largest counts first. */
static int by_count(const void *a, const void *b) {
  const vlOccluderCount *x = a, *y = b;
  if (x->count != y->count)
    return x->count < y->count ? 1 : -1;
  if (x->geometry != y->geometry)
    return x->geometry < y->geometry ? -1 : 1;
  return x->prim < y->prim ? -1 : x->prim > y->prim;
}

static void end_learning(vlOccluders *o, const vlWorld *world) {
  qsort(o->table, VL_OCCLUDER_TABLE, sizeof *o->table, by_count);
  for (uint32_t k = 0; k < VL_OCCLUDER_TABLE && o->count < VL_OCCLUDERS; k++) {
    const vlOccluderCount *c = &o->table[k];
    if ((uint64_t)c->count * WORTH < o->rays)
      break;
    o->count += make_occluder(o, shape_of(world, c->geometry), c->prim, &o->faces[o->count]);
  }
  o->learns = false;
  o->rays = 0;
}

void vl_occluders_begin(vlOccluders *o, const vlWorld *world, uint32_t n) {
  if (o->world != world) {
    o->world = world;
    memcpy(o->center, world->center, sizeof o->center);
    o->reach = is_usual(world->radius) ? 2.0f * world->radius : 0.0f;
    begin_learning(o);
  } else if (o->learns && o->rays >= LEARNING) {
    end_learning(o, world);
  } else if (!o->learns && o->rays >= USING) {
    begin_learning(o);
  }
  o->rays += n;
}

void vl_occluders_learn(vlOccluders *o, uint32_t geometry, uint32_t prim) {
  enum { TRIES = 8 };
  uint32_t at = vl_hash3(geometry, prim, 0);
  for (uint32_t k = 0; k < TRIES; k++) {
    vlOccluderCount *c = &o->table[(at + k) & (VL_OCCLUDER_TABLE - 1)];
    if (c->count == 0)
      *c = (vlOccluderCount){geometry, prim, 0};
    if (c->geometry != geometry || c->prim != prim)
      continue;
    c->count++;
    return;
  }
}
