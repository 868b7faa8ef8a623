/* test/render/test_motion.c: images of moving objects: the mean of many images at fixed times
 * (z-test), the same bits on every instruction set, no self-intersection, moving vertices
 * against equally moving instances, the slope of an edge with a rolling shutter. */
#include "render/shots.h"
#include "velo/sampler.h"
#include "velo/shape_kinds.h"
#include "velo/texture.h"
#include "velo/tracer.h"

enum { W = 24, H = 18 };

/* Where the wheel is: turned by 120 degrees in the first half second, by 60 in the second. */
static void wheel_pose(double t, double m[16]) {
  double f = t < 0.5 ? 2 * t : 2 * t - 1,
         angle = (t < 0.5 ? 120 * f : 120 + 60 * f) * M_PI / 180;
  double x = t < 0.5 ? -0.6 : -0.6 + 0.8 * f, y = t < 0.5 ? 0.1 * f : 0.1 + 0.1 * f,
         z = t < 0.5 ? -3 : -3 + 0.2 * f;
  set_matrix(m, cos(angle), -sin(angle), 0, x, sin(angle), cos(angle), 0, y, 0, 0, 1, z);
}

/* A wheel of boards, a sphere and a mesh whose vertices move, over a floor; the camera may
 * move, too. held >= 0: all rests, but where it is at that time. */
static void fill(Stage *s, bool camera_moves, double held) {
  s->camera.fov = 0.9;
  s->camera.shutter_open = 0.25;
  s->camera.shutter_close = 0.75;
  if (camera_moves) {
    const double eye[3] = {0.3, 0.1, 0}, lookat[3] = {0.25, 0, -3};
    memcpy(s->camera.eye_close, eye, sizeof eye);
    memcpy(s->camera.lookat_close, lookat, sizeof lookat);
    s->camera.roll_close = 0.2;
  }
  s->build.color = VL_COLOR_RGB;
  s->render.max_depth = 3;
  add_sky(s, 0.3f);
  add_point(s, 1, 2.5f, -1, 9);
  Quad floor = quad_at(0, -0.9f, -3.5f, 5, 0, 0, 0, 0, 5);
  floor.material = add_diffuse(s, 0.5f, 0.5f, 0.5f);
  add_quad(s, &floor);
  vlGroupId group = vl_scene_add_group(s->scene, "wheel");
  vlTextureDef checks = vl_default_texture_def(VL_TEXTURE_CHECKERBOARD, false);
  checks.su = 5;
  checks.sv = 5;
  checks.float_a = vl_float_input(1);
  checks.float_b = vl_float_input(0);
  for (int k = 0; k < 3; k++) {
    Quad board =
        quad_at(0, 0, 0.1f * (float)k, k == 0 ? 0.6f : 0.1f, 0, 0, 0, k == 0 ? 0.1f : 0.6f, 0);
    board.material = add_diffuse(s, 0.8f, 0.3f, 0.1f);
    board.group = group;
    board.patch = k == 2;
    if (k == 1)
      board.alpha.texture = vl_scene_add_texture(s->scene, &checks);
    add_quad(s, &board);
  }
  vlShapeDef ball = vl_default_shape_def(VL_SHAPE_SPHERE);
  ball.radius = 0.25f;
  ball.group = group;
  ball.material = add_diffuse(s, 0.2f, 0.3f, 0.8f);
  set_matrix(ball.group_from_shape, 1, 0, 0, 0.4, 0, 1, 0, 0.4, 0, 0, 1.3, 0);
  assert_int_not_equal(vl_scene_add_shape(s->scene, &ball).index, 0);
  const double times[3] = {0, 0.5, 1};
  double poses[48];
  for (int k = 0; k < 3; k++)
    wheel_pose(times[k], poses + 16 * k);
  if (held >= 0)
    wheel_pose(held, poses);
  if (held >= 0)
    vl_scene_add_instance(s->scene, group, poses, (vlSource){0});
  else
    vl_scene_add_moving_instance(s->scene, group, 3, times, poses, (vlSource){0});
  float *block, close[3 * 13 * 7];
  vlShapeDef mesh = mesh_sphere(6, 0.4f, true, &block);
  set_matrix(mesh.group_from_shape, 1, 0, 0, 0.7, 0, 1, 0, 0, 0, 0, 1, -3);
  for (uint32_t i = 0; i < 3 * mesh.vertices; i++)
    close[i] =
        mesh.positions[i] * 0.6f + (i % 3 == 1 ? 0.6f * fabsf(mesh.positions[i - 1]) : 0);
  double f = fmin(fmax((held - 0.25) / 0.25, 0), 1);
  for (uint32_t i = 0; held >= 0 && i < 3 * mesh.vertices; i++)
    close[i] = (float)((double)mesh.positions[i] * (1 - f) + (double)close[i] * f);
  if (held >= 0)
    mesh.positions = close;
  if (held < 0) {
    mesh.positions_close = close;
    mesh.normals_close = mesh.normals;
  }
  mesh.times[0] = 0.25;
  mesh.times[1] = 0.5;
  mesh.material = add_diffuse(s, 0.3f, 0.7f, 0.3f);
  assert_int_not_equal(vl_scene_add_shape(s->scene, &mesh).index, 0);
  free(block);
}

/* Independent samples: the mean of N images of worlds at rest, spread over the time, and a
 * blurred one have the same expectation. */
static void blur_is_the_mean_of_held_images(void **state) {
  (void)state;
  enum { HELD = 200, SPP = 4 };
  for (int moves = 0; moves < 2; moves++) {
    static double sum[2][W * H], square[2][W * H];
    memset(sum, 0, sizeof sum);
    memset(square, 0, sizeof square);
    for (int k = 0; k < 2 * HELD; k++) { /* even: blurred, odd: held */
      int set = k % 2;
      /* the times of the held ones: even steps, jittered */
      double t = 0.25 + 0.5 * (k / 2 + fmod(0.61803398875 * k, 1.0)) / HELD;
      Stage s = stage_open(W, H);
      fill(&s, moves, set ? t : -1);
      s.render.sampler = VL_SAMPLER_INDEPENDENT;
      vlError error;
      vlWorld *world = NULL;
      vlCamera camera, held;
      assert_int_equal(vl_world_build(s.scene, &s.build, &world, &error), VL_OK);
      assert_int_equal(vl_camera_make(&s.camera, &camera, NULL, &error), VL_OK);
      assert_int_equal(vl_camera_at(&camera, t, &held), VL_OK);
      vlFilm *film = NULL;
      vlImage *image = NULL;
      s.render.seed = (uint32_t)(k + 1000 * moves);
      s.render.spp = SPP;
      assert_int_equal(vl_film_create(s.context, &s.film, &film), VL_OK);
      assert_int_equal(vl_render(world, set ? &held : &camera, film, &s.render, NULL, &error),
                       VL_OK);
      assert_int_equal(vl_film_develop(film, NULL, &image), VL_OK);
      for (uint32_t i = 0; i < W * H; i++) {
        double v = vl_image_get(image, i % W, i / W, 1);
        sum[set][i] += v;
        square[set][i] += v * v;
      }
      vl_image_destroy(image);
      vl_film_destroy(film);
      vl_world_destroy(world);
      stage_close(&s);
    }
    double chi2 = 0;
    int far = 0;
    for (int i = 0; i < W * H; i++) {
      double mean[2], variance = 0;
      for (int k = 0; k < 2; k++) {
        mean[k] = sum[k][i] / HELD;
        /* of held ones: too much, if anything */
        variance += (square[k][i] / HELD - mean[k] * mean[k]) / HELD;
      }
      double z = (mean[0] - mean[1]) / sqrt(variance + 1e-12);
      chi2 += z * z;
      far += fabs(z) > 3;
      if (fabs(z) > 5)
        fail_msg("moves %d, pixel %d %d: blurred %g, held %g, z %g", moves, i % W, i / W,
                 mean[0], mean[1], z);
    }
    double freedom = W * H;
    assert_true(chi2 < freedom + 5 * sqrt(2 * freedom));
    assert_true(chi2 > 0.3 * freedom);
    assert_true(far < 10);
  }
}

static void same_bits(void **state) {
  (void)state;
  Image first = {0, 0, NULL, {0}};
  for (int k = 0; k < 3; k++) {
    vlContextDef def = vl_default_context_def();
    def.isa = (vlIsa[3]){VL_ISA_BASE, VL_ISA_V3, VL_ISA_V4}[k];
    def.threads = 1 + (uint32_t)k;
    Stage s = stage_open(80, 60);
    vl_scene_destroy(s.scene);
    vl_context_destroy(s.context);
    if (vl_context_create(&def, &s.context) == VL_ERROR_UNSUPPORTED)
      continue; /* this machine lacks it */
    assert_int_equal(vl_scene_create(s.context, &s.scene), VL_OK);
    fill(&s, true, -1);
    s.render.spp = 16;
    Image p = stage_finish(&s);
    if (first.rgba) {
      for (size_t i = 0; i < 80 * 60 * 4; i++)
        if (memcmp(&p.rgba[i], &first.rgba[i], sizeof(float)) != 0)
          fail_msg("isa v%d: number %zu differs", (int)def.isa, i);
      image_free(&p);
    } else {
      first = p;
    }
  }
  image_free(&first);
}

/* Ambient occlusion of single convex objects: every sample that hits one is white, however fast
 * it moves, unless a ray that leaves the surface hits the object again. */
static void nothing_hides_itself(void **state) {
  (void)state;
  for (int k = 0; k < 4; k++) { /* turning, far from the origin, growing, vertices */
    Stage s = stage_open(40, 40);
    s.build.color = VL_COLOR_RGB;
    s.render.tracer = VL_TRACER_AMBIENT_OCCLUSION;
    s.render.spp = 64;
    double far = k == 1 ? 1000 : 0, times[2] = {0, 1}, poses[32];
    s.camera.eye[0] = s.camera.lookat[0] = far + 0.5;
    s.camera.fov = 0.5;
    float *block;
    vlShapeDef ball = mesh_sphere(12, 1, false, &block);
    float *close = malloc(3 * ball.vertices * sizeof(float));
    for (uint32_t i = 0; i < 3 * ball.vertices; i++)
      close[i] = ball.positions[i] * 0.7f + (i % 3 == 0 ? 0.9f : 0);
    ball.material = add_diffuse(&s, 0.5f, 0.5f, 0.5f);
    if (k == 3) {
      ball.positions_close = close;
      set_matrix(ball.group_from_shape, 1, 0, 0, far, 0, 1, 0, 0, 0, 0, 1, -5);
    } else {
      ball.group = vl_scene_add_group(s.scene, "ball");
    }
    assert_int_not_equal(vl_scene_add_shape(s.scene, &ball).index, 0);
    double g = k == 2 ? 0.3 : 1;
    set_matrix(poses, 1, 0, 0, far, 0, 1, 0, 0, 0, 0, 1, -5);
    set_matrix(poses + 16, 0, -g, 0, far + 1, g, 0, 0, 0, 0, 0, g, -4.5);
    if (k < 3)
      vl_scene_add_moving_instance(s.scene, ball.group, 2, times, poses, (vlSource){0});
    Image p = stage_finish(&s);
    int inside = 0;
    for (uint32_t i = 0; i < p.width * p.height; i++) {
      double alpha = p.rgba[4 * i + 3];
      inside += alpha > 0.5;
      assert_near("openness", p.rgba[4 * i + 1], alpha, 1e-3);
    }
    assert_true(inside > 100);
    image_free(&p);
    free(block);
    free(close);
  }
}

/* A translation said three ways: instance, vertices, and the camera going the other way. */
static void ways_to_move_agree(void **state) {
  (void)state;
  Image p[3];
  for (int k = 0; k < 3; k++) {
    Stage s = stage_open(32, 24);
    s.build.color = VL_COLOR_RGB;
    s.render.max_depth = 0;
    s.render.spp = 32;
    add_sky(&s, 1);
    float *block, close[3 * 17 * 9];
    vlShapeDef ball = mesh_sphere(8, 0.5f, false, &block);
    ball.material = add_diffuse(&s, 0.5f, 0.5f, 0.5f);
    double times[2] = {0, 1}, poses[32];
    set_matrix(poses, 1, 0, 0, -0.5, 0, 1, 0, 0, 0, 0, 1, -2);
    memcpy(poses + 16, poses, 16 * sizeof *poses);
    poses[19] = 0.5;
    poses[23] = 0.25;
    for (uint32_t i = 0; i < 3 * ball.vertices; i++)
      close[i] = ball.positions[i] + (i % 3 == 0 ? 1.0f : i % 3 == 1 ? 0.25f : 0.0f);
    if (k == 0)
      ball.group = vl_scene_add_group(s.scene, "ball");
    if (k > 0)
      memcpy(ball.group_from_shape, poses, sizeof ball.group_from_shape);
    if (k == 1)
      ball.positions_close = close;
    vl_scene_add_shape(s.scene, &ball);
    if (k == 0)
      vl_scene_add_moving_instance(s.scene, ball.group, 2, times, poses, (vlSource){0});
    if (k == 2) {
      double eye[3] = {-1, -0.25, 0}, lookat[3] = {-1, -0.25, -1};
      memcpy(s.camera.eye_close, eye, sizeof eye);
      memcpy(s.camera.lookat_close, lookat, sizeof lookat);
    }
    p[k] = stage_finish(&s);
    free(block);
  }
  for (int k = 1; k < 3; k++) {
    double differing = 0;
    for (size_t i = 0; i < 32 * 24; i++)
      differing += fabs((double)p[0].rgba[4 * i + 3] - (double)p[k].rgba[4 * i + 3]);
    assert_true(differing < 0.2); /* a few samples on edges, of 24,576 */
  }
  assert_true(image_region(&p[0], 0, 0, 32, 24, 3) > 0.02);
  for (int k = 0; k < 3; k++)
    image_free(&p[k]);
}

/* A white card's vertical edge moves to the right; rows are read one after the other: where
 * each row sees it. */
static void rolling_shutter_slants_edges(void **state) {
  (void)state;
  /* down, up; exposed for long: the edge is soft, its middle the same */
  for (int k = 0; k < 3; k++) {
    enum { WIDTH = 96, HEIGHT = 64 };
    Stage s = stage_open(WIDTH, HEIGHT);
    s.camera.projection = VL_PROJECTION_ORTHOGRAPHIC;
    s.camera.fx = 32; /* pixels a unit */
    s.build.color = VL_COLOR_RGB;
    s.render.max_depth = 0;
    s.render.spp = k == 2 ? 256 : 64;
    s.camera.shutter_close = k == 2 ? 0.25 : 0;
    s.camera.readout = 0.5;
    s.camera.readout_direction = k == 1 ? VL_READOUT_UP : VL_READOUT_DOWN;
    vlGroupId group = vl_scene_add_group(s.scene, "card");
    Quad card = quad_at(-5, 0, 0, 5, 0, 0, 0, 5, 0);
    card.group = group;
    add_quad(&s, &card);
    double times[2] = {0, 1}, poses[32], speed = 1.5; /* units a second */
    set_matrix(poses, 1, 0, 0, -0.8, 0, 1, 0, 0, 0, 0, 1, -2);
    memcpy(poses + 16, poses, 16 * sizeof *poses);
    poses[19] += speed;
    vl_scene_add_moving_instance(s.scene, group, 2, times, poses, (vlSource){0});
    Image p = stage_finish(&s);
    double sy = 0, sx = 0, syy = 0, sxy = 0;
    for (uint32_t y = 0; y < HEIGHT; y++) {
      double x = 0; /* the edge: how many pixels the card covers */
      for (uint32_t i = 0; i < WIDTH; i++)
        x += (double)image_at(&p, i, y, 3);
      sy += y;
      sx += x;
      syy += (double)y * y;
      sxy += x * y;
    }
    double slope = (HEIGHT * sxy - sx * sy) / (HEIGHT * syy - sy * sy), sign = k == 1 ? -1 : 1;
    double want = sign * speed * 32 * 0.5 / HEIGHT, offset = (sx - slope * sy) / HEIGHT;
    assert_near("slope in pixels a row", slope, want, 1e-3);
    double first = 48 - 0.8 * 32 + speed * 32 * (k == 1 ? 0.5 * 63 / 64.0 : k == 2 ? 0.125 : 0);
    assert_near("edge in row 0", offset, first, 0.05);
    image_free(&p);
  }
}

static void nonsense_is_refused(void **state) {
  (void)state;
  for (int k = 0; k < 7; k++) {
    Stage s = stage_open(8, 8);
    vlGroupId group = vl_scene_add_group(s.scene, "g");
    double times[2] = {0, k == 0 ? 0 : 1}, poses[32];
    set_matrix(poses, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0);
    memcpy(poses + 16, poses, 16 * sizeof *poses);
    if (k == 1)
      poses[16] = -1;
    if (k == 2)
      poses[16] = 0;
    if (k == 3)
      poses[20] = NAN;
    float *block, close[3 * 5 * 3] = {0};
    vlShapeDef mesh = mesh_sphere(2, 1, true, &block);
    mesh.positions_close = close;
    mesh.normals_close = mesh.normals;
    if (k == 4)
      mesh.times[1] = -1;
    if (k == 5)
      mesh.normals_close = NULL;
    if (k == 6)
      close[7] = INFINITY;
    if (k < 4)
      vl_scene_add_moving_instance(s.scene, group, 2, times, poses, (vlSource){0});
    else
      vl_scene_add_shape(s.scene, &mesh);
    assert_int_equal(vl_scene_result(s.scene, NULL), VL_ERROR_SCENE);
    free(block);
    stage_close(&s);
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(blur_is_the_mean_of_held_images),
      cmocka_unit_test(same_bits),
      cmocka_unit_test(nothing_hides_itself),
      cmocka_unit_test(ways_to_move_agree),
      cmocka_unit_test(rolling_shutter_slants_edges),
      cmocka_unit_test(nonsense_is_refused),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
