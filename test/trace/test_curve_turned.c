/* test_curve_turned.c: curves do not depend on how the scene is turned. The same rays, turned
 * with the curves, hit the same pieces at the same distance, u and v (from which the hair
 * material takes the offset h from the axis), with turned points and normals; and the rays that
 * leave there meet the same neighbours. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "statistics.h"
#include "unit.h"

#include "trace/stages.h"
#include "trace/surface/offset.h"
#include "velo/shape_kinds.h"

enum { HAIRS = 12, RAYS = 20000 };

typedef struct Hairs {
  float positions[HAIRS][12], widths[HAIRS][2], normals[HAIRS][6];
} Hairs;

/* Hairs side by side, half of them bent. The gap between neighbours is smaller than their
 * width. */
static void make_hairs(Hairs *h, statRng *rng) {
  for (int k = 0; k < HAIRS; k++) {
    bool bent = k >= HAIRS / 2;
    for (int i = 0; i < 4; i++) {
      float *p = h->positions[k] + 3 * i;
      p[0] = 0.5f * (float)i - 0.75f;
      p[1] = bent ? 0.3f * stat_float(rng) : 0;
      p[2] = 0.07f * (float)k;
    }
    for (int i = 0; i < 2; i++) {
      h->widths[k][i] = bent ? 0.03f + 0.02f * stat_float(rng) : 0.05f;
      double n[3];
      stat_direction(rng, n);
      for (int j = 0; j < 3; j++)
        h->normals[k][3 * i + j] = (float)n[j];
    }
  }
}

static vlWorld *build(vlContext *context, const Hairs *h, vlCurveKind kind,
                      const double turn[16], bool instance) {
  vlScene *scene;
  vlWorld *world;
  vlError error = {0};
  assert_int_equal(vl_scene_create(context, &scene), VL_OK);
  vlShapeDef def = vl_default_shape_def(VL_SHAPE_CURVES);
  def.faces = HAIRS;
  def.vertices = 4 * HAIRS;
  def.positions = h->positions[0];
  def.widths = h->widths[0];
  def.normals = h->normals[0];
  def.curve = kind;
  if (instance) {
    def.group = vl_scene_add_group(scene, NULL);
    vl_scene_add_instance(scene, def.group, turn, (vlSource){0});
  } else {
    memcpy(def.group_from_shape, turn, sizeof def.group_from_shape);
  }
  assert_int_not_equal(vl_scene_add_shape(scene, &def).index, 0);
  if (vl_world_build(scene, NULL, &world, &error) != VL_OK)
    fail_msg("%s", error.message);
  vl_scene_destroy(scene);
  return world;
}

typedef struct Hit {
  uint32_t shape, prim, instance;
  float t;
} Hit;

static Hit trace(const vlWorld *world, vlVec3 o, vlVec3 d) {
  Hit h;
  vlRays ray = vl_one_ray(&o, &d, NULL, NULL, NULL);
  vl_accel_closest(world, 1, &ray, false, &h.shape, &h.prim, &h.instance, &h.t);
  return h;
}

static vlVec3 rotate(const double m[16], vlVec3 v) {
  double x = (double)v.x, y = (double)v.y, z = (double)v.z;
  return vl_vec3((float)(m[0] * x + m[1] * y + m[2] * z),
                 (float)(m[4] * x + m[5] * y + m[6] * z),
                 (float)(m[8] * x + m[9] * y + m[10] * z));
}

static bool near(vlVec3 a, vlVec3 b, float tolerance) {
  return vl_length(vl_sub(a, b)) <= tolerance;
}

/* Whether both hits are the same. Rounding decides which of two hairs a ray meets at an
 * edge. */
static bool same_hit(const Hit *a, const Hit *b) {
  if (a->shape == VL_NONE || b->shape == VL_NONE)
    return a->shape == b->shape;
  return a->prim == b->prim && vl_abs(a->t - b->t) < 1e-3f;
}

static void compare(vlCurveKind kind, bool instance, statRng *rng) {
  static const double identity[16] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
  /* by one radian about (1, 2, 3) */
  static const double turn[16] = {0.5731378554489870,
                                  -0.6090066421373933,
                                  0.5482918096085999,
                                  0,
                                  0.7403488404607820,
                                  0.6716445041915284,
                                  -0.0278792829479463,
                                  0,
                                  -0.3512785121235170,
                                  0.4219058779181122,
                                  0.8358222520957642,
                                  0,
                                  0,
                                  0,
                                  0,
                                  1};
  vlContext *context;
  assert_int_equal(vl_context_create(NULL, &context), VL_OK);
  Hairs hairs;
  make_hairs(&hairs, rng);
  vlWorld *still = build(context, &hairs, kind, identity, instance);
  vlWorld *turned = build(context, &hairs, kind, turn, instance);
  int hits = 0, others = 0, met = 0, other_neighbours = 0;
  for (int k = 0; k < RAYS; k++) {
    double from[3], leave[3];
    stat_direction(rng, from);
    stat_direction(rng, leave);
    vlVec3 o = vl_vec3((float)(3 * from[0]), (float)(3 * from[1]), (float)(3 * from[2]));
    vlVec3 target =
        vl_vec3(1.4f * stat_float(rng) - 0.7f, 0.2f * stat_float(rng), 0.8f * stat_float(rng));
    vlVec3 d = vl_normalize(vl_sub(target, o)),
           w = vl_vec3((float)leave[0], (float)leave[1], (float)leave[2]);
    vlVec3 to = rotate(turn, o), td = vl_normalize(rotate(turn, d)), tw = rotate(turn, w);
    Hit a = trace(still, o, d), b = trace(turned, to, td);
    others += !same_hit(&a, &b);
    if (!same_hit(&a, &b) || a.shape == VL_NONE)
      continue;
    hits++;
    vlPoint p = vl_point_at_time(still, 0, o, d, a.shape, a.prim, a.instance, a.t);
    vlPoint q = vl_point_at_time(turned, 0, to, td, b.shape, b.prim, b.instance, b.t);
    /* At an end of a segment, and where a ray looks along a curve, u turns quickly with the
     * ray, and n with u. */
    bool steady = vl_abs(p.v - 0.5f) < 0.49f && vl_abs(p.u - q.u) < 1e-3f;
    others += !steady;
    if (!steady)
      continue;
    assert_true(near(rotate(turn, p.p), q.p, 1e-3f));
    if (!near(rotate(turn, p.g), q.g, 2e-3f) || !near(rotate(turn, p.n), q.n, 2e-3f))
      fail_msg("kind %d, ray %d: the normal is not turned", kind, k);
    if (vl_abs(p.v - q.v) > 1e-3f)
      fail_msg("ray %d: v %g, turned %g", k, (double)p.v, (double)q.v);
    if (vl_abs(p.offset - q.offset) > 1e-4f * p.offset)
      fail_msg("kind %d, ray %d: rays start %g off, turned %g", kind, k, (double)p.offset,
               (double)q.offset);
    if (vl_abs(vl_dot(w, p.g)) < 1e-3f)
      continue;
    Hit next = trace(still, vl_offset_origin(p.p, p.g, p.offset, w), w);
    Hit turned_next = trace(turned, vl_offset_origin(q.p, q.g, q.offset, tw), tw);
    met += next.shape != VL_NONE;
    other_neighbours += !same_hit(&next, &turned_next);
  }
  assert_true(hits > RAYS / 5 && met > hits / 10);
  if (others > hits / 20)
    fail_msg("kind %d: %d of %d hits differ", kind, others, hits);
  if (other_neighbours > hits / 500)
    fail_msg("kind %d: %d of %d second hits differ", kind, other_neighbours, hits);
  vl_world_destroy(still);
  vl_world_destroy(turned);
  assert_int_equal(vl_context_memory(context, NULL), 0);
  vl_context_destroy(context);
}

static void turned_curves_are_met_alike(void **state) {
  (void)state;
  statRng rng = stat_rng(11);
  for (int kind = 0; kind < 3; kind++)
    for (int instance = 0; instance < 2; instance++)
      compare((vlCurveKind)kind, instance, &rng);
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(turned_curves_are_met_alike)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
