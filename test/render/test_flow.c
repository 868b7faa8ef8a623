/* test/render/test_flow.c: optical flow between two cameras against known geometry; boxes
 * against counted pixels. */
#include "render/ground_truths.h"
#include "velo/boxes.h"
#include "velo/shape_kinds.h"

static GroundTruth ground_truth_take(Stage *s, const vlCameraDef *other, uint32_t channels) {
  GroundTruth t = ground_truth_begin(s);
  vlError error = {0};
  assert_int_equal(vl_camera_make(other, &t.other, NULL, &error), VL_OK);
  vlChannelsDef def = vl_default_channels_def(s->camera.width, s->camera.height);
  def.channels = channels;
  def.forward = &t.other;
  ground_truth_channels(&t, &def);
  return t;
}

/* A wall at depth 8, and in front of it a narrow wall at depth 4. The other camera is 1 to the
 * right. The focal length is 60, so the wall moves 7.5 pixels to the left and the narrow wall
 * 15. Stripes 7.5 pixels wide appear and disappear. */
static void test_two_walls(void **state) {
  (void)state;
  Stage s = stage_open(120, 40);
  Quad wall = quad_at(0, 0, -8, 40, 0, 0, 0, 40, 0),
       narrow = quad_at(0, 0, -4, 0.8f, 0, 0, 0, 40, 0);
  add_quad(&s, &wall);
  add_quad(&s, &narrow);
  s.camera.fx = s.camera.fy = 60;
  vlCameraDef other = s.camera;
  other.eye[0] = other.lookat[0] = 1;
  GroundTruth t = ground_truth_take(&s, &other, VL_CHANNEL_ALL | VL_CHANNEL_FORWARD);
  uint32_t counts[4] = {0, 0, 0, 0};
  for (uint32_t y = 0; y < 40; y++)
    for (uint32_t x = 0; x < 120; x++) {
      bool front = x + 0.5 > 48 && x + 0.5 < 72; /* 0.8 * 60 / 4 = 12 pixels to both sides */
      double u = front ? -15 : -7.5, at = x + 0.5 + u;
      assert_int_equal(id(&t, x, y, "id.object"), front ? 2 : 1);
      assert_near("u", number(&t, x, y, "forward.U"), u, 2e-5);
      assert_near("v", number(&t, x, y, "forward.V"), 0, 2e-5);
      /* the narrow wall covers columns 33 to 57 of the other image */
      uint32_t expected = at < 0                         ? VL_HIDDEN_OUTSIDE
                          : !front && at > 33 && at < 57 ? VL_HIDDEN_BEHIND
                                                         : VL_HIDDEN_NOT;
      if (at == 33 || at == 57 || at == 0)
        continue; /* pixels on the edge are not tested */
      counts[expected]++;
      assert_int_equal(id(&t, x, y, "forward.hidden"), expected);
    }
  assert_true(counts[0] > 1000 && counts[1] > 200 && counts[2] > 200);
  ground_truth_free(&t);
  stage_close(&s);
}

/* The other camera looks away, or has another projection. The sky's flow depends on the
 * camera's rotation. */
static void test_sky_and_nowhere(void **state) {
  (void)state;
  Stage s = stage_open(64, 64);
  Quad wall = quad_at(0, -1, -8, 40, 0, 0, 0, 1, 0); /* below the horizon */
  add_quad(&s, &wall);
  vlCameraDef other = s.camera;
  other.lookat[2] = 1;
  GroundTruth t = ground_truth_take(&s, &other, VL_CHANNEL_ALL | VL_CHANNEL_FORWARD);
  for (uint32_t y = 0; y < 64; y++) {
    assert_int_equal(id(&t, 20, y, "forward.hidden"), VL_HIDDEN_NOWHERE);
    assert_true(number(&t, 20, y, "forward.U") == 0 && number(&t, 20, y, "forward.V") == 0);
  }
  ground_truth_free(&t);
  other = s.camera;
  /* the sky's flow depends on the camera's orientation, not on its position */
  other.eye[0] = 100;
  other.lookat[0] = 100 + 0.1;
  other.lookat[2] = -1;
  t = ground_truth_take(&s, &other, VL_CHANNEL_ALL | VL_CHANNEL_FORWARD);
  double o[3], d[3], pixel[2], z;
  assert_true(vl_camera_unproject(&t.camera, 30.5, 10.5, o, d));
  double far_point[3] = {100 + d[0], d[1], d[2]};
  assert_true(vl_camera_project(&t.other, far_point, pixel, &z));
  assert_int_equal(id(&t, 30, 10, "id.object"), 0);
  assert_near("u", number(&t, 30, 10, "forward.U"), pixel[0] - 30.5, 1e-4);
  assert_near("v", number(&t, 30, 10, "forward.V"), pixel[1] - 10.5, 1e-4);
  assert_int_equal(id(&t, 30, 10, "forward.hidden"), VL_HIDDEN_NOT);
  ground_truth_free(&t);
  stage_close(&s);
}

/* No surface hides itself. The scene is a ball and a floor at grazing angles, far from the
 * origin. The reference is the other camera's own ground truth at that place. */
static void test_no_self_occlusion(void **state) {
  (void)state;
  Stage s = stage_open(90, 70);
  const float far_off = 500;
  Quad floor = quad_at(far_off, -1, -6, 30, 0, 0, 0, 0, -30);
  add_quad(&s, &floor);
  vlShapeDef ball = vl_default_shape_def(VL_SHAPE_SPHERE);
  set_matrix(ball.group_from_shape, 1, 0, 0, far_off, 0, 1, 0, 0, 0, 0, 1, -5);
  vl_scene_add_shape(s.scene, &ball);
  float *block;
  vlShapeDef mesh = mesh_sphere(6, 0.7f, true, &block);
  set_matrix(mesh.group_from_shape, 1, 0, 0, far_off + 2, 0, 1, 0, -0.3, 0, 0, 1, -6);
  vl_scene_add_shape(s.scene, &mesh);
  free(block);
  s.camera.eye[0] = s.camera.lookat[0] = (double)far_off;
  s.camera.eye[1] = -0.8;
  s.camera.lookat[1] = -0.8;
  vlCameraDef other = s.camera;
  other.eye[0] += 5;
  other.eye[1] = 0.5;
  GroundTruth t = ground_truth_take(&s, &other, VL_CHANNEL_ALL | VL_CHANNEL_FORWARD);
  uint32_t seen = 0, hidden = 0, wrong = 0;
  for (uint32_t y = 0; y < 70; y++)
    for (uint32_t x = 0; x < 90; x++) {
      uint32_t h = id(&t, x, y, "forward.hidden"), object = id(&t, x, y, "id.object");
      if (object == 0 || h > VL_HIDDEN_BEHIND)
        continue;
      double p[3], n[3], to[3], along = 0;
      static const char *const P[3] = {"P.X", "P.Y", "P.Z"}, *const G[3] = {"Ng.X", "Ng.Y",
                                                                            "Ng.Z"};
      for (int k = 0; k < 3; k++) {
        p[k] = number(&t, x, y, P[k]);
        n[k] = number(&t, x, y, G[k]);
        to[k] = other.eye[k] - p[k];
        along += to[k] * n[k];
      }
      /* of convex things: what is turned away is hidden by itself; what is turned there can be
       * hidden by others only */
      bool away = object == 2 && along < -0.02;
      bool ball_between = false, mesh_between = false;
      for (int step = 1; step < 400; step++) {
        double q[3];
        for (int k = 0; k < 3; k++)
          q[k] = p[k] + to[k] * step / 400;
        double a = hypot(hypot(q[0] - (double)far_off, q[1]), q[2] + 5);
        double b = hypot(hypot(q[0] - (double)far_off - 2, q[1] + 0.3), q[2] + 6);
        ball_between = ball_between || (object != 2 && a < 1);
        mesh_between = mesh_between || (object != 3 && b < 0.72);
      }
      seen += h == VL_HIDDEN_NOT;
      hidden += h == VL_HIDDEN_BEHIND;
      bool expected = away || ball_between || mesh_between;
      if (object == 3)
        continue;
      wrong += expected != (h == VL_HIDDEN_BEHIND);
    }
  if (seen < 1000 || hidden < 40 || wrong > 5)
    fail_msg("%u seen, %u hidden, %u wrong", seen, hidden, wrong);
  ground_truth_free(&t);
  stage_close(&s);
}

/* Boxes of a square that is half occluded by another, and of an instance that extends beyond
 * the image. */
static void test_boxes(void **state) {
  (void)state;
  Stage s = stage_open(100, 60);
  Quad back = quad_at(0.5f, 0, -4, 1, 0, 0, 0, 1, 0),
       front = quad_at(-0.25f, 0, -2, 0.5f, 0, 0, 0, 0.5f, 0);
  add_quad(&s, &back);
  add_quad(&s, &front);
  vlGroupId group = vl_scene_add_group(s.scene, "tile");
  Quad tile = quad_at(0, 0, 0, 1, 0, 0, 0, 1, 0);
  tile.group = group;
  add_quad(&s, &tile);
  double m[16];
  set_matrix(m, 0, -1, 0, 6.5, 1, 0, 0, 0, 0, 0, 1, -5);
  vl_scene_add_instance(s.scene, group, m, (vlSource){0});
  s.camera.fx = s.camera.fy = 40;
  GroundTruth t = ground_truth_take(&s, &s.camera, VL_CHANNEL_ALL);
  vlIdBox objects[3], instances[1];
  vlBoxesDef def = vl_default_boxes_def(100, 60);
  vlError error;
  assert_int_equal(vl_world_boxes(t.world, &t.camera, &def, objects, instances, &error), VL_OK);
  /* back: 45 to 65 across, 20 to 40 down; front: 35 to 55, 20 to 40 */
  assert_int_equal(objects[0].all, 20 * 20);
  assert_int_equal(objects[0].seen, 10 * 20);
  const uint32_t seen[4] = {55, 20, 65, 40}, all[4] = {45, 20, 65, 40};
  assert_memory_equal(objects[0].seen_box, seen, sizeof seen);
  assert_memory_equal(objects[0].all_box, all, sizeof all);
  assert_int_equal(objects[1].all, 400);
  assert_int_equal(objects[1].seen, 400);
  for (int k = 0; k < 4; k++)
    assert_near("outline", objects[0].outline[k], all[k], 1e-9);
  assert_true(objects[0].has_outline && objects[0].has_space && !objects[0].grouped);
  assert_near("x", objects[0].low[0], -0.5, 0);
  assert_near("x", objects[0].high[0], 1.5, 0);
  /* tile: 5.5 to 7.5 across at depth 5, 94 to 110: 6 columns in the image */
  assert_int_equal(instances[0].seen, 6 * 16);
  assert_true(instances[0].has_outline && objects[2].grouped && !objects[2].has_outline);
  const double outline[4] = {94, 22, 110, 38};
  for (int k = 0; k < 4; k++)
    assert_near("outline", instances[0].outline[k], outline[k], 1e-5);
  assert_near("box", instances[0].low[0], -1, 0);
  for (int i = 0; i < 16; i++)
    assert_near("pose", instances[0].world_from_box[i], m[i], 1e-6);
  uint64_t counted[3] = {0, 0, 0};
  for (uint32_t y = 0; y < 60; y++)
    for (uint32_t x = 0; x < 100; x++)
      if (id(&t, x, y, "id.object"))
        counted[id(&t, x, y, "id.object") - 1]++;
  for (int i = 0; i < 3; i++)
    assert_int_equal(counted[i], objects[i].seen);
  def.crop[0] = 50;
  def.crop[2] = 60;
  assert_int_equal(vl_world_boxes(t.world, &t.camera, &def, objects, NULL, &error), VL_OK);
  assert_int_equal(objects[0].all, 10 * 20);
  assert_int_equal(objects[0].seen, 5 * 20);
  def.crop[2] = 101;
  assert_int_equal(vl_world_boxes(t.world, &t.camera, &def, objects, NULL, &error),
                   VL_ERROR_ARGUMENT);
  ground_truth_free(&t);
  stage_close(&s);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(test_two_walls),
      cmocka_unit_test(test_sky_and_nowhere),
      cmocka_unit_test(test_no_self_occlusion),
      cmocka_unit_test(test_boxes),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
