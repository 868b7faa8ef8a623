/* test/scene/test_first_image.c: the first image of a model: from where it is seen, how the
 * studio is scaled to its lamps, the walls that are hidden, the ground. */
#include <math.h>
#include <string.h>

#include "model.h"
#include "scene/lamps.h"
#include "scene/solid.h"
#include "scene/studio.h"
#include "unit.h"
#include "velo/light.h"
#include "velo/shape_kinds.h"

static void flat_models(void **state) {
  (void)state;
  for (int axis = 0; axis < 3; axis++)
    for (int up = 1; up < 3; up++) {
      Model m = begin();
      float low[3] = {-1, -1, -1}, high[3] = {1, 1, 1};
      low[axis] = -0.01f;
      high[axis] = 0.01f;
      add_box(&m, low, high, false, false);
      vlCompleteDef def = first_image();
      if (up == 2) {
        def.up[1] = 0;
        def.up[2] = 1;
        def.front[1] = -1;
        def.front[2] = 0;
      }
      complete(&m, &def);
      double d[3];
      toward_eye(&m, d);
      assert_true(fabs(d[axis]) > 0.75);
      end(&m);
      m = begin();
      add_box(&m, low, high, false, false);
      def = first_image();
      def.framing = VL_FRAMING_CORNER;
      complete(&m, &def);
      toward_eye(&m, d);
      assert_true(fabs(d[2]) > 0.8 && d[1] > 0.2);
      end(&m);
    }
}

/* A ball at x = `x` whose triangles are smaller on the side of -z than on that of +z, finer
 * times as many. */
enum { COLUMNS_OF_BALL = 24, COARSE = 16, MAX_RINGS = 80 };

static void add_ball(Model *m, float x, int finer, bool inward) {
  static float p[3 * (MAX_RINGS + 1) * COLUMNS_OF_BALL];
  static uint32_t indices[6 * MAX_RINGS * COLUMNS_OF_BALL];
  const int rings = COARSE * (1 + finer);
  const double pi = 3.14159265358979323846;
  size_t faces = 0;
  for (int r = 0; r <= rings; r++) {
    const double t = r < COARSE ? 0.5 * pi * r / COARSE
                                : 0.5 * pi * (1 + (double)(r - COARSE) / (COARSE * finer));
    for (int c = 0; c < COLUMNS_OF_BALL; c++) {
      float *v = p + 3 * (r * COLUMNS_OF_BALL + c);
      v[0] = x + (float)(sin(t) * cos(2 * pi * c / COLUMNS_OF_BALL));
      v[1] = (float)(sin(t) * sin(2 * pi * c / COLUMNS_OF_BALL));
      v[2] = (float)cos(t);
    }
  }
  for (int r = 0; r < rings; r++)
    for (int c = 0; c < COLUMNS_OF_BALL; c++) {
      const uint32_t a = (uint32_t)(r * COLUMNS_OF_BALL + c),
                     b = (uint32_t)(r * COLUMNS_OF_BALL + (c + 1) % COLUMNS_OF_BALL),
                     n = COLUMNS_OF_BALL;
      const uint32_t quad[6] = {a, a + n, b, b, a + n, b + n};
      for (int k = 0; k < 6; k++)
        indices[3 * faces + (size_t)k] = quad[inward ? 5 - k : k];
      faces += 2;
    }
  vlShapeDef def = vl_default_shape_def(VL_SHAPE_TRIANGLES);
  def.vertices = (size_t)((rings + 1) * COLUMNS_OF_BALL);
  def.faces = faces;
  def.positions = p;
  def.indices = indices;
  assert_int_not_equal(vl_scene_add_shape(m->scene, &def).index, 0);
}

/* A model with more detail behind is seen from there, whichever way its triangles are wound and
 * wherever it is, unless its file or an option says which side is the front. */
static void detail_is_in_front(void **state) {
  (void)state;
  for (int given = 0; given < 3; given++)
    for (int finer = 1; finer <= 4; finer += 3)
      for (int inward = 0; inward < 2; inward++)
        for (int far = 0; far < 2; far++) {
          Model m = begin();
          add_ball(&m, far ? 1000 : 0, finer, inward);
          vlCompleteDef def = first_image();
          def.open_walls = false;
          def.find_up = given != 1;
          if (given == 2)
            def.azimuth = 0.25;
          complete(&m, &def);
          double d[3];
          toward_eye(&m, d);
          if (given == 0 && finer > 1)
            assert_true(d[2] < -0.8 && d[0] < -0.3);
          else
            assert_true(d[2] > 0.8 && d[0] > 0.2);
          assert_true(d[1] > 0.2);
          const double azimuth = vl_scene_completed(m.scene).azimuth;
          assert_true((fabs(azimuth) > 3) == (given == 0 && finer > 1));
          end(&m);
        }
}

/* The arrays must live until the shape is added. */
static vlShapeDef one_triangle(const float positions[9], const uint32_t corners[3]) {
  vlShapeDef shape = vl_default_shape_def(VL_SHAPE_TRIANGLES);
  shape.vertices = 3;
  shape.faces = 1;
  shape.positions = positions;
  shape.indices = corners;
  return shape;
}

/* A sheet that looks backwards is seen from behind. */
static void sheet_from_behind(void **state) {
  (void)state;
  for (int back = 0; back < 2; back++) {
    Model m = begin();
    const float p[9] = {0, 0, 0, 1, 0, 0, 0, 1, 0};
    const uint32_t front[3] = {0, 1, 2}, behind[3] = {0, 2, 1};
    vlShapeDef shape = one_triangle(p, back ? behind : front);
    assert_int_not_equal(vl_scene_add_shape(m.scene, &shape).index, 0);
    vlCompleteDef def = first_image();
    complete(&m, &def);
    double d[3];
    toward_eye(&m, d);
    assert_true(back ? d[2] < -0.8 : d[2] > 0.8);
    end(&m);
  }
}

/* Mirroring turns the corners' order and keeps the outside on its side. */
static void mirrored_sheet(void **state) {
  (void)state;
  for (int axis = 0; axis < 3; axis++) {
    Model m = begin();
    const float p[9] = {0, 0, 0, 1, 0, 0, 0, 1, 0};
    const uint32_t front[3] = {0, 1, 2};
    vlShapeDef shape = one_triangle(p, front);
    shape.group_from_shape[5 * axis] = -1;
    assert_int_not_equal(vl_scene_add_shape(m.scene, &shape).index, 0);
    vlCompleteDef def = first_image();
    complete(&m, &def);
    double d[3];
    toward_eye(&m, d);
    assert_true(axis == 2 ? d[2] < -0.8 : d[2] > 0.8);
    end(&m);
  }
}

/* A ground whose faces look down is seen from above, unless it cannot be seen from there. */
static void ground_from_above(void **state) {
  (void)state;
  for (int one_sided = 0; one_sided < 2; one_sided++) {
    Model m = begin();
    const float p[9] = {0, 0, 0, 1, 0, 0, 0, 0, 1};
    const uint32_t down[3] = {0, 1, 2};
    vlShapeDef shape = one_triangle(p, down);
    shape.one_sided = one_sided;
    assert_int_not_equal(vl_scene_add_shape(m.scene, &shape).index, 0);
    vlCompleteDef def = first_image();
    complete(&m, &def);
    double d[3];
    toward_eye(&m, d);
    assert_true(one_sided ? d[1] < -0.7 : d[1] > 0.7);
    end(&m);
  }
}

/* A thin box has no front but by the rounding of its sums: it is seen from the front, and so is
 * a chart of the given depth. */
static void charts(void **state) {
  (void)state;
  for (int k = 0; k < 8; k++) {
    Model m = begin();
    const float s = 1 + 0.137f * (float)k, depth = k & 1 ? 0.03f : 0.38f,
                low[3] = {-0.31f * s, 0.17f, -depth * s}, high[3] = {0.83f * s, 0.17f + s, 0};
    add_box(&m, low, high, false, false);
    vlCompleteDef def = first_image();
    complete(&m, &def);
    double d[3];
    toward_eye(&m, d);
    assert_true(d[2] > 0.9);
    end(&m);
  }
}

/* A body that is turned about y: radii and heights from the lowest to the highest. z: turned
 * about z. */
static void add_turned(Model *m, const float (*profile)[2], uint32_t rows, bool z) {
  enum { AROUND = 24, MAX_ROWS = 16 };
  float p[3 * AROUND * MAX_ROWS];
  uint32_t indices[6 * AROUND * MAX_ROWS], n = 0;
  for (uint32_t i = 0; i < rows; i++)
    for (uint32_t k = 0; k < AROUND; k++) {
      const double turn = 2 * M_PI * k / AROUND;
      float *v = p + 3 * (i * AROUND + k);
      v[0] = profile[i][0] * (float)cos(turn);
      v[z ? 2 : 1] = profile[i][1];
      v[z ? 1 : 2] = profile[i][0] * (float)(z ? sin(turn) : -sin(turn));
    }
  for (uint32_t i = 0; i + 1 < rows; i++)
    for (uint32_t k = 0; k < AROUND; k++) {
      const uint32_t a = i * AROUND + k, b = i * AROUND + (k + 1) % AROUND;
      const uint32_t own[6] = {a, b, b + AROUND, a, b + AROUND, a + AROUND};
      memcpy(indices + n, own, sizeof own);
      n += 6;
    }
  vlShapeDef def = vl_default_shape_def(VL_SHAPE_TRIANGLES);
  def.vertices = rows * AROUND;
  def.faces = n / 3;
  def.positions = p;
  def.indices = indices;
  assert_int_not_equal(vl_scene_add_shape(m->scene, &def).index, 0);
}

/* A figure on a plinth, a vase, a post and a ball: turned about y or z, while y or z is taken
 * for upwards. What stands only one way stands so; what lies either way stays as it was. */
static void upright(void **state) {
  (void)state;
  static const float figure[8][2] = {{0, 0},        {0.5f, 0},     {0.5f, 0.3f}, {0.2f, 0.5f},
                                     {0.15f, 0.9f}, {0.35f, 1.2f}, {0.3f, 1.6f}, {0, 1.8f}};
  static const float vase[5][2] = {
      {0.2f, 0}, {0.45f, 0.6f}, {0.5f, 0.8f}, {0.25f, 1.3f}, {0.4f, 1.5f}};
  static const float post[2][2] = {{0.5f, 0}, {0.5f, 1.5f}};
  static const float ball[9][2] = {{0, -1},         {0.38f, -0.92f}, {0.71f, -0.71f},
                                   {0.92f, -0.38f}, {1, 0},          {0.92f, 0.38f},
                                   {0.71f, 0.71f},  {0.38f, 0.92f},  {0, 1}};
  static const struct {
    const float (*profile)[2];
    uint32_t rows;
    bool stands;
  } bodies[4] = {{figure, 8, true}, {vase, 5, true}, {post, 2, false}, {ball, 9, false}};
  for (int k = 0; k < 4; k++)
    for (int z = 0; z < 2; z++)
      for (int guess = 0; guess < 2; guess++)
        for (int find = 0; find < 2; find++) {
          Model m = begin();
          add_turned(&m, bodies[k].profile, bodies[k].rows, z);
          vlCompleteDef def = first_image();
          const double up[2][3] = {{0, 1, 0}, {0, 0, 1}}, front[2][3] = {{0, 0, 1}, {0, -1, 0}};
          memcpy(def.up, up[guess], sizeof def.up);
          memcpy(def.front, front[guess], sizeof def.front);
          def.find_up = find;
          complete(&m, &def);
          const int is_z = find && bodies[k].stands ? z : guess;
          const vlCompleteDef done = vl_scene_completed(m.scene);
          assert_memory_equal(done.up, up[is_z], sizeof def.up);
          assert_memory_equal(done.front, front[is_z], sizeof def.front);
          assert_memory_equal(m.scene->defs.camera.up, up[is_z], sizeof def.up);
          assert_false(done.find_up);
          end(&m);
        }
}

static const float wall_low[3] = {-2, 0, -2}, wall_high[3] = {2, 2.5f, 2};
static const float table_low[3] = {-0.5f, 0, -0.5f}, table_high[3] = {0.5f, 0.8f, 0.5f};

/* The walls, floor and ceiling on the camera's side are hidden, two triangles each; kept where
 * the caller wants it. */
static void rooms(void **state) {
  (void)state;
  for (int inward = 0; inward < 2; inward++)
    for (int hidden = 0; hidden < 2; hidden++) {
      Model m = begin();
      add_box(&m, wall_low, wall_high, inward, inward);
      add_box(&m, table_low, table_high, false, false);
      vlCompleteDef def = first_image();
      def.open_walls = hidden;
      complete(&m, &def);
      assert_int_equal(m.scene->shapes.items[0].faces, hidden ? 6 : 12);
      assert_int_equal(m.scene->shapes.items[1].faces, 12);
      const vlShapeDef *d = &m.scene->shapes.items[0];
      /* none lies in the planes x = 2, y = 2.5, z = 2 */
      for (uint32_t i = 0; hidden && i < d->faces; i++) {
        for (int k = 0; k < 3; k++) {
          bool all = true;
          for (int c = 0; c < 3; c++)
            all = all && d->positions[3 * d->indices[3 * i + (uint32_t)c] + (uint32_t)k] ==
                             wall_high[k];
          assert_false(all);
        }
      }
      end(&m);
    }
}

/* A closed object is no room: alone; with wrong winding; around a part that is not hidden. */
static void objects(void **state) {
  (void)state;
  for (int k = 0; k < 3; k++) {
    Model m = begin();
    add_box(&m, wall_low, wall_high, k == 1, false);
    const float low[3] = {1.5f, 1, -1}, high[3] = {3, 1.5f, 1};
    if (k == 2)
      add_box(&m, low, high, false, false);
    vlCompleteDef def = first_image();
    complete(&m, &def);
    assert_int_equal(m.scene->shapes.items[0].faces, 12);
    end(&m);
  }
}

/* Mirrored objects of one-sided faces are whole, and mirrored rooms are opened. */
static void mirrored_walls(void **state) {
  (void)state;
  for (int inward = 0; inward < 2; inward++) {
    Model m = begin();
    add_box(&m, wall_low, wall_high, inward, true);
    m.scene->shapes.items[0].group_from_shape[0] = -1;
    if (inward)
      add_box(&m, table_low, table_high, false, false);
    vlCompleteDef def = first_image();
    complete(&m, &def);
    assert_int_equal(m.scene->shapes.items[0].faces, inward ? 6 : 12);
    end(&m);
  }
}

/* An object whose one-sided faces look inwards is seen from both sides: alone; in two parts,
 * one in the other; with vertex normals that say its outside. Its faces stay as they are where
 * they are not one-sided, where what it contains looks outwards, and where the caller says what
 * is to be done with walls. */
static void turned(void **state) {
  (void)state;
  enum { ALONE, PARTS, TWO_SIDED, AROUND, KEPT, GIVEN, CASES };
  static const float figure[8][2] = {{0, 0},        {0.5f, 0},     {0.5f, 0.3f}, {0.2f, 0.5f},
                                     {0.15f, 0.9f}, {0.35f, 1.2f}, {0.3f, 1.6f}, {0, 1.8f}};
  static const float low[3] = {-0.1f, 0.1f, -0.1f}, high[3] = {0.1f, 0.2f, 0.1f};
  for (int k = 0; k < CASES; k++) {
    Model m = begin();
    add_turned(&m, figure, 8, false);
    vlShapeDef *shape = &m.scene->shapes.items[0];
    const size_t faces = shape->faces;
    shape->reverse_orientation = true;
    shape->one_sided = k != TWO_SIDED;
    if (k == PARTS || k == AROUND)
      add_box(&m, low, high, k == PARTS, true);
    vlCompleteDef def = first_image();
    def.open_walls = k != KEPT;
    for (int i = 0; i < 3 && k == GIVEN; i++)
      def.walls_from[i] = 3;
    complete(&m, &def);
    shape = &m.scene->shapes.items[0];
    const vlCompleteDef done = vl_scene_completed(m.scene);
    const bool found = k == ALONE || k == PARTS;
    assert_int_equal(done.both_sides, found);
    assert_int_equal(shape->one_sided, !found && k != TWO_SIDED);
    assert_int_equal(done.open_walls, k == AROUND || k == GIVEN);
    assert_int_equal(shape->faces < faces, k == AROUND || k == GIVEN);
    if (k == PARTS)
      assert_false(m.scene->shapes.items[1].one_sided);
    end(&m);
  }
}

/* A convex shell that contains nothing is a panorama if there is something to see on it, else
 * an object that is wound the wrong way. */
static void bare_shells(void **state) {
  (void)state;
  static const float colors[32] = {1, 0, 0, 1, 0, 1, 0, 1};
  for (int coloured = 0; coloured < 2; coloured++) {
    Model m = begin();
    add_box(&m, wall_low, wall_high, true, true);
    m.scene->shapes.items[0].colors = coloured ? colors : NULL;
    vlCompleteDef def = first_image();
    complete(&m, &def);
    const vlCameraDef *c = &m.scene->defs.camera;
    assert_int_equal(vl_scene_completed(m.scene).both_sides, !coloured);
    assert_int_equal(fabs(c->eye[0]) < 2 && fabs(c->eye[2]) < 2, coloured);
    end(&m);
  }
}

/* The camera is in the dome and frames what the dome contains; the half on its side is
 * hidden. */
static void dome(void **state) {
  (void)state;
  Model m = begin();
  const float low[3] = {-50, -50, -50}, high[3] = {50, 50, 50};
  add_box(&m, low, high, true, true);
  add_box(&m, table_low, table_high, false, false);
  vlCompleteDef def = first_image();
  complete(&m, &def);
  const vlCameraDef *c = &m.scene->defs.camera;
  assert_true(fabs(c->eye[0]) < 10 && fabs(c->eye[1]) < 10 && fabs(c->eye[2]) < 10);
  assert_true(m.scene->shapes.items[0].faces < 12);
  assert_int_equal(m.scene->shapes.count, 2); /* no ground */
  end(&m);
}

/* The ground lies under the model, is a backdrop, and is left out where nothing asks for it. */
static void ground(void **state) {
  (void)state;
  for (int wanted = 0; wanted < 2; wanted++) {
    Model m = begin();
    const float low[3] = {-1, 3, -1}, high[3] = {1, 5, 1};
    add_box(&m, low, high, false, false);
    vlCompleteDef def = first_image();
    def.backdrop = wanted;
    complete(&m, &def);
    assert_int_equal(m.scene->shapes.count, 1 + wanted);
    if (wanted) {
      const vlShapeDef *d = &m.scene->shapes.items[1];
      assert_true(d->backdrop && d->alpha.texture.index);
      assert_true(d->group_from_shape[7] <= 3 && d->group_from_shape[7] > 2.99);
    }
    end(&m);
  }
}

/* The studio's radiance is proportional to the lamps' light. */
static void lamps(void **state) {
  (void)state;
  const float lux[3] = {0.01f, 6830, 100000};
  for (int i = 0; i < 3; i++)
    for (int point = 0; point < 2; point++) {
      Model m = begin();
      add_box(&m, table_low, table_high, false, false);
      vlLightDef light = vl_default_light_def(point ? VL_LIGHT_POINT : VL_LIGHT_DISTANT);
      light.color = vl_spectrum_rgb(1, 1, 1);
      light.scale = lux[i] * (point ? 1e6f : 1);
      if (point) { /* as far as the distant one is to the model */
        light.from[1] = 400;
        light.world_from_light[7] = 600;
      }
      assert_int_not_equal(vl_scene_add_light(m.scene, &light).index, 0);
      vlCompleteDef def = first_image();
      complete(&m, &def);
      const vlLightDef *studio = &m.scene->lights.items[1];
      double ratio = (double)studio->scale * M_PI / (double)lux[i];
      assert_true(ratio > 0.25 && ratio < 0.36); /* quarters of a stop */
      end(&m);
    }
}

/* Many spheres of one shape have the box of all of them. */
static void box_of_spheres(void **state) {
  (void)state;
  const double centers[9] = {0, 0, 0, 5, 0, -1, 1, -7, 0};
  const float radii[3] = {1, 2, 0.5f};
  vlShapeDef def = vl_default_shape_def(VL_SHAPE_SPHERE);
  def.faces = 3;
  def.centers = centers;
  def.radii = radii;
  const vlExtent box = vl_shape_box(&def);
  const double low[3] = {-1, -7.5, -3}, high[3] = {7, 2, 1};
  for (int i = 0; i < 3; i++) {
    assert_true(fabs(box.low[i] - low[i]) < 1e-6);
    assert_true(fabs(box.high[i] - high[i]) < 1e-6);
  }
}

/* ---- what was chosen, as a def ----------------------------------------------------------- */

enum { PLAIN, FLAT, FROM_BEHIND, LAMP, ROOM, DOME, LIT_DOME, SHELL, CASES };

static void add_shell(Model *m, float side, bool lit) {
  const float low[3] = {-side, -side, -side}, high[3] = {side, side, side};
  add_box(m, low, high, true, true);
  if (!lit)
    return;
  vlShapeDef *d = &m->scene->shapes.items[0];
  vlEmissionDef light = vl_default_emission_def();
  light.radiance = vl_spectrum_rgb(1, 1, 1);
  d->emission = vl_scene_add_emission(m->scene, &light);
  assert_int_not_equal(d->emission.index, 0);
}

static Model begin_case(int k) {
  Model m = begin();
  const float low[3] = {-1, 0, -0.01f}, high[3] = {1, 1.3f, 0.01f};
  if (k == ROOM)
    add_box(&m, wall_low, wall_high, true, true);
  if (k == DOME || k == LIT_DOME || k == SHELL)
    add_shell(&m, 50, k == LIT_DOME);
  if (k == FLAT || k == FROM_BEHIND)
    add_box(&m, low, high, k == FROM_BEHIND, false);
  else if (k != SHELL)
    add_box(&m, table_low, table_high, false, false);
  if (k != LAMP)
    return m;
  vlLightDef light = vl_default_light_def(VL_LIGHT_DISTANT);
  light.scale = 1234;
  assert_int_not_equal(vl_scene_add_light(m.scene, &light).index, 0);
  return m;
}

static void assert_same_scenes(const Model *a, const Model *b, bool cameras) {
  const vlScene *s = a->scene, *t = b->scene;
  assert_int_equal(s->shapes.count, t->shapes.count);
  for (size_t i = 0; i < s->shapes.count; i++) {
    const vlShapeDef *c = &s->shapes.items[i], *d = &t->shapes.items[i];
    assert_int_equal(c->faces, d->faces);
    assert_int_equal(c->backdrop, d->backdrop);
    assert_memory_equal(&c->radius, &d->radius, sizeof c->radius);
    assert_memory_equal(c->group_from_shape, d->group_from_shape, sizeof c->group_from_shape);
    if (c->faces)
      assert_memory_equal(c->indices, d->indices, 3 * c->faces * sizeof *c->indices);
  }
  assert_int_equal(s->lights.count, t->lights.count);
  for (size_t i = 0; i < s->lights.count; i++) {
    const vlLightDef *c = &s->lights.items[i], *d = &t->lights.items[i];
    assert_memory_equal(&c->scale, &d->scale, sizeof c->scale);
    assert_memory_equal(c->world_from_light, d->world_from_light, sizeof c->world_from_light);
  }
  const vlCameraDef *c = &s->defs.camera, *d = &t->defs.camera;
  for (int i = 0; i < 3 && cameras; i++)
    assert_true(c->eye[i] == d->eye[i] && c->lookat[i] == d->lookat[i] && c->up[i] == d->up[i]);
  assert_true(!cameras || c->fov == d->fov);
}

/* A scene that is completed by what was chosen has the same camera, lights, ground and walls;
 * all but the camera also where the camera is another. */
static void choices_as_a_def(void **state) {
  (void)state;
  for (int k = 0; k < CASES; k++)
    for (int variant = 0; variant < 8; variant++) {
      vlCompleteDef def = first_image();
      def.ground = variant & 1;
      def.framing = variant & 2 ? VL_FRAMING_FRONT : VL_FRAMING_AUTO;
      if (variant & 4)
        memcpy(def.up, (double[3]){0, 0, 1}, sizeof def.up);
      if (variant & 4)
        memcpy(def.front, (double[3]){0, -1, 0}, sizeof def.front);
      Model m = begin_case(k), again = begin_case(k), other = begin_case(k);
      complete(&m, &def);
      vlCompleteDef chosen = vl_scene_completed(m.scene);
      assert_int_not_equal(chosen.environment, VL_ENVIRONMENT_AUTO);
      complete(&again, &chosen);
      assert_same_scenes(&m, &again, true);
      const vlCompleteDef twice = vl_scene_completed(again.scene);
      assert_memory_equal(&chosen, &twice, sizeof twice);
      other.scene->defs.camera_missing = false;
      other.scene->defs.camera.eye[0] = 77;
      complete(&other, &chosen);
      assert_same_scenes(&m, &other, false);
      assert_true(other.scene->defs.camera.eye[0] == 77);
      end(&m);
      end(&again);
      end(&other);
    }
}

/* A floor of the studio's albedo has the radiance of the studio's floor where a camera sees one
 * go over into the other, no studio has a colour cast on it that its floor has not, and other
 * environments are no studios. */
static void studios_have_floors(void **state) {
  (void)state;
  static const vlEnvironmentKind kinds[] = {VL_ENVIRONMENT_STUDIO, VL_ENVIRONMENT_WINDOW,
                                            VL_ENVIRONMENT_EVENING};
  enum { ROWS = 180, COLUMNS = 360 };
  const double degree = 3.14159265358979323846 / 180;
  for (int k = 0; k < 3; k++) {
    const vlStudio *studio = vl_studio(kinds[k]);
    double white[3] = {0, 0, 0}; /* radiance of a white floor */
    for (int row = 0; row < ROWS; row++)
      for (int column = 0; column < COLUMNS; column++) {
        const double e = 90.0 * (row + 0.5) / ROWS * degree, a = (column + 0.5) * degree;
        const vlVec3 d = {(float)(cos(e) * sin(a)), (float)(cos(e) * cos(a)), (float)sin(e)};
        float rgb[3] = {0, 0, 0};
        studio->radiance(d, rgb);
        for (int c = 0; c < 3; c++)
          white[c] += (double)rgb[c] * sin(e) * cos(e) * degree * degree * 0.5 / (180 * degree);
      }
    float rgb[3] = {0, 0, 0};
    studio->radiance((vlVec3){0, (float)cos(25 * degree), -(float)sin(25 * degree)}, rgb);
    for (int c = 0; c < 3; c++) {
      const double ratio = (double)studio->floor[c] * white[c] / (double)rgb[c];
      if (!(fabs(ratio - 1) < 0.15))
        print_message("studio %d, channel %d: %.3f\n", k, c, ratio);
      assert_true(fabs(ratio - 1) < 0.15);
    }
    assert_true(vl_environment_is_studio(kinds[k]));
  }
  assert_false(vl_environment_is_studio(VL_ENVIRONMENT_SKY));
  assert_false(vl_environment_is_studio(VL_ENVIRONMENT_FILE));
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(flat_models),
      cmocka_unit_test(detail_is_in_front),
      cmocka_unit_test(sheet_from_behind),
      cmocka_unit_test(ground_from_above),
      cmocka_unit_test(charts),
      cmocka_unit_test(upright),
      cmocka_unit_test(rooms),
      cmocka_unit_test(objects),
      cmocka_unit_test(mirrored_sheet),
      cmocka_unit_test(mirrored_walls),
      cmocka_unit_test(turned),
      cmocka_unit_test(bare_shells),
      cmocka_unit_test(dome),
      cmocka_unit_test(ground),
      cmocka_unit_test(lamps),
      cmocka_unit_test(box_of_spheres),
      cmocka_unit_test(choices_as_a_def),
      cmocka_unit_test(studios_have_floors),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
