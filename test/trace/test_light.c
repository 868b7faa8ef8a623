/* test/trace/test_light.c: light sampling against its densities: directions of vl_stage_lights,
 * counted over the sphere, against the density for multiple importance sampling of the light
 * that a ray in that direction hits (chi-square); the light tree's choice against its
 * probabilities; the Monte Carlo estimate of incident radiance against the same integral with
 * uniform directions. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "statistics.h"
#include "unit.h"

#include "light/light_kind.h"
#include "trace/stages.h"
#include "velo/shape_kinds.h"

enum { TRIES = 200 * 1000 };

typedef struct Fixture {
  vlContext *context;
  vlScene *scene;
  vlWorld *world;
  vlVec3 p, n;
  float side;
  vlTraceScratch *scratch;
} Fixture;

static Fixture *begin(void) {
  Fixture *f = calloc(1, sizeof *f);
  assert_int_equal(vl_context_create(NULL, &f->context), VL_OK);
  assert_int_equal(vl_scene_create(f->context, &f->scene), VL_OK);
  f->scratch = aligned_alloc(64, sizeof *f->scratch);
  memset(f->scratch, 0, sizeof *f->scratch);
  return f;
}

static void build(Fixture *f, vlLightSampler sampler) {
  vlBuildDef def = vl_default_build_def();
  def.color = VL_COLOR_RGB;
  def.light_sampler = sampler;
  vlError error;
  assert_int_equal(vl_world_build(f->scene, &def, &f->world, &error), VL_OK);
}

static void end(Fixture *f) {
  vl_world_destroy(f->world);
  vl_scene_destroy(f->scene);
  assert_int_equal(vl_context_memory(f->context, NULL), 0);
  vl_context_destroy(f->context);
  free(f->scratch);
  free(f);
}

static vlEmissionId emission(Fixture *f, bool two_sided) {
  vlEmissionDef def = vl_default_emission_def();
  def.radiance = vl_spectrum_rgb(1, 1, 1);
  def.two_sided = two_sided;
  return vl_scene_add_emission(f->scene, &def);
}

/* Density of sampling direction d: of the light that a ray meets there first (lights must not
 * hide each other). */
static double density(void *user, const double d[3]) {
  Fixture *f = user;
  float o[3] = {f->p.x, f->p.y, f->p.z}, w[3] = {(float)d[0], (float)d[1], (float)d[2]};
  vlRays ray = {o, o + 1, o + 2, w, w + 1, w + 2, NULL, NULL, NULL, NULL};
  uint32_t shape, prim, instance;
  float t;
  vl_accel_closest(f->world, 1, &ray, false, &shape, &prim, &instance, &t);
  vlVec3 dir = vl_vec3(w[0], w[1], w[2]);
  double pdf = 0;
  for (size_t k = 0; k < f->world->infinite_lights.count; k++) {
    uint32_t index = f->world->infinite_lights.items[k];
    pdf += (double)vl_light_pmf(&f->world->tree, (vlReceiver){f->p, f->n, f->side}, index) *
           vl_infinite_pdf(f->world, &f->world->lights.items[index], f->p, dir);
  }
  if (shape == VL_NONE || f->world->shapes.items[shape].first_light == VL_NONE)
    return pdf;
  uint32_t index = f->world->shapes.items[shape].first_light + prim;
  const vlWorldLight *light = &f->world->lights.items[index];
  vlPoint at = vl_point_at_time(f->world, 0.0f, f->p, dir, shape, prim, instance, t);
  if (vl_dot(at.g, dir) >= 0 && !f->world->emitted.items[light->emitted].two_sided)
    return pdf;
  return pdf + (double)vl_area_pdf(f->world, light, f->p, &at) *
                   vl_light_pmf(&f->world->tree, (vlReceiver){f->p, f->n, f->side}, index);
}

/* The part of the light samples that falls into a cell of the sphere is the integral of the
 * density over it. Uniform directions estimate the integral. Both are means with known
 * variances: their difference, squared and summed over the cells, is chi-square. (Edges of
 * lights cut cells: a numerical integral would have to find them.) */
enum { ROWS = 16, COLUMNS = 32, CELLS = ROWS * COLUMNS };

typedef struct Cell {
  double sum, sum2; /* of the density, over uniform directions */
  uint32_t count;   /* of light samples, of uniform directions */
} Cell;

static uint32_t cell_of(double x, double y, double z) {
  uint32_t row = (uint32_t)((z + 1) * 0.5 * ROWS),
           column = (uint32_t)((atan2(y, x) + M_PI) / (2 * M_PI) * COLUMNS);
  return (row < ROWS ? row : ROWS - 1) * COLUMNS + (column < COLUMNS ? column : COLUMNS - 1);
}

/* Whether a density is that of direction d, or of one beside it: the rounding of d may move it
 * across an edge of the density. */
static bool is_density(Fixture *f, const double d[3], double pdf) {
  const double step = 1e-5;
  for (int k = 0; k < 7; k++) {
    double beside[3] = {d[0], d[1], d[2]};
    if (k)
      beside[(k - 1) / 2] += k % 2 ? step : -step;
    double length = sqrt(beside[0] * beside[0] + beside[1] * beside[1] + beside[2] * beside[2]);
    for (int i = 0; i < 3; i++)
      beside[i] /= length;
    double told = density(f, beside);
    if (fabs(told - pdf) <= 5e-3 * told)
      return true;
  }
  return false;
}

static uint32_t sample_all(Fixture *f, Cell *cells, unsigned seed) {
  statRng rng = stat_rng(seed);
  vlTraceScratch *s = f->scratch;
  uint32_t done = 0;
  for (; done < TRIES; done += VL_BATCH) {
    vlNumbers u;
    for (uint32_t i = 0; i < VL_BATCH; i++) {
      s->at.surface.p.x[i] = f->p.x;
      s->at.surface.p.y[i] = f->p.y;
      s->at.surface.p.z[i] = f->p.z;
      s->at.surface.side[i] = f->side;
      s->at.surface.n.x[i] = f->n.x;
      s->at.surface.n.y[i] = f->n.y;
      s->at.surface.n.z[i] = f->n.z;
      u.u0[i] = stat_float(&rng);
      u.u1[i] = stat_float(&rng);
      u.u2[i] = stat_float(&rng);
    }
    vl_stage_lights(f->world, VL_BATCH, &s->at.paths, &s->at.surface, u.u1, u.u2, u.u0,
                    &s->light);
    for (uint32_t i = 0; i < VL_BATCH; i++) {
      const vlLightSamples *l = &s->light;
      if (!(l->pdf[i] > 0) || l->delta[i])
        continue;
      double d[3] = {l->w.x[i], l->w.y[i], l->w.z[i]}, told = density(f, d);
      if (!(told > 0))
        continue; /* at the very edge a ray may just miss, or another light stands before it */
      /* The density that comes with a sample is the one that a hit is given. */
      if (!is_density(f, d, (double)l->pdf[i]))
        fail_msg("pdf %g with the sample, %g for the hit", (double)l->pdf[i], told);
      cells[cell_of(d[0], d[1], d[2])].count++;
    }
  }
  return done;
}

static void judge(Fixture *f, unsigned seed, unsigned tests) {
  static Cell sampled[CELLS], uniform[CELLS];
  memset(sampled, 0, sizeof sampled);
  memset(uniform, 0, sizeof uniform);
  uint32_t n = sample_all(f, sampled, seed), m = 4 * TRIES;
  statRng rng = stat_rng(seed + 1000);
  for (uint32_t i = 0; i < m; i++) {
    double d[3];
    stat_direction(&rng, d);
    double pdf = density(f, d);
    if (!(pdf > 0))
      continue;
    Cell *cell = &uniform[cell_of(d[0], d[1], d[2])];
    cell->count++;
    cell->sum += 4 * M_PI * pdf;
    cell->sum2 += 4 * M_PI * pdf * 4 * M_PI * pdf;
  }
  double statistic = 0;
  uint32_t freedom = 0;
  for (uint32_t k = 0; k < CELLS; k++) {
    const Cell *a = &sampled[k], *b = &uniform[k];
    if (b->count < 100 || a->count < 100) {
      double expected = b->sum / m * n;
      if (b->count >= 100 && expected > 200)
        fail_msg("cell %u: %u samples, %g expected", k, a->count, expected);
      continue;
    }
    double ma = (double)a->count / n, mb = b->sum / m;
    double variance = mb * (1 - mb) / n + (b->sum2 / m - mb * mb) / m;
    statistic += (ma - mb) * (ma - mb) / variance;
    freedom++;
  }
  assert_true(freedom >= 1);
  double p = stat_chi2_q(statistic, freedom);
  if (!(p > 0.01 / tests))
    fail_msg("chi-square %g with %u degrees of freedom: p = %g", statistic, freedom, p);
}

enum { TESTS = 20 };

static void add_triangles(Fixture *f, const float *positions, uint32_t faces, bool two_sided) {
  uint32_t indices[24];
  for (uint32_t i = 0; i < 3 * faces; i++)
    indices[i] = i;
  vlShapeDef def = vl_default_shape_def(VL_SHAPE_TRIANGLES);
  def.vertices = 3 * faces;
  def.faces = faces;
  def.positions = positions;
  def.indices = indices;
  def.emission = emission(f, two_sided);
  assert_int_not_equal(vl_scene_add_shape(f->scene, &def).index, 0);
}

static void triangles(void **state) {
  (void)state;
  const float near[9] = {-1, -1, 1, 2, -1, 1, -1, 2, 1},
              far[9] = {-1, -1, 6, 2, -1, 6, -1, 2, 8};
  for (int i = 0; i < 2; i++) {
    Fixture *f = begin();
    add_triangles(f, i ? far : near, 1, true);
    f->p = vl_vec3(0.2f, 0.1f, 0);
    f->n = vl_vec3(0, 0, 1);
    build(f, VL_LIGHT_SAMPLER_BVH);
    judge(f, 1 + (unsigned)i, TESTS);
    end(f);
  }
}

/* Several lights, each choice of the tree with its probability; all ways of choosing. */
static void many_triangles(void **state) {
  (void)state;
  const float p[36] = {-3, -1, 2, -2, -1, 2, -3, 1, 2.5f, 2, -1, 1,  3, -1, 1,  2, 1,  1,
                       -1, 3,  0, 1,  3,  0, 0,  3, 2,    0, -3, -1, 1, -3, -1, 0, -3, 1};
  const vlLightSampler samplers[3] = {VL_LIGHT_SAMPLER_BVH, VL_LIGHT_SAMPLER_POWER,
                                      VL_LIGHT_SAMPLER_UNIFORM};
  for (int i = 0; i < 3; i++) {
    Fixture *f = begin();
    add_triangles(f, p, 4, true);
    f->p = vl_vec3(0.1f, 0.2f, 0.1f);
    f->n = vl_normalize(vl_vec3(0.3f, 0.2f, 1));
    build(f, samplers[i]);
    judge(f, 11 + (unsigned)i, TESTS);
    double sum = 0;
    for (uint32_t k = 0; k < 4; k++)
      sum += vl_light_pmf(&f->world->tree, (vlReceiver){f->p, f->n, f->side}, k);
    assert_true(fabs(sum - 1) < 1e-5);
    end(f);
  }
}

/* A sun and triangles on all sides of a surface that light leaves on both sides (side 0) or
 * only on one. What cannot count is not chosen, and the others have its share. */
static void one_side(void **state) {
  (void)state;
  const float p[27] = {-3, -1, 2, -2, -1, 2,  -3, 1, 2.5f, 2,  -1, 2,  3, -1,
                       2,  2,  1, 2,  -1, -3, -2, 1, -3,   -2, 0,  -3, -1};
  for (int side = -1; side <= 1; side++)
    for (int sky = 0; sky <= 1; sky++) {
      Fixture *f = begin();
      add_triangles(f, p, 3, true);
      vlLightDef sun = vl_default_light_def(VL_LIGHT_DISTANT);
      sun.from[0] = 0.4f;
      sun.from[1] = 0.2f;
      sun.from[2] = 1;
      sun.to[0] = sun.to[1] = sun.to[2] = 0;
      assert_int_not_equal(vl_scene_add_light(f->scene, &sun).index, 0);
      vlLightDef even = vl_default_light_def(VL_LIGHT_INFINITE);
      if (sky)
        assert_int_not_equal(vl_scene_add_light(f->scene, &even).index, 0);
      f->p = vl_vec3(0.1f, 0.2f, 0);
      f->n = vl_vec3(0, 0, 1);
      f->side = (float)side;
      build(f, VL_LIGHT_SAMPLER_BVH);
      const vlLightTree *tree = &f->world->tree;
      vlReceiver at = {f->p, f->n, f->side};
      double sum = 0, slots = (side < 0 ? 1 : 2) + sky;
      size_t count = f->world->lights.count;
      for (uint32_t k = 0; k < count; k++) {
        float pmf = vl_light_pmf(tree, at, k);
        bool distant = f->world->lights.items[k].kind == VL_LIGHT_DISTANT;
        if (f->world->lights.items[k].far)
          assert_true(fabs((double)pmf - (distant && side < 0 ? 0 : 1 / slots)) < 1e-6);
        else
          assert_true((pmf > 0) ==
                      (side == 0 || (side < 0) == (f->world->lights.items[k].corners[2] < 0)));
        sum += (double)pmf;
      }
      /* A branch may promise light that neither of its children has: such samples find none. */
      assert_true(sum < 1 + 1e-5 && sum > (side ? 0 : 1 - 1e-5));
      if (!sky)
        judge(f, 51 + (unsigned)(side + 1), TESTS);
      end(f);
    }
}

/* So many lights that the choice leaves few bits for the point. */
static void crowd(void **state) {
  (void)state;
  enum { SIDE = 20, FACES = 2 * SIDE * SIDE };
  float p[SIDE + 1][SIDE + 1][3];
  uint32_t indices[3 * FACES], *at = indices;
  for (uint32_t y = 0; y <= SIDE; y++)
    for (uint32_t x = 0; x <= SIDE; x++) {
      p[y][x][0] = (float)x * 0.2f - 2;
      p[y][x][1] = (float)y * 0.2f - 2;
      p[y][x][2] = 1;
      uint32_t k = y * (SIDE + 1) + x;
      if (x == SIDE || y == SIDE)
        continue;
      const uint32_t faces[6] = {k, k + 1, k + SIDE + 1, k + 1, k + SIDE + 2, k + SIDE + 1};
      memcpy(at, faces, sizeof faces);
      at += 6;
    }
  Fixture *f = begin();
  vlShapeDef def = vl_default_shape_def(VL_SHAPE_TRIANGLES);
  def.vertices = (SIDE + 1) * (SIDE + 1);
  def.faces = FACES;
  def.positions = p[0][0];
  def.indices = indices;
  def.emission = emission(f, true);
  assert_int_not_equal(vl_scene_add_shape(f->scene, &def).index, 0);
  f->p = vl_vec3(0.2f, 0.1f, 0);
  f->n = vl_vec3(0, 0, 1);
  build(f, VL_LIGHT_SAMPLER_UNIFORM);
  assert_true(vl_light_pmf(&f->world->tree, (vlReceiver){f->p, f->n, f->side}, 7) < 1.0f / 256);
  judge(f, 15, TESTS);
  end(f);
}

static void add_round(Fixture *f, vlShapeKind kind, const double m[16]) {
  vlShapeDef def = vl_default_shape_def(kind);
  def.emission = emission(f, true);
  if (m)
    memcpy(def.group_from_shape, m, sizeof def.group_from_shape);
  assert_int_not_equal(vl_scene_add_shape(f->scene, &def).index, 0);
}

static void round_lights(void **state) {
  (void)state;
  const vlShapeKind kinds[3] = {VL_SHAPE_SPHERE, VL_SHAPE_DISK, VL_SHAPE_CYLINDER};
  const double plain[16] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 3, 0, 0, 0, 1};
  const double bent[16] = {1.5, 0.2, 0, 0.4, 0, 0.8, 0.1, 0.2, 0, 0, 0.6, 3, 0, 0, 0, 1};
  for (int k = 0; k < 3; k++)
    for (int j = 0; j < 2; j++) {
      if (kinds[k] == VL_SHAPE_CYLINDER)
        continue; /* one direction meets it twice: the nearer hides the farther */
      Fixture *f = begin();
      add_round(f, kinds[k], j ? bent : plain);
      f->p = vl_vec3(0.2f, 0.1f, 0);
      f->n = vl_vec3(0, 0, 1);
      /* A bent sphere is sampled by area: its far side is hidden, so that only one that is seen
       * from inside fits this test. */
      if (kinds[k] == VL_SHAPE_SPHERE && j)
        f->p = vl_vec3(0.4f, 0.3f, 3);
      build(f, VL_LIGHT_SAMPLER_BVH);
      judge(f, 21 + (unsigned)(2 * k + j), TESTS);
      end(f);
    }
}

static void sphere_from_inside(void **state) {
  (void)state;
  Fixture *f = begin();
  add_round(f, VL_SHAPE_SPHERE, NULL);
  f->p = vl_vec3(0.3f, -0.2f, 0.5f);
  f->n = vl_vec3(0, 0, 1);
  build(f, VL_LIGHT_SAMPLER_BVH);
  judge(f, 31, TESTS);
  end(f);
}

static void patch(void **state) {
  (void)state;
  const float p[12] = {-1, -1, 2, 1, -1, 2.5f, -1, 1, 3, 1.2f, 1, 2};
  const uint32_t index[4] = {0, 1, 2, 3};
  Fixture *f = begin();
  vlShapeDef def = vl_default_shape_def(VL_SHAPE_BILINEAR);
  def.vertices = 4;
  def.faces = 1;
  def.positions = p;
  def.indices = index;
  def.emission = emission(f, true);
  assert_int_not_equal(vl_scene_add_shape(f->scene, &def).index, 0);
  f->p = vl_vec3(0, 0.1f, 0);
  f->n = vl_vec3(0, 0, 1);
  build(f, VL_LIGHT_SAMPLER_BVH);
  judge(f, 41, TESTS);
  end(f);
}

static void sky(void **state) {
  (void)state;
  for (int i = 0; i < 3; i++) {
    Fixture *f = begin();
    vlLightDef def = vl_default_light_def(VL_LIGHT_INFINITE);
    vlImage *image = NULL;
    if (i) {
      vlImageDef image_def = vl_default_image_def(32, 32, 3);
      image_def.type = VL_PIXEL_F32;
      assert_int_equal(vl_image_create(f->context, &image_def, &image), VL_OK);
      float *pixels = vl_image_pixels(image);
      for (int k = 0; k < 32 * 32 * 3; k++)
        pixels[k] = i == 1              ? 1.0f + 0.5f * sinf(0.05f * (float)k)
                    : (k / 3) % 37 == 5 ? 50.0f
                                        : 0.5f;
      def.image = image;
      const double turned[16] = {0, -1, 0, 0, 0.6, 0, -0.8, 0, 0.8, 0, 0.6, 0, 0, 0, 0, 1};
      memcpy(def.world_from_light, turned, sizeof turned);
    }
    assert_int_not_equal(vl_scene_add_light(f->scene, &def).index, 0);
    f->n = vl_vec3(0, 0, 1);
    build(f, VL_LIGHT_SAMPLER_BVH);
    vl_image_destroy(image);
    judge(f, 51 + (unsigned)i, TESTS);
    end(f);
  }
}

/* A sky seen through windows: before the point, slanting, and so near that it fills half the
 * sphere. */
static void portals(void **state) {
  (void)state;
  const float corners[3][4][3] = {
      {{-0.5f, -1, 1}, {-0.5f, 1, 1}, {1, 1, 1}, {1, -1, 1}},
      {{3, -0.4f, 0}, {2.2f, -0.4f, 0.6f}, {2.2f, 0.8f, 0.6f}, {3, 0.8f, 0}},
      {{-2, -3, 0.02f}, {-2, 3, 0.02f}, {2, 3, 0.02f}, {2, -3, 0.02f}}};
  for (int i = 0; i < 3; i++) {
    Fixture *f = begin();
    vlLightDef def = vl_default_light_def(VL_LIGHT_INFINITE);
    vlImageDef image_def = vl_default_image_def(32, 32, 3);
    vlImage *image;
    image_def.type = VL_PIXEL_F32;
    assert_int_equal(vl_image_create(f->context, &image_def, &image), VL_OK);
    float *pixels = vl_image_pixels(image);
    for (int k = 0; k < 32 * 32 * 3; k++)
      pixels[k] = (k / 3) % 37 == 5   ? 20.0f
                  : (k / 3) % 11 == 0 ? 0.0f
                                      : 0.5f + 0.3f * sinf(0.05f * (float)k);
    const double turned[16] = {0, -1, 0, 0, 0.6, 0, -0.8, 0, 0.8, 0, 0.6, 0, 0, 0, 0, 1};
    memcpy(def.world_from_light, turned, sizeof turned);
    def.image = image;
    def.has_portal = true;
    memcpy(def.portal, corners[i], sizeof corners[i]);
    assert_int_not_equal(vl_scene_add_light(f->scene, &def).index, 0);
    f->n = vl_vec3(0, 0, 1);
    build(f, VL_LIGHT_SAMPLER_BVH);
    vl_image_destroy(image);
    judge(f, 61 + (unsigned)i, TESTS);
    end(f);
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(triangles),
      cmocka_unit_test(many_triangles),
      cmocka_unit_test(one_side),
      cmocka_unit_test(round_lights),
      cmocka_unit_test(sphere_from_inside),
      cmocka_unit_test(patch),
      cmocka_unit_test(sky),
      cmocka_unit_test(crowd),
      cmocka_unit_test(portals),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
