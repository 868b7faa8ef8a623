/* world/accel/brute_force.c: finds the primitives of a small world and computes their
 * constants. */
#include "world/accel/brute_force.h"

#include <math.h>
#include <string.h>

#include "math/double3.h"
#include "world/world.h"

/* Within these limits no product of the kernels overflows or underflows. */
static bool has_usual_size(const vlWorld *world) {
  float largest = 0;
  for (int i = 0; i < 3; i++)
    largest = fmaxf(largest, fmaxf(fabsf(world->bounds_min[i]), fabsf(world->bounds_max[i])));
  return world->radius > 1e-6f && largest < 1e6f;
}

static bool is_eligible(const vlWorld *world) {
  if (world->instances.count > 0 || world->moves || world->has_one_sided ||
      !has_usual_size(world))
    return false;
  const vlWorldGroup *group = &world->groups.items[0];
  uint32_t triangles = 0, others = 0;
  for (uint32_t k = 0; k < group->count; k++) {
    const vlWorldShape *s = &world->shapes.items[group->shapes[k]];
    if (s->alpha >= 0)
      return false;
    *(s->triangles ? &triangles : &others) += s->faces;
    if (triangles > 2 * VL_BRUTE_FACES || others > VL_BRUTE_OTHERS)
      return false;
  }
  return true;
}

/* (q - p) x (r - q) . n: positive if the corner q of a polygon with the normal n is convex. */
static double turn(const double p[3], const double q[3], const double r[3], const double n[3]) {
  double in[3], out[3], across[3];
  vl_sub3(q, p, in);
  vl_sub3(r, q, out);
  vl_cross3(in, out, across);
  return vl_dot3(across, n);
}

/* A triangle or a quadrilateral while it is made. */
typedef struct Face {
  double corner[4][3];
  double normal[3]; /* of the first triangle, unit length, or 0 */
  int corners;
  double diagonal[2][3]; /* of a quadrilateral: ends of the edge between its triangles, in the
                            order in which the second triangle has them */
} Face;

static void corners_of(const vlWorldShape *s, uint32_t prim, double corner[3][3]) {
  for (int k = 0; k < 3; k++)
    for (int i = 0; i < 3; i++)
      corner[k][i] =
          s->positions[3 * (size_t)s->indices[3 * (size_t)prim + (size_t)k] + (size_t)i];
}

static Face triangle_face(const vlWorldShape *s, uint32_t prim) {
  Face f = {.corners = 3};
  corners_of(s, prim, f.corner);
  double one[3], two[3];
  vl_sub3(f.corner[1], f.corner[0], one);
  vl_sub3(f.corner[2], f.corner[0], two);
  vl_cross3(one, two, f.normal);
  vl_normalize3(f.normal);
  return f;
}

static bool same_point(const double a[3], const double b[3]) {
  return a[0] == b[0] && a[1] == b[1] && a[2] == b[2];
}

/* Whether the quadrilateral is plane, but for the rounding of its corners to floats, and
 * convex. */
static bool is_good_quadrilateral(const Face *f) {
  double size = 0, height = 0;
  for (int k = 0; k < 4; k++) {
    double from[3];
    vl_sub3(f->corner[k], f->corner[0], from);
    height = fmax(height, fabs(vl_dot3(from, f->normal)));
    for (int i = 0; i < 3; i++)
      size = fmax(size, fabs(f->corner[k][i]));
    if (!(turn(f->corner[k], f->corner[(k + 1) % 4], f->corner[(k + 2) % 4], f->normal) > 0))
      return false;
  }
  return height <= 0x1p-24 * size;
}

/* Adds the next triangle to a triangle, if both have an edge in common and make up a good
 * quadrilateral. */
static void extend(Face *f, const vlWorldShape *s, uint32_t prim) {
  double next[3][3];
  corners_of(s, prim, next);
  for (int k = 0; k < 3; k++)
    /* edge k of the first is edge j of the second, in the other direction */
    for (int j = 0; j < 3; j++) {
      if (!same_point(f->corner[k], next[(j + 1) % 3]) ||
          !same_point(f->corner[(k + 1) % 3], next[j]))
        continue;
      Face q = {.corners = 4};
      memcpy(q.normal, f->normal, sizeof q.normal);
      memcpy(q.corner[0], f->corner[k], sizeof q.corner[0]);
      memcpy(q.corner[1], next[(j + 2) % 3], sizeof q.corner[1]);
      memcpy(q.corner[2], f->corner[(k + 1) % 3], sizeof q.corner[2]);
      memcpy(q.corner[3], f->corner[(k + 2) % 3], sizeof q.corner[3]);
      memcpy(q.diagonal[0], next[j], sizeof q.diagonal[0]);
      memcpy(q.diagonal[1], next[(j + 1) % 3], sizeof q.diagonal[1]);
      if (is_good_quadrilateral(&q)) {
        *f = q;
        return;
      }
    }
}

/* Swapping the ends changes nothing but signs: differences and products of doubles are rounded
 * alike. */
static void make_edge(const vlBruteForce *b, const double from[3], const double to[3],
                      float edge[3], float moment[3]) {
  double p[3], q[3], across[3];
  for (int i = 0; i < 3; i++) {
    p[i] = from[i] - (double)b->center[i];
    q[i] = to[i] - (double)b->center[i];
  }
  vl_cross3(p, q, across);
  for (int i = 0; i < 3; i++) {
    edge[i] = (float)(q[i] - p[i]);
    moment[i] = (float)across[i];
  }
}

/* extent: radius of the world. */
static void add_face(vlBruteForce *b, const Face *f, float extent) {
  uint32_t at = b->faces++;
  float longest = 0;
  for (int k = 0; k < 4; k++) {
    float edge[3], moment[3];
    int from = k < f->corners ? k : f->corners - 1;
    make_edge(b, f->corner[from], f->corner[(from + 1) % f->corners], edge, moment);
    for (int i = 0; i < 3; i++) {
      b->edge[k][i][at] = edge[i];
      b->moment[k][i][at] = moment[i];
    }
    for (int i = 0; i < 3; i++)
      longest = fmaxf(longest, fabsf(edge[i]));
  }
  b->tolerance[at] = 0x1p-23f * extent * longest;
  for (int i = 0; i < 3; i++) {
    b->normal[i][at] = (float)f->normal[i];
    b->corner[i][at] = (float)f->corner[0][i];
  }
  b->pair[at] = f->corners == 4;
  if (b->pair[at])
    make_edge(b, f->diagonal[0], f->diagonal[1], b->diagonal_edge[at], b->diagonal_moment[at]);
}

/* Adds the triangles of a shape. False: there are too many. */
static bool add_triangles(vlBruteForce *b, const vlWorld *world, uint32_t shape) {
  const vlWorldShape *s = &world->shapes.items[shape];
  for (uint32_t prim = 0; prim < s->faces; prim++) {
    if (b->faces == VL_BRUTE_FACES)
      return false;
    b->shape[b->faces] = shape;
    b->prim[b->faces] = prim;
    b->pass_shadow[b->faces] = s->pass_shadow;
    Face f = triangle_face(s, prim);
    if (prim + 1 < s->faces)
      extend(&f, s, prim + 1);
    add_face(b, &f, world->radius);
    if (f.corners == 4)
      prim++;
  }
  return true;
}

static void add_other(vlBruteForce *b, const vlWorldShape *s, uint32_t face) {
  float low[3], high[3], *sphere = b->sphere[b->others++];
  vl_world_prim_bounds(s, face, low, high);
  double squared = 0;
  for (int i = 0; i < 3; i++) {
    sphere[i] = 0.5f * (low[i] + high[i]);
    double half = fmax((double)high[i] - (double)sphere[i], (double)sphere[i] - (double)low[i]);
    squared += half * half;
  }
  sphere[3] = (float)squared;
}

static void add_others(vlBruteForce *b, uint32_t shape, const vlWorldShape *s) {
  for (uint32_t prim = 0; prim < s->faces; prim++) {
    uint32_t id = b->faces + b->others;
    b->shape[id] = shape;
    b->prim[id] = prim;
    b->pass_shadow[id] = s->pass_shadow;
    add_other(b, s, prim);
  }
}

/* Adds all shapes, those of triangles first. False: there are too many faces. */
static bool add_shapes(vlBruteForce *b, const vlWorld *world) {
  const vlWorldGroup *group = &world->groups.items[0];
  for (uint32_t k = 0; k < group->count; k++) {
    uint32_t shape = group->shapes[k];
    if (world->shapes.items[shape].triangles && !add_triangles(b, world, shape))
      return false;
  }
  for (uint32_t k = 0; k < group->count; k++) {
    const vlWorldShape *s = &world->shapes.items[group->shapes[k]];
    if (!s->triangles)
      add_others(b, group->shapes[k], s);
  }
  return b->faces + VL_BRUTE_OTHER_COST * b->others <= VL_BRUTE_FACES;
}

vlResult vl_brute_force_make(const vlWorld *world, vlBruteForce **result) {
  *result = NULL;
  if (!is_eligible(world))
    return VL_OK;
  vlBruteForce *b = vl_alloc_zero(world->context, 1, sizeof *b);
  if (!b)
    return VL_ERROR_MEMORY;
  memcpy(b->center, world->center, sizeof b->center);
  if (add_shapes(b, world))
    *result = b;
  else
    vl_free(world->context, b);
  return VL_OK;
}
