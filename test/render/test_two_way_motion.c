/* test/render/test_two_way_motion.c: the tracers with light paths against the path tracer, with
 * moving objects and cameras: the same mean within both standard errors; connections of inner
 * vertices in a room whose lamp stands in a shade, with less noise; the same bits for any
 * threads. */
#include "render/lamp_room.h"
#include "velo/medium.h"
#include "velo/shape_kinds.h"
#include "velo/tracer.h"

enum { SIZE = 18, FINE = 54 };

typedef struct Case {
  const char *name;
  bool things, camera, curve, lens, fog, sky;
  uint32_t size; /* 0: as the tracer wants it */
  vlContext *context;
} Case;

static void move_camera(vlCameraDef *c) {
  const double eye[3] = {0.6, 0.1, -0.2}, lookat[3] = {0.2, 0.1, -3};
  memcpy(c->eye_close, eye, sizeof eye);
  memcpy(c->lookat_close, lookat, sizeof lookat);
  c->roll_close = 0.3;
}

/* A board that rotates and a ball that moves with it, above a floor. */
static void add_mover(Stage *s) {
  static const double times[2] = {0.2, 0.9};
  double poses[32];
  vlGroupId group = vl_scene_add_group(s->scene, "mover");
  Quad board = quad_at(0, 0, 0, 0.5f, 0, 0, 0, 0.1f, 0.2f);
  board.material = add_diffuse(s, 0.8f, 0.3f, 0.1f);
  board.group = group;
  add_quad(s, &board);
  vlShapeDef ball = vl_default_shape_def(VL_SHAPE_SPHERE);
  ball.radius = 0.25f;
  ball.z_min = -0.25f;
  ball.z_max = 0.25f;
  ball.group = group;
  ball.material = add_diffuse(s, 0.2f, 0.3f, 0.8f);
  set_matrix(ball.group_from_shape, 1, 0, 0, 0.4, 0, 1, 0, 0.4, 0, 0, 1, 0);
  assert_int_not_equal(vl_scene_add_shape(s->scene, &ball).index, 0);
  set_matrix(poses, 1, 0, 0, -0.7, 0, 1, 0, -0.3, 0, 0, 1, -3);
  set_matrix(poses + 16, 0, -1, 0, 0.7, 1, 0, 0, 0, 0, 0, 1, -3.4);
  vl_scene_add_moving_instance(s->scene, group, 2, times, poses, (vlSource){0});
}

static Stage room(const void *user, vlTracer tracer) {
  const Case *c = user;
  uint32_t size = c->size ? c->size : tracer == VL_TRACER_MERGING ? FINE : SIZE;
  Stage s = stage_open_in(c->context, size, size);
  s.camera.fov = 1;
  s.camera.shutter_open = 0.25;
  s.camera.shutter_close = 0.85;
  if (c->camera)
    move_camera(&s.camera);
  if (c->lens) {
    s.camera.lens_radius = 0.05;
    s.camera.focus_distance = 3;
  }
  if (c->curve) {
    s.camera.shutter_points = 3;
    s.camera.shutter_at[1] = 0.3;
    s.camera.shutter_at[2] = 1;
    s.camera.shutter_value[1] = 1;
    s.camera.shutter_value[2] = 0.2;
  }
  s.build.color = VL_COLOR_RGB;
  s.render.spp = size == FINE ? 24 : 96;
  s.render.max_depth = 4;
  Quad q = quad_at(0.4f, 1.3f, -3, 0.3f, 0.05f, 0, 0, 0.1f, 0.3f);
  q.material = add_diffuse(&s, 0.2f, 0.2f, 0.2f);
  q.emission = add_emission(&s, 10, false);
  if (c->sky)
    add_sky(&s, 0.8f);
  if (!c->sky)
    add_quad(&s, &q);
  q = quad_at(0, -1, -3, 3, 0, 0, 0, 0, -3);
  q.material = add_diffuse(&s, 0.7f, 0.5f, 0.3f);
  add_quad(&s, &q);
  q = quad_at(0, 0, -4.5f, 3, 0, 0, 0, 3, 0);
  q.material = add_diffuse(&s, 0.3f, 0.6f, 0.8f);
  add_quad(&s, &q);
  if (c->things)
    add_mover(&s);
  if (c->fog) {
    vlMediumDef def = vl_default_medium_def(VL_MEDIUM_HOMOGENEOUS);
    def.sigma_a = vl_spectrum_constant(0.02f);
    def.sigma_s = vl_spectrum_constant(0.15f);
    vl_scene_defs(s.scene)->camera_medium = vl_scene_add_medium(s.scene, &def);
  }
  return s;
}

static void agrees(const char *how, const Case *what, vlTracer tracer, const Measure *eye,
                   double bias) {
  Measure m = measure(room, what, tracer);
  assert_agree(what->name, how, &m, eye, bias);
}

static void moving(void **state) {
  (void)state;
  static const Case cases[] = {{"things", true, false, true, false, false, false, 0, NULL},
                               {"camera", false, true, true, false, false, false, 0, NULL},
                               {"both", true, true, false, true, false, true, 0, NULL},
                               {"both in fog", true, true, true, false, true, false, 0, NULL}};
  for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
    Measure eye = measure(room, &cases[i], VL_TRACER_VOLPATH);
    agrees("bidirectional", &cases[i], VL_TRACER_BIDIRECTIONAL, &eye, 0.005);
    agrees("light paths", &cases[i], VL_TRACER_LIGHT_PATH, &eye, 0.005);
    if (i < 3)
      agrees("merging", &cases[i], VL_TRACER_MERGING, &eye, 0.02);
  }
}

/* Where it shows: the blur of a moving thing's light is where it should be, pixel by pixel. */
static void blurred_alike(void **state) {
  (void)state;
  Case what = {"pixels", true, true, true, false, false, false, SIZE, NULL};
  static const vlTracer tracers[2] = {VL_TRACER_BIDIRECTIONAL, VL_TRACER_MERGING};
  Stage s = room(&what, VL_TRACER_PATH);
  s.render.spp = 1024;
  s.build.color = VL_COLOR_SPECTRAL;
  Image path = stage_finish(&s);
  for (int k = 0; k < 2; k++) {
    s = room(&what, tracers[k]);
    s.render.tracer = tracers[k];
    s.render.spp = 512;
    s.render.merge_radius = 0.02;
    s.build.color = VL_COLOR_SPECTRAL; /* times and wavelengths of merging's passes are spread
                                          apart from each other */
    Image p = stage_finish(&s);
    assert_true(image_differing(&path, &p, 0.25) < 0.025); /* edges of the lamp are noisy */
    image_free(&p);
  }
  image_free(&path);
}

/* ---- connections of inner vertices ------------------------------------------------------- */

/* A red and a blue board that move one after the other over the lamp's tube and reflect most of
 * its light. */
static void add_boards(Stage *s) {
  static const double times[2] = {0, 1};
  double poses[32];
  vlGroupId group = vl_scene_add_group(s->scene, "boards");
  for (int k = 0; k < 2; k++) {
    Quad board = quad_at(k ? 0.9f : -0.9f, 0, 0, 0.7f, 0.2f, 0, 0, 0, 0.8f);
    board.material = k ? add_diffuse(s, 0.1f, 0.2f, 0.9f) : add_diffuse(s, 0.9f, 0.2f, 0.1f);
    board.group = group;
    add_quad(s, &board);
  }
  set_matrix(poses, 1, 0, 0, -1.2, 0, 1, 0, 1.3, 0, 0, 1, -3);
  set_matrix(poses + 16, 1, 0, 0, 1.9, 0, 1, 0, 1.5, 0, 0, 1, -3);
  vl_scene_add_moving_instance(s->scene, group, 2, times, poses, (vlSource){0});
}

typedef struct Lamp {
  bool spectral, fog, camera;
} Lamp;

static Stage lamp_room(const void *user, vlTracer tracer) {
  const Lamp *what = user;
  Stage s = stage_open_in(NULL, SIZE, SIZE);
  s.camera.fov = 1.2;
  s.camera.shutter_open = 0.1;
  s.camera.shutter_close = 0.9;
  if (what->camera)
    move_camera(&s.camera);
  s.build.color = what->spectral ? VL_COLOR_SPECTRAL : VL_COLOR_RGB;
  s.render.max_depth = 5;
  s.render.spp = tracer == VL_TRACER_VOLPATH ? 128 : 24;
  s.render.light_paths = 2048; /* several groups */
  vlMaterialId white = add_diffuse(&s, 0.7f, 0.7f, 0.7f);
  const vlMaterialId walls[3] = {add_diffuse(&s, 0.8f, 0.4f, 0.3f),
                                 add_diffuse(&s, 0.3f, 0.5f, 0.8f), white};
  add_walls(&s, walls, white);
  vlMaterialId dark = add_diffuse(&s, 0.3f, 0.3f, 0.3f);
  add_tube(&s, 0.2f, 0.5f, 0.35f, dark);
  add_ball_of(&s, 0.4f, 0.5f, 0.15f, dark, add_emission(&s, 40, false));
  add_boards(&s);
  if (what->fog) {
    vlMediumDef def = vl_default_medium_def(VL_MEDIUM_HOMOGENEOUS);
    def.sigma_a = vl_spectrum_constant(0.02f);
    def.sigma_s = vl_spectrum_constant(0.2f);
    vl_scene_defs(s.scene)->camera_medium = vl_scene_add_medium(s.scene, &def);
  }
  return s;
}

static void moving_boards(void **state) {
  (void)state;
  static const Lamp all[3] = {{false, false, false}, {true, false, true}, {false, true, false}};
  for (int k = 0; k < 3; k++) {
    Measure path = measure(lamp_room, &all[k], VL_TRACER_VOLPATH);
    Measure both = measure(lamp_room, &all[k], VL_TRACER_BIDIRECTIONAL);
    char what[64];
    snprintf(what, sizeof what, "boards, %d", k);
    assert_agree(what, "bidirectional", &both, &path, 0.002);
  }
}

/* A grey board that moves to the right is grey wherever the blur has its place: the times of
 * the groups do not depend on their wavelengths. */
static void grey_blur(void **state) {
  (void)state;
  static const double times[2] = {0, 1};
  double poses[32];
  Stage s = stage_open_in(NULL, SIZE, SIZE);
  s.build.color = VL_COLOR_SPECTRAL;
  s.render.tracer = VL_TRACER_BIDIRECTIONAL;
  s.render.spp = 256;
  s.render.max_depth = 2;
  s.render.light_paths = 2048;
  s.camera.shutter_open = 0;
  s.camera.shutter_close = 1;
  add_point(&s, 0, 0, 0, 10);
  vlGroupId group = vl_scene_add_group(s.scene, "board");
  Quad board = quad_at(0, 0, 0, 0.15f, 0, 0, 0, 2, 0);
  board.material = add_diffuse(&s, 0.2f, 0.2f, 0.2f);
  board.group = group;
  add_quad(&s, &board);
  set_matrix(poses, 1, 0, 0, -1.5, 0, 1, 0, 0, 0, 0, 1, -3);
  set_matrix(poses + 16, 1, 0, 0, 1.5, 0, 1, 0, 0, 0, 0, 1, -3);
  vl_scene_add_moving_instance(s.scene, group, 2, times, poses, (vlSource){0});
  Image p = stage_finish(&s);
  for (uint32_t band = 0; band < 3; band++) {
    double seen[3];
    for (int c = 0; c < 3; c++)
      seen[c] = image_region(&p, band * SIZE / 3, 0, (band + 1) * SIZE / 3, SIZE, c);
    for (int c = 0; c < 3; c++)
      if (!(fabs(seen[c] - seen[1]) < 0.01 * seen[1]))
        fail_msg("band %u: channel %d %.5f, green %.5f", band, c, seen[c], seen[1]);
  }
  image_free(&p);
}

static void less_noise(void **state) {
  (void)state;
  const Lamp what = {false, false, false};
  double path = pair_noise(lamp_room, &what, VL_TRACER_VOLPATH);
  double both = pair_noise(lamp_room, &what, VL_TRACER_BIDIRECTIONAL);
  if (!(both < path / 3))
    fail_msg("noise of volpath %g, bidirectional %g", path, both);
}

static Image pixels(vlContext *context, const void *with) {
  vlTracer tracer = *(const vlTracer *)with;
  Case what = {"bits", true, true, true, true, true, false, SIZE, context};
  Stage s = room(&what, tracer);
  s.render.tracer = tracer;
  s.render.spp = 4;
  return stage_finish(&s);
}

static void same_bits(void **state) {
  (void)state;
  for (int merge = 0; merge < 2; merge++) {
    vlTracer tracer = merge ? VL_TRACER_MERGING : VL_TRACER_BIDIRECTIONAL;
    Image a = assert_same_bits(pixels, &tracer, 2);
    image_free(&a);
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(moving),        cmocka_unit_test(blurred_alike),
      cmocka_unit_test(moving_boards), cmocka_unit_test(grey_blur),
      cmocka_unit_test(less_noise),    cmocka_unit_test(same_bits)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
