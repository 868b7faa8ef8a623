/* test_occluders.c: triangles that block most shadow rays: what a worker has learned changes no
 * result, whatever the rays; it blocks most rays of a closed room; it is forgotten in another
 * world. */
#include <math.h>
#include <stdlib.h>
#include <string.h>
/* cmocka.h needs the headers above */

#include "unit.h"
#include "velo/material.h"
#include "velo/shape_kinds.h"
#include "world/accel/occluders.h"
#include "world/world.h"

enum { BATCH = 1024, BATCHES = 200, THINGS = 60 };

static uint32_t seed = 5;
static float random_unit(void) {
  seed = seed * 1664525u + 1013904223u;
  return (float)(seed >> 8) * 0x1p-24f;
}
static float random_signed(void) {
  return 2 * random_unit() - 1;
}

/* ---- worlds ------------------------------------------------------------------------------ */

typedef struct Made {
  vlContext *context;
  vlScene *scene;
  vlWorld *world;
} Made;

static void add_triangles(const Made *m, uint32_t vertices, const float *positions,
                          uint32_t faces, const uint32_t *indices, vlMaterialId material) {
  vlShapeDef def = vl_default_shape_def(VL_SHAPE_TRIANGLES);
  def.positions = positions;
  def.vertices = vertices;
  def.indices = indices;
  def.faces = faces;
  def.material = material;
  assert_int_not_equal(vl_scene_add_shape(m->scene, &def).index, 0);
}

/* A room of `size`, around the point (shift, shift, shift), with a window in its wall x = size:
 * its walls, thin and small triangles everywhere, and a pane of an interface in the middle. */
static void make_room(Made *m, float size, float shift, vlIsa isa) {
  vlContextDef def = vl_default_context_def();
  def.isa = isa;
  assert_int_equal(vl_context_create(&def, &m->context), VL_OK);
  assert_int_equal(vl_scene_create(m->context, &m->scene), VL_OK);
  float p[8][3];
  for (int k = 0; k < 8; k++)
    for (int i = 0; i < 3; i++)
      p[k][i] = shift + (k >> i & 1 ? size : -size);
  static const uint32_t walls[11][3] = {{0, 2, 6}, {0, 6, 4}, {0, 4, 5}, {0, 5, 1},
                                        {2, 3, 7}, {2, 7, 6}, {0, 1, 3}, {0, 3, 2},
                                        {4, 6, 7}, {4, 7, 5}, {1, 5, 7}};
  add_triangles(m, 8, p[0], 11, walls[0], (vlMaterialId){0});
  static const uint32_t face[3] = {0, 1, 2};
  for (int k = 0; k < THINGS; k++) {
    float thin = k % 3 ? 0.2f : 0.002f, at[3], q[3][3];
    for (int i = 0; i < 3; i++)
      at[i] = shift + 0.9f * size * random_signed();
    for (int j = 0; j < 3; j++)
      for (int i = 0; i < 3; i++)
        q[j][i] = at[i] + size * random_signed() * (j == 1 ? thin : 0.2f);
    add_triangles(m, 3, q[0], 1, face, (vlMaterialId){0});
  }
  vlMaterialDef nothing = vl_default_material_def(VL_MATERIAL_INTERFACE);
  vlMaterialId passed = vl_scene_add_material(m->scene, &nothing);
  float pane[3][3] = {{shift, shift - size, shift - size},
                      {shift, shift + size, shift - size},
                      {shift, shift, shift + size}};
  add_triangles(m, 3, pane[0], 1, face, passed);
  vlError error = {0};
  if (vl_world_build(m->scene, NULL, &m->world, &error) != VL_OK)
    fail_msg("%s", error.message);
  assert_null(m->world->accel.brute_force);
}

static void close_room(Made *m) {
  vl_world_destroy(m->world);
  vl_scene_destroy(m->scene);
  vl_context_destroy(m->context);
}

/* ---- rays -------------------------------------------------------------------------------- */

static float o_[3][BATCH], d_[3][BATCH], end_[BATCH];

static const vlRays all_rays = {o_[0], o_[1], o_[2], d_[0], d_[1],
                                d_[2], NULL,  end_,  NULL,  NULL};

typedef struct Face {
  const vlWorldShape *shape;
  uint32_t prim;
} Face;

static Face random_face(const vlWorld *world) {
  const vlWorldShape *s =
      &world->shapes
           .items[(uint32_t)(random_unit() * random_unit() * (float)world->shapes.count)];
  return (Face){s, (uint32_t)(random_unit() * (float)s->faces)};
}

static float small(void) {
  return powf(10, -1 - 7 * random_unit()) * random_signed();
}

/* A point of a triangle: inside, on an edge, or a little beside it. */
static void point_of(Face f, float p[3]) {
  float u = random_unit(), v = random_unit() * (1 - u);
  if (random_unit() < 0.3f)
    v = random_unit() < 0.5f ? small() : 1 - u + small();
  for (int i = 0; i < 3; i++) {
    float corner[3];
    for (uint32_t k = 0; k < 3; k++)
      corner[k] = f.shape->positions[3 * (size_t)f.shape->indices[3 * f.prim + k] + (size_t)i];
    p[i] = corner[0] + u * (corner[1] - corner[0]) + v * (corner[2] - corner[0]);
  }
}

/* Rays through a point of a triangle. They begin in the room, at another triangle, near the
 * same triangle (so they graze it), or far away; they end before the point, at it, beyond it,
 * or never. */
static void make_rays(const vlWorld *world, float size, float shift) {
  for (uint32_t k = 0; k < BATCH; k++) {
    float from[3], to[3], kind = random_unit(), off = kind < 0.4f ? size * small() : 0;
    Face f = random_face(world);
    point_of(f, to);
    point_of(kind < 0.4f ? f : random_face(world), from);
    for (int i = 0; i < 3; i++) {
      from[i] += off * random_signed();
      if (kind > 0.6f)
        from[i] = shift + (kind > 0.99f ? 1000 : 0.99f) * size * random_signed();
      o_[i][k] = from[i];
      d_[i][k] = to[i] - from[i];
    }
    kind = random_unit();
    end_[k] = kind < 0.3f   ? 1 + small()
              : kind < 0.4f ? 1
              : kind < 0.7f ? 2 * random_unit()
                            : INFINITY;
  }
}

/* The shadow rays of a worker that learns are those of Embree. Returns the share of rays that
 * its triangles block. */
static double compare(float size, float shift, vlIsa isa) {
  Made m = {0};
  make_room(&m, size, shift, isa);
  vlOccluders *o = calloc(1, sizeof *o);
  assert_non_null(o);
  unsigned state = vl_accel_enter();
  uint64_t tested = 0, known = 0, open = 0;
  for (int batch = 0; batch < BATCHES; batch++) {
    static uint8_t blocked[2][BATCH], alone[BATCH];
    make_rays(m.world, size, shift);
    vl_accel_occluded(m.world, BATCH, &all_rays, NULL, blocked[0]);
    vl_accel_occluded(m.world, BATCH, &all_rays, o, blocked[1]);
    m.world->accel.occluder_kernels->test(o, BATCH, &all_rays, alone);
    for (int k = 0; k < BATCH; k++) {
      if (blocked[0][k] != blocked[1][k])
        fail_msg("size %g, shift %g, batch %d, ray %d: %d, Embree alone %d", (double)size,
                 (double)shift, batch, k, blocked[1][k], blocked[0][k]);
      tested += o->count > 0;
      known += alone[k];
      open += !blocked[0][k];
    }
  }
  vl_accel_leave(state);
  assert_true(tested > BATCHES * BATCH / 2 && open > BATCHES * BATCH / 10);
  free(o);
  close_room(&m);
  return (double)known / (double)tested;
}

static void results_are_the_same(void **state) {
  (void)state;
  static const float places[][2] = {{1, 0}, {1, 30}, {1e-4f, 0}, {2e4f, 0}, {50, -400}};
  for (size_t k = 0; k < sizeof places / sizeof *places; k++) {
    double share = compare(places[k][0], places[k][1], VL_ISA_AUTO);
    if (share < 0.2)
      fail_msg("size %g: only %.3f of the rays were blocked", (double)places[k][0], share);
  }
}

static void results_are_the_same_with_all_instruction_sets(void **state) {
  (void)state;
  for (vlIsa isa = VL_ISA_BASE; isa <= vl_isa_best(); isa++)
    assert_true(compare(3, 1, isa) > 0.2);
}

/* Beyond the usual sizes nothing is tested. */
static void unusual_worlds(void **state) {
  (void)state;
  assert_true(compare(1e-9f, 0, VL_ISA_AUTO) == 0 && compare(1e9f, 0, VL_ISA_AUTO) == 0);
}

/* Triangles of one world block no ray of another. */
static void forgotten_in_another_world(void **state) {
  (void)state;
  Made room = {0}, other = {0};
  make_room(&room, 1, 0, VL_ISA_AUTO);
  make_room(&other, 1, 50, VL_ISA_AUTO);
  vlOccluders *o = calloc(1, sizeof *o);
  assert_non_null(o);
  static uint8_t blocked[BATCH];
  unsigned floats = vl_accel_enter();
  for (int batch = 0; batch < 20; batch++) {
    make_rays(room.world, 1, 0);
    vl_accel_occluded(room.world, BATCH, &all_rays, o, blocked);
  }
  assert_true(o->count > 0);
  vl_accel_occluded(other.world, BATCH, &all_rays, o, blocked);
  assert_int_equal(o->count, 0);
  for (int k = 0; k < BATCH; k++)
    if (o_[0][k] < 2 && o_[0][k] > -2)
      assert_true(!blocked[k] || end_[k] > 2);
  vl_accel_leave(floats);
  free(o);
  close_room(&room);
  close_room(&other);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(results_are_the_same),
      cmocka_unit_test(results_are_the_same_with_all_instruction_sets),
      cmocka_unit_test(unusual_worlds),
      cmocka_unit_test(forgotten_in_another_world),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
