/* test/scene/test_framed.c: what of a model the added camera frames, and how it stands: stray
 * parts, wide grounds, cities. */
#include <string.h>

#include "model.h"

/* Of a point in world space: its place in the image of the added camera, -1 to 1 in the smaller
 * direction. */
static void project(const Model *m, const double p[3], double image[2]) {
  const vlCameraDef *c = &m->scene->defs.camera;
  double ahead[3], right[3], up[3], d[3], length = 0, along = 0;
  for (int i = 0; i < 3; i++) {
    ahead[i] = c->lookat[i] - c->eye[i];
    length += ahead[i] * ahead[i];
  }
  for (int i = 0; i < 3; i++)
    ahead[i] /= sqrt(length);
  for (int i = 0; i < 3; i++) {
    const int j = (i + 1) % 3, k = (i + 2) % 3;
    right[i] = ahead[j] * c->up[k] - ahead[k] * c->up[j];
  }
  length = sqrt(right[0] * right[0] + right[1] * right[1] + right[2] * right[2]);
  for (int i = 0; i < 3; i++)
    right[i] /= length;
  for (int i = 0; i < 3; i++) {
    const int j = (i + 1) % 3, k = (i + 2) % 3;
    up[i] = right[j] * ahead[k] - right[k] * ahead[j];
    d[i] = p[i] - c->eye[i];
  }
  image[0] = image[1] = 0;
  for (int i = 0; i < 3; i++) {
    along += d[i] * ahead[i];
    image[0] += d[i] * right[i];
    image[1] += d[i] * up[i];
  }
  for (int i = 0; i < 2; i++)
    image[i] /= along * tan(0.5 * c->fov);
}

/* The larger side of the rectangle that a box takes in the image: 2 is the image's height. */
static double size_in_image(const Model *m, const float low[3], const float high[3],
                            bool *whole) {
  double min[2] = {INFINITY, INFINITY}, max[2] = {-INFINITY, -INFINITY};
  const double aspect = 1.5;
  for (int k = 0; k < 8; k++) {
    const double p[3] = {(double)(k & 1 ? high[0] : low[0]), (double)(k & 2 ? high[1] : low[1]),
                         (double)(k & 4 ? high[2] : low[2])};
    double q[2];
    project(m, p, q);
    for (int i = 0; i < 2; i++) {
      min[i] = fmin(min[i], q[i]);
      max[i] = fmax(max[i], q[i]);
    }
  }
  *whole = min[0] > -aspect && max[0] < aspect && min[1] > -1 && max[1] < 1;
  return fmax(max[0] - min[0], max[1] - min[1]);
}

static const float low[3] = {-1, 0, -0.6f}, high[3] = {1, 1.5f, 0.6f};

/* Small parts far away along an axis, to one side or both: the image is that of the model, and
 * so is the ground. */
static void stray_parts(void **state) {
  (void)state;
  const float distances[3] = {8, 1000, 1e5f};
  for (int axis = 0; axis < 3; axis++)
    for (int k = 0; k < 3; k++)
      for (int sides = 1; sides < 3; sides++) {
        Model m = begin();
        add_box(&m, low, high, false, false);
        for (int side = 0; side < sides; side++) {
          float a[3] = {0, 0.5f, 0}, b[3];
          a[axis] += side ? -distances[k] : distances[k];
          for (int i = 0; i < 3; i++)
            b[i] = a[i] + 0.02f;
          add_box(&m, a, b, false, false);
        }
        vlCompleteDef def = first_image();
        complete(&m, &def);
        bool whole;
        assert_true(size_in_image(&m, low, high, &whole) > 1 && whole);
        const vlShapeDef *disk = &m.scene->shapes.items[m.scene->shapes.count - 1];
        assert_true(fabs(disk->group_from_shape[7]) < 0.01); /* the ground is under the model */
        assert_true(vl_scene_completed(m.scene).ground_radius < 100);
        end(&m);
      }
}

/* A box whose corners are a grid of its faces, one of which, on a side, is far away: the image
 * is that of the rest, also if no corners are shared, and so is what a turntable goes around.
 */
static void lone_corner(void **state) {
  (void)state;
  enum { SIDE = 20, FACES = 6 * 2 * SIDE * SIDE };
  static float p[9 * FACES];
  static uint32_t indices[3 * FACES];
  for (int far_away = 0; far_away < 2; far_away++) {
    uint32_t n = 0;
    for (int side = 0; side < 6; side++)
      for (int k = 0; k < 6 * SIDE * SIDE; k++, n++) {
        static const int corners[6][2] = {{0, 0}, {1, 0}, {1, 1}, {0, 0}, {1, 1}, {0, 1}};
        const int i = k / 6 % SIDE + corners[k % 6][0], j = k / 6 / SIDE + corners[k % 6][1];
        const int axis = side / 2, u = (axis + 1) % 3, v = (axis + 2) % 3;
        p[3 * n + (uint32_t)axis] = side & 1 ? high[axis] : low[axis];
        p[3 * n + (uint32_t)u] = low[u] + (high[u] - low[u]) * (float)i / SIDE;
        p[3 * n + (uint32_t)v] = low[v] + (high[v] - low[v]) * (float)j / SIDE;
        if (far_away && side == 5 && i == 10 && j == 10)
          memcpy(p + 3 * n, (float[3]){400, 300, 200}, 3 * sizeof *p);
        indices[n] = n;
      }
    Model m = begin();
    add_triangles(&m, n, p, n / 3, indices, false);
    vlCompleteDef def = first_image();
    complete(&m, &def);
    bool whole;
    assert_true(size_in_image(&m, low, high, &whole) > 1 && whole);
    double framed[2][3];
    assert_true(vl_scene_framed(m.scene, framed[0], framed[1]));
    for (int i = 0; i < 3; i++)
      assert_true(fabs(framed[0][i] - (double)low[i]) < 1e-6 &&
                  fabs(framed[1][i] - (double)high[i]) < 1e-6);
    end(&m);
  }
}

/* A spire that is not far higher than the rest is in the image up to its tip. */
static void spire(void **state) {
  (void)state;
  enum { SIDES = 16 };
  float p[3 * (SIDES + 1)] = {0, 3.4f, 0};
  uint32_t indices[3 * SIDES];
  for (uint32_t i = 0; i < SIDES; i++) {
    const double turn = 2 * 3.14159265358979323846 * i / SIDES;
    const float ring[3] = {(float)(0.2 * cos(turn)), 1.5f, (float)(0.2 * sin(turn))};
    memcpy(p + 3 * (i + 1), ring, sizeof ring);
    memcpy(indices + 3 * i, (uint32_t[3]){0, 1 + (i + 1) % SIDES, 1 + i}, 3 * sizeof *indices);
  }
  Model m = begin();
  double framed[2][3];
  assert_false(vl_scene_framed(m.scene, framed[0], framed[1]));
  add_box(&m, low, high, false, false);
  add_triangles(&m, SIDES + 1, p, SIDES, indices, false);
  vlCompleteDef def = first_image();
  complete(&m, &def);
  bool whole;
  size_in_image(&m, low, (float[3]){high[0], 3.4f, high[2]}, &whole);
  assert_true(whole);
  assert_true(vl_scene_framed(m.scene, framed[0], framed[1]));
  assert_true(fabs(framed[1][1] - 3.4) < 1e-5);
  end(&m);
}

/* What belongs to the model stays in the image: a thin mast that is ten times as high; a chain
 * of small things, each near the next; a thing that is not small. */
static void all_of_it(void **state) {
  (void)state;
  for (int k = 0; k < 3; k++) {
    Model m = begin();
    add_box(&m, low, high, false, false);
    float a[3] = {-0.01f, 1.5f, -0.01f}, b[3] = {0.01f, 15, 0.01f};
    if (k == 2)
      memcpy(a, (float[3]){9, 0, 0}, sizeof a);
    if (k == 2)
      memcpy(b, (float[3]){10, 0.5f, 0.5f}, sizeof b);
    for (int i = 0; k == 1 && i < 8; i++) {
      memcpy(a, (float[3]){2.0f * (float)i + 2, 0, 0}, sizeof a);
      memcpy(b, (float[3]){2.0f * (float)i + 2.02f, 0.02f, 0.02f}, sizeof b);
      add_box(&m, a, b, false, false);
    }
    if (k != 1)
      add_box(&m, a, b, false, false);
    vlCompleteDef def = first_image();
    complete(&m, &def);
    bool whole;
    size_in_image(&m, a, b, &whole);
    assert_true(whole);
    end(&m);
  }
}

/* An object on a ground that is a hundred times as wide is seen from near, with some
 * ground around it; up to five times as wide, with all of it. z: y and z are exchanged. */
static void on_a_plain(void **state) {
  (void)state;
  for (int z = 0; z < 2; z++)
    for (int thick = 0; thick < 2; thick++)
      for (int wide = 0; wide < 2; wide++) {
        const float w = wide ? 100 : 5;
        float object[2][3] = {{-1, 0, -1}, {1, 1.5f, 1}},
              ground[2][3] = {{-w, thick ? -0.1f : 0, -w}, {w, 0, w}};
        for (int i = 0; z && i < 2; i++)
          for (int k = 0; k < 2; k++) {
            float *p = k ? object[i] : ground[i];
            memcpy(p, (float[3]){p[0], p[2], p[1]}, sizeof ground[i]);
          }
        Model m = begin();
        add_box(&m, object[0], object[1], false, false);
        add_box(&m, ground[0], ground[1], false, false);
        vlCompleteDef def = first_image();
        def.find_up = wide;
        if (z && !wide) { /* that this is a ground is not obvious */
          memcpy(def.up, (double[3]){0, 0, 1}, sizeof def.up);
          memcpy(def.front, (double[3]){0, -1, 0}, sizeof def.front);
        }
        complete(&m, &def);
        bool whole;
        const double size = size_in_image(&m, object[0], object[1], &whole);
        assert_true(whole && size > (wide ? 1 : 0.2));
        double middle[2];
        project(&m, (double[3]){0, z ? 0 : 0.75, z ? 0.75 : 0}, middle);
        assert_true(!wide || fabs(middle[0]) + fabs(middle[1]) < 0.3);
        size_in_image(&m, ground[0], ground[1], &whole);
        assert_true(whole == !wide);
        assert_true(m.scene->defs.camera.up[z ? 2 : 1] == 1);
        double d[3];
        toward_eye(&m, d);
        assert_true(d[z ? 2 : 1] > 0.15 && d[z ? 2 : 1] < 0.75);
        end(&m);
      }
}

/* Blocks of different heights, along y or z, with a plane under them or without, are a city,
 * which is seen from the side and above; a door with a few fittings is none. */
static void cities(void **state) {
  (void)state;
  for (int z = 0; z < 2; z++)
    for (int plane = 0; plane < 2; plane++)
      for (int guess = 1; guess < 3; guess++) {
        Model m = begin();
        for (int i = 0; i < 144; i++) {
          const float x = 25.0f * (float)(i % 12), y = 25.0f * (float)(i / 12),
                      h = 6 + (float)(i * 37 % 101) * 0.3f;
          float a[3] = {x, 0, y}, b[3] = {x + 15, h, y + 15};
          if (z)
            memcpy(a, (float[3]){x, y, 0}, sizeof a);
          if (z)
            memcpy(b, (float[3]){x + 15, y + 15, h}, sizeof b);
          add_box(&m, a, b, false, false);
        }
        const float y_low[3] = {-10, -1, -10}, y_high[3] = {300, 0, 300},
                    z_low[3] = {-10, -10, -1}, z_high[3] = {300, 300, 0};
        if (plane)
          add_box(&m, z ? z_low : y_low, z ? z_high : y_high, false, false);
        vlCompleteDef def = first_image();
        def.find_up = true;
        if (guess == 2) {
          memcpy(def.up, (double[3]){0, 0, 1}, sizeof def.up);
          memcpy(def.front, (double[3]){0, -1, 0}, sizeof def.front);
        }
        complete(&m, &def);
        assert_true(m.scene->defs.camera.up[z ? 2 : 1] == 1);
        double d[3];
        toward_eye(&m, d);
        assert_true(d[z ? 2 : 1] > 0.2 && d[z ? 2 : 1] < 0.75);
        end(&m);
      }
  Model m = begin();
  const float boxes[4][2][3] = {{{0, 0, 0}, {1, 2, 0.04f}},
                                {{0.85f, 1, 0.04f}, {0.95f, 1.05f, 0.12f}},
                                {{0.1f, 1.1f, 0.04f}, {0.9f, 1.9f, 0.05f}},
                                {{0.1f, 0.1f, 0.04f}, {0.9f, 0.9f, 0.05f}}};
  for (int i = 0; i < 4; i++)
    add_box(&m, boxes[i][0], boxes[i][1], false, false);
  vlCompleteDef def = first_image();
  def.find_up = true;
  complete(&m, &def);
  double d[3];
  toward_eye(&m, d);
  assert_true(d[2] > 0.9);
  end(&m);
}

/* Adds a box; of z, y and z are exchanged so that z is upwards and -y the front. */
static void add_block(Model *m, const float b[2][3], bool z) {
  float a[2][3];
  memcpy(a, b, sizeof a);
  for (int i = 0; z && i < 2; i++) {
    a[i][1] = -b[1 - i][2];
    a[i][2] = b[i][1];
  }
  add_box(m, a[0], a[1], false, false);
}

/* The up axis that is found for blocks that stand along y or z; aircraft lie. */
static void assert_stands(const float (*blocks)[2][3], int count, bool z, bool changes) {
  for (int guess = 1; guess < 3; guess++) {
    Model m = begin();
    for (int i = 0; i < count; i++)
      add_block(&m, blocks[i], z);
    vlCompleteDef def = first_image();
    def.find_up = true;
    if (guess == 2) {
      memcpy(def.up, (double[3]){0, 0, 1}, sizeof def.up);
      memcpy(def.front, (double[3]){0, -1, 0}, sizeof def.front);
    }
    complete(&m, &def);
    assert_true(m.scene->defs.camera.up[changes ? (z ? 2 : 1) : guess] == 1);
    end(&m);
  }
}

static void figures_and_chairs(void **state) {
  (void)state;
  static const float figure[5][2][3] = {{{-0.2f, 0.8f, -0.12f}, {0.2f, 1.5f, 0.12f}},
                                        {{-0.85f, 1.36f, -0.06f}, {0.85f, 1.48f, 0.06f}},
                                        {{-0.1f, 1.5f, -0.1f}, {0.1f, 1.8f, 0.1f}},
                                        {{-0.17f, 0, -0.1f}, {-0.03f, 0.8f, 0.2f}},
                                        {{0.03f, 0, -0.1f}, {0.17f, 0.8f, 0.2f}}};
  static const float chair[6][2][3] = {{{-0.25f, 0.45f, -0.25f}, {0.25f, 0.5f, 0.25f}},
                                       {{-0.25f, 0.5f, -0.25f}, {0.25f, 1, -0.2f}},
                                       {{-0.25f, 0, -0.25f}, {-0.2f, 0.45f, -0.2f}},
                                       {{0.2f, 0, -0.25f}, {0.25f, 0.45f, -0.2f}},
                                       {{-0.25f, 0, 0.2f}, {-0.2f, 0.45f, 0.25f}},
                                       {{0.2f, 0, 0.2f}, {0.25f, 0.45f, 0.25f}}};
  static const float aircraft[4][2][3] = {{{-1, 1, -8}, {1, 3, 7}},
                                          {{-0.2f, 1.5f, 7}, {0.2f, 2, 8}},
                                          {{-9, 1.5f, -1}, {9, 1.8f, 1.5f}},
                                          {{-3, 2.2f, -8}, {3, 2.4f, -7}}};
  for (int z = 0; z < 2; z++) {
    assert_stands(figure, 5, z, true);
    assert_stands(chair, 6, z, true);
  }
  for (int z = 0; z < 2; z++)
    assert_stands(aircraft, 4, z, false);
}

/* What is the same in front and behind but not above and below stands so: a car; so does a
 * storey of walls without a ceiling, 2.6 m high. */
static void cars_and_storeys(void **state) {
  (void)state;
  static const float car[6][2][3] = {
      {{-0.8f, 0.3f, -2}, {0.8f, 0.8f, 2}},      {{-0.7f, 0.8f, -1.2f}, {0.7f, 1.3f, 0.9f}},
      {{-0.8f, 0, -1.5f}, {-0.6f, 0.6f, -0.9f}}, {{0.6f, 0, -1.5f}, {0.8f, 0.6f, -0.9f}},
      {{-0.8f, 0, 0.9f}, {-0.6f, 0.6f, 1.5f}},   {{0.6f, 0, 0.9f}, {0.8f, 0.6f, 1.5f}},
  };
  static const float storey[6][2][3] = {
      {{-2.2f, -0.2f, -2.7f}, {2.2f, 0, 2.7f}}, {{-2.2f, 0, -2.7f}, {-2, 2.6f, 2.7f}},
      {{2, 0, -2.7f}, {2.2f, 2.6f, 2.7f}},      {{-2, 0, -2.7f}, {2, 2.6f, -2.5f}},
      {{-2, 0, 2.5f}, {-0.5f, 2.6f, 2.7f}},     {{0.5f, 0, 2.5f}, {2, 2.6f, 2.7f}},
  };
  for (int z = 0; z < 2; z++)
    assert_stands(car, 6, z, true);
  assert_stands(storey, 6, 1, true);
}

enum { HILLS = 30 };

/* A point of hills over y, or over z. */
static void hill_point(uint32_t i, bool z, double p[3]) {
  const double x = (double)(i % HILLS) / HILLS, y = (double)(i / HILLS) / HILLS,
               h = 0.08 * sin(7 * x - 2) * cos(6 * y - 3) + 0.05 * sin(19 * x * y + 3 * y);
  p[0] = x;
  p[1] = z ? -y : h;
  p[2] = z ? h : y;
}

/* The up axis of hills, as a sheet, or as a cloud of points. */
static void assert_lies(bool z, bool points, bool down) {
  float p[HILLS * HILLS * 3], radii[HILLS * HILLS];
  double centers[HILLS * HILLS * 3];
  uint32_t indices[6 * (HILLS - 1) * (HILLS - 1)], n = 0;
  for (uint32_t i = 0; i < HILLS * HILLS; i++) {
    hill_point(i, z, centers + 3 * i);
    for (int k = 0; k < 3; k++)
      p[3 * i + (uint32_t)k] = (float)centers[3 * i + (uint32_t)k];
    radii[i] = 0.002f;
  }
  for (uint32_t i = 0; i < HILLS * (HILLS - 1); i++) {
    const uint32_t quad[6] = {i, i + HILLS, i + 1, i + 1, i + HILLS, i + HILLS + 1};
    if (i % HILLS == HILLS - 1)
      continue;
    for (int k = 0; k < 6; k++)
      indices[n++] = quad[down ? 5 - k : k];
  }
  Model m = begin();
  vlShapeDef shape = vl_default_shape_def(points ? VL_SHAPE_SPHERE : VL_SHAPE_TRIANGLES);
  shape.vertices = points ? 0 : HILLS * HILLS;
  shape.faces = points ? HILLS * HILLS : n / 3;
  shape.positions = points ? NULL : p;
  shape.indices = points ? NULL : indices;
  shape.centers = points ? centers : NULL;
  shape.radii = points ? radii : NULL;
  assert_int_not_equal(vl_scene_add_shape(m.scene, &shape).index, 0);
  vlCompleteDef def = first_image();
  def.find_up = true;
  complete(&m, &def);
  assert_true(m.scene->defs.camera.up[z ? 2 : 1] == 1);
  double d[3];
  toward_eye(&m, d);
  assert_true(d[z ? 2 : 1] > 0.1);
  end(&m);
}

/* Hills lie, whatever the shapes of their edges and the sides of their faces are. */
static void terrain(void **state) {
  (void)state;
  for (int z = 0; z < 2; z++)
    for (int down = 0; down < 2; down++)
      assert_lies(z, false, down);
  assert_lies(false, true, false);
  assert_lies(true, true, false);
}

/* A closed chart with bars on the side of -y is one of a file with z upwards; with bars on the
 * side of y it lies. */
static void charts_of_z(void **state) {
  (void)state;
  for (int below = 0; below < 2; below++) {
    Model m = begin();
    const float b[3][2][3] = {{{0, 0, 0}, {1, 0.01f, 0.8f}},
                              {{0.1f, 0.01f, 0.1f}, {0.3f, 0.02f, 0.7f}},
                              {{0.5f, 0.01f, 0.1f}, {0.9f, 0.02f, 0.4f}}};
    for (int i = 0; i < 3; i++) {
      float a[2][3];
      memcpy(a, b[i], sizeof a);
      if (below)
        a[0][1] = -b[i][1][1];
      if (below)
        a[1][1] = -b[i][0][1];
      add_box(&m, a[0], a[1], false, false);
    }
    vlCompleteDef def = first_image();
    def.find_up = true;
    complete(&m, &def);
    assert_true(m.scene->defs.camera.up[below ? 2 : 1] == 1);
    double d[3];
    toward_eye(&m, d);
    assert_true(below ? d[1] < -0.8 : d[1] > 0.5);
    end(&m);
  }
}

/* A plate with bars is seen from the side of the bars: along x always, along z if the file does
 * not say which side is its front; one with a small hook behind is seen from the front. */
static void raised_parts(void **state) {
  (void)state;
  for (int axis = 0; axis < 3; axis += 2)
    for (int side = -1; side < 2; side += 2)
      for (int hook = 0; hook < 2; hook++) {
        Model m = begin();
        float b[3][2][3] = {{{0, 0, 0}, {1, 0.8f, 0.01f}},
                            {{0.1f, 0.1f, 0.01f}, {0.3f, 0.7f, 0.02f}},
                            {{0.5f, 0.1f, 0.01f}, {0.9f, 0.4f, 0.02f}}};
        if (hook)
          memcpy(b[1], (float[2][3]){{0.4f, 0.7f, 0.01f}, {0.42f, 0.72f, 0.02f}}, sizeof b[1]);
        for (int i = 0; i < (hook ? 2 : 3); i++) {
          float a[2][3];
          for (int k = 0; k < 2; k++)
            for (int c = 0; c < 3; c++)
              a[k][axis == 0 ? 2 - c : c] = c == 2 && side < 0 ? -b[i][1 - k][c] : b[i][k][c];
          add_box(&m, a[0], a[1], false, false);
        }
        vlCompleteDef def = first_image();
        def.find_up = true;
        complete(&m, &def);
        double d[3];
        toward_eye(&m, d);
        assert_true(d[axis] * (hook ? 1 : side) > 0.8);
        end(&m);
      }
}

/* A camera that is taken from another scene is not replaced by an added one. */
static void a_taken_camera_stays(void **state) {
  (void)state;
  Model m = begin();
  vlScene *other = NULL;
  add_box(&m, low, high, false, false);
  assert_int_equal(vl_scene_create(m.context, &other), VL_OK);
  vl_scene_defs(other)->camera.eye[0] = 77;
  assert_int_equal(vl_scene_take_camera(m.scene, other, NULL), VL_OK);
  vl_scene_destroy(other);
  vlCompleteDef def = vl_default_complete_def();
  complete(&m, &def);
  assert_true(vl_scene_defs(m.scene)->camera.eye[0] == 77);
  end(&m);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(a_taken_camera_stays),
      cmocka_unit_test(stray_parts),
      cmocka_unit_test(all_of_it),
      cmocka_unit_test(on_a_plain),
      cmocka_unit_test(cities),
      cmocka_unit_test(figures_and_chairs),
      cmocka_unit_test(terrain),
      cmocka_unit_test(raised_parts),
      cmocka_unit_test(lone_corner),
      cmocka_unit_test(spire),
      cmocka_unit_test(cars_and_storeys),
      cmocka_unit_test(charts_of_z),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
