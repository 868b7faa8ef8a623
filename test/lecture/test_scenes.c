/* test/lecture/test_scenes.c: every scene of the lecture loads, and its camera has the slide's
 * eye, lookat and f = zoom d / s. */
#include <dirent.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "unit.h"
#include "velo/camera.h"
#include "velo/load.h"
#include "velo/render.h"

static const struct {
  const char *name;
  double eye[3], lookat[3], f;
} scenes[] = {
    {"pinhole", {300, 400, 500}, {0, 0, -50}, 400 / 0.625},
    {"axis_aligned", {0, 0, 500}, {0, 0, 0}, 500},
    {"tracer_raycast", {300, 400, 500}, {0, 0, -50}, 400},
    {"tracer_path", {300, 400, 500}, {0, 0, -50}, 400},
    {"tracer_ambientocclusion", {300, 400, 500}, {0, 0, -50}, 400},
    {"view_plane_250", {0, 0, 500}, {0, 0, 0}, 250},
    {"view_plane_500", {0, 0, 500}, {0, 0, 0}, 500},
    {"view_plane_1000", {0, 0, 500}, {0, 0, 0}, 1000},
    {"eye_200", {0, 0, 200}, {0, 0, 0}, 200},
    {"eye_150", {0, 0, 150}, {0, 0, 0}, 200},
    {"eye_100", {0, 0, 100}, {0, 0, 0}, 200},
    {"distortion_e15_d875", {0, 0, 15}, {0, 0, 0}, 875},
    {"distortion_e2_d85", {0, 0, 2}, {0, 0, 0}, 85},
    {"distortion_e10_d1687", {0, 0, 10}, {0, 0, 0}, 1687},
    {"distortion_e5_d750", {0, 0, 5}, {0, 0, 0}, 750},
    {"distortion_e2_5_d280", {0, 0, 2.5}, {0, 0, 0}, 280},
    {"example_1", {0, 0, 50}, {0, 0, 0}, 500},
    {"example_2", {300, 400, 50}, {0, 0, -50}, 400},
    {"example_3", {-1000, 2000, 500}, {0, -100, 0}, 250},
    {"perspective_one_point", {0, 130, 620}, {0, 130, 0}, 420},
    {"perspective_two_point", {430, 130, 430}, {0, 130, 0}, 420},
    {"perspective_three_point", {330, 440, 380}, {0, 70, 0}, 420},
    {"property_1", {0, 0, 500}, {0, 0, 0}, 500},
    {"property_2", {0, 0, 500}, {0, 0, 0}, 500},
    {"property_3", {0, 0, 500}, {0, 0, 0}, 500},
    {"property_4", {0, 0, 500}, {0, 0, 0}, 500},
    {"property_5", {0, 0, 500}, {0, 0, 0}, 500},
    {"property_6", {300, 300, 300}, {0, 0, 0}, 120},
    {"wide_perspective", {0, 0, 0}, {0, 0, -1}, 111.91383796},
    /* 240 / (2 tan 32.5 degrees) */
    {"wide_panini", {0, 0, 0}, {0, 0, -1}, 188.36226925409883},
    {"wide_stereographic", {0, 0, 0}, {0, 0, -1}, 188.36226925409883},
    /* 240 / 65 degrees, in radians */
    {"wide_equirectangular", {0, 0, 0}, {0, 0, -1}, 211.55364743291935},
};
enum { COUNT = sizeof scenes / sizeof scenes[0] };

static vlContext *context;

static int set_up(void **state) {
  (void)state;
  vlContextDef def = vl_default_context_def();
  return vl_context_create(&def, &context) == VL_OK ? 0 : -1;
}

static int tear_down(void **state) {
  (void)state;
  vl_context_destroy(context);
  return 0;
}

static void cameras_are_the_slides(void **state) {
  (void)state;
  for (int k = 0; k < COUNT; k++) {
    char path[1024];
    vlError error = {0};
    vlScene *scene;
    snprintf(path, sizeof path, "%s/scenes/lecture/%s.pbrt", VELO_SOURCE_DIR, scenes[k].name);
    assert_int_equal(vl_scene_create(context, &scene), VL_OK);
    if (vl_scene_load(scene, path, NULL, &error) != VL_OK)
      fail_msg("%s: %s:%u:%u: %s", scenes[k].name, error.file, error.line, error.column,
               error.message);
    vlCamera camera;
    const char *warning;
    if (vl_camera_make(&vl_scene_defs(scene)->camera, &camera, &warning, &error) != VL_OK)
      fail_msg("%s: %s", scenes[k].name, error.message);
    assert_null(warning);
    assert_true(fabs(camera.fx / scenes[k].f - 1) < 1e-7 &&
                fabs(camera.fy / scenes[k].f - 1) < 1e-7);
    assert_true(camera.cx == camera.width / 2.0 && camera.cy == camera.height / 2.0);
    const double *m = camera.world_from_camera;
    for (int a = 0; a < 3; a++)
      assert_true(fabs(m[4 * a + 3] - scenes[k].eye[a]) < 1e-6 * (1 + fabs(scenes[k].eye[a])));
    /* lookat in the middle; what is above it (up = y) above the middle, what is to the right to
     * the right */
    double pixel[2], z;
    assert_true(vl_camera_project(&camera, scenes[k].lookat, pixel, &z));
    assert_true(fabs(pixel[0] - camera.cx) < 1e-4 && fabs(pixel[1] - camera.cy) < 1e-4);
    double above[3] = {scenes[k].lookat[0], scenes[k].lookat[1] + z / 20, scenes[k].lookat[2]};
    assert_true(vl_camera_project(&camera, above, pixel, &z));
    assert_true(pixel[1] < camera.cy - camera.fy / 100 && fabs(pixel[0] - camera.cx) < 1e-3);
    assert_true(m[0] > 0); /* every eye of the lecture has the world's x axis to its right */
    vlSceneInfo info;
    vl_scene_info(scene, &info);
    assert_true(info.shapes > 0);
    vl_scene_destroy(scene);
  }
}

/* No scene without an entry above. */
static void all_scenes_are_listed(void **state) {
  (void)state;
  DIR *folder = opendir(VELO_SOURCE_DIR "/scenes/lecture");
  assert_non_null(folder);
  int seen = 0;
  for (struct dirent *entry; (entry = readdir(folder));) {
    char *dot = strrchr(entry->d_name, '.');
    if (!dot || strcmp(dot, ".pbrt") != 0)
      continue;
    *dot = 0;
    int found = 0;
    for (int k = 0; k < COUNT; k++)
      found += strcmp(entry->d_name, scenes[k].name) == 0;
    if (found != 1)
      fail_msg("scenes/lecture/%s.pbrt is not checked here", entry->d_name);
    seen++;
  }
  closedir(folder);
  assert_int_equal(seen, COUNT);
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(cameras_are_the_slides),
                                     cmocka_unit_test(all_scenes_are_listed)};
  return cmocka_run_group_tests(tests, set_up, tear_down);
}
