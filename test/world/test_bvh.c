/* test_bvh.c: velo's own tree gives the hits of Embree with portable bits: random rays, rays
 * through corners and along edges, axes and planes, with ends near hits, in worlds of every
 * kind of shape and motion and of extreme sizes; the same bits for every instruction set and
 * number of threads; parts shared with a previous world.
 *
 * VELO_RAYS sets the number of rays of each case. */
#include <math.h>
#include <stdlib.h>
#include <string.h>
/* cmocka.h needs the headers above */

#include "bvh_worlds.h"
#include "math/double3.h"
#include "shape/surface_point.h"
#include "unit.h"
#include "velo/shape_kinds.h"
#include "world/accel/bvh.h"
#include "world/accel/local_ray.h"
#include "world/accel/nearest.h"
#include "world/moving.h"
#include "world/world.h"

enum { BATCH = 1024 };
#define EPSILON 0x1p-24 /* relative rounding error of a float */

/* ---- rays -------------------------------------------------------------------------------- */

static float o_[3][BATCH], d_[3][BATCH], start_[BATCH], end_[BATCH], time_[BATCH];
static const vlRays all_rays = {o_[0], o_[1],  o_[2], d_[0], d_[1],
                                d_[2], start_, end_,  time_, NULL};

typedef enum Way { ANYWHERE, CORNERS, EDGES, ALONG, AXES, WAYS } Way;
static const char *const way_names[WAYS] = {"anywhere", "through corners", "through edges",
                                            "along edges", "along axes"};

/* A point of a triangle of the world, at a time; corner: one of them; edge: on an edge. Places
 * of instances are left out, so that some rays meet nothing. */
static void point_of(const vlWorld *w, float time, int corner, bool edge, float p[3],
                     float along[3]) {
  static const vlWorldShape none = {.kind = VL_SHAPE_SPHERE};
  const vlWorldShape *s = w->shapes.count ? NULL : &none;
  for (uint32_t tries = 0;
       w->shapes.count && tries < 100 && (!s || s->kind != VL_SHAPE_TRIANGLES); tries++)
    s = &w->shapes.items[random_below((uint32_t)w->shapes.count)];
  float u = random_unit(), v = random_unit() * (1 - u);
  if (s->kind != VL_SHAPE_TRIANGLES) {
    for (int i = 0; i < 3; i++) {
      p[i] = w->center[i] + w->radius * random_signed();
      along[i] = random_signed();
    }
    return;
  }
  const uint32_t *f = s->indices + 3 * (size_t)random_below(s->faces);
  float room[3][3];
  const float *c[3];
  for (int k = 0; k < 3; k++)
    c[k] = vl_vertex_at(s, f[k], time, room[k]);
  if (edge)
    v = 0;
  if (corner >= 0) {
    u = corner == 1;
    v = corner == 2;
  }
  for (int i = 0; i < 3; i++) {
    p[i] = corner >= 0 ? c[corner][i]
                       : c[0][i] + u * (c[1][i] - c[0][i]) + v * (c[2][i] - c[0][i]);
    along[i] = c[1][i] - c[0][i];
  }
}

static void make_rays(const vlWorld *w, Way way) {
  for (uint32_t k = 0; k < BATCH; k++) {
    float from[3], to[3], along[3], other[3], length = powf(10, 3 * random_signed());
    if (w->radius > 1e8f)
      length *= 1e-3f; /* products of larger numbers lose digits in Embree's reciprocal, */
    if (w->radius < 1e-8f)
      length *= 1e3f; /* those of smaller ones have few digits */
    time_[k] = w->moves ? (random_unit() < 0.1f ? (float)random_below(2) : random_unit()) : 0;
    point_of(w, time_[k], way == CORNERS ? (int)random_below(3) : -1,
             way == EDGES || way == ALONG, to, along);
    point_of(w, time_[k], way == AXES ? 0 : -1, false, from, other);
    uint32_t axis = random_below(3);
    for (int i = 0; i < 3; i++) {
      if (random_unit() < 0.3f)
        from[i] = w->center[i] + 2 * w->radius * random_signed();
      o_[i][k] = from[i];
      d_[i][k] = (to[i] - from[i]) * length;
      if (way == ALONG) {
        o_[i][k] = to[i] - 3 * along[i];
        d_[i][k] = along[i];
      }
      if (way == AXES) {
        o_[i][k] = to[i];
        d_[i][k] = 0;
      }
    }
    if (way == AXES) {
      for (int i = 0; i < 3; i++)
        o_[i][k] += 1e-3f * w->radius * random_signed(); /* not in the face of a box */
      o_[axis][k] = w->center[axis] + 2 * w->radius;
      d_[axis][k] = -length;
    }
    start_[k] = random_unit() < 0.2f ? random_unit() / length : 0;
    end_[k] = random_unit() < 0.3f ? 2 * random_unit() / length : INFINITY;
  }
}

/* ---- comparison -------------------------------------------------------------------------- */

typedef struct Hits {
  uint32_t shape[BATCH], prim[BATCH], instance[BATCH];
  float t[BATCH];
  uint8_t blocked[BATCH];
} Hits;

static void trace(const vlWorld *w, bool coherent, Hits *h) {
  vl_accel_closest(w, BATCH, &all_rays, coherent, h->shape, h->prim, h->instance, h->t);
  vl_accel_occluded(w, BATCH, &all_rays, NULL, h->blocked);
}

static bool same_hit(const vlWorld *w, const Hits *a, const Hits *b, uint32_t k) {
  if (a->shape[k] != b->shape[k] || a->prim[k] != b->prim[k] ||
      a->instance[k] != b->instance[k])
    return false;
  if (a->shape[k] == VL_NONE || w->shapes.items[a->shape[k]].kind == VL_SHAPE_TRIANGLES)
    return true;
  return a->t[k] == b->t[k];
}

static const Case cases[] = {
    {.name = "plain", .size = 1, .plain = true},
    {.name = "tiny", .size = 1e-10f, .plain = true},
    {.name = "huge", .size = 1e10f, .plain = true},
    {.name = "alpha", .size = 1, .plain = true, .alpha = true},
    {.name = "moving", .size = 1, .plain = true, .moving = true},
    {.name = "moving, alpha", .size = 10, .moving = true, .alpha = true},
    {.name = "others", .size = 1, .others = true},
    {.name = "others, alpha", .size = 1, .plain = true, .others = true, .alpha = true},
    {.name = "instances", .size = 1, .plain = true, .placed = true},
    {.name = "instances of all",
     .size = 100,
     .plain = true,
     .moving = true,
     .others = true,
     .alpha = true,
     .placed = true},
    {.name = "moving instances", .size = 1, .plain = true, .travelling = true},
    {.name = "moving instances of all",
     .size = 1,
     .plain = true,
     .moving = true,
     .others = true,
     .alpha = true,
     .travelling = true},
};

static uint32_t batches(void) {
  const char *rays = getenv("VELO_RAYS");
  return rays ? (uint32_t)(strtoul(rays, NULL, 10) / (WAYS * BATCH)) + 1 : 20;
}

/* The triangle that a ray hits. */
typedef struct Met {
  bool is;
  double sine;  /* of the angle between ray and plane */
  double inner; /* the least barycentric coordinate of the point, less its uncertainty */
} Met;

static Met met_triangle(const vlWorld *w, const Hits *h, uint32_t k) {
  if (h->shape[k] == VL_NONE || w->shapes.items[h->shape[k]].kind != VL_SHAPE_TRIANGLES)
    return (Met){0};
  const vlWorldShape *s = &w->shapes.items[h->shape[k]];
  double o[3] = {(double)o_[0][k], (double)o_[1][k], (double)o_[2][k]};
  double d[3] = {(double)d_[0][k], (double)d_[1][k], (double)d_[2][k]}, n[3], c[3][3], side[3],
         sum = 0;
  vlWorldInstance moved;
  if (h->instance[k] != VL_NONE)
    vl_ray_to_group(vl_instance_at(&w->instances.items[h->instance[k]], time_[k], &moved), o,
                    d);
  for (size_t i = 0; i < 3; i++) {
    float room[3];
    const float *at = vl_vertex_at(s, s->indices[3 * (size_t)h->prim[k] + i], time_[k], room);
    for (int j = 0; j < 3; j++)
      c[i][j] = (double)at[j] - o[j];
  }
  for (int i = 0; i < 3; i++) {
    vl_cross3(c[(i + 1) % 3], c[(i + 2) % 3], n);
    side[i] = vl_dot3(n, d);
    sum += side[i];
  }
  for (int j = 0; j < 3; j++) {
    c[1][j] -= c[0][j];
    c[2][j] -= c[0][j];
  }
  vl_cross3(c[1], c[2], n);
  double twice_area = sqrt(vl_dot3(n, n)),
         longest = sqrt(fmax(vl_dot3(c[1], c[1]), vl_dot3(c[2], c[2])));
  double far = sqrt(vl_dot3(d, d)) * (double)h->t[k];
  return (Met){true, fabs(vl_dot3(n, d)) / (twice_area * sqrt(vl_dot3(d, d))),
               fmin(side[0] / sum, fmin(side[1] / sum, side[2] / sum)) -
                   1e-6 * (1 + far * longest / twice_area)};
}

/* The judge: what a ray meets, without a tree and in double, with bounds of the rounding errors
 * of the accelerators' arithmetic (bvh.hot.c). A hit is certain if these errors cannot undo it,
 * and possible if they can make it. */

typedef struct Verdict {
  double certain;  /* a hit that lets no ray pass is met no later than here; infinity: none is
                      certain */
  double first[4]; /* for each of the results: where its hit can be at the earliest; infinity:
                      it is none */
  bool possible;   /* any hit */
} Verdict;

/* The ray in a group, by the arithmetic of the accelerators. Returns a bound of the relative
 * error of the map's scale: packets of Embree sum the determinant of a moving instance in
 * another order. */
static double to_group(const vlWorld *w, uint32_t k, uint32_t instance, float o[3],
                       float d[3]) {
  float world_o[3], world_d[3], pose[12], map[12];
  for (int i = 0; i < 3; i++) {
    o[i] = world_o[i] = o_[i][k];
    d[i] = world_d[i] = d_[i][k];
  }
  if (instance == VL_NONE)
    return 0;
  const vlWorldInstance *at = &w->instances.items[instance];
  memcpy(pose, at->from_group, sizeof pose);
  if (at->keys) {
    vlTimeStep step = vl_time_step(time_[k], at->keys);
    const float *a = at->path + 12 * (size_t)step.first;
    for (int i = 0; i < 12; i++)
      pose[i] = a[i] * (1.0f - step.part) + a[i + 12] * step.part;
  }
  vl_bvh_map(pose, map);
  for (int i = 0; i < 3; i++) {
    const float *m = map + 4 * i;
    o[i] = world_o[0] * m[0] + (world_o[1] * m[1] + (world_o[2] * m[2] + m[3]));
    d[i] = world_d[0] * m[0] + (world_d[1] * m[1] + world_d[2] * m[2]);
  }
  double terms = 0; /* of the determinant, over the determinant */
  for (int i = 0; i < 3; i++)
    terms += fabs((double)pose[4 * i] * (double)map[i]);
  return at->keys ? 8 * EPSILON * terms : 0;
}

/* Distances at which a ray may meet a triangle with the corners c. Returns 0: it does not, 1:
 * it may, 2: it does. */
static int meets(const float *const c[3], const float o[3], const float d[3],
                 double scale_error, double at[2]) {
  double v[3][3], edge[3][3], n[3], u[3], reach = 0, longest = 0, far = 0, speed, height;
  double ray[3] = {(double)d[0], (double)d[1], (double)d[2]}, length = sqrt(vl_dot3(ray, ray));
  for (int k = 0; k < 3; k++) {
    for (int i = 0; i < 3; i++)
      v[k][i] = (double)c[k][i] - (double)o[i];
    reach = fmax(reach, sqrt(vl_dot3(v[k], v[k])));
    far = fmax(far, fabs((double)o[k]));
  }
  for (int k = 0; k < 3; k++) {
    for (int i = 0; i < 3; i++)
      edge[k][i] = v[(k + 1) % 3][i] - v[k][i];
    longest = fmax(longest, sqrt(vl_dot3(edge[k], edge[k])));
    vl_cross3(v[k], v[(k + 1) % 3], n);
    u[k] = 2 * vl_dot3(n, ray);
  }
  vl_cross3(edge[0], edge[1], n);
  speed = vl_dot3(n, ray);
  height = vl_dot3(n, v[0]);
  /* Corners relative to the origin are off by `near`, and their differences by a little
   * more. */
  double near = EPSILON * reach + 2 * scale_error * far;
  double beside = length * (8 * near * (reach + longest) + 32 * EPSILON * reach * longest);
  double slow = length * 16 * (near + EPSILON * longest) * longest,
         low = reach * slow + 8 * near * longest * longest;
  double wide = beside + 2 * EPSILON * fabs(u[0] + u[1] + u[2]);
  double min = fmin(u[0], fmin(u[1], u[2])), max = fmax(u[0], fmax(u[1], u[2]));
  if (min < -wide && max > wide)
    return 0;
  at[0] = -INFINITY;
  at[1] = INFINITY;
  if (fabs(speed) <= slow)
    return 1;
  double t = height / speed,
         error = (low + fabs(t) * slow) / (fabs(speed) - slow) + 8 * EPSILON * fabs(t);
  at[0] = t - error;
  at[1] = t + error;
  return min > beside || max < -beside ? 2 : 1;
}

static void judge_shape(const vlWorld *w, uint32_t k, uint32_t instance, uint32_t index,
                        bool shadow, const Hits *const results[3], Verdict *verdict) {
  const vlWorldShape *s = &w->shapes.items[index];
  float o[3], d[3];
  double scale_error = to_group(w, k, instance, o, d);
  for (uint32_t prim = 0; prim < s->faces; prim++) {
    double at[2] = {0, 0}, low = (double)start_[k], high = (double)end_[k];
    int met = 2;
    if (s->kind == VL_SHAPE_TRIANGLES) {
      float room[3][3];
      const float *c[3];
      for (size_t i = 0; i < 3; i++)
        c[i] = vl_vertex_at(s, s->indices[3 * (size_t)prim + i], time_[k], room[i]);
      met = meets(c, o, d, scale_error, at);
      if (met && vl_triangle_lets_pass(w, &all_rays, k, instance, s, prim, shadow))
        met = 0;
    } else { /* both call the same function */
      met = vl_ray_meets_shape(w, &all_rays, k, instance, s, prim, shadow, low, high, &at[0])
                ? 2
                : 0;
      at[1] = at[0] * (1 + 2 * EPSILON);
    }
    if (!met || at[1] < low || at[0] > high)
      continue;
    verdict->possible = true;
    if (met == 2 && at[0] >= low && at[1] <= high)
      verdict->certain = fmin(verdict->certain, at[1]);
    for (int r = 0; r < 3; r++)
      if (results[r]->shape[k] == index && results[r]->prim[k] == prim &&
          results[r]->instance[k] == instance)
        verdict->first[r] = at[0];
  }
}

/* Whether rounding decides what a ray meets: each of the results is one that exact arithmetic
 * allows. */
static bool is_undecided(const vlWorld *w, uint32_t k, bool shadow,
                         const Hits *const results[3]) {
  Verdict v = {.certain = INFINITY, .first = {INFINITY, INFINITY, INFINITY}};
  for (uint32_t n = 0; n <= w->instances.count; n++) {
    const vlWorldGroup *group = &w->groups.items[n ? w->instances.items[n - 1].group : 0];
    for (uint32_t i = 0; i < group->count; i++)
      judge_shape(w, k, n ? n - 1 : VL_NONE, group->shapes[i], shadow, results, &v);
  }
  if (shadow)
    return v.possible && v.certain == INFINITY;
  for (int r = 0; r < 3; r++) {
    if (results[r]->shape[k] == VL_NONE ? v.certain < INFINITY
                                        : !(v.first[r] <= v.certain * (1 + 4 * EPSILON)))
      return false;
  }
  return true;
}

static void differ(const char *name, const char *way, uint32_t k,
                   const Hits *const results[3]) {
  print_message("%s, %s: o %a %a %a d %a %a %a, %a to %a, time %a\n", name, way,
                (double)o_[0][k], (double)o_[1][k], (double)o_[2][k], (double)d_[0][k],
                (double)d_[1][k], (double)d_[2][k], (double)start_[k], (double)end_[k],
                (double)time_[k]);
  static const char *const names[] = {"Embree", "packets", "BVH"};
  for (int r = 0; r < 3; r++)
    print_message("%s: shape %d prim %d instance %d t %.9g blocked %d\n", names[r],
                  (int)results[r]->shape[k], (int)results[r]->prim[k],
                  (int)results[r]->instance[k], (double)results[r]->t[k],
                  results[r]->blocked[k]);
  fail();
}

static void hits_are_those_of_embree(void **state) {
  (void)state;
  for (size_t c = 0; c < sizeof cases / sizeof *cases; c++) {
    Made m = {0};
    make(&cases[c], &m, VL_ISA_AUTO, 2);
    unsigned floats = vl_accel_enter();
    for (Way way = ANYWHERE; way < WAYS; way++) {
      uint32_t rays = 0, met = 0, undecided = 0;
      for (uint32_t b = 0; b < batches(); b++) {
        static Hits hits[3];
        make_rays(m.worlds[0], way);
        trace(m.worlds[0], false, &hits[0]);
        trace(m.worlds[0], true, &hits[1]);
        trace(m.worlds[1], false, &hits[2]);
        for (uint32_t k = 0; k < BATCH; k++) {
          rays++;
          met += hits[2].shape[k] != VL_NONE;
          bool same = same_hit(m.worlds[0], &hits[0], &hits[2], k);
          /* Embree's packets do not compare all hits at the ray's very start. */
          if (hits[2].t[k] != 0)
            same = same && same_hit(m.worlds[0], &hits[1], &hits[2], k);
          bool same_shadow = hits[0].blocked[k] == hits[2].blocked[k];
          if (same && same_shadow)
            continue;
          undecided++;
          const Hits *results[3] = {&hits[0], &hits[hits[2].t[k] != 0 ? 1 : 0], &hits[2]};
          if ((!same && !is_undecided(m.worlds[0], k, false, results)) ||
              (!same_shadow && !is_undecided(m.worlds[0], k, true, results)))
            differ(cases[c].name, way_names[way], k, results);
        }
      }
      assert_true(met > rays / 20);
      if (way != ALONG && undecided > rays / 100)
        fail_msg("%s, %s: %u differences", cases[c].name, way_names[way], undecided);
      if (getenv("VELO_RAYS"))
        print_message("%s, %s: %u rays, %u hits, %u undecided\n", cases[c].name, way_names[way],
                      rays, met, undecided);
    }
    vl_accel_leave(floats);
    unmake(&m);
  }
}

/* A ray's end within a few units in the last place of a hit. The BVH finds it if its exact
 * distance is not beyond the end; Embree's distances are off by two units at most. */
static void ends_near_hits(void **state) {
  (void)state;
  for (size_t c = 0; c < sizeof cases / sizeof *cases; c++) {
    if (cases[c].others || cases[c].alpha)
      continue;
    Made m = {0};
    make(&cases[c], &m, VL_ISA_AUTO, 2);
    unsigned floats = vl_accel_enter();
    uint32_t tested = 0;
    for (uint32_t b = 0; b < batches(); b++) {
      static Hits first, hits[2];
      make_rays(m.worlds[0], ANYWHERE);
      for (uint32_t k = 0; k < BATCH; k++) {
        start_[k] = 0;
        end_[k] = INFINITY;
      }
      trace(m.worlds[1], false, &first);
      for (int step = -4; step <= 4; step++) {
        for (uint32_t k = 0; k < BATCH; k++) {
          float t = first.t[k];
          for (int s = 0; s != step; s += step > 0 ? 1 : -1)
            t = nextafterf(t, step > 0 ? INFINITY : 0);
          end_[k] = t;
        }
        for (int a = 0; a < 2; a++)
          trace(m.worlds[a], false, &hits[a]);
        for (uint32_t k = 0; k < BATCH; k++) {
          if (first.shape[k] == VL_NONE || !(first.t[k] > 0))
            continue;
          Met met = met_triangle(m.worlds[0], &first, k);
          if (met.sine < 0.05 || met.inner < 0)
            continue; /* its distance is less certain than some units */
          bool flat = d_[0][k] == 0 || d_[1][k] == 0 || d_[2][k] == 0;
          tested++;
          assert_int_equal(hits[1].blocked[k], step >= 0);
          assert_int_equal(
              hits[1].shape[k] == first.shape[k] && hits[1].prim[k] == first.prim[k],
              step >= 0);
          if (flat || (step > -4 && step < 4))
            continue;
          assert_int_equal(hits[0].blocked[k], step >= 0);
        }
      }
    }
    assert_true(tested > 1000);
    vl_accel_leave(floats);
    unmake(&m);
  }
}

/* Every set of kernels and number of threads gives the same tree and the same hits. */
static void same_for_all_sets_and_threads(void **state) {
  (void)state;
  static Hits known, hits;
  const Case *what = &cases[sizeof cases / sizeof *cases - 1];
  for (vlIsa isa = VL_ISA_BASE; isa <= vl_isa_best(); isa++)
    for (uint32_t threads = 1; threads <= 3; threads += 2) {
      Made m = {0};
      make(what, &m, isa, threads);
      unsigned floats = vl_accel_enter();
      seed = 11;
      make_rays(m.worlds[1], ANYWHERE);
      memset(&hits, 0, sizeof hits);
      trace(m.worlds[1], false, &hits);
      if (isa == VL_ISA_BASE && threads == 1)
        known = hits;
      assert_memory_equal(&known, &hits, sizeof hits);
      vl_accel_leave(floats);
      unmake(&m);
    }
}

/* A world shares the trees of the previous one; one with Embree has nothing to share. */
static void trees_are_shared(void **state) {
  (void)state;
  for (size_t c = 0; c < sizeof cases / sizeof *cases; c++) {
    Made m = {0};
    make(&cases[c], &m, VL_ISA_AUTO, 2);
    const vlAccel *old = &m.worlds[1]->accel;
    for (int a = 0; a < 2; a++) {
      vlBuildDef build = vl_default_build_def();
      build.accelerator = VL_ACCELERATOR_BVH;
      build.previous = m.worlds[a];
      vlWorld *world = NULL;
      assert_int_equal(vl_world_build(m.scene, &build, &world, NULL), VL_OK);
      for (uint32_t k = 0; k < old->group_count; k++) {
        vlBvh *tree = world->accel.groups[k];
        assert_int_equal(tree == old->groups[k], a == 1);
        assert_int_equal(atomic_load(&tree->users), a == 1 ? 2 : 1);
      }
      assert_int_equal(world->accel.scene == old->scene, a == 1 || !old->scene);
      static Hits hits[2];
      make_rays(world, ANYWHERE);
      unsigned floats = vl_accel_enter();
      trace(m.worlds[1], false, &hits[0]);
      if (a == 1) { /* what is shared outlives its first owner */
        vl_world_destroy(m.worlds[1]);
        m.worlds[1] = NULL;
      }
      trace(world, false, &hits[1]);
      vl_accel_leave(floats);
      assert_memory_equal(&hits[0], &hits[1], sizeof hits[0]);
      vl_world_destroy(world);
    }
    unmake(&m);
  }
}

/* Stops a build at its n-th allocation. */
typedef struct Stopper {
  long left;
  vlCancel *cancel;
} Stopper;

static void *stopping_allocate(void *user, size_t size) {
  Stopper *s = user;
  if (s->left > 0 && --s->left == 0)
    vl_cancel_request(s->cancel);
  return malloc(size);
}
static void plain_release(void *user, void *block) {
  (void)user;
  free(block);
}

/* A build that is stopped anywhere keeps no memory. */
static void stopped_builds(void **state) {
  (void)state;
  Made m = {0};
  Stopper stopper = {0};
  vlContextDef def = vl_default_context_def();
  def.threads = 1;
  def.allocator = (vlAllocator){&stopper, stopping_allocate, plain_release};
  make_scene(&cases[sizeof cases / sizeof *cases - 1], &m, &def);
  assert_int_equal(vl_cancel_create(m.context, &stopper.cancel), VL_OK);
  vlBuildDef build = vl_default_build_def();
  build.accelerator = VL_ACCELERATOR_BVH;
  build.cancel = stopper.cancel;
  size_t before = vl_context_memory(m.context, NULL);
  uint32_t stopped = 0;
  for (long n = 1;; n += 3) {
    vl_cancel_clear(stopper.cancel);
    stopper.left = n;
    vlResult r = vl_world_build(m.scene, &build, &m.worlds[1], NULL);
    bool reached = stopper.left == 0;
    stopper.left = 0;
    assert_true(r == VL_OK || r == VL_CANCELLED);
    stopped += r == VL_CANCELLED;
    vl_world_destroy(m.worlds[1]);
    m.worlds[1] = NULL;
    assert_int_equal(vl_context_memory(m.context, NULL), before);
    if (!reached)
      break;
  }
  assert_true(stopped > 20);
  vl_cancel_destroy(stopper.cancel);
  unmake(&m);
}

/* Rays that are no rays miss everything, and hurt nothing. */
static void broken_rays(void **state) {
  (void)state;
  Made m = {0};
  make(&cases[sizeof cases / sizeof *cases - 1], &m, VL_ISA_AUTO, 2);
  static Hits hits;
  static const float broken[] = {NAN, INFINITY, -INFINITY, 3e38f, 0x1p121f};
  make_rays(m.worlds[1], ANYWHERE);
  for (uint32_t k = 0; k < BATCH; k++)
    (k % 2 ? o_ : d_)[k % 3][k] = broken[k % 5];
  unsigned floats = vl_accel_enter();
  trace(m.worlds[1], false, &hits);
  vl_accel_leave(floats);
  for (uint32_t k = 0; k < BATCH; k++)
    assert_true(hits.shape[k] == VL_NONE && !hits.blocked[k]);
  unmake(&m);
}

/* An empty world, and one that only has instances. */
static void nothing_at_all(void **state) {
  (void)state;
  Made m = {0};
  assert_int_equal(vl_context_create(NULL, &m.context), VL_OK);
  assert_int_equal(vl_scene_create(m.context, &m.scene), VL_OK);
  vlGroupId group = vl_scene_add_group(m.scene, NULL);
  double pose[16];
  set_pose(pose, 1, true);
  vl_scene_add_instance(m.scene, group, pose, (vlSource){0});
  vlBuildDef build = vl_default_build_def();
  build.accelerator = VL_ACCELERATOR_BVH;
  assert_int_equal(vl_world_build(m.scene, &build, &m.worlds[1], NULL), VL_OK);
  static Hits hits;
  make_rays(m.worlds[1], AXES);
  trace(m.worlds[1], false, &hits);
  for (uint32_t k = 0; k < BATCH; k++)
    assert_true(hits.shape[k] == VL_NONE && !hits.blocked[k]);
  unmake(&m);
}

/* Embree reports a hit at an infinite distance where the arithmetic of a huge triangle
 * overflows. */
static void a_distance_that_overflows_is_no_hit(void **state) {
  (void)state;
  vlNearest known = {
      .t = INFINITY, .instance = VL_NONE, .geometry = VL_NONE, .primitive = VL_NONE};
  vlNearest hit = {.t = INFINITY, .instance = VL_NONE};
  assert_false(vl_nearest_offer(&known, &hit));
  hit.t = NAN;
  assert_false(vl_nearest_offer(&known, &hit));
  hit.t = 1;
  assert_true(vl_nearest_offer(&known, &hit));
  assert_true(known.geometry == 0);
}

int main(void) {
  vlBuildDef embree = vl_default_build_def();
  embree.accelerator = VL_ACCELERATOR_EMBREE;
  vlAccelerator kind;
  has_embree = vl_accel_choose(&embree, &kind, NULL) == VL_OK;
  const struct CMUnitTest alone[] = {
      cmocka_unit_test(same_for_all_sets_and_threads),
      cmocka_unit_test(stopped_builds),
      cmocka_unit_test(broken_rays),
      cmocka_unit_test(nothing_at_all),
      cmocka_unit_test(a_distance_that_overflows_is_no_hit),
  };
  const struct CMUnitTest beside_embree[] = {
      cmocka_unit_test(hits_are_those_of_embree),
      cmocka_unit_test(ends_near_hits),
      cmocka_unit_test(trees_are_shared),
  };
  int failed = cmocka_run_group_tests(alone, NULL, NULL);
  return has_embree ? failed + cmocka_run_group_tests(beside_embree, NULL, NULL) : failed;
}
