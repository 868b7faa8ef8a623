/* test/camera/test_answers.c: what project calls valid has a ray from unproject, which leads
 * back to the same film point, for random cameras of every projection and distortion and points
 * all around them, most of them outside the image. */
#include "camera/random_cameras.h"

enum { CAMERAS = 12, POINTS = 300 };

/* Points before the camera, on a sphere around it, and far to the side. */
static void draw_points(const vlCamera *camera, uint64_t *state, double points[POINTS][3]) {
  for (int i = 0; i < POINTS; i++) {
    double wide = i % 3 == 0 ? 1 : 4, z = i % 3 == 1 ? next_between(state, -3, 3) : 1;
    double p[3] = {next_between(state, -wide, wide), next_between(state, -wide, wide), z};
    const double *m = camera->world_from_camera;
    for (int k = 0; k < 3; k++, m += 4)
      points[i][k] = m[0] * p[0] + m[1] * p[1] + m[2] * p[2] + m[3];
  }
}

static int check_camera(const vlCamera *camera, uint64_t *state) {
  double points[POINTS][3], pixels[POINTS][2], z[POINTS], o[POINTS][3], d[POINTS][3];
  uint8_t valid[POINTS], answered[POINTS];
  int outside = 0;
  draw_points(camera, state, points);
  vl_camera_project_batch(camera, POINTS, points[0], pixels[0], z, valid);
  vl_camera_unproject_batch(camera, POINTS, pixels[0], o[0], d[0], answered);
  for (int i = 0; i < POINTS; i++) {
    double x = pixels[i][0], y = pixels[i][1], p[3], again[2], depth;
    if (!valid[i])
      continue;
    outside += x < 0 || y < 0 || x > camera->width || y > camera->height;
    if (!answered[i])
      fail_msg("%s: %.17g %.17g is valid and has no ray",
               vl_projection_name(camera->projection), x, y);
    for (int k = 0; k < 3; k++)
      p[k] = o[i][k] + 2 * d[i][k];
    assert_true(vl_camera_project(camera, p, again, &depth));
    double error = fmax(fabs(again[0] - x), fabs(again[1] - y));
    if (error > 1e-8 * (1000 + fabs(x) + fabs(y)))
      fail_msg("%s: %g %g comes back %g pixels off", vl_projection_name(camera->projection), x,
               y, error);
  }
  return outside;
}

static void valid_points_are_answered(void **state) {
  (void)state;
  uint64_t random = 13;
  int outside = 0;
  for (int kind = 0; kind < PROJECTIONS; kind++)
    for (int bent = 0; bent < DISTORTIONS; bent++)
      for (int i = 0; i < CAMERAS; i++) {
        vlCamera camera;
        if (bent != VL_DISTORTION_NONE && !has_distortion((vlProjection)kind))
          continue;
        if (random_camera((vlProjection)kind, (vlDistortion)bent, i % 2 ? 1 : 0.3, &random,
                          &camera))
          outside += check_camera(&camera, &random);
      }
  assert_true(outside > 10000);
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(valid_points_are_answered)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
