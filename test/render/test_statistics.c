/* test/render/test_statistics.c: all samplers, seeds and sample orders estimate the same image:
 * z-tests per pixel and over the whole image, on a scene with soft shadow, gloss, glass and
 * depth of field. Standard deviations come from repeated renders with other seeds, which is
 * valid for correlated samples, too. */
#include "render/shots.h"
#include "velo/sampler.h"
#include "velo/shape_kinds.h"

enum { WIDTH = 32, HEIGHT = 24, PIXELS = WIDTH * HEIGHT, SEEDS = 12, BLOCK = 8 };

typedef struct Estimate {
  double mean[PIXELS], variance[PIXELS]; /* of the mean over seeds */
  double block[PIXELS / (BLOCK * BLOCK)], block_variance[PIXELS / (BLOCK * BLOCK)];
  double image, image_variance;
} Estimate;

static Stage scene(void) {
  Stage s = stage_open(WIDTH, HEIGHT);
  s.camera.eye[1] = 0.6;
  s.camera.eye[2] = 2.2;
  s.camera.lookat[1] = -0.2;
  s.camera.lookat[2] = -1;
  s.camera.lens_radius = 0.05;
  s.camera.focus_distance = 2.5;
  s.camera.fov = 0.9;
  s.render.max_depth = 4;
  Quad floor = quad_at(0, -0.5f, 0, 3, 0, 0, 0, 0, -3),
       light = quad_at(0.4f, 1.2f, 0, 0.4f, 0, 0, 0, 0, 0.4f);
  floor.material = add_diffuse(&s, 0.6f, 0.5f, 0.4f);
  add_quad(&s, &floor);
  light.emission = add_emission(&s, 5, false);
  add_quad(&s, &light);
  add_sky(&s, 0.2f);
  vlMaterialDef defs[2] = {vl_default_material_def(VL_MATERIAL_DIELECTRIC),
                           vl_default_material_def(VL_MATERIAL_CONDUCTOR)};
  defs[0].u_roughness = defs[0].v_roughness = vl_float_input(0.1f);
  defs[1].u_roughness = defs[1].v_roughness = vl_float_input(0.15f);
  for (int k = 0; k < 2; k++) {
    vlShapeDef ball = vl_default_shape_def(VL_SHAPE_SPHERE);
    set_matrix(ball.group_from_shape, 0.4, 0, 0, k - 0.5, 0, 0.4, 0, -0.1, 0, 0, 0.4, -0.2);
    ball.material = vl_scene_add_material(s.scene, &defs[k]);
    vl_scene_add_shape(s.scene, &ball);
  }
  return s;
}

static void estimate(vlSamplerKind sampler, uint32_t spp, uint32_t first_seed, Estimate *e) {
  static double sum[PIXELS], sum2[PIXELS];
  memset(sum, 0, sizeof sum);
  memset(sum2, 0, sizeof sum2);
  memset(e, 0, sizeof *e);
  Stage s = scene();
  s.render.sampler = sampler;
  s.render.spp = spp;
  double image2 = 0, block2[PIXELS / (BLOCK * BLOCK)] = {0};
  for (uint32_t k = 0; k < SEEDS; k++) {
    s.render.seed = first_seed + k;
    Image p = stage_take(&s);
    double all = 0, block[PIXELS / (BLOCK * BLOCK)] = {0};
    for (uint32_t i = 0; i < PIXELS; i++) {
      double v = p.rgba[4 * i + 1];
      sum[i] += v;
      sum2[i] += v * v;
      all += v / PIXELS;
      block[i / WIDTH / BLOCK * (WIDTH / BLOCK) + i % WIDTH / BLOCK] += v / (BLOCK * BLOCK);
    }
    e->image += all / SEEDS;
    image2 += all * all;
    for (uint32_t b = 0; b < PIXELS / (BLOCK * BLOCK); b++) {
      e->block[b] += block[b] / SEEDS;
      block2[b] += block[b] * block[b];
    }
    assert_int_equal(p.stats.not_finite, 0);
    image_free(&p);
  }
  stage_close(&s);
  for (uint32_t i = 0; i < PIXELS; i++) {
    e->mean[i] = sum[i] / SEEDS;
    e->variance[i] = fmax(0, sum2[i] / SEEDS - e->mean[i] * e->mean[i]) / (SEEDS - 1);
  }
  for (uint32_t b = 0; b < PIXELS / (BLOCK * BLOCK); b++)
    e->block_variance[b] = fmax(0, block2[b] / SEEDS - e->block[b] * e->block[b]) / (SEEDS - 1);
  e->image_variance = fmax(0, image2 / SEEDS - e->image * e->image) / (SEEDS - 1);
}

/* Differences in units of their standard deviation. With few seeds t has heavy tails: for an
 * image or a block 6 is beyond chance. Over pixels the mean of z^2 must be near its
 * expectation, (n-1)/(n-3) = 1.22 for n = 12 seeds. */
static void compare(const char *what, const Estimate *a, const Estimate *b) {
  double floor2 = 1e-12;
  double z = (a->image - b->image) / sqrt(a->image_variance + b->image_variance + floor2);
  if (fabs(z) > 5.5)
    fail_msg("%s: the image's mean is %.6f instead of %.6f: z = %.1f", what, b->image, a->image,
             z);
  for (uint32_t i = 0; i < PIXELS / (BLOCK * BLOCK); i++) {
    z = (a->block[i] - b->block[i]) /
        sqrt(a->block_variance[i] + b->block_variance[i] + floor2);
    if (fabs(z) > 7)
      fail_msg("%s: block %u is %.6f instead of %.6f: z = %.1f", what, i, b->block[i],
               a->block[i], z);
  }
  double sum = 0;
  int wild = 0;
  for (uint32_t i = 0; i < PIXELS; i++) {
    z = (a->mean[i] - b->mean[i]) / sqrt(a->variance[i] + b->variance[i] + 1e-10);
    sum += z * z < 36 ? z * z : 36;
    wild += fabs(z) > 8;
  }
  sum /= PIXELS;
  if (sum < 0.6 || sum > 1.7)
    fail_msg("%s: mean of z^2 over pixels is %.2f", what, sum);
  if (wild > 2)
    fail_msg("%s: %d pixels are past 8 deviations", what, wild);
}

static const char *const name[9] = {"independent", "regular",        "stratified",
                                    "n-rooks",     "multi-jittered", "hammersley",
                                    "halton",      "sobol",          "zsobol"};

static void samplers_agree(void **state) {
  (void)state;
  static Estimate reference, other;
  estimate(VL_SAMPLER_INDEPENDENT, 64, 1000, &reference);
  for (int k = 0; k < 9; k++) {
    if (k == VL_SAMPLER_REGULAR)
      continue; /* a fixed grid: not an unbiased estimate */
    estimate((vlSamplerKind)k, 36, 1, &other);
    compare(name[k], &reference, &other);
  }
}

/* The test itself: a scene one percent brighter must be detected at the level of the image. */
static void the_test_has_eyes(void **state) {
  (void)state;
  static Estimate a, b;
  estimate(VL_SAMPLER_ZSOBOL, 36, 1, &a);
  estimate(VL_SAMPLER_ZSOBOL, 36, 100, &b);
  double z = (a.image - 1.01 * b.image) / sqrt(a.image_variance + b.image_variance);
  if (fabs(z) < 5.5)
    fail_msg("one percent makes z = %.1f only", z);
}

/* The regular sampler has the error of its fixed grid only: it must be near the mean of the
 * others. */
static void regular_is_near(void **state) {
  (void)state;
  static Estimate a;
  estimate(VL_SAMPLER_ZSOBOL, 36, 1, &a);
  Stage s = scene();
  s.render.sampler = VL_SAMPLER_REGULAR;
  s.render.spp = 256;
  Image p = stage_finish(&s);
  assert_ratio("regular", image_mean(&p, 1), a.image, 0.05);
  image_free(&p);
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(samplers_agree),
                                     cmocka_unit_test(the_test_has_eyes),
                                     cmocka_unit_test(regular_is_near)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
