/* test/render/test_motion_ground_truth.c: ground truth of moving objects: the same as in a
 * static world with the same poses; flow leads to the point's new position; the channels of a
 * pixel agree with each other. */
#include "render/shots.h"
#include "velo/channels.h"
#include "velo/shape_kinds.h"

enum {
  W = 48,
  H = 36,
  TRUTH = VL_CHANNEL_Z | VL_CHANNEL_P | VL_CHANNEL_N | VL_CHANNEL_UV | VL_CHANNEL_ID_OBJECT
};

static const double times[2] = {0, 1};

/* A mesh ball and a sphere that move together, a mesh whose vertices move; f < 0: on the move;
 * else at rest where they are at the time f, which is also the shutter's middle. */
static Stage fill(double f) {
  Stage s = stage_open(W, H);
  bool still = f >= 0;
  double a[16], b[16], poses[32];
  s.camera.fov = 0.8;
  s.camera.shutter_open = 0.2;
  s.camera.shutter_close = 0.6;
  set_matrix(a, 1, 0, 0, -0.6, 0, 1, 0, 0.1, 0, 0, 1, -3);
  /* no turn: the truth is known exactly */
  set_matrix(b, 1, 0, 0, 0.4, 0, 1.5, 0, 0.3, 0, 0, 1, -2.5);
  memcpy(poses, a, sizeof a);
  memcpy(poses + 16, b, sizeof b);
  vlGroupId group = vl_scene_add_group(s.scene, "g");
  float *block, rows[2][3 * 13 * 7];
  vlShapeDef mesh = mesh_sphere(6, 0.5f, true, &block),
             ball = vl_default_shape_def(VL_SHAPE_SPHERE);
  mesh.group = ball.group = group;
  ball.radius = 0.3f;
  set_matrix(ball.group_from_shape, 1, 0, 0, 0.2, 0, 1, 0, 0.6, 0, 0, 1, 0.3);
  vl_scene_add_shape(s.scene, &mesh);
  vl_scene_add_shape(s.scene, &ball);
  if (still) {
    double m[16];
    for (int i = 0; i < 16; i++)
      m[i] = a[i] * (1 - f) + b[i] * f;
    vl_scene_add_instance(s.scene, group, m, (vlSource){0});
  } else {
    vl_scene_add_moving_instance(s.scene, group, 2, times, poses, (vlSource){0});
  }
  mesh.group.index = 0;
  set_matrix(mesh.group_from_shape, 1, 0, 0, 0.8, 0, 1, 0, -0.4, 0, 0, 1, -3);
  for (uint32_t i = 0; i < 3 * mesh.vertices; i++) {
    float x = mesh.positions[i],
          close = x * (i % 3 == 1 ? 1.4f : 0.8f) + (i % 3 == 0 ? -0.4f : 0.0f);
    rows[0][i] = still ? (float)((double)x * (1 - f) + (double)close * f) : x;
    rows[1][i] = close;
  }
  mesh.positions = rows[0];
  if (!still) {
    mesh.positions_close = rows[1];
    mesh.normals_close = mesh.normals;
  }
  vl_scene_add_shape(s.scene, &mesh);
  assert_int_equal(vl_scene_result(s.scene, NULL), VL_OK);
  free(block);
  return s;
}

static void channels_of(Stage *s, const vlCamera *camera, vlChannelsDef *def, vlImage **floats,
                        vlImage **ids) {
  vlWorld *world = NULL;
  vlError error;
  if (vl_world_build(s->scene, &s->build, &world, &error) != VL_OK)
    fail_msg("build: %s", error.message);
  if (vl_render_channels(world, camera, def, floats, ids, &error) != VL_OK)
    fail_msg("channels: %s", error.message);
  vl_world_destroy(world);
}

static void as_in_a_still_world(void **state) {
  (void)state;
  for (int k = 0; k < 3; k++) { /* the shutter's middle, and given times */
    double f = k == 0 ? 0.4 : k == 1 ? 0 : 0.75;
    vlImage *floats[2], *ids[2];
    Stage s[2];
    for (int still = 0; still < 2; still++) {
      s[still] = fill(still ? f : -1);
      vlChannelsDef def = vl_default_channels_def(W, H);
      def.channels = TRUTH;
      if (k && !still)
        def.time = f;
      vlCamera camera;
      vlError error;
      assert_int_equal(vl_camera_make(&s[still].camera, &camera, NULL, &error), VL_OK);
      channels_of(&s[still], &camera, &def, &floats[still], &ids[still]);
    }
    uint32_t seen = 0, differing = 0, parts = vl_image_channels(floats[0]);
    for (uint32_t i = 0; i < W * H; i++) {
      uint32_t object = (uint32_t)vl_image_get(ids[0], i % W, i / W, 0);
      bool same = object == (uint32_t)vl_image_get(ids[1], i % W, i / W, 0);
      seen += object != 0;
      for (uint32_t c = 0; c < parts && same && object; c++) {
        double a = vl_image_get(floats[0], i % W, i / W, c),
               b = vl_image_get(floats[1], i % W, i / W, c);
        /* normals and uv of facets may differ on an edge; nothing else may */
        if (!(fabs(a - b) < 2e-5))
          same = false;
      }
      differing += !same;
    }
    assert_true(seen > 200);
    if (differing > 6)
      fail_msg("time %g: %u of %u pixels differ", f, differing, seen);
    for (int still = 0; still < 2; still++) {
      vl_image_destroy(floats[still]);
      vl_image_destroy(ids[still]);
      stage_close(&s[still]);
    }
  }
}

/* Flow from time 0 to time 1 for a camera at rest: points of the ball follow its pose, vertices
 * follow their given positions. */
static void flow_follows(void **state) {
  (void)state;
  Stage s = fill(-1);
  vlCamera camera, now, then;
  vlError error;
  assert_int_equal(vl_camera_make(&s.camera, &camera, NULL, &error), VL_OK);
  assert_int_equal(vl_camera_at(&camera, 0, &now), VL_OK);
  assert_int_equal(vl_camera_at(&camera, 1, &then), VL_OK);
  vlChannelsDef def = vl_default_channels_def(W, H);
  def.channels = TRUTH | VL_CHANNEL_FORWARD;
  def.forward = &then;
  vlImage *floats = NULL, *ids = NULL;
  channels_of(&s, &now, &def, &floats, &ids);
  uint32_t at = vl_image_channels(floats) - 2, moved = 0;
  for (uint32_t y = 0; y < H; y++)
    for (uint32_t x = 0; x < W; x++) {
      uint32_t object = (uint32_t)vl_image_get(ids, x, y, 0);
      if (object == 0)
        continue;
      double p[3], q[3], pixel[2], z;
      for (uint32_t c = 0; c < 3; c++)
        p[c] = vl_image_get(floats, x, y, 1 + c);
      if (object == 3) { /* shape space: less (0.8, -0.4, -3) */
        q[0] = 0.8 + 0.8 * (p[0] - 0.8) - 0.4;
        q[1] = -0.4 + 1.4 * (p[1] + 0.4);
        q[2] = -3 + 0.8 * (p[2] + 3);
      } else {
        q[0] = p[0] + 1;
        q[1] = 1.5 * (p[1] - 0.1) + 0.3;
        q[2] = p[2] + 0.5;
      }
      assert_true(vl_camera_project(&then, q, pixel, &z));
      assert_near("flow x", vl_image_get(floats, x, y, at), pixel[0] - (x + 0.5), 2e-4);
      assert_near("flow y", vl_image_get(floats, x, y, at + 1), pixel[1] - (y + 0.5), 2e-4);
      moved++;
    }
  assert_true(moved > 200);
  vl_image_destroy(floats);
  vl_image_destroy(ids);
  stage_close(&s);
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(as_in_a_still_world),
                                     cmocka_unit_test(flow_follows)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
