/* test/import/test_motion.c: pbrt's animated transforms: moving shapes become groups and
 * instances with two poses at pbrt's times; moving parts of objects move with each instance;
 * the camera's two poses. */
#include "import/load.h"
#include "velo/light.h"
#include "velo/shape.h"

#define W "WorldBegin\n"

static void assert_pose(const double *got, double x, double y, double z) {
  if (fabs(got[3] - x) > 1e-12 || fabs(got[7] - y) > 1e-12 || fabs(got[11] - z) > 1e-12)
    fail_msg("at (%g %g %g), expected (%g %g %g)", got[3], got[7], got[11], x, y, z);
}

static void shapes_move(void **state) {
  (void)state;
  Loaded l;
  load_fine(&l, "TransformTimes 2 5\n" W
                "Shape \"sphere\"\nTranslate 1 0 0\nActiveTransform EndTime\nTranslate 0 3 "
                "0\nActiveTransform All\n"
                "Shape \"sphere\"\nShape \"disk\"\nTranslate 0 0 7\nShape \"sphere\"\n"
                "AreaLightSource \"diffuse\"\nShape \"sphere\"\n");
  assert_int_equal(l.scene->shapes.count, 5);
  assert_int_equal(l.scene->groups.count, 2); /* two that follow each other share theirs */
  assert_int_equal(l.scene->instances.count, 2);
  const uint32_t groups[5] = {0, 1, 1, 2, 2};
  for (int i = 0; i < 5; i++)
    assert_int_equal(l.scene->shapes.items[i].group.index, groups[i]);
  const vlSceneInstance *q = l.scene->instances.items;
  for (int i = 0; i < 2; i++) {
    assert_int_equal(q[i].keys, 2);
    assert_true(q[i].times[0] == 2 && q[i].times[1] == 5);
    assert_pose(q[i].poses, 1, 0, i ? 7 : 0);
    assert_pose(q[i].poses + 16, 1, 3, i ? 7 : 0);
  }
  assert_int_equal(l.scene->shapes.items[4].emission.index, 0);
  assert_non_null(strstr(l.log, "an area light that moves (ActiveTransform) gives no light"));
  end_load(&l);
}

static void instances_move(void **state) {
  (void)state;
  Loaded l;
  load_fine(&l, W
            "ObjectBegin \"o\"\nShape \"sphere\"\nAttributeBegin\nActiveTransform "
            "EndTime\nTranslate 0 0 "
            "4\n"
            "Shape \"disk\"\nAttributeEnd\nObjectEnd\n"
            "ObjectInstance \"o\"\nActiveTransform StartTime\nTranslate 1 2 0\nObjectInstance "
            "\"o\"\n");
  /* the object's own group, and that of its part; two instances of each */
  assert_int_equal(l.scene->groups.count, 2);
  assert_int_equal(l.scene->instances.count, 4);
  const vlSceneInstance *q = l.scene->instances.items;
  assert_int_equal(q[0].keys, 0);
  assert_int_equal(q[1].keys, 2);
  assert_pose(q[1].poses, 1, 2, 0);
  assert_pose(q[1].poses + 16, 0, 0, 0);
  for (int i = 2; i < 4; i++) {
    assert_int_equal(q[i].group.index, 2);
    const double *first = q[i].poses, *last = q[i].poses + 16 * (q[i].keys - 1),
                 *middle = first + 8 * (q[i].keys - 1);
    assert_pose(first, i == 3 ? 1 : 0, i == 3 ? 2 : 0, 0);
    assert_pose(middle, i == 3 ? 0.5 : 0, i == 3 ? 1 : 0, 2);
    assert_pose(last, 0, 0, 4);
  }
  end_load(&l);
}

static void cameras_move(void **state) {
  (void)state;
  Loaded l;
  vlCamera camera;
  load_fine(&l,
            "TransformTimes 1 3\nLookAt 0 0 -5 0 0 0 0 1 0\nActiveTransform EndTime\nTranslate "
            "2 0 0\n"
            "Camera \"perspective\" \"float shutteropen\" 1 \"float shutterclose\" 2\n" W);
  const vlCameraDef *def = &vl_scene_defs(l.scene)->camera;
  assert_int_equal(vl_camera_make(def, &camera, NULL, NULL), VL_OK);
  assert_true(camera.moves && camera.pose_times[0] == 1 && camera.pose_times[1] == 3);
  assert_pose(camera.world_from_camera, 0, 0, -5);
  assert_pose(camera.world_from_camera_close, -2, 0, -5);
  end_load(&l);
  load_fine(&l,
            "Camera \"pinhole\" \"point3 eye\" [0 0 5] \"point3 eyeclose\" [1 0 5] "
            "\"float rollclose\" 90\n"
            "\"float shutteropen\" 1 \"float shutterclose\" 2 \"float readout\" 0.5 "
            "\"string readoutdirection\" \"up\"\n"
            "\"string shuttercurve\" \"trapezoid\" \"float shutterrise\" 0.25\n" W);
  def = &vl_scene_defs(l.scene)->camera;
  assert_int_equal(vl_camera_make(def, &camera, NULL, NULL), VL_OK);
  assert_true(camera.moves && camera.pose_times[0] == 1 && camera.pose_times[1] == 2.5);
  assert_pose(camera.world_from_camera_close, 1, 0, 5);
  assert_true(camera.readout == 0.5 && camera.readout_direction == VL_READOUT_UP);
  assert_true(camera.shutter_points == 4 && camera.shutter_at[1] == 0.25 &&
              camera.shutter_at[2] == 0.75);
  end_load(&l);
}

/* Objects that cannot move use the transform at the start, with a warning. */
static void others_rest(void **state) {
  (void)state;
  Loaded l;
  load_fine(&l, W "ActiveTransform EndTime\nTranslate 0 0 1\nLightSource \"point\"\n");
  assert_non_null(strstr(l.log, "warning t.pbrt:4:1: this cannot move"));
  assert_true(l.scene->lights.items[0].world_from_light[11] == 0);
  end_load(&l);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(shapes_move),
      cmocka_unit_test(instances_move),
      cmocka_unit_test(cameras_move),
      cmocka_unit_test(others_rest),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
