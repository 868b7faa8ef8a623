/* bvh_worlds.h: worlds of random shapes for test_bvh.c: grids, loose triangles, curves,
 * quadrics and patches, in place and in instances, at rest and moving, of extreme sizes; each
 * is built with Embree's tree and with velo's own. */
#ifndef TEST_WORLD_BVH_WORLDS_H
#define TEST_WORLD_BVH_WORLDS_H

#include <math.h>
#include <string.h>
/* cmocka.h needs the headers above */

#include "unit.h"
#include "velo/material.h"
#include "velo/shape_kinds.h"
#include "velo/texture.h"
#include "world/world.h"

enum { SHAPES = 24, GRID = 5 };

static uint32_t seed;
static inline float random_unit(void) {
  seed = seed * 1664525u + 1013904223u;
  return (float)(seed >> 8) * 0x1p-24f;
}
static inline float random_signed(void) {
  return 2 * random_unit() - 1;
}
static inline uint32_t random_below(uint32_t n) {
  return (uint32_t)(random_unit() * (float)n);
}

typedef struct Case {
  const char *name;
  float size;
  bool plain, moving;      /* triangles */
  bool alpha, others;      /* alpha, one side, interfaces; curves, quadrics, patches */
  bool placed, travelling; /* in instances, in moving ones */
} Case;

typedef struct Made {
  vlContext *context;
  vlScene *scene;
  vlWorld *worlds[2]; /* Embree, BVH */
} Made;

typedef struct Kit {
  const Case *what;
  vlScene *scene;
  vlGroupId group;
  vlMaterialId interface;
  vlTextureId checks;
} Kit;

static inline void decorate(const Kit *k, vlShapeDef *def) {
  def->group = k->group;
  if (!k->what->alpha)
    return;
  if (random_unit() < 0.4f)
    def->alpha.texture = k->checks;
  if (random_unit() < 0.2f)
    def->material = k->interface;
  if (random_unit() < 0.3f)
    def->one_sided = def->kind == VL_SHAPE_TRIANGLES;
}

/* A grid of triangles in a plane or a curved surface, with corners on round numbers if `even`.
 * Some triangles have no area. */
static inline void add_grid(const Kit *k, bool even, bool moving) {
  float p[GRID * GRID][3], later[GRID * GRID][3],
      size = k->what->size, origin[3], wide = even ? 0.25f : 0.2f + 0.2f * random_unit();
  uint32_t faces[2 * (GRID - 1) * (GRID - 1)][3], count = 0;
  uint32_t axis = random_below(3);
  for (int i = 0; i < 3; i++)
    origin[i] = even ? 0.25f * (float)((int)random_below(7) - 3) : random_signed();
  for (int y = 0; y < GRID; y++)
    for (int x = 0; x < GRID; x++) {
      float at[3] = {(float)x * wide, (float)y * wide,
                     even ? 0 : 0.1f * random_signed() * wide};
      for (uint32_t i = 0; i < 3; i++) {
        p[y * GRID + x][i] = size * (origin[i] + at[(i + axis) % 3]);
        later[y * GRID + x][i] = p[y * GRID + x][i] + size * 0.3f * random_signed();
      }
    }
  for (uint32_t y = 0; y + 1 < GRID; y++)
    for (uint32_t x = 0; x + 1 < GRID; x++) {
      uint32_t a = y * GRID + x, f[6] = {a, a + 1, a + GRID, a + 1, a + GRID + 1, a + GRID};
      if (random_unit() < 0.05f)
        f[1] = f[0];
      memcpy(faces[count], f, sizeof f);
      count += 2;
    }
  vlShapeDef def = vl_default_shape_def(VL_SHAPE_TRIANGLES);
  def.positions = p[0];
  def.vertices = GRID * GRID;
  def.indices = faces[0];
  def.faces = count;
  if (moving)
    def.positions_close = later[0];
  if (moving && random_unit() < 0.5f)
    def.times[1] = 0.25; /* the steps of the world's time are quarters */
  decorate(k, &def);
  vl_scene_add_shape(k->scene, &def);
}

/* Triangles of any form and size. */
static inline void add_triangles(const Kit *k, bool moving) {
  enum { FACES = 16 };
  float p[3 * FACES][3], later[3 * FACES][3], size = k->what->size;
  uint32_t faces[FACES][3];
  for (uint32_t f = 0; f < FACES; f++) {
    float at[3] = {random_signed(), random_signed(), random_signed()},
          large = powf(10, -4 * random_unit());
    if (size < 1e-8f)
      large = 1;
    for (uint32_t c = 0; c < 3; c++) {
      faces[f][c] = 3 * f + c;
      for (uint32_t i = 0; i < 3; i++) {
        float thin = c == 1 && f % 3 == 0 ? (size < 1e-8f ? 0.3f : 0.001f) : 1;
        p[3 * f + c][i] = size * (at[i] + large * thin * random_signed());
        later[3 * f + c][i] = p[3 * f + c][i] + size * 0.3f * random_signed();
      }
    }
  }
  vlShapeDef def = vl_default_shape_def(VL_SHAPE_TRIANGLES);
  def.positions = p[0];
  def.vertices = 3 * FACES;
  def.indices = faces[0];
  def.faces = FACES;
  if (moving)
    def.positions_close = later[0];
  decorate(k, &def);
  vl_scene_add_shape(k->scene, &def);
}

static inline void set_pose(double m[16], float size, bool even) {
  memset(m, 0, 16 * sizeof *m);
  for (int i = 0; i < 3; i++) {
    for (int j = 0; j < 3; j++)
      m[4 * i + j] = even ? (i == j) : (double)(0.6f * random_signed()) + (i == j);
    m[4 * i + 3] = (double)(size * 0.7f * random_signed());
  }
  m[15] = 1;
}

static inline void add_other(const Kit *k, uint32_t which) {
  static const vlShapeKind kinds[] = {VL_SHAPE_SPHERE, VL_SHAPE_DISK, VL_SHAPE_CYLINDER,
                                      VL_SHAPE_BILINEAR, VL_SHAPE_CURVES};
  vlShapeDef def = vl_default_shape_def(kinds[which % 5]);
  float p[8][3], size = k->what->size,
                 widths[4] = {0.05f * size, 0.02f * size, 0.03f * size, 0.05f * size};
  static const uint32_t face[4] = {0, 1, 2, 3};
  for (int c = 0; c < 8; c++)
    for (int i = 0; i < 3; i++)
      p[c][i] = size * 0.5f * random_signed();
  def.positions = p[0];
  if (def.kind == VL_SHAPE_BILINEAR) {
    def.vertices = 4;
    def.faces = 1;
    def.indices = face;
  }
  if (def.kind == VL_SHAPE_CURVES) {
    def.vertices = 8;
    def.faces = 2;
    def.widths = widths;
  }
  def.radius = 0.3f * size;
  def.z_min = -0.2f * size;
  def.z_max = 0.2f * size;
  def.height = 0;
  set_pose(def.group_from_shape, size, false);
  decorate(k, &def);
  vl_scene_add_shape(k->scene, &def);
}

static inline void fill(Kit *k) {
  for (uint32_t i = 0; i < SHAPES; i++) {
    bool moving = k->what->moving && (!k->what->plain || i % 2);
    if (k->what->plain || k->what->moving) {
      add_grid(k, i % 2 || k->what->size != 1, moving);
      add_triangles(k, moving);
    }
    if (k->what->others)
      add_other(k, i);
  }
}

static inline void make_scene(const Case *what, Made *m, const vlContextDef *def) {
  seed = 7;
  assert_int_equal(vl_context_create(def, &m->context), VL_OK);
  assert_int_equal(vl_scene_create(m->context, &m->scene), VL_OK);
  Kit k = {.what = what, .scene = m->scene};
  vlMaterialDef nothing = vl_default_material_def(VL_MATERIAL_INTERFACE);
  k.interface = vl_scene_add_material(m->scene, &nothing);
  vlTextureDef checks = vl_default_texture_def(VL_TEXTURE_CHECKERBOARD, false);
  k.checks = vl_scene_add_texture(m->scene, &checks);
  fill(&k);
  for (int g = 0; g < 2 && (what->placed || what->travelling); g++) {
    k.group = vl_scene_add_group(m->scene, NULL);
    fill(&k);
    for (int i = 0; i < 4; i++) {
      double poses[32], times[2] = {0, 1};
      set_pose(poses, what->size, i == 0);
      set_pose(poses + 16, what->size, true);
      memcpy(poses + 16, poses, 11 * sizeof *poses);
      if (i % 2) {
        poses[16] *= 1.5;
        poses[21] *= 0.75;
        poses[17] += 0.2;
      }
      if (what->travelling && i < 3)
        vl_scene_add_moving_instance(m->scene, k.group, 2, times, poses, (vlSource){0});
      else
        vl_scene_add_instance(m->scene, k.group, poses, (vlSource){0});
    }
  }
}

static bool has_embree; /* else worlds[0] is null */

static inline void make(const Case *what, Made *m, vlIsa isa, uint32_t threads) {
  vlContextDef def = vl_default_context_def();
  def.isa = isa;
  def.threads = threads;
  make_scene(what, m, &def);
  vlBuildDef build = vl_default_build_def();
  for (int a = !has_embree; a < 2; a++) {
    build.accelerator = a ? VL_ACCELERATOR_BVH : VL_ACCELERATOR_EMBREE;
    vlError error = {0};
    if (vl_world_build(m->scene, &build, &m->worlds[a], &error) != VL_OK)
      fail_msg("%s: %s", what->name, error.message);
    assert_null(m->worlds[a]->accel.brute_force);
    assert_int_equal(m->worlds[a]->accel.kind, build.accelerator);
  }
}

static inline void unmake(Made *m) {
  for (int a = 0; a < 2; a++)
    vl_world_destroy(m->worlds[a]);
  vl_scene_destroy(m->scene);
  vl_context_destroy(m->context);
}

#endif
