/* test_brute_force.c: worlds of few primitives: brute force against Embree on the same rays,
 * rays through edges and corners, instruction sets, single rays and blocks of them, and which
 * worlds are of that kind. */
#include <math.h>
#include <stdlib.h>
#include <string.h>
/* cmocka.h needs the headers above */

#include "unit.h"
#include "velo/material.h"
#include "velo/shape_kinds.h"
#include "world/accel/brute_force.h"
#include "world/world.h"

enum { RAYS = 20000 };

static uint32_t seed = 11;
static float random_signed(void) {
  seed = seed * 1664525u + 1013904223u;
  return (float)(seed >> 8) * 0x1p-23f - 1;
}

/* ---- worlds ------------------------------------------------------------------------------ */

typedef struct Made {
  vlContext *context;
  vlScene *scene;
  vlWorld *world;
  vlIsa isa;
} Made;

static void open_scene(Made *m) {
  vlContextDef def = vl_default_context_def();
  def.isa = m->isa;
  assert_int_equal(vl_context_create(&def, &m->context), VL_OK);
  assert_int_equal(vl_scene_create(m->context, &m->scene), VL_OK);
}

static void build(Made *m) {
  vlError error = {0};
  if (vl_world_build(m->scene, NULL, &m->world, &error) != VL_OK)
    fail_msg("%s", error.message);
}

static void close_scene(Made *m) {
  vl_world_destroy(m->world);
  vl_scene_destroy(m->scene);
  vl_context_destroy(m->context);
}

/* A box turned about the y axis, from `low` to `high` before; 12 triangles that are no pairs if
 * `crooked`. */
static void add_box(Made *m, const float low[3], const float high[3], float angle, bool crooked,
                    vlMaterialId material) {
  static const uint32_t quads[6][4] = {{0, 1, 3, 2}, {4, 6, 7, 5}, {0, 4, 5, 1},
                                       {2, 3, 7, 6}, {0, 2, 6, 4}, {1, 5, 7, 3}};
  float p[8][3];
  uint32_t f[12][3];
  for (int k = 0; k < 8; k++) {
    float x = k & 4 ? high[0] : low[0], y = k & 2 ? high[1] : low[1],
          z = k & 1 ? high[2] : low[2];
    if (crooked && k == 5) {
      x += 0.1f;
      y += 0.07f;
      z += 0.03f;
    }
    p[k][0] = cosf(angle) * x + sinf(angle) * z;
    p[k][1] = y;
    p[k][2] = cosf(angle) * z - sinf(angle) * x;
  }
  for (int k = 0; k < 6; k++) {
    const uint32_t *q = quads[k], one[3] = {q[0], q[1], q[2]}, two[3] = {q[0], q[2], q[3]};
    memcpy(f[2 * k], one, sizeof one);
    memcpy(f[2 * k + 1], two, sizeof two);
  }
  vlShapeDef def = vl_default_shape_def(VL_SHAPE_TRIANGLES);
  def.positions = p[0];
  def.vertices = 8;
  def.indices = f[0];
  def.faces = 12;
  def.material = material;
  assert_int_not_equal(vl_scene_add_shape(m->scene, &def).index, 0);
}

static void add_ball(Made *m, float radius, double x, double y, double z) {
  vlShapeDef def = vl_default_shape_def(VL_SHAPE_SPHERE);
  def.radius = radius;
  def.z_min = -radius;
  def.z_max = radius;
  double at[16] = {1, 0, 0, x, 0, 1, 0, y, 0, 0, 1, z, 0, 0, 0, 1};
  memcpy(def.group_from_shape, at, sizeof at);
  assert_int_not_equal(vl_scene_add_shape(m->scene, &def).index, 0);
}

/* A room with boxes, one of them crooked, one of an interface, and two balls. shift: moves
 * everything. */
static void make_room(Made *m, float shift) {
  open_scene(m);
  vlMaterialDef nothing = vl_default_material_def(VL_MATERIAL_INTERFACE);
  vlMaterialId none = {0}, passed = vl_scene_add_material(m->scene, &nothing);
  const float boxes[5][6] = {{-4, -4, -4, 4, 4, 4},
                             {-2, -3.9f, -3, -0.5f, 1, -1},
                             {0.5f, -3.9f, 0, 2, -1, 1.5f},
                             {-1, 1.5f, -1, 1, 2.5f, 1},
                             {1.7f, 0, -2, 3, 1.1f, -1}};
  for (int k = 0; k < 5; k++) {
    float low[3], high[3];
    for (int i = 0; i < 3; i++) {
      low[i] = boxes[k][i] + shift;
      high[i] = boxes[k][3 + i] + shift;
    }
    add_box(m, low, high, k && shift == 0 ? 0.3f * (float)k : 0, k == 4,
            k == 3 ? passed : none);
  }
  add_ball(m, 0.8f, -1.5 + (double)shift, 0.5 + (double)shift, 2 + (double)shift);
  add_ball(m, 0.5f, 2 + (double)shift, -2 + (double)shift, 2.5 + (double)shift);
  build(m);
}

/* ---- rays -------------------------------------------------------------------------------- */

static float o_[3][RAYS], d_[3][RAYS], end_[RAYS];
static uint32_t shape_[2][RAYS], prim_[2][RAYS], instance_[2][RAYS];
static uint8_t blocked_[2][RAYS];
static float t_[2][RAYS];

static vlRays rays_at(uint32_t first, bool ends) {
  return (vlRays){o_[0] + first, o_[1] + first, o_[2] + first, d_[0] + first,
                  d_[1] + first, d_[2] + first, NULL,          ends ? end_ + first : NULL,
                  NULL,          NULL};
}

static void make_rays(float shift) {
  for (uint32_t k = 0; k < RAYS; k++) {
    for (int i = 0; i < 3; i++) {
      o_[i][k] = shift + 3.9f * random_signed();
      d_[i][k] = random_signed();
    }
    end_[k] = 4 + 4 * random_signed();
  }
}

static bool same_hit(uint32_t k) {
  return shape_[0][k] == shape_[1][k] && prim_[0][k] == prim_[1][k] &&
         instance_[0][k] == instance_[1][k];
}

/* Hits and shadows are those of the accelerator, which is Embree where velo has it. shift:
 * rounding grows with the distance from the origin, and with it the number of rays so near to
 * an edge that it decides; one in 100,000 may differ for each. */
static void equal_to_accelerator(float shift, int allowed) {
  Made m = {0};
  make_room(&m, shift);
  make_rays(shift);
  assert_non_null(m.world->accel.brute_force);
  assert_int_equal(m.world->accel.brute_force->others, 2);
  /* 3 sides of the crooked box are plane */
  assert_int_equal(m.world->accel.brute_force->faces, 4 * 6 + 3 + 2 * 3);
  unsigned state = vl_accel_enter();
  vlRays rays = rays_at(0, false), short_rays = rays_at(0, true);
  vl_accel_closest(m.world, RAYS, &rays, false, shape_[0], prim_[0], instance_[0], t_[0]);
  vl_accel_occluded(m.world, RAYS, &short_rays, NULL, blocked_[0]);
  struct vlBruteForce *brute_force = m.world->accel.brute_force;
  m.world->accel.brute_force = NULL; /* the accelerator answers */
  vl_accel_closest(m.world, RAYS, &rays, false, shape_[1], prim_[1], instance_[1], t_[1]);
  vl_accel_occluded(m.world, RAYS, &short_rays, NULL, blocked_[1]);
  m.world->accel.brute_force = brute_force;
  vl_accel_leave(state);
  int hits = 0, blocked = 0, other_hits = 0, other_shadows = 0, kinds[2] = {0};
  for (uint32_t k = 0; k < RAYS; k++) {
    hits += shape_[0][k] != VL_NONE;
    blocked += blocked_[0][k];
    other_hits += !same_hit(k);
    other_shadows += blocked_[0][k] != blocked_[1][k];
    if (shape_[0][k] == VL_NONE)
      continue;
    kinds[m.world->shapes.items[shape_[0][k]].kind == VL_SHAPE_TRIANGLES]++;
    if (same_hit(k) && !(fabsf(t_[0][k] - t_[1][k]) <= 1e-4f * t_[1][k] + 1e-6f))
      fail_msg("ray %u: t %g, accelerator %g", k, (double)t_[0][k], (double)t_[1][k]);
  }
  assert_int_equal(hits, RAYS); /* the room is closed */
  assert_true(blocked > RAYS / 4 && blocked < RAYS && kinds[0] > RAYS / 100 &&
              kinds[1] > RAYS / 2);
  if (other_hits > allowed || other_shadows > allowed)
    fail_msg("%d hits and %d shadows differ, of %d rays", other_hits, other_shadows, RAYS);
  close_scene(&m);
}

static void room(void **state) {
  (void)state;
  equal_to_accelerator(0, 1);
}

static void room_far_from_the_origin(void **state) {
  (void)state;
  equal_to_accelerator(300, 10);
}

/* Rays from inside of a closed room to points on its edges, diagonals and corners, and exactly
 * along its axes, hit it. */
static void no_ray_passes_between_faces(void **state) {
  (void)state;
  Made m = {0};
  open_scene(&m);
  const float low[3] = {-1.3f, -0.7f, -2.1f}, high[3] = {1.1f, 0.9f, 1.7f};
  add_box(&m, low, high, 0.4f, true, (vlMaterialId){0});
  build(&m);
  const vlWorldShape *s = &m.world->shapes.items[0];
  for (uint32_t k = 0; k < RAYS; k++) {
    uint32_t face = k % 12, a = s->indices[3 * face + k % 3],
             b = s->indices[3 * face + (k + 1) % 3];
    float share = k % 7 == 0 ? 0 : 0.5f + 0.5f * random_signed();
    for (int i = 0; i < 3; i++) {
      o_[i][k] = 0.4f * random_signed();
      d_[i][k] = s->positions[3 * a + (uint32_t)i] * (1 - share) +
                 s->positions[3 * b + (uint32_t)i] * share - o_[i][k];
    }
    if (k % 11 == 0)
      for (int i = 0; i < 3; i++)
        d_[i][k] = i == (int)(k % 3) ? (k & 1 ? 1 : -1) : 0;
  }
  vlRays rays = rays_at(0, false);
  vl_accel_closest(m.world, RAYS, &rays, false, shape_[0], prim_[0], instance_[0], t_[0]);
  vl_accel_occluded(m.world, RAYS, &rays, NULL, blocked_[0]);
  for (uint32_t k = 0; k < RAYS; k++)
    if (shape_[0][k] != 0 || !blocked_[0][k])
      fail_msg("ray %u leaves the room", k);
  close_scene(&m);
}

static void trace_all(const Made *m, uint32_t step, int to) {
  for (uint32_t k = 0; k < RAYS; k += step) {
    uint32_t n = RAYS - k < step ? RAYS - k : step;
    vlRays rays = rays_at(k, k & 64);
    vl_accel_closest(m->world, n, &rays, false, shape_[to] + k, prim_[to] + k,
                     instance_[to] + k, t_[to] + k);
    vl_accel_occluded(m->world, n, &rays, NULL, blocked_[to] + k);
  }
}

/* Neither the number of rays of a call nor the instruction set changes a bit. */
static void the_same_bits(void **state) {
  (void)state;
  make_rays(0);
  Made first = {0};
  make_room(&first, 0);
  trace_all(&first, 64, 0);
  for (vlIsa isa = VL_ISA_BASE; isa <= vl_isa_best(); isa++) {
    static const uint32_t steps[] = {64, 1, 3, 4, 16, 32};
    Made m = {.isa = isa};
    make_room(&m, 0);
    for (size_t j = 0; j < sizeof steps / sizeof *steps; j++) {
      memset(shape_[1], 0xee, sizeof shape_[1]);
      memset(t_[1], 0xee, sizeof t_[1]);
      trace_all(&m, steps[j], 1);
      if (steps[j] == 64 || 64 % steps[j] == 0) {
        assert_memory_equal(t_[0], t_[1], sizeof t_[0]);
        assert_memory_equal(blocked_[0], blocked_[1], sizeof blocked_[0]);
      }
      for (uint32_t k = 0; 64 % steps[j] == 0 && k < RAYS; k++)
        assert_true(same_hit(k));
    }
    close_scene(&m);
  }
  close_scene(&first);
}

/* NaN, infinity and rays without direction hit nothing. */
static void broken_rays(void **state) {
  (void)state;
  Made m = {0};
  make_room(&m, 0);
  const float bad[4] = {NAN, INFINITY, -INFINITY, 3e38f};
  for (uint32_t k = 0; k < 128; k++) {
    for (int i = 0; i < 3; i++) {
      o_[i][k] = 0.5f;
      d_[i][k] = k < 64 && i == 1 ? bad[k % 4] : 0.3f;
    }
    if (k >= 64)
      o_[k % 3][k] = bad[k % 4];
    if (k % 8 == 7)
      for (int i = 0; i < 3; i++)
        d_[i][k] = 0;
  }
  vlRays rays = rays_at(0, false);
  vl_accel_closest(m.world, 128, &rays, false, shape_[0], prim_[0], instance_[0], t_[0]);
  for (uint32_t k = 0; k < 128; k++)
    if (k % 4 == 0 || k >= 64 || k % 8 == 7)
      assert_int_equal(shape_[0][k], VL_NONE);
  close_scene(&m);
}

/* ---- which worlds ------------------------------------------------------------------------ */

static bool is_few(int boxes, int balls, bool instance, float opacity) {
  Made m = {0};
  open_scene(&m);
  vlShapeDef def = vl_default_shape_def(VL_SHAPE_SPHERE);
  def.alpha = vl_float_input(opacity);
  if (instance) {
    static const double still[16] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
    def.group = vl_scene_add_group(m.scene, "group");
    vl_scene_add_instance(m.scene, def.group, still, (vlSource){0});
  }
  vl_scene_add_shape(m.scene, &def);
  for (int k = 0; k < boxes; k++) {
    const float low[3] = {2 * (float)k, 0, 0}, high[3] = {2 * (float)k + 1, 1, 1};
    add_box(&m, low, high, 0, false, (vlMaterialId){0});
  }
  for (int k = 0; k < balls; k++)
    add_ball(&m, 0.5f, 3 * k, 5, 0);
  build(&m);
  bool few = m.world->accel.brute_force != NULL;
  close_scene(&m);
  return few;
}

/* Whether brute force is used for a ball of this size and place: no product of the kernels may
 * overflow or underflow. */
static bool is_usual(float radius, double x) {
  Made m = {0};
  open_scene(&m);
  add_ball(&m, radius, x, 0, 0);
  build(&m);
  bool few = m.world->accel.brute_force != NULL;
  close_scene(&m);
  return few;
}

static void which_worlds(void **state) {
  (void)state;
  assert_true(is_usual(1, 0));
  assert_true(is_usual(1e-3f, 1e5));
  assert_false(is_usual(1e-8f, 0));
  assert_false(is_usual(1, 1e8));
  assert_false(is_usual(1e10f, 0));
  assert_true(is_few(0, 0, false, 1));
  assert_true(is_few(7, 0, false, 1));  /* 42 faces and a sphere */
  assert_false(is_few(8, 0, false, 1)); /* 48 faces and a sphere */
  assert_true(is_few(3, 6, false, 1));  /* 18 faces and 7 spheres */
  assert_false(is_few(4, 6, false, 1));
  assert_false(is_few(0, 8, false, 1));
  assert_false(is_few(1, 0, true, 1));
  assert_false(is_few(1, 0, false, 0.5f));
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(room),
      cmocka_unit_test(room_far_from_the_origin),
      cmocka_unit_test(no_ray_passes_between_faces),
      cmocka_unit_test(the_same_bits),
      cmocka_unit_test(broken_rays),
      cmocka_unit_test(which_worlds),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
