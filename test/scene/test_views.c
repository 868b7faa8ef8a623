/* test/scene/test_views.c: views of a first image: planes that lean, parts that stand on one
 * plane, blocks of terrain, points far from the origin. */
#include <math.h>
#include <string.h>

#include "model.h"
#include "scene/tilt.h"
#include "scene/tray.h"
#include "unit.h"

/* The default up and front, +y and +z; a model that stands better along z gets that. */
static vlCompleteDef guessed(void) {
  vlCompleteDef def = first_image();
  def.find_up = true;
  return def;
}

static bool stands_along_z(const Model *m) {
  return vl_scene_completed(m->scene).up[2] != 0;
}

/* ---- planes ------------------------------------------------------------------------------ */

/* A box, turned by `angle` about the axis, as a transform of its shape. */
static void turn_box(Model *m, const float low[3], const float high[3], int axis,
                     double angle) {
  add_box(m, low, high, false, false);
  double *g = m->scene->shapes.items[m->scene->shapes.count - 1].group_from_shape;
  const int i = (axis + 1) % 3, j = (axis + 2) % 3;
  g[5 * i] = g[5 * j] = cos(angle);
  g[4 * i + j] = -sin(angle);
  g[4 * j + i] = sin(angle);
}

/* A disc that would be seen edge-on is seen open, from above where it faces up. */
static void leaning_discs(void **state) {
  (void)state;
  static const float low[3] = {-1, -0.01f, -1}, high[3] = {1, 0.01f, 1};
  static const float long_high[3] = {4, 0.01f, 0.02f};
  for (int axis = 0; axis < 3; axis += 2)
    for (int k = -4; k <= 4; k++) {
      const double angle = 0.3 * k;
      Model m = begin();
      turn_box(&m, low, high, axis, angle);
      vlCompleteDef def = first_image();
      complete(&m, &def);
      double d[3], n[3] = {axis == 2 ? -sin(angle) : 0, cos(angle), axis == 0 ? sin(angle) : 0},
                   found[3], open = 0, same = 0;
      toward_eye(&m, d);
      const vlExtent box = {{-1, -1, -1}, {1, 1, 1}};
      assert_true(vl_tilt_find(m.scene, &box, found));
      for (int i = 0; i < 3; i++) {
        open += d[i] * n[i];
        same += found[i] * n[i];
      }
      assert_true(fabs(same) > 1 - 1e-6);
      assert_true(fabs(open) > 0.55);
      assert_true(d[1] > -1e-6);
      end(&m);
    }
  Model m = begin(); /* a rod lies in many planes */
  turn_box(&m, low, long_high, 2, 0.3);
  const vlExtent box = {{-4, -4, -4}, {4, 4, 4}};
  double n[3];
  m.scene->shapes.items[0].group_from_shape[10] = 0.02;
  assert_false(vl_tilt_find(m.scene, &box, n));
  end(&m);
}

/* What is no plane is seen as it was: from the front, a little from the right and above. */
static void a_block_is_no_plane(void **state) {
  (void)state;
  static const float low[3] = {-1, -0.5f, -1}, high[3] = {1, 0.5f, 1};
  Model m = begin();
  turn_box(&m, low, high, 0, 0.3);
  vlCompleteDef def = first_image();
  complete(&m, &def);
  assert_true(fabs(vl_scene_completed(m.scene).azimuth - 0.45) < 1e-9);
  assert_true(fabs(vl_scene_completed(m.scene).elevation - 0.3) < 1e-9);
  end(&m);
}

/* ---- rooms without a ceiling ------------------------------------------------------------- */

/* Floor and four walls of boxes, with a ceiling or without, along the axis; or the sheet of a
 * box without its top. */
static void add_room(Model *m, int up, bool ceiling) {
  static const float parts[6][2][3] = {
      {{-2.2f, -0.2f, -2.7f}, {2.2f, 0, 2.7f}}, {{-2.2f, 0, -2.7f}, {-2, 2.5f, 2.7f}},
      {{2, 0, -2.7f}, {2.2f, 2.5f, 2.7f}},      {{-2, 0, -2.7f}, {2, 2.5f, -2.5f}},
      {{-2, 0, 2.5f}, {2, 2.5f, 2.7f}},         {{-2.2f, 2.5f, -2.7f}, {2.2f, 2.7f, 2.7f}}};
  for (int k = 0; k < (ceiling ? 6 : 5); k++) {
    float low[3], high[3];
    for (int i = 0; i < 3; i++) {
      low[(i + up + 2) % 3] = parts[k][0][i];
      high[(i + up + 2) % 3] = parts[k][1][i];
    }
    add_box(m, low, high, false, false);
  }
}

static void rooms_without_ceiling(void **state) {
  (void)state;
  for (int up = 1; up < 3; up++)
    for (int ceiling = 0; ceiling < 2; ceiling++) {
      Model m = begin();
      add_room(&m, up, ceiling);
      vlCompleteDef def = first_image();
      if (up == 2) {
        def.up[1] = def.front[2] = 0;
        def.up[2] = 1;
        def.front[1] = -1;
      }
      complete(&m, &def);
      assert_true((vl_scene_completed(m.scene).elevation > 0.8) == !ceiling);
      end(&m);
    }
  for (int k = 0; k < 3; k++) { /* a sheet; seen from one side; with its top */
    static const float low[3] = {-2, 0, -2}, high[3] = {2, 2, 2};
    static const uint32_t top[2] = {8, 9}; /* faces of the box at the high end of y */
    Model m = begin();
    add_box(&m, low, high, k == 1, k == 1);
    vlShapeDef *shape = &m.scene->shapes.items[0];
    uint32_t kept[36], n = 0;
    for (uint32_t face = 0; face < 12; face++)
      if (k == 2 || (face != top[0] && face != top[1]))
        for (uint32_t c = 0; c < 3; c++)
          kept[n++] = shape->indices[3 * face + c];
    shape->indices = kept;
    shape->faces = n / 3;
    const vlExtent box = {{-2, 0, -2}, {2, 2, 2}};
    assert_int_equal(vl_tray_is(m.scene, &box, 1), k == 0);
    end(&m);
  }
}

/* ---- what stands ------------------------------------------------------------------------- */

/* Corner k of a post with a pointed top: four below, four above, the tip; z: it points up along
 * z. */
static void post_point(int k, float x, float y, float height, bool z, float p[3]) {
  const float side = k == 8 ? 0 : 0.3f, level[3] = {0, 0.6f * height, height};
  const float a = x + (k % 4 == 1 || k % 4 == 2 ? side : -side),
              b = y + (k % 4 >= 2 ? side : -side), h = level[k / 4];
  p[0] = a;
  p[1] = z ? b : h;
  p[2] = z ? h : b;
}

/* A field of posts, each a shape; or boxes in their place, which stand on either side. */
static void add_field(Model *m, bool z, bool boxes) {
  static const uint32_t faces[42] = {0, 1, 5, 0, 5, 4, 1, 2, 6, 1, 6, 5, 2, 3,
                                     7, 2, 7, 6, 3, 0, 4, 3, 4, 7, 4, 5, 8, 5,
                                     6, 8, 6, 7, 8, 7, 4, 8, 0, 2, 1, 0, 3, 2};
  for (int k = 0; k < 20; k++) {
    const float x = (float)(k % 5) + 0.2f * sinf((float)k),
                y = (float)(k / 5) + 0.2f * cosf(3.0f * (float)k),
                height = 1 + fabsf(sinf(7 * (float)k));
    float p[27];
    for (int c = 0; c < 9; c++)
      post_point(c, x, y, height, z, p + 3 * c);
    const float low[3] = {x, z ? y : 0, z ? 0 : y},
                high[3] = {x + 0.5f, z ? y + 0.5f : 2, z ? 2 : y + 0.5f};
    if (boxes)
      add_box(m, low, high, false, false);
    else
      add_triangles(m, 9, p, 14, faces, false);
  }
}

/* Trees stand on their ground, whichever axis is up; boxes have no upper end. */
static void trees_stand(void **state) {
  (void)state;
  for (int z = 0; z < 2; z++)
    for (int boxes = 0; boxes < 2; boxes++) {
      Model m = begin();
      add_field(&m, z, boxes);
      vlCompleteDef def = guessed();
      complete(&m, &def);
      assert_int_equal(stands_along_z(&m), z && !boxes);
      end(&m);
    }
}

/* ---- terrain ----------------------------------------------------------------------------- */

enum { CELLS = 40, ROW = CELLS + 1 };

static float hill(int i, int j, float height) {
  return height * (sinf(0.4f * (float)i) * cosf(0.3f * (float)j) +
                   0.3f * sinf(1.7f * (float)i + 0.9f * (float)j));
}

/* A block with hills on top and a flat underside; z: upwards. */
static void add_block(Model *m, float height, bool z) {
  static float p[6 * ROW * ROW];
  static uint32_t indices[3 * (4 * CELLS * CELLS + 8 * CELLS)];
  uint32_t n = 0;
  for (int under = 0; under < 2; under++)
    for (int j = 0; j < ROW; j++)
      for (int i = 0; i < ROW; i++) {
        float *v = p + 3 * (under * ROW * ROW + j * ROW + i);
        const float up = under ? -0.5f : hill(i, j, height);
        v[0] = 2.0f * (float)i / CELLS;
        v[1] = z ? 2.0f * (float)j / CELLS : up;
        v[2] = z ? up : -2.0f * (float)j / CELLS;
      }
  for (uint32_t under = 0; under < 2; under++)
    for (uint32_t j = 0; j < CELLS; j++)
      for (uint32_t i = 0; i < CELLS; i++) {
        const uint32_t a = under * ROW * ROW + j * ROW + i, b = a + 1, c = a + ROW, d = c + 1;
        const uint32_t up[6] = {a, b, d, a, d, c};
        for (int k = 0; k < 6; k++)
          indices[n++] = up[under ? 5 - k : k];
      }
  for (uint32_t side = 0; side < 4; side++)
    for (uint32_t k = 0; k < CELLS; k++) {
      const uint32_t at[2] = {k, k + 1};
      uint32_t edge[2];
      for (int e = 0; e < 2; e++)
        edge[e] = side < 2 ? side * CELLS * ROW + at[e] : at[e] * ROW + (side - 2) * CELLS;
      const uint32_t a = edge[0], b = edge[1], below = ROW * ROW;
      const uint32_t wall[6] = {a, a + below, b + below, a, b + below, b};
      for (int c = 0; c < 6; c++)
        indices[n++] = wall[side == 1 || side == 2 ? 5 - c : c];
    }
  add_triangles(m, 2 * ROW * ROW, p, n / 3, indices, false);
}

static void blocks_of_terrain(void **state) {
  (void)state;
  for (int z = 0; z < 2; z++)
    for (int k = 1; k <= 3; k++) {
      Model m = begin();
      add_block(&m, 0.04f * (float)k, z);
      vlCompleteDef def = guessed();
      complete(&m, &def);
      assert_int_equal(stands_along_z(&m), z);
      end(&m);
    }
}

/* Points of terrain, as balls of eight faces, stand also where the numbers of their corners
 * are so large that the balls are crooked. */
static void points_far_away(void **state) {
  (void)state;
  static float p[18 * ROW * ROW];
  static uint32_t indices[24 * ROW * ROW];
  static const uint32_t ball[24] = {0, 2, 4, 2, 1, 4, 1, 3, 4, 3, 0, 4,
                                    2, 0, 5, 1, 2, 5, 3, 1, 5, 0, 3, 5};
  for (int far = 0; far < 2; far++) {
    for (int i = 0; i < ROW * ROW; i++)
      for (int k = 0; k < 6; k++) {
        float *v = p + 18 * i + 3 * k;
        v[0] = 5.0f * (float)(i % ROW) + (far ? 450000 : 0);
        v[1] = 5.0f * (float)(i / ROW) + (far ? 5200000 : 0);
        v[2] = hill(i % ROW, i / ROW, 10) + 300;
        v[k / 2] += k & 1 ? 0.9f : -0.9f;
      }
    for (uint32_t i = 0; i < 24 * ROW * ROW; i++)
      indices[i] = 6 * (i / 24) + ball[i % 24];
    Model m = begin();
    add_triangles(&m, 6 * ROW * ROW, p, 8 * ROW * ROW, indices, false);
    vlCompleteDef def = guessed();
    complete(&m, &def);
    assert_true(stands_along_z(&m));
    end(&m);
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(leaning_discs),         cmocka_unit_test(a_block_is_no_plane),
      cmocka_unit_test(rooms_without_ceiling), cmocka_unit_test(trees_stand),
      cmocka_unit_test(blocks_of_terrain),     cmocka_unit_test(points_far_away),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
