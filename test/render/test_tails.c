/* test/render/test_tails.c: rare bright samples of camera paths (render/tails.h): the formula;
 * its error against that of volpath's images; and the race, which does not choose volpath for a
 * room that is quiet but for a glint that volpath meets once in a million samples. */
#include "render/choose.h"
#include "render/lamp_room.h"
#include "render/tails.h"
#include "velo/choose.h"
#include "velo/tracer.h"

enum { SIZE = 48, RACE_SAMPLES = 8 };

/* ---- given numbers ----------------------------------------------------------------------- */

/* One light path: weighted radiance (0.3, 0.6, 0.9), found by camera paths with 1/50 of the
 * density. */
static void by_numbers(void **state) {
  (void)state;
  const double base[6] = {9, 9, 9, 1, 2, 3}, odds = 0.02;
  vlTails tails = {.width = 2, .height = 1, .base = base, .min = 0, .rare = 10, .max = 1e9};
  const float x = 1.5f, y = 0.5f, given = (float)odds;
  /* f / q and f / p, relative to base: the same for all */
  double q = 0.3 * (1 + odds), p = 0.3 * (1 + odds) / odds;
  struct {
    double rare, max, expected;
  } cases[] = {
      {10, 1e9, q * p},
      {p * 1.01, 1e9, 0}, /* not rare */
      {p * 0.99, 1e9, q * p},
      {1, 0.5 * 3 * p, q * p * 0.25}, /* samples limited to a half */
  };
  for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
    float r = 0.3f, g = 0.6f, b = 0.9f;
    tails.rare = cases[k].rare;
    tails.max = cases[k].max;
    vl_tails_measure(&tails, 1, &x, &y, &given, (float *const[3]){&r, &g, &b});
    assert_near("second moment", (double)r, cases[k].expected, 1e-5 * q * p);
    assert_near("its square", (double)g / VL_TAIL_SQUARES,
                cases[k].expected * cases[k].expected, 1e-5 * q * p * q * p);
    assert_true(b == 0);
  }
  float never = 0, r = 1, g = 1, b = 1;
  vl_tails_measure(&tails, 1, &x, &y, &never, (float *const[3]){&r, &g, &b});
  assert_true(r == 0 && g == 0 && b == 0);
}

/* ---- a room ------------------------------------------------------------------------------ */

typedef struct Room {
  double lamp;           /* radiance of the ceiling */
  float ball, roughness; /* radius of a ball of metal in the light of a spot light; 0: none */
  float spot;            /* intensity */
} Room;

static Stage room(const void *user, vlTracer tracer) {
  const Room *r = user;
  (void)tracer;
  Stage s = stage_open(SIZE, SIZE);
  s.camera.fov = 1.2;
  s.render.max_depth = 4;
  s.render.spp = 512;
  vlMaterialId white = add_diffuse(&s, 0.6f, 0.6f, 0.6f), walls[3] = {white, white, white};
  add_walls(&s, walls, white);
  if (r->lamp > 0) {
    Quad lamp = quad_at(0, 2.4f, -2, 1.2f, 0, 0, 0, 0, 1.2f);
    lamp.emission = add_emission(&s, (float)r->lamp, false);
    lamp.material = white;
    add_quad(&s, &lamp);
  }
  if (!(r->ball > 0))
    return s;
  vlMaterialDef metal = vl_default_material_def(VL_MATERIAL_CONDUCTOR);
  metal.u_roughness = metal.v_roughness = vl_float_input(r->roughness);
  metal.remap_roughness = false;
  add_ball_of(&s, 0.5f, -1.5f, r->ball, vl_scene_add_material(s.scene, &metal),
              (vlEmissionId){0});
  vlLightDef spot = vl_default_light_def(VL_LIGHT_SPOT);
  const float from[3] = {-2, 2, -2}, to[3] = {0.5f, -1.5f, -3};
  memcpy(spot.from, from, sizeof from);
  memcpy(spot.to, to, sizeof to);
  spot.scale = r->spot;
  spot.cone_angle = 0.2f * r->ball;
  spot.cone_delta = 0.02f * r->ball;
  assert_int_not_equal(vl_scene_add_light(s.scene, &spot).index, 0);
  return s;
}

static vlTracerChoice choice_of(const Room *r) {
  Stage s = room(r, VL_TRACER_VOLPATH);
  vlWorld *world = NULL;
  vlCamera camera;
  vlError error = {0};
  vlTracerChoice choice;
  assert_int_equal(vl_world_build(s.scene, &s.build, &world, &error), VL_OK);
  assert_int_equal(vl_camera_make(&s.camera, &camera, NULL, &error), VL_OK);
  assert_int_equal(vl_choose_tracer(world, &camera, &s.film, &s.render, false, &choice, &error),
                   VL_OK);
  vl_world_destroy(world);
  stage_close(&s);
  return choice;
}

static Image image_of(const Room *r, vlTracer tracer, uint32_t spp, uint32_t seed) {
  Stage s = room(r, tracer);
  s.render.tracer = tracer;
  s.render.spp = spp;
  s.render.seed = seed;
  return stage_finish(&s);
}

/* The squared relative error of volpath's images, by pairs of seeds; the base is an image by
 * light paths. */
static double measured_error(const Room *r, uint32_t spp, uint32_t pairs) {
  enum { N = SIZE * SIZE };
  Image base = image_of(r, VL_TRACER_BIDIRECTIONAL, 64, 1);
  double mean = 0, sum = 0;
  for (uint32_t i = 0; i < N; i++)
    mean += (double)base.rgba[4 * i + 1] / N;
  for (uint32_t k = 0; k < pairs; k++) {
    Image a = image_of(r, VL_TRACER_VOLPATH, spp, 2 * k),
          b = image_of(r, VL_TRACER_VOLPATH, spp, 2 * k + 1);
    for (uint32_t i = 0; i < N; i++) {
      double apart = (double)(a.rgba[4 * i + 1] - b.rgba[4 * i + 1]),
             to = (double)base.rgba[4 * i + 1];
      sum += 0.5 * apart * apart / (to * to + 0.1 * mean * mean) / N / pairs;
    }
    image_free(&a);
    image_free(&b);
  }
  image_free(&base);
  return sum;
}

/* All light comes by the ball, and all of volpath's samples that find it are bright. */
static void the_error_of_images(void **state) {
  (void)state;
  const Room r = {.ball = 0.15f, .roughness = 0.3f, .spot = 3000};
  double told = choice_of(&r).trials[0].tail,
         seen = measured_error(&r, 64, 4) * 64 / RACE_SAMPLES;
  if (!(told > 0.6 * seen && told < 1.6 * seen))
    fail_msg("error by rare samples %g, images have %g", told, seen);
}

/* A lamp that lights the room, and a spot light whose reflection in a small ball is 3 % of the
 * light. */
static void a_glint(void **state) {
  (void)state;
  const Room quiet = {.lamp = 3},
             glint = {.lamp = 3, .ball = 0.02f, .roughness = 0.1f, .spot = 120000};
  vlTracerChoice a = choice_of(&quiet), b = choice_of(&glint);
  assert_int_equal(a.tracer, VL_TRACER_VOLPATH);
  assert_true(a.trials[0].tail < 0.02 * a.trials[0].error);
  assert_int_equal(b.tracer, VL_TRACER_BIDIRECTIONAL);
  assert_true(b.trials[0].tail > 5 * a.trials[0].error);
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(by_numbers),
                                     cmocka_unit_test(the_error_of_images),
                                     cmocka_unit_test(a_glint)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
