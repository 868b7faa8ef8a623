/* test/render/test_errors.c: standard errors against true ones: of images of 20 seeds, the root
 * of the mean of stated variances over that of the true ones, for each sampler, for own and
 * shared samples, filters, colours, numbers of samples. */
#include "render/shots.h"
#include "velo/filter_kinds.h"
#include "velo/sampler.h"
#include "velo/shape_kinds.h"

enum { WIDTH = 32, HEIGHT = 24, SEEDS = 20, VALUES = WIDTH * HEIGHT * 3 };

/* A room: a floor, a wall, a ball, a lamp in the image. */
static void fill(Stage *s) {
  Quad floor = quad_at(-4, -1, -1, 8, 0, 0, 0, 0, -6),
       wall = quad_at(-4, -1, -6, 8, 0, 0, 0, 5, 0);
  Quad lamp = quad_at(-1, 1.5f, -4, 1.2f, 0.3f, 0, 0, -0.2f, -0.8f);
  floor.material = add_diffuse(s, 0.7f, 0.7f, 0.6f);
  wall.material = add_diffuse(s, 0.6f, 0.3f, 0.2f);
  lamp.material = add_diffuse(s, 0, 0, 0);
  lamp.emission = add_emission(s, 12, true);
  add_quad(s, &floor);
  add_quad(s, &wall);
  add_quad(s, &lamp);
  vlShapeDef ball = vl_default_shape_def(VL_SHAPE_SPHERE);
  ball.radius = 0.8f;
  ball.z_min = -0.8f;
  ball.z_max = 0.8f;
  ball.material = add_diffuse(s, 0.8f, 0.8f, 0.8f);
  set_matrix(ball.group_from_shape, 1, 0, 0, 0.8, 0, 1, 0, -0.2, 0, 0, 1, -3.5);
  vl_scene_add_shape(s->scene, &ball);
  s->render.max_depth = 3;
}

typedef struct Case {
  vlSamplerKind sampler;
  vlPixelFilterKind filter;
  bool share, rgb;
  uint32_t spp, sequence;
} Case;

/* The ratio of an image's stated to true errors, and that of errors which take the samples as
 * independent. */
static void measure(const Case *c, double ratio[2]) {
  Stage s = stage_open(WIDTH, HEIGHT);
  vlWorld *world;
  vlCamera camera;
  vlFilm *film;
  fill(&s);
  s.build.color = c->rgb ? VL_COLOR_RGB : VL_COLOR_SPECTRAL;
  s.film.errors = true;
  s.film.filter = vl_default_pixel_filter(c->filter);
  s.render.sampler = c->sampler;
  s.render.share_samples = c->share;
  s.render.spp = c->spp;
  s.render.sequence = c->sequence;
  assert_int_equal(vl_world_build(s.scene, &s.build, &world, NULL), VL_OK);
  assert_int_equal(vl_camera_make(&s.camera, &camera, NULL, NULL), VL_OK);
  assert_int_equal(vl_film_create(s.context, &s.film, &film), VL_OK);
  static double sum[VALUES], squares[VALUES];
  double stated[2] = {0, 0}, variance = 0;
  memset(sum, 0, sizeof sum);
  memset(squares, 0, sizeof squares);
  for (uint32_t seed = 1; seed <= SEEDS; seed++) {
    s.render.seed = seed;
    vl_film_clear(film);
    assert_int_equal(vl_render(world, &camera, film, &s.render, NULL, NULL), VL_OK);
    vlImage *image;
    assert_int_equal(vl_film_develop(film, NULL, &image), VL_OK);
    const float *p = vl_image_const_pixels(image);
    for (int i = 0; i < VALUES; i++) {
      double v = (double)p[i / 3 * 4 + i % 3];
      sum[i] += v;
      squares[i] += v * v;
    }
    vl_image_destroy(image);
    for (int k = 0; k < 2; k++) {
      vlDevelopDef develop = vl_default_develop_def();
      develop.independent = k;
      assert_int_equal(vl_film_errors(film, &develop, &image), VL_OK);
      p = vl_image_const_pixels(image);
      for (int i = 0; i < VALUES; i++)
        stated[k] += (double)p[i] * (double)p[i] / SEEDS;
      vl_image_destroy(image);
    }
  }
  for (int i = 0; i < VALUES; i++)
    variance += (squares[i] - sum[i] * sum[i] / SEEDS) / (SEEDS - 1);
  for (int k = 0; k < 2; k++)
    ratio[k] = sqrt(stated[k] / variance);
  vl_film_destroy(film);
  vl_world_destroy(world);
  stage_close(&s);
}

/* The ratio lies between 0.85 and 1.15; its own statistical error is 0.04 with 20 seeds. The
 * errors of independent samples are at least `independent` times the true ones, so that they
 * would fail. Of independent samples both are nearly the same. */
static void check(const char *what, const Case *c, double independent) {
  double ratio[2];
  measure(c, ratio);
  const double quotient = ratio[0] / ratio[1];
  const bool differ = c->sampler == VL_SAMPLER_INDEPENDENT && fabs(quotient - 1) > 0.12;
  if (differ)
    fail_msg("%s, %u samples: %.3f times the errors of independent samples, which they are",
             what, c->spp, quotient);
  if (!(ratio[0] > 0.85 && ratio[0] < 1.15 && ratio[1] > independent))
    fail_msg("%s, sampler %d, %u samples: %.3f times the true errors, independent %.3f", what,
             (int)c->sampler, c->spp, ratio[0], ratio[1]);
}

/* Samplers that can go on without end, with one sequence. */
static void one_sequence(void **state) {
  (void)state;
  Case c = {.filter = VL_PIXEL_FILTER_GAUSSIAN, .share = true, .spp = 32};
  c.sampler = VL_SAMPLER_INDEPENDENT;
  check("one sequence", &c, 1);
  c.sampler = VL_SAMPLER_HALTON;
  check("one sequence", &c, 1.5);
  c.sampler = VL_SAMPLER_SOBOL;
  check("one sequence", &c, 2);
  c.sampler = VL_SAMPLER_ZSOBOL;
  for (c.spp = 16; c.spp <= 64; c.spp *= 2)
    check("one sequence", &c, 2);
}

/* Samplers that divide the square into cells, with two sequences, which are independent of each
 * other. */
static void two_sequences(void **state) {
  (void)state;
  Case c = {.filter = VL_PIXEL_FILTER_GAUSSIAN, .share = true, .spp = 32, .sequence = 16};
  for (int sampler = VL_SAMPLER_REGULAR; sampler <= VL_SAMPLER_HAMMERSLEY; sampler++) {
    c.sampler = (vlSamplerKind)sampler;
    check("two sequences", &c, 1.5);
  }
}

static void filters_and_colours(void **state) {
  (void)state;
  Case c = {.sampler = VL_SAMPLER_ZSOBOL, .spp = 32};
  c.filter = VL_PIXEL_FILTER_GAUSSIAN;
  check("gaussian, own samples", &c, 2);
  c.rgb = c.share = true;
  check("gaussian, RGB", &c, 2);
  c.filter = VL_PIXEL_FILTER_BOX;
  check("box, RGB", &c, 2);
  c.filter = VL_PIXEL_FILTER_MITCHELL;
  check("mitchell, RGB", &c, 1.3);
  c.filter = VL_PIXEL_FILTER_TRIANGLE;
  c.spp = 24; /* parts of 16 and 8 samples */
  check("triangle, RGB", &c, 1.5);
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(one_sequence),
                                     cmocka_unit_test(two_sequences),
                                     cmocka_unit_test(filters_and_colours)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
