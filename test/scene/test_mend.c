/* test/scene/test_mend.c: models that their files hide by mistake: an opacity of 0 everywhere,
 * parts that are wound inwards, shells that draw outlines; skies around landscapes. */
#include <math.h>

#include "model.h"
#include "unit.h"

static const float body_low[3] = {-1, 0, -1}, body_high[3] = {1, 2, 1};

static vlShapeDef *shape(const Model *m, size_t index) {
  return &m->scene->shapes.items[index];
}

static void invisible(void **state) {
  (void)state;
  for (int visible = 0; visible < 2; visible++) {
    Model m = begin();
    const float other_low[3] = {2, 0, 0}, other_high[3] = {3, 1, 1};
    add_box(&m, body_low, body_high, false, false);
    add_box(&m, other_low, other_high, false, false);
    shape(&m, 0)->alpha.value = 0;
    shape(&m, 1)->alpha.value = visible ? 0.5f : 0;
    vlCompleteDef def = first_image();
    complete(&m, &def);
    assert_true(shape(&m, 0)->alpha.value == (visible ? 0.0f : 1.0f));
    assert_true(shape(&m, 1)->alpha.value == (visible ? 0.5f : 1.0f));
    end(&m);
  }
}

/* A file with a camera and light keeps what it says. */
static void complete_files_stay(void **state) {
  (void)state;
  Model m = begin();
  add_box(&m, body_low, body_high, false, false);
  shape(&m, 0)->alpha.value = 0;
  vl_scene_defs(m.scene)->camera_missing = vl_scene_defs(m.scene)->light_missing = false;
  vlCompleteDef def = first_image();
  complete(&m, &def);
  assert_true(shape(&m, 0)->alpha.value == 0);
  end(&m);
}

/* A shell closely around the model is left out if it is one-sided and looks inwards; a room
 * around a table, and shells of two sides stay. */
static void outlines(void **state) {
  (void)state;
  const float near_low[3] = {-1.05f, -0.05f, -1.05f}, near_high[3] = {1.05f, 2.05f, 1.05f};
  const float wide_low[3] = {-3, 0, -3}, wide_high[3] = {3, 2.5f, 3};
  for (int k = 0; k < 4; k++) {
    const bool wide = k == 1, outward = k == 2, two_sided = k == 3;
    Model m = begin();
    add_box(&m, wide ? wide_low : near_low, wide ? wide_high : near_high, !outward, !two_sided);
    add_box(&m, body_low, body_high, false, true);
    vlCompleteDef def = first_image();
    complete(&m, &def);
    assert_true(shape(&m, 0)->alpha.value == (k == 0 ? 0.0f : 1.0f));
    assert_true(shape(&m, 1)->alpha.value == 1);
    assert_true(shape(&m, 1)->one_sided);
    end(&m);
  }
}

/* Of two objects the one that is wound inwards is seen from both sides, wherever they are. */
static void partly_inward(void **state) {
  (void)state;
  for (int far = 0; far < 2; far++) {
    Model m = begin();
    const float x = far ? 500.0f : 0;
    const float low[2][3] = {{x, 0, 0}, {x + 2, 0, 0}},
                high[2][3] = {{x + 1, 1, 1}, {x + 3, 1.1f, 1}};
    add_box(&m, low[0], high[0], true, true);
    add_box(&m, low[1], high[1], false, true);
    vlCompleteDef def = first_image();
    complete(&m, &def);
    assert_false(shape(&m, 0)->one_sided);
    assert_true(shape(&m, 1)->one_sided);
    end(&m);
  }
}

/* A ball whose faces look inwards. */
static void add_sky(Model *m, float radius) {
  enum { ROWS = 12, AROUND = 24 };
  float p[3 * (ROWS + 1) * AROUND];
  uint32_t indices[6 * ROWS * AROUND];
  const double pi = 3.14159265358979323846;
  for (int i = 0; i < (ROWS + 1) * AROUND; i++) {
    const double t = pi * (i / AROUND) / ROWS, turn = 2 * pi * (i % AROUND) / AROUND;
    p[3 * i] = radius * (float)(sin(t) * cos(turn));
    p[3 * i + 1] = radius * (float)cos(t);
    p[3 * i + 2] = radius * (float)(sin(t) * sin(turn));
  }
  for (uint32_t i = 0; i < ROWS * AROUND; i++) {
    const uint32_t a = i, b = i / AROUND * AROUND + (i + 1) % AROUND;
    const uint32_t quad[6] = {a, a + AROUND, b, b, a + AROUND, b + AROUND};
    for (int k = 0; k < 6; k++)
      indices[6 * i + (uint32_t)k] = quad[k];
  }
  add_triangles(m, (ROWS + 1) * AROUND, p, 2 * ROWS * AROUND, indices, false);
}

/* The camera frames a landscape, not the sky around it; a room's walls are framed. */
static void skies(void **state) {
  (void)state;
  const float land_low[3] = {-20, -2, -20}, land_high[3] = {20, 1, 20};
  const float wall_low[3] = {-50, -50, -50}, wall_high[3] = {50, 50, 50};
  for (int room = 0; room < 2; room++) {
    Model m = begin();
    if (room)
      add_box(&m, wall_low, wall_high, true, false);
    else
      add_sky(&m, 50);
    add_box(&m, land_low, land_high, false, false);
    vlCompleteDef def = first_image();
    complete(&m, &def);
    double low[3], high[3];
    assert_true(vl_scene_framed(m.scene, low, high));
    assert_true((high[0] - low[0] > 60) == (room == 1));
    end(&m);
  }
}

/* A room whose walls are .2 thick, of slabs or of a box in a box. */
static void add_room(Model *m, bool slabs) {
  const float low[3] = {0, 0, 0}, high[3] = {5, 3, 4};
  const float inner_low[3] = {0.2f, 0.2f, 0.2f}, inner_high[3] = {4.8f, 2.8f, 3.8f};
  if (!slabs) {
    add_box(m, low, high, false, false);
    add_box(m, inner_low, inner_high, true, false);
    return;
  }
  for (int side = 0; side < 6; side++) {
    float a[3], b[3];
    for (int i = 0; i < 3; i++) {
      a[i] = i > side / 2 ? inner_low[i] : low[i];
      b[i] = i > side / 2 ? inner_high[i] : high[i];
    }
    if (side % 2)
      a[side / 2] = inner_high[side / 2];
    else
      b[side / 2] = inner_low[side / 2];
    add_box(m, a, b, false, false);
  }
}

static size_t count_faces(const Model *m) {
  size_t faces = 0;
  for (size_t i = 0; i < m->scene->shapes.count; i++)
    if (m->scene->shapes.items[i].kind == VL_SHAPE_TRIANGLES)
      faces += m->scene->shapes.items[i].faces;
  return faces;
}

/* The walls on the camera's side are hidden, with their outside, if there is something in the
 * room. What is in it stays, and so do solid boxes. */
static void thick_walls(void **state) {
  (void)state;
  const float furniture[3][2][3] = {{{1, 0.2f, 1}, {2, 1, 1.8f}},
                                    {{3, 0.2f, 2.5f}, {4, 0.7f, 3.4f}},
                                    {{0.3f, 0.2f, 3}, {0.8f, 2.2f, 3.7f}}};
  const size_t in_room = 3 * 12;
  for (int slabs = 0; slabs < 2; slabs++)
    for (int furnished = 0; furnished < 2; furnished++) {
      Model m = begin();
      add_room(&m, slabs);
      for (int k = 0; k < 3 && furnished; k++)
        add_box(&m, furniture[k][0], furniture[k][1], false, false);
      const size_t before = count_faces(&m);
      vlCompleteDef def = first_image();
      complete(&m, &def);
      const size_t after = count_faces(&m);
      if (furnished) {
        /* three of the six walls */
        assert_true(before - after >= 12);
        assert_true(after >= in_room + 12);
      } else if (slabs) {
        assert_int_equal(after, before);
      }
      end(&m);
    }
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(invisible), cmocka_unit_test(complete_files_stay),
      cmocka_unit_test(outlines),  cmocka_unit_test(partly_inward),
      cmocka_unit_test(skies),     cmocka_unit_test(thick_walls),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
