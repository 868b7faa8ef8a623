/* test/render/test_small_lamps.c: lamps that are smaller than a pixel, seen by the camera
 * itself, against closed forms: radiance times solid angle. By camera rays alone they are a
 * firefly in one image of many. */
#include "fog.h"
#include "velo/medium.h"
#include "velo/tracer.h"

enum { SIZE = 32 };
static const float RADIANCE = 1000;

typedef struct Case {
  const char *name;
  vlTracer tracer;
  double lens;
  float half;     /* half the side of the squares */
  uint32_t paths; /* of light; 0: as many as pixels */
  uint32_t spp;
  bool fog; /* in a ball around the square in the middle */
  double tolerance;
} Case;

static void add_square(Stage *s, float x, float y, float half, float tilt, bool two_sided) {
  Quad q = quad_at(x, y, -3, half * cosf(tilt), 0, half * sinf(tilt), 0, half, 0);
  q.material = add_diffuse(s, 0, 0, 0);
  q.emission = add_emission(s, RADIANCE, two_sided);
  add_quad(s, &q);
}

/* Sum over the image of a lamp of the given area that faces the camera from p, tilted about y:
 * the cosines at the lamp and at the film, which is at distance 1. */
static double shine(const Stage *s, double x, double y, double area, double tilt) {
  double d2 = x * x + y * y + 9;
  double d = sqrt(d2);
  double at_lamp = fabs((x * sin(tilt) + 3 * cos(tilt)) / d);
  double at_film = 3 / d;
  double pixel = 2 * tan(0.5 * s->camera.fov) / SIZE;
  return (double)RADIANCE * area * at_lamp / (d2 * at_film * at_film * at_film * pixel * pixel);
}

static void check(const Case *c) {
  Stage s = stage_open(SIZE, SIZE);
  s.build.color = VL_COLOR_RGB;
  s.camera.fov = 0.8;
  if (c->lens > 0) {
    s.camera.lens_radius = c->lens;
    s.camera.focus_distance = 3;
  }
  s.render.tracer = c->tracer;
  s.render.spp = c->spp;
  s.render.max_depth = 2;
  if (c->paths)
    s.render.light_paths = c->paths;
  const double tilt = 0.9;
  add_square(&s, -0.8f, 0, c->half, 0.9f, true);
  add_square(&s, 0, 0, c->half, 0, true);
  add_square(&s, 0.8f, 0, c->half, 0, true);
  Quad screen = quad_at(0.72f, 0, -2.7f, 0.1f, 0, 0, 0, 0.1f, 0); /* hides the last square */
  screen.material = add_diffuse(&s, 0, 0, 0);
  add_quad(&s, &screen);
  if (c->fog) {
    vlMediumDef def = fog(0.5f, 0, 0);
    vlMediumId medium = add_medium(&s, &def);
    add_ball(&s, -3, 0.4f, interface(&s), medium, (vlMediumId){0});
  }
  double area = 4 * (double)(c->half * c->half);
  double left = shine(&s, -0.8, 0, area, tilt);
  double middle = shine(&s, 0, 0, area, 0) * (c->fog ? exp(-0.5 * 0.4) : 1);
  Image p = stage_finish(&s);
  uint32_t third = SIZE / 3;
  double scale = (double)third * SIZE;
  double a = image_region(&p, 0, 0, third, SIZE, 0) * scale;
  double b = image_region(&p, third, 0, 2 * third, SIZE, 0) * scale;
  double hidden = image_region(&p, 2 * third + 1, 0, SIZE, SIZE, 0);
  image_free(&p);
  assert_ratio(c->name, a, left, c->tolerance);
  assert_ratio(c->name, b, middle, c->tolerance);
  assert_near(c->name, hidden, 0, 1e-6);
}

static void small_lamps(void **state) {
  (void)state;
  const Case cases[] = {
      {"bidirectional", VL_TRACER_BIDIRECTIONAL, 0, 0.001f, 0, 8, false, 0.04},
      {"merging", VL_TRACER_MERGING, 0, 0.001f, 0, 8, false, 0.04},
      {"sppm", VL_TRACER_SPPM, 0, 0.001f, 0, 8, false, 0.04},
      {"through a lens", VL_TRACER_BIDIRECTIONAL, 0.02, 0.001f, 0, 8, false, 0.04},
      {"in fog", VL_TRACER_BIDIRECTIONAL, 0, 0.001f, 0, 8, true, 0.04},
  };
  for (size_t i = 0; i < sizeof cases / sizeof *cases; i++)
    check(&cases[i]);
}

/* Both ways of seeing a lamp have a part in the image, or only rays have: few light paths; a
 * lamp of about a pixel. */
static void both_ways(void **state) {
  (void)state;
  const Case cases[] = {
      {"few light paths", VL_TRACER_BIDIRECTIONAL, 0, 0.02f, 2, 1024, false, 0.04},
      {"few light paths, fog", VL_TRACER_BIDIRECTIONAL, 0, 0.02f, 2, 1024, true, 0.04},
      {"few light paths, lens", VL_TRACER_BIDIRECTIONAL, 0.02, 0.02f, 2, 1024, false, 0.04},
      {"a pixel", VL_TRACER_BIDIRECTIONAL, 0, 0.041f, 0, 64, false, 0.04},
      {"some pixels", VL_TRACER_BIDIRECTIONAL, 0, 0.06f, 0, 64, false, 0.04},
  };
  for (size_t i = 0; i < sizeof cases / sizeof *cases; i++)
    check(&cases[i]);
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(small_lamps),
                                     cmocka_unit_test(both_ways)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
