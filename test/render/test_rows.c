/* test/render/test_rows.c: ground truth of rolling shutters: each row is that of its own time,
 * for random cameras and objects in motion. */
#include "render/ground_truths.h"
#include "statistics.h"
#include "velo/boxes.h"

enum { W = 70, H = 45, SEEDS = 12, LINES = 6 };

/* A camera that moves and turns, and reads in one of the four directions; a ball and a mesh in
 * motion, and a floor at rest. */
static Stage fill(uint32_t seed) {
  Stage s = stage_open(W, H);
  statRng rng = stat_rng(seed), *r = &rng;
  s.camera.fov = 0.9;
  s.camera.shutter_open = 0.1;
  s.camera.shutter_close = 0.1 + 0.2 * stat_double(r);
  s.camera.readout = 0.2 + 0.6 * stat_double(r);
  s.camera.readout_direction = (vlReadout)(seed % 4);
  for (int k = 0; k < 3; k++) {
    s.camera.eye[k] = stat_double(r) - 0.5;
    s.camera.eye_close[k] = stat_double(r) - 0.5;
    s.camera.lookat[k] = (k == 2 ? -4 : 0) + 0.5 * stat_double(r);
    s.camera.lookat_close[k] = (k == 2 ? -4 : 0) + 0.5 * stat_double(r);
  }
  s.camera.roll_close = 0.3 * stat_double(r);
  Quad floor = quad_at(0, -0.9f, -3.5f, 5, 0, 0, 0, 0, 5);
  add_quad(&s, &floor);
  const double times[2] = {0, 1};
  double poses[32];
  set_matrix(poses, 1, 0, 0, -stat_double(r), 0, 1, 0, 0.2, 0, 0, 1, -3);
  set_matrix(poses + 16, 0.8, 0, 0, stat_double(r), 0, 0, 1, 0, 0, -1, 0, -2.7);
  vlGroupId group = vl_scene_add_group(s.scene, "g");
  float *block;
  vlShapeDef mesh = mesh_sphere(6, 0.5f, true, &block),
             ball = vl_default_shape_def(VL_SHAPE_SPHERE);
  mesh.group = ball.group = group;
  ball.radius = 0.3f;
  set_matrix(ball.group_from_shape, 1, 0, 0, 0.5, 0, 1, 0, 0.6, 0, 0, 1, 0.3);
  vl_scene_add_shape(s.scene, &mesh);
  vl_scene_add_shape(s.scene, &ball);
  vl_scene_add_moving_instance(s.scene, group, 2, times, poses, (vlSource){0});
  assert_int_equal(vl_scene_result(s.scene, NULL), VL_OK);
  free(block);
  return s;
}

static bool to_the_side(const Stage *s) {
  return s->camera.readout_direction == VL_READOUT_RIGHT ||
         s->camera.readout_direction == VL_READOUT_LEFT;
}

/* The bytes of a pixel of two images, the second of which begins at pixel (x0, y0). */
static void assert_same_pixel(const vlImage *a, const vlImage *b, uint32_t x, uint32_t y,
                              uint32_t x0, uint32_t y0) {
  size_t parts = vl_image_channels(a);
  const uint32_t *p = vl_image_const_pixels(a), *q = vl_image_const_pixels(b);
  p += ((size_t)y * vl_image_width(a) + x) * parts;
  q += ((size_t)(y - y0) * vl_image_width(b) + (x - x0)) * parts;
  for (size_t c = 0; c < parts; c++)
    if (p[c] != q[c])
      fail_msg("pixel %u, %u differs in %s", x, y, vl_image_channel_name(a, (uint32_t)c));
}

/* A row has the same bytes as where the whole scene is held at the row's time. */
static void rows_are_held_scenes(void **state) {
  (void)state;
  for (uint32_t seed = 0; seed < SEEDS; seed++) {
    Stage s = fill(seed);
    bool side = to_the_side(&s);
    uint32_t seen = 0;
    GroundTruth t = ground_truth_begin(&s);
    vlChannelsDef def = vl_default_channels_def(W, H);
    ground_truth_channels(&t, &def);
    for (uint32_t k = 0; k < LINES; k++) {
      uint32_t line = (side ? W - 1 : H - 1) * k / (LINES - 1);
      vlImage *floats, *ids;
      def.time =
          vl_camera_time(&t.camera, side ? line + 0.5 : 0.5, side ? 0.5 : line + 0.5, 0.5);
      assert_int_equal(vl_render_channels(t.world, &t.camera, &def, &floats, &ids, NULL),
                       VL_OK);
      for (uint32_t i = 0; i < (side ? H : W); i++) {
        uint32_t x = side ? line : i, y = side ? i : line;
        assert_same_pixel(t.floats, floats, x, y, 0, 0);
        assert_same_pixel(t.ids, ids, x, y, 0, 0);
        seen += id(&t, x, y, "id.instance") != 0;
      }
      vl_image_destroy(floats);
      vl_image_destroy(ids);
    }
    assert_true(seen > 5);
    ground_truth_free(&t);
    stage_close(&s);
  }
}

static void crops_have_the_same_bytes(void **state) {
  (void)state;
  for (uint32_t seed = 0; seed < 4; seed++) {
    Stage s = fill(seed);
    GroundTruth t = ground_truth_begin(&s);
    vlChannelsDef def = vl_default_channels_def(W, H);
    ground_truth_channels(&t, &def);
    const uint32_t crop[4] = {11, 7, 61, 40};
    memcpy(def.crop, crop, sizeof crop);
    vlImage *floats, *ids;
    assert_int_equal(vl_render_channels(t.world, &t.camera, &def, &floats, &ids, NULL), VL_OK);
    for (uint32_t y = crop[1]; y < crop[3]; y++)
      for (uint32_t x = crop[0]; x < crop[2]; x++) {
        assert_same_pixel(t.floats, floats, x, y, crop[0], crop[1]);
        assert_same_pixel(t.ids, ids, x, y, crop[0], crop[1]);
      }
    vl_image_destroy(floats);
    vl_image_destroy(ids);
    ground_truth_free(&t);
    stage_close(&s);
  }
}

/* Boxes and counts are those of the ids. */
static void boxes_are_of_the_rows(void **state) {
  (void)state;
  int outlines = 0;
  for (uint32_t seed = 0; seed < SEEDS; seed++) {
    Stage s = fill(seed);
    GroundTruth t = ground_truth_begin(&s);
    vlChannelsDef def = vl_default_channels_def(W, H);
    ground_truth_channels(&t, &def);
    vlBoxesDef boxes = vl_default_boxes_def(W, H);
    vlIdBox objects[3];
    assert_int_equal(vl_world_id_count(t.world, VL_ID_OBJECT), 3);
    vlIdBox instance;
    assert_int_equal(vl_world_boxes(t.world, &t.camera, &boxes, objects, &instance, NULL),
                     VL_OK);
    const uint32_t *all = instance.all_box, edges[4] = {0, 0, W, H};
    outlines += instance.has_outline;
    /* the outline of all points, cut by the image's edges */
    for (int k = 0; k < 4 && instance.has_outline; k++) {
      double at = fmin(fmax(instance.outline[k], 0), k % 2 ? H : W);
      if (all[k] != edges[k])
        assert_near("outline", at, all[k], 1.0);
      else
        assert_true(fabs(at - edges[k]) < 1.0);
    }
    for (uint32_t k = 1; k <= 3; k++) {
      uint32_t count = 0, box[4] = {W, H, 0, 0};
      for (uint32_t i = 0; i < W * H; i++) {
        uint32_t x = i % W, y = i / W;
        if (id(&t, x, y, "id.object") != k)
          continue;
        count++;
        box[0] = x < box[0] ? x : box[0];
        box[1] = y < box[1] ? y : box[1];
        box[2] = x >= box[2] ? x + 1 : box[2];
        box[3] = y >= box[3] ? y + 1 : box[3];
      }
      assert_int_equal(objects[k - 1].seen, count);
      assert_memory_equal(objects[k - 1].seen_box, box, count ? sizeof box : 0);
    }
    ground_truth_free(&t);
    stage_close(&s);
  }
  assert_true(outlines > SEEDS / 2);
}

/* Flow to a rolling shutter is that to its camera held at the time of the row to which it
 * leads, and tells as much of what hides the point. */
static void flow_leads_to_the_row_of_its_time(void **state) {
  (void)state;
  uint32_t moved = 0;
  for (uint32_t seed = 0; seed < SEEDS; seed++) {
    Stage s = fill(seed), later = fill(seed + 5);
    GroundTruth t = ground_truth_begin(&s), u = ground_truth_begin(&later);
    t.other = u.camera;
    vlChannelsDef def = vl_default_channels_def(W, H);
    def.channels = VL_CHANNEL_FORWARD | VL_CHANNEL_ID_OBJECT;
    def.forward = &t.other;
    ground_truth_channels(&t, &def);
    for (uint32_t k = 0; k < 60; k++) {
      uint32_t x = (7 * k + 3 * seed) % W, y = (11 * k + seed) % H;
      double to[2] = {x + 0.5 + number(&t, x, y, "forward.U"),
                      y + 0.5 + number(&t, x, y, "forward.V")};
      if (id(&t, x, y, "forward.hidden") > VL_HIDDEN_BEHIND)
        continue;
      bool side = to_the_side(&later);
      double line = side ? to[0] : to[1], row = floor(line);
      double a = vl_camera_time(&t.other, side ? row + 0.5 : 0.5, side ? 0.5 : row + 0.5, 0.5);
      double step = t.other.readout / (side ? W : H) *
                    (later.camera.readout_direction % 2 ? -1 : 1); /* up and left */
      vlCamera held;
      assert_int_equal(vl_camera_at(&t.other, a + (line - row - 0.5) * step, &held), VL_OK);
      const uint32_t crop[4] = {x, y, x + 1, y + 1};
      memcpy(def.crop, crop, sizeof crop);
      def.forward = &held;
      vlImage *floats, *ids;
      assert_int_equal(vl_render_channels(t.world, &t.camera, &def, &floats, &ids, NULL),
                       VL_OK);
      assert_near("flow x", number(&t, x, y, "forward.U"), vl_image_get(floats, 0, 0, 0), 2e-4);
      assert_near("flow y", number(&t, x, y, "forward.V"), vl_image_get(floats, 0, 0, 1), 2e-4);
      const uint32_t *hidden = vl_image_const_pixels(ids);
      int at = vl_image_find_channel(ids, "forward.hidden");
      assert_int_equal(hidden[at], id(&t, x, y, "forward.hidden"));
      moved += id(&t, x, y, "id.object") > 1;
      vl_image_destroy(floats);
      vl_image_destroy(ids);
    }
    ground_truth_free(&t);
    ground_truth_free(&u);
    stage_close(&s);
    stage_close(&later);
  }
  if (moved <= 40)
    fail_msg("%u moving points", moved);
}

/* Without a rolling shutter all rows have the time of the middle. */
static void others_have_one_time(void **state) {
  (void)state;
  Stage s = fill(1);
  s.camera.readout = 0;
  GroundTruth t = ground_truth_begin(&s);
  vlChannelsDef def = vl_default_channels_def(W, H);
  ground_truth_channels(&t, &def);
  def.time = vl_camera_time(&t.camera, 0.5 * W, 0.5 * H, 0.5);
  vlImage *floats, *ids;
  assert_int_equal(vl_render_channels(t.world, &t.camera, &def, &floats, &ids, NULL), VL_OK);
  for (uint32_t i = 0; i < W * H; i++) {
    assert_same_pixel(t.floats, floats, i % W, i / W, 0, 0);
    assert_same_pixel(t.ids, ids, i % W, i / W, 0, 0);
  }
  vl_image_destroy(floats);
  vl_image_destroy(ids);
  ground_truth_free(&t);
  stage_close(&s);
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(rows_are_held_scenes),
                                     cmocka_unit_test(crops_have_the_same_bytes),
                                     cmocka_unit_test(boxes_are_of_the_rows),
                                     cmocka_unit_test(flow_leads_to_the_row_of_its_time),
                                     cmocka_unit_test(others_have_one_time)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
