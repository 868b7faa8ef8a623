/* test/trace/test_emission.c: emission of light paths: the mean weight is the light's power
 * (formulas of the book, 12), directions and positions have the right distribution (chi-square
 * against exact solid angles and areas), and the density of a sampled path equals the one used
 * by multiple importance sampling. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "statistics.h"
#include "unit.h"

#include "light/light_kind.h"
#include "schema/schema.h"
#include "trace/two_way/stages.h"
#include "velo/shape_kinds.h"

enum { TRIES = 100 * 1000, ROWS = 8, COLUMNS = 8, TESTS = 40 };

typedef struct Fixture {
  vlContext *context;
  vlScene *scene;
  vlWorld *world;
  vlTwoWay way;
  float choice[8];
} Fixture;

static Fixture *begin(void) {
  Fixture *f = calloc(1, sizeof *f);
  assert_int_equal(vl_context_create(NULL, &f->context), VL_OK);
  assert_int_equal(vl_scene_create(f->context, &f->scene), VL_OK);
  return f;
}
static void build(Fixture *f) {
  vlBuildDef def = vl_default_build_def();
  def.color = VL_COLOR_RGB;
  vlError error;
  if (vl_world_build(f->scene, &def, &f->world, &error) != VL_OK)
    fail_msg("%s", error.message);
  assert_true(f->world->lights.count < 8);
  assert_true(vl_two_way_choice(f->world, f->choice));
  f->way.choice = f->choice;
}
static void end(Fixture *f) {
  vl_world_destroy(f->world);
  vl_scene_destroy(f->scene);
  assert_int_equal(vl_context_memory(f->context, NULL), 0);
  vl_context_destroy(f->context);
  free(f);
}
/* A sphere, so that the world has a size. */
static void add_ball(Fixture *f, float radius) {
  vlShapeDef def = vl_default_shape_def(VL_SHAPE_SPHERE);
  def.radius = radius;
  def.z_min = -radius;
  def.z_max = radius;
  assert_int_not_equal(vl_scene_add_shape(f->scene, &def).index, 0);
}

static vlEmission one(const Fixture *f, statRng *rng) {
  const float lambda[4] = {0, 0, 0, 0};
  float u[5];
  for (int i = 0; i < 5; i++)
    u[i] = stat_float(rng);
  return vl_emission_sample(f->world, &f->way, lambda, u[0], u[1], u[2], u[3], u[4]);
}

/* Mean of the flux, in standard errors from its expectation. `slack`: share by which the
 * expectation may be off. */
static void power_is(Fixture *f, const char *what, double expected, double slack,
                     unsigned seed) {
  statRng rng = stat_rng(seed);
  double sum = 0, squares = 0;
  for (int i = 0; i < TRIES; i++) {
    vlEmission e = one(f, &rng);
    double v = e.valid ? (double)e.flux[1] : 0;
    sum += v;
    squares += v * v;
  }
  double mean = sum / TRIES, error = sqrt(fmax(0, squares / TRIES - mean * mean) / TRIES);
  if (!(fabs(mean - expected) <= 4.5 * error + (slack + 1e-5) * expected))
    fail_msg("%s: power %g, expected %g, standard error %g", what, mean, expected, error);
}

/* The density stored with a path equals vl_emission_density. */
static void density_is_told(Fixture *f, const char *what, unsigned seed) {
  statRng rng = stat_rng(seed);
  for (int i = 0; i < 2000; i++) {
    vlEmission e = one(f, &rng);
    if (!e.valid)
      continue;
    const vlWorldLight *light = &f->world->lights.items[e.light];
    vlPoint at;
    memset(&at, 0, sizeof at);
    at.p = e.at;
    at.g = at.n = e.n;
    double told = (double)vl_emission_density(f->world, &f->way, e.light, vl_neg(e.d), 1.0f,
                                              light->kind == VL_LIGHT_AREA ? &at : NULL);
    if (!(fabs(told - (double)e.density) <= 1e-4 * told))
      fail_msg("%s: density %g with the path, %g told", what, (double)e.density, told);
  }
}

/* Directions weighed by 1 / density (times area: of the disk or window that all pass through; 1
 * for points) measure the solid angle of each cell of the cone z >= low. */
static void directions(Fixture *f, const char *what, double low,
                       double (*area)(const Fixture *, const vlEmission *), unsigned seed) {
  enum { CELLS = ROWS * COLUMNS };
  double sum[CELLS] = {0}, squares[CELLS] = {0}, statistic = 0;
  statRng rng = stat_rng(seed);
  for (int i = 0; i < TRIES; i++) {
    vlEmission e = one(f, &rng);
    if (!e.valid)
      continue;
    double z = (double)e.d.z;
    if (area)
      z = -z; /* infinite lights: cells of the direction towards the light */
    assert_true(z >= low - 1e-4);
    double phi = atan2((double)e.d.y, (double)e.d.x);
    int row = (int)((z - low) / (1 - low) * ROWS),
        column = (int)((phi + M_PI) / (2 * M_PI) * COLUMNS);
    row = row < 0 ? 0 : row < ROWS ? row : ROWS - 1;
    column = column < COLUMNS ? column : COLUMNS - 1;
    double weight = 1 / ((double)e.density * (area ? area(f, &e) : 1));
    sum[row * COLUMNS + column] += weight;
    squares[row * COLUMNS + column] += weight * weight;
  }
  double expected = 2 * M_PI * (1 - low) / CELLS;
  for (int k = 0; k < CELLS; k++) {
    double mean = sum[k] / TRIES, variance = (squares[k] / TRIES - mean * mean) / TRIES;
    statistic += (mean - expected) * (mean - expected) / variance;
  }
  double p = stat_chi2_q(statistic, CELLS);
  if (!(p > 0.01 / TESTS))
    fail_msg("%s: chi-square %g, p = %g", what, statistic, p);
}
static double world_disk(const Fixture *f, const vlEmission *e) {
  (void)e;
  return M_PI * (double)f->world->radius * (double)f->world->radius;
}

/* ---- points and what is far away --------------------------------------------------------- */

static void points(void **state) {
  (void)state;
  for (int spot = 0; spot < 2; spot++) {
    Fixture *f = begin();
    add_ball(f, 1);
    vlLightDef def = vl_default_light_def(spot ? VL_LIGHT_SPOT : VL_LIGHT_POINT);
    def.from[2] = 3;
    def.to[2] = 4;
    def.scale = 2;
    def.cone_angle = 0.9f;
    def.cone_delta = 0.4f;
    vl_scene_add_light(f->scene, &def);
    build(f);
    double end_cos = cos(0.9), start = cos(0.5);
    double solid = spot ? 2 * M_PI * ((1 - start) + (start - end_cos) / 2) : 4 * M_PI;
    power_is(f, spot ? "spot" : "point", 2 * solid, 0, 1);
    density_is_told(f, "point", 2);
    directions(f, spot ? "spot" : "point", spot ? end_cos : -1, NULL, 3);
    end(f);
  }
}

/* A cone with a half angle of 180 degrees has its edge behind the light. */
static void whole_cone(void **state) {
  (void)state;
  Fixture *f = begin();
  add_ball(f, 1);
  vlLightDef def = vl_default_light_def(VL_LIGHT_SPOT);
  def.cone_angle = (float)M_PI;
  def.cone_delta = 2;
  assert_int_not_equal(vl_scene_add_light(f->scene, &def).index, 0);
  build(f);
  double start = cos(M_PI - 2);
  power_is(f, "spot of 180 degrees", 2 * M_PI * ((1 - start) + (start + 1) / 2), 0, 31);
  density_is_told(f, "spot of 180 degrees", 32);
  end(f);
}

/* A given power is sent whatever the falloff at the edge. */
static void spots_of_a_power(void **state) {
  (void)state;
  for (int squared = 0; squared < 2; squared++) {
    Fixture *f = begin();
    add_ball(f, 1);
    vlLightDef def = vl_default_light_def(VL_LIGHT_SPOT);
    def.cone_angle = 1.2f;
    def.cone_delta = 1.1f;
    def.cone_squared = squared;
    def.power = 7;
    assert_int_not_equal(vl_scene_add_light(f->scene, &def).index, 0);
    build(f);
    power_is(f, squared ? "spot with an edge of t^2" : "spot", 7, 0, 33);
    end(f);
    def.power = NAN;
    const double inner = 1 - cos(0.1);
    const double edge = cos(0.1) - cos(1.2);
    const double solid = 2 * M_PI * (inner + edge / (squared ? 3 : 2));
    assert_true(fabs(vl_light_power(&def, 5, 0) - 5 * solid) < 1e-5 * solid);
  }
}

/* Chi-square test: the same count is expected in all cells, together `total`. */
static void counts_are_equal(const char *what, const uint32_t *counts, uint32_t cells,
                             uint32_t total) {
  const double expected = (double)total / cells;
  double statistic = 0;
  for (uint32_t k = 0; k < cells; k++)
    statistic += (counts[k] - expected) * (counts[k] - expected) / expected;
  const double p = stat_chi2_q(statistic, cells - 1);
  if (!(p > 0.01 / TESTS))
    fail_msg("%s: chi-square %g, p = %g", what, statistic, p);
}

/* Rays pass a disk that covers the world, with uniform density over it. w: the disk's normal,
 * towards the light. */
static void check_disk(Fixture *f, vlVec3 w, unsigned seed) {
  enum { RINGS = 6, PARTS = 8 };
  uint32_t counts[RINGS * PARTS] = {0};
  statRng rng = stat_rng(seed);
  vlFrame frame = vl_frame_from_z(w);
  vlVec3 center = vl_vec3(f->world->center[0], f->world->center[1], f->world->center[2]);
  for (int i = 0; i < TRIES; i++) {
    vlEmission e = one(f, &rng);
    vlVec3 o = vl_mul(vl_sub(e.o, center), 1 / f->world->radius);
    double x = (double)vl_dot(o, frame.x), y = (double)vl_dot(o, frame.y), r2 = x * x + y * y;
    assert_true(r2 < 1.00001 && vl_dot(o, w) > 0.999f);
    int ring = (int)(r2 * RINGS), part = (int)((atan2(y, x) + M_PI) / (2 * M_PI) * PARTS);
    counts[(ring < RINGS ? ring : RINGS - 1) * PARTS + (part < PARTS ? part : PARTS - 1)]++;
  }
  counts_are_equal("disk", counts, RINGS * PARTS, TRIES);
}

static void distant(void **state) {
  (void)state;
  Fixture *f = begin();
  add_ball(f, 2);
  vlLightDef def = vl_default_light_def(VL_LIGHT_DISTANT);
  def.from[0] = 1;
  def.from[2] = 2;
  def.to[2] = 0;
  def.illuminance = 3;
  vl_scene_add_light(f->scene, &def);
  build(f);
  power_is(f, "distant", 3 * world_disk(f, NULL), 0, 11);
  density_is_told(f, "distant", 12);
  check_disk(f, vl_normalize(vl_vec3(1, 0, 2)), 13);
  end(f);
}

static void skies(void **state) {
  (void)state;
  enum { SIDE = 16 };
  for (int imaged = 0; imaged < 2; imaged++) {
    Fixture *f = begin();
    add_ball(f, 2);
    vlLightDef def = vl_default_light_def(VL_LIGHT_INFINITE);
    def.scale = 3;
    double mean = 1;
    vlImage *image = NULL;
    if (imaged) {
      vlImageDef image_def = vl_default_image_def(SIDE, SIDE, 3);
      image_def.type = VL_PIXEL_F32;
      assert_int_equal(vl_image_create(f->context, &image_def, &image), VL_OK);
      float *pixels = vl_image_pixels(image);
      mean = 0;
      for (int i = 0; i < SIDE * SIDE; i++) {
        float v = i % 23 == 7 ? 30.0f : i % 5 ? 0.4f : 0.0f;
        pixels[3 * i] = pixels[3 * i + 1] = pixels[3 * i + 2] = v;
        mean += (double)v / (SIDE * SIDE);
      }
      def.image = image;
    }
    vl_scene_add_light(f->scene, &def);
    vl_image_destroy(image);
    build(f);
    power_is(f, imaged ? "imaged sky" : "sky", 3 * mean * 4 * M_PI * world_disk(f, NULL), 0,
             21);
    density_is_told(f, "sky", 22);
    directions(f, imaged ? "imaged sky" : "sky", -1, world_disk, 23);
    end(f);
  }
}

static double window_across(const Fixture *f, const vlEmission *e) {
  (void)f;
  return 0.5 * 0.8 * -(double)e->d.z;
}

/* Through a portal in the plane z = 2 (0.5 x 0.8), from the half space above it. */
static void portal(void **state) {
  (void)state;
  Fixture *f = begin();
  add_ball(f, 2);
  vlLightDef def = vl_default_light_def(VL_LIGHT_INFINITE);
  vlImageDef image_def = vl_default_image_def(4, 4, 3);
  vlImage *image;
  image_def.type = VL_PIXEL_F32;
  assert_int_equal(vl_image_create(f->context, &image_def, &image), VL_OK);
  for (int i = 0; i < 48; i++)
    ((float *)vl_image_pixels(image))[i] = 2;
  def.image = image;
  def.has_portal = true;
  const float corners[4][3] = {
      {0, 0, 2}, {0, 0.8f, 2}, {0.5f, 0.8f, 2}, {0.5f, 0, 2}}; /* (last - first) x ... = +z */
  memcpy(def.portal, corners, sizeof corners);
  assert_int_not_equal(vl_scene_add_light(f->scene, &def).index, 0);
  vl_image_destroy(image);
  build(f);
  power_is(f, "portal", 2 * M_PI * 0.5 * 0.8, 1e-4, 31);
  density_is_told(f, "portal", 32);
  directions(f, "portal", 0, window_across, 33);
  statRng rng = stat_rng(34);
  for (int i = 0; i < 5000; i++) {
    /* each ray passes through the portal and starts outside the world */
    vlEmission e = one(f, &rng);
    if (!e.valid)
      continue;
    float t = (2 - e.o.z) / e.d.z, x = e.o.x + t * e.d.x, y = e.o.y + t * e.d.y;
    assert_true(t > 0 && x > -1e-4f && x < 0.5001f && y > -1e-4f && y < 0.8001f);
    assert_true(vl_length(e.o) > 2);
  }
  end(f);
}

/* ---- surfaces ---------------------------------------------------------------------------- */

static vlEmissionId emission(Fixture *f, bool two_sided) {
  vlEmissionDef def = vl_default_emission_def();
  def.radiance = vl_spectrum_rgb(1, 1, 1);
  def.scale = 5;
  def.two_sided = two_sided;
  return vl_scene_add_emission(f->scene, &def);
}

/* Cosine-weighted about the normal: the squared cosine and the azimuth are uniform; so is the
 * choice of side. */
static void leave_by_cosine(Fixture *f, const char *what, bool two_sided, unsigned seed) {
  enum { CELLS = 2 * ROWS * COLUMNS };
  uint32_t counts[CELLS] = {0}, n = 0;
  statRng rng = stat_rng(seed);
  for (int i = 0; i < TRIES; i++) {
    vlEmission e = one(f, &rng);
    if (!e.valid)
      continue;
    vlFrame frame = vl_frame_from_z(e.n);
    double c = (double)vl_dot(e.d, e.n), x = (double)vl_dot(e.d, frame.x),
           y = (double)vl_dot(e.d, frame.y);
    int row = (int)(c * c * ROWS), column = (int)((atan2(y, x) + M_PI) / (2 * M_PI) * COLUMNS);
    row = row < ROWS ? row : ROWS - 1;
    column = column < COLUMNS ? column : COLUMNS - 1;
    counts[((c < 0) * ROWS + row) * COLUMNS + column]++;
    n++;
  }
  assert_true(n > TRIES * 0.999);
  uint32_t cells = two_sided ? CELLS : CELLS / 2;
  for (uint32_t k = cells; k < CELLS; k++)
    assert_int_equal(counts[k], 0);
  counts_are_equal(what, counts, cells, n);
}

static void surfaces(void **state) {
  (void)state;
  static const float triangle[9] = {0, 0, 0, 2, 0, 0.5f, 0.3f, 1, 0},
                     patch[12] = {0, 0, 0, 2, 0, 0, 0, 1, 0, 2, 1, 0};
  static const uint32_t index[4] = {0, 1, 2, 3};
  const vlShapeKind kinds[4] = {VL_SHAPE_TRIANGLES, VL_SHAPE_BILINEAR, VL_SHAPE_DISK,
                                VL_SHAPE_SPHERE};
  const char *const names[4] = {"triangle", "patch", "disk", "sphere"};
  double cross[3] = {0 * 0 - 0.5 * 1, 0.5 * 0.3 - 2 * 0, 2 * 1 - 0 * 0.3};
  const double areas[4] = {
      0.5 * sqrt(cross[0] * cross[0] + cross[1] * cross[1] + cross[2] * cross[2]), 2,
      M_PI * 1.5 * 1.5, 4 * M_PI * 1.5 * 1.5};
  for (int kind = 0; kind < 4; kind++)
    for (int sides = 1; sides <= 2; sides++) {
      Fixture *f = begin();
      vlShapeDef def = vl_default_shape_def(kinds[kind]);
      def.radius = 1.5f;
      def.z_min = -1.5f;
      def.z_max = 1.5f;
      if (kind < 2) {
        def.vertices = kind ? 4 : 3;
        def.faces = 1;
        def.positions = kind ? patch : triangle;
        def.indices = index;
      }
      def.emission = emission(f, sides == 2);
      assert_int_not_equal(vl_scene_add_shape(f->scene, &def).index, 0);
      build(f);
      power_is(f, names[kind], 5 * M_PI * areas[kind] * sides, 0,
               40 + (unsigned)(2 * kind + sides));
      density_is_told(f, names[kind], 50);
      leave_by_cosine(f, names[kind], sides == 2, 60 + (unsigned)(2 * kind + sides));
      end(f);
    }
}

/* Points on a triangle: sixteen parts of equal area have equal counts. */
static void places(void **state) {
  (void)state;
  static const float p[9] = {0, 0, 0, 3, 0, 0, 1, 2, 0};
  static const uint32_t index[3] = {0, 1, 2};
  Fixture *f = begin();
  vlShapeDef def = vl_default_shape_def(VL_SHAPE_TRIANGLES);
  def.vertices = 3;
  def.faces = 1;
  def.positions = p;
  def.indices = index;
  def.emission = emission(f, false);
  vl_scene_add_shape(f->scene, &def);
  build(f);
  uint32_t counts[16] = {0};
  statRng rng = stat_rng(71);
  for (int i = 0; i < TRIES; i++) {
    vlEmission e = one(f, &rng);
    double b2 = (double)e.at.y / 2, b1 = ((double)e.at.x - b2) / 3, b0 = 1 - b1 - b2;
    int part = 0;
    for (int level = 0; level < 2; level++) {
      /* the midpoints of the sides make four triangles */
      int corner = b0 > 0.5 ? 0 : b1 > 0.5 ? 1 : b2 > 0.5 ? 2 : 3;
      part = 4 * part + corner;
      b0 = corner == 3 ? 1 - 2 * b0 : 2 * b0 - (corner == 0);
      b1 = corner == 3 ? 1 - 2 * b1 : 2 * b1 - (corner == 1);
      b2 = 1 - b0 - b1;
    }
    counts[part]++;
  }
  counts_are_equal("triangle", counts, 16, TRIES);
  end(f);
}

/* Several lights: each is chosen by its share of the power, and the whole is their sum. */
static void together(void **state) {
  (void)state;
  Fixture *f = begin();
  add_ball(f, 1);
  vlLightDef def = vl_default_light_def(VL_LIGHT_POINT);
  def.from[2] = 3;
  def.scale = 2;
  vl_scene_add_light(f->scene, &def);
  def = vl_default_light_def(VL_LIGHT_DISTANT);
  def.illuminance = 7;
  vl_scene_add_light(f->scene, &def);
  vlShapeDef disk = vl_default_shape_def(VL_SHAPE_DISK);
  disk.radius = 0.5f;
  disk.height = 2;
  disk.emission = emission(f, false);
  vl_scene_add_shape(f->scene, &disk);
  build(f);
  power_is(f, "three lights", 2 * 4 * M_PI + 7 * world_disk(f, NULL) + 5 * M_PI * M_PI * 0.25,
           0, 81);
  density_is_told(f, "three lights", 82);
  end(f);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(points),
      cmocka_unit_test(whole_cone),
      cmocka_unit_test(spots_of_a_power),
      cmocka_unit_test(distant),
      cmocka_unit_test(skies),
      cmocka_unit_test(portal),
      cmocka_unit_test(surfaces),
      cmocka_unit_test(places),
      cmocka_unit_test(together),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
