/* test/camera/cameras.h: helpers of the camera tests: a random source with fixed seeds, a few
 * very different cameras. */
#ifndef TEST_CAMERA_CAMERAS_H
#define TEST_CAMERA_CAMERAS_H

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "unit.h"
#include "velo/camera.h"

#define RADIANS(degrees) ((degrees) * (3.14159265358979323846 / 180.0))

/* splitmix64; the sequence depends on the seed only. */
static inline uint64_t next_bits(uint64_t *state) {
  uint64_t z = (*state += 0x9e3779b97f4a7c15u);
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
  z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
  return z ^ (z >> 31);
}
static inline double next_unit(uint64_t *state) {
  return (double)(next_bits(state) >> 11) * 0x1p-53;
}
static inline double next_between(uint64_t *state, double low, double high) {
  return low + (high - low) * next_unit(state);
}

static inline void set3(double v[3], double x, double y, double z) {
  v[0] = x;
  v[1] = y;
  v[2] = z;
}

static inline vlCamera make_or_fail(const vlCameraDef *def) {
  vlCamera camera;
  vlError error;
  const char *warning;
  vlResult result = vl_camera_make(def, &camera, &warning, &error);
  if (result != VL_OK)
    fail_msg("%s", error.message);
  assert_null(warning);
  return camera;
}

/* The lecture's World::build. */
static inline vlCameraDef lecture_def(uint32_t width, uint32_t height) {
  vlCameraDef def = vl_default_camera_def(width, height);
  set3(def.eye, 300, 400, 500);
  set3(def.lookat, 0, 0, -50);
  def.view_distance = 400;
  return def;
}

enum { CAMERA_COUNT = 6 };
/* 0 lecture; 1 rolled, off-centre, skewed, other fy; 2 a matrix that mirrors and scales; 3
 * orthographic; 4 orthographic with a screen window; 5 pbrt's fov with a screen window, a large
 * image. */
static inline vlCamera camera_of(int index) {
  vlCameraDef def = lecture_def(400, 400);
  switch (index) {
    case 1:
      def = vl_default_camera_def(641, 479);
      def.fx = 812.5;
      def.fy = 790.25;
      def.skew = 1.75;
      def.cx = 300.125;
      def.cy = 250.5;
      set3(def.eye, -1000, 2000, 500);
      set3(def.lookat, 0, -100, 0);
      def.roll = RADIANS(33);
      break;
    case 2: {
      const double m[16] = {-1.2, 0.4, 0.3, 5, 0.2, -1.9, 0.8, -6,
                            0.6,  0.7, 2.1, 7, 0,   0,    0,   1};
      def = vl_default_camera_def(320, 200);
      def.has_matrix = true;
      memcpy(def.world_from_camera, m, sizeof m);
      def.fov = RADIANS(60);
      def.fov_axis = VL_FOV_HORIZONTAL;
      break;
    }
    case 3:
      def = vl_default_camera_def(200, 300);
      def.projection = VL_PROJECTION_ORTHOGRAPHIC;
      def.pixel_size = 0.25;
      def.zoom = 2;
      set3(def.eye, 10, 20, 30);
      set3(def.lookat, 1, 2, 3);
      break;
    case 4:
      def = vl_default_camera_def(300, 200);
      def.projection = VL_PROJECTION_ORTHOGRAPHIC;
      def.screen_min_x = -1;
      def.screen_max_x = 5;
      def.screen_min_y = -2;
      def.screen_max_y = 2;
      def.roll = RADIANS(-10);
      break;
    case 5:
      def = vl_default_camera_def(7680, 4320);
      def.fov = RADIANS(20);
      def.screen_min_x = -1.5;
      def.screen_max_x = 1.9;
      def.screen_min_y = -0.8;
      def.screen_max_y = 1.1;
      set3(def.eye, 0.1, 0.2, 0.3);
      set3(def.lookat, -3, 0.25, 1);
      break;
    default:
      break;
  }
  return make_or_fail(&def);
}

/* One clear line: the code, no line break, and the words that matter. second may be null. */
static inline void expect_error(vlCameraDef def, const char *first, const char *second) {
  vlCamera c;
  vlError error;
  memset(&error, 0x55, sizeof error);
  assert_int_equal(vl_camera_make(&def, &c, NULL, &error), VL_ERROR_ARGUMENT);
  assert_int_equal(error.code, VL_ERROR_ARGUMENT);
  if (!strstr(error.message, first) || (second && !strstr(error.message, second)) ||
      strchr(error.message, '\n'))
    fail_msg("message \"%s\" should speak of \"%s\" and \"%s\"", error.message, first,
             second ? second : "");
}
/* The default def with a change. */
#define EXPECT_ERROR(change, ...)                    \
  do {                                               \
    vlCameraDef d = vl_default_camera_def(640, 480); \
    change;                                          \
    expect_error(d, __VA_ARGS__);                    \
  } while (0)

#endif
