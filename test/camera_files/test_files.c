/* test/camera_files/test_files.c: camera files: round trips through every dialect, the
 * half-pixel table in exact numbers, rejected content by name, memory. */
#include "camera_files/files.h"

#include <locale.h>
#include <stdlib.h>
#include <sys/stat.h>
#include <unistd.h>

#include "velo/distortion.h"
#include "velo/header.h"
#include "velo/image.h"
#include "velo/lens.h"
#include "velo/load.h"
#include "velo/projection.h"
#include "velo/render.h"
#include "velo/sensor.h"
#include "velo/trajectory.h"

static vlCameraRecord read_as(const char *path, vlCameraDialect dialect, const char *frame) {
  vlCameraRecord record;
  vlError error;
  vlCameraFileDef def = vl_default_camera_file_def();
  def.dialect = dialect;
  def.frame = frame;
  if (vl_camera_read(context, path, &def, &record, &error) != VL_OK)
    fail_msg("%s", error.message);
  return record;
}

#define SAYS(name, text, words) assert_non_null(strstr(refused(name, text).message, words))

static vlCameraRecord some_camera(void) {
  vlCameraRecord record = {
      .camera = vl_default_camera_def(640, 480), .frames = 1, .name = "left"};
  vlCameraDef *d = &record.camera;
  set3(d->eye, 1.1, 2.3, -3.7);
  set3(d->lookat, 0.1, 0.2, 0.7);
  d->roll = 0.3;
  d->fx = 511.7;
  d->fy = 509.3;
  d->cx = 322.25;
  d->cy = 238.125;
  return record;
}

static void lens(vlCameraDef *d, vlDistortion kind, uint32_t count, const double *k) {
  d->distortion = kind;
  d->distortion_count = count;
  memcpy(d->distortion_coefficients, k, count * sizeof *k);
}

static void compare(const vlCameraDef *a, const vlCameraDef *b, double tolerance) {
  vlCamera one = make_or_fail(a), two = make_or_fail(b);
  uint64_t seed = 7;
  assert_int_equal(one.width, two.width);
  assert_int_equal(one.height, two.height);
  for (int i = 0; i < 200; i++) {
    double x = next_between(&seed, 0, 640), y = next_between(&seed, 0, 480), o[3], v[3], p[2],
           z;
    assert_true(vl_camera_unproject(&one, x, y, o, v));
    for (int k = 0; k < 3; k++)
      v[k] = o[k] + 4.0 * v[k];
    assert_true(vl_camera_project(&two, v, p, &z));
    if (!(fabs(p[0] - x) <= tolerance && fabs(p[1] - y) <= tolerance))
      fail_msg("%.17g %.17g: %.17g %.17g", x, y, p[0], p[1]);
  }
}

static void there_and_back(const vlCameraRecord *record, vlCameraDialect dialect,
                           const char *name, double tolerance) {
  vlError error;
  vlCameraFileDef def = vl_default_camera_file_def();
  def.dialect = dialect;
  char path[256];
  snprintf(path, sizeof path, "%s", path_of(name));
  if (vl_camera_write(context, path, &def, record, &error) != VL_OK)
    fail_msg("%s", error.message);
  vlCameraRecord back = read_as(path, VL_CAMERA_DIALECT_AUTO, NULL);
  assert_int_equal(back.dialect, dialect);
  compare(&record->camera, &back.camera, tolerance);
}

static const double five[5] = {-0.21, 0.07, 0.0011, -0.0007, 0.013};
static const double fourteen[14] = {-0.1,  0.05, 0.001, -0.002, 0.01, 0.02, 0.01,
                                    0.003, 1e-3, 2e-4,  -1e-3,  3e-4, 0.01, -0.02};
static const double fisheye[4] = {0.03, -0.011, 0.004, -0.0006};

static void test_round_trips(void **state) {
  (void)state;
  vlCameraRecord r = some_camera();
  there_and_back(&r, VL_CAMERA_DIALECT_VELO, "a.json", 1e-9);
  there_and_back(&r, VL_CAMERA_DIALECT_OPENCV, "a.yaml", 1e-9);
  there_and_back(&r, VL_CAMERA_DIALECT_OPENCV, "b.json", 1e-9);
  there_and_back(&r, VL_CAMERA_DIALECT_COLMAP, "cameras.txt", 1e-9);
  there_and_back(&r, VL_CAMERA_DIALECT_NERF, "transforms.json", 1e-9);
  there_and_back(&r, VL_CAMERA_DIALECT_BLENDER, "c.json", 1e-9);
  lens(&r.camera, VL_DISTORTION_OPENCV, 5, five);
  there_and_back(&r, VL_CAMERA_DIALECT_OPENCV, "a.yaml", 1e-9);
  there_and_back(&r, VL_CAMERA_DIALECT_COLMAP, "cameras.txt", 1e-9);
  there_and_back(&r, VL_CAMERA_DIALECT_NERF, "transforms.json", 1e-9);
  lens(&r.camera, VL_DISTORTION_OPENCV, 14, fourteen);
  there_and_back(&r, VL_CAMERA_DIALECT_OPENCV, "a.yaml", 1e-9);
  r.camera.projection = VL_PROJECTION_EQUIDISTANT;
  lens(&r.camera, VL_DISTORTION_RADIAL, 4, fisheye);
  there_and_back(&r, VL_CAMERA_DIALECT_OPENCV, "b.json", 1e-9);
  there_and_back(&r, VL_CAMERA_DIALECT_COLMAP, "cameras.txt", 1e-9);
  there_and_back(&r, VL_CAMERA_DIALECT_NERF, "transforms.json", 1e-9);
  r.camera.distortion = VL_DISTORTION_RAD_TAN_THIN_PRISM;
  r.camera.distortion_count = 12;
  for (int i = 0; i < 12; i++)
    r.camera.distortion_coefficients[i] = (i % 2 ? -0.001 : 0.002) / (i + 1);
  there_and_back(&r, VL_CAMERA_DIALECT_NERF, "transforms.json", 1e-9);
}

/* These hold no pose of their own. */
static void test_round_trips_at_the_origin(void **state) {
  (void)state;
  vlCameraRecord r = some_camera();
  r.camera.has_matrix = true;
  r.camera.roll = 0.0;
  lens(&r.camera, VL_DISTORTION_OPENCV, 5, five);
  there_and_back(&r, VL_CAMERA_DIALECT_ROS, "a.yaml", 1e-9);
  lens(&r.camera, VL_DISTORTION_OPENCV, 4, five);
  there_and_back(&r, VL_CAMERA_DIALECT_KALIBR, "a.yaml", 1e-9);
  r.camera.projection = VL_PROJECTION_UNIFIED;
  r.camera.shape[0] = 0.9;
  there_and_back(&r, VL_CAMERA_DIALECT_KALIBR, "a.yaml", 1e-9);
  r.camera.distortion = VL_DISTORTION_NONE;
  r.camera.distortion_count = 0;
  r.camera.projection = VL_PROJECTION_DOUBLE_SPHERE;
  r.camera.shape[0] = -0.2;
  r.camera.shape[1] = 0.6;
  there_and_back(&r, VL_CAMERA_DIALECT_KALIBR, "a.yaml", 1e-9);
  r.camera.projection = VL_PROJECTION_FOV;
  r.camera.shape[0] = 0.9;
  r.camera.shape[1] = VL_UNSET;
  there_and_back(&r, VL_CAMERA_DIALECT_KALIBR, "a.yaml", 1e-9);
}

/* ROS's calibration has OpenCV's fields, and each is read by the other's name. */
static void test_related_dialects(void **state) {
  (void)state;
  static const vlCameraDialect related[2] = {VL_CAMERA_DIALECT_ROS, VL_CAMERA_DIALECT_OPENCV};
  vlCameraRecord r = some_camera();
  r.camera.has_matrix = true;
  r.camera.roll = 0.0;
  lens(&r.camera, VL_DISTORTION_OPENCV, 5, five);
  for (int i = 0; i < 2; i++) {
    vlError error;
    vlCameraFileDef def = vl_default_camera_file_def();
    def.dialect = related[i];
    const char *path = path_of("related.yaml");
    if (vl_camera_write(context, path, &def, &r, &error) != VL_OK)
      fail_msg("%s", error.message);
    const vlCameraRecord back = read_as(path, related[!i], NULL);
    compare(&r.camera, &back.camera, 1e-9);
  }
}

/* Every number of the def comes back in its own bits. */
static void test_velo_is_exact(void **state) {
  (void)state;
  uint64_t seed = 3;
  for (int i = 0; i < 200; i++) {
    vlCameraRecord r = some_camera(), back;
    vlCameraDef *d = &r.camera;
    double *numbers[] = {&d->fx,          &d->fy,
                         &d->cx,          &d->cy,
                         &d->skew,        &d->eye[0],
                         &d->up[2],       &d->roll,
                         &d->lens_radius, &d->focus_distance,
                         &d->near_plane,  &d->exposure_time,
                         &d->max_angle};
    for (size_t k = 0; k < sizeof numbers / sizeof *numbers; k++)
      *numbers[k] = next_between(&seed, 0.5, 1.5);
    d->far_plane = next_between(&seed, 10, 20);
    lens(d, VL_DISTORTION_OPENCV, 5, five);
    d->has_matrix = i & 1;
    for (int k = 0; k < 12 && d->has_matrix; k++)
      d->world_from_camera[k] = next_between(&seed, -1, 1);
    vlError error;
    if (vl_camera_write(context, path_of("v.json"), NULL, &r, &error) != VL_OK)
      fail_msg("%s", error.message);
    back = read_as(path_of("v.json"), VL_CAMERA_DIALECT_AUTO, NULL);
    vlCamera one, two;
    assert_int_equal(vl_camera_make(d, &one, NULL, NULL), VL_OK);
    assert_int_equal(vl_camera_make(&back.camera, &two, NULL, NULL), VL_OK);
    assert_memory_equal(&one, &two, sizeof one);
    assert_string_equal(back.name, "left");
  }
}

static const char *const opencv_text =
    "%YAML:1.0\n"
    "---\n"
    "image_width: 640\n"
    "image_height: 480\n"
    "camera_matrix: !!opencv-matrix\n"
    "   rows: 3\n"
    "   cols: 3\n"
    "   dt: d\n"
    "   data: [ 500., 0., 319.5, 0., 501., 239.5, 0., 0., 1. ]\n"
    "distortion_coefficients: !!opencv-matrix\n"
    "   rows: 1\n"
    "   cols: 5\n"
    "   dt: d\n"
    "   data: [ 0., 0., 0., 0., 0. ]\n";

/* One camera whose axis goes through the image's centre, in every dialect's own numbers. */
static void test_half_pixel_table(void **state) {
  (void)state;
  mkdir(path_of("half"), 0700); /* no images.txt beside */
  const vlCameraRecord records[] = {
      read_as(put("o.yaml", opencv_text), 0, NULL),
      read_as(put("o.json",
                  "{\"image_width\":640,\"image_height\":480,"
                  "\"camera_matrix\":[[500,0,319.5],[0,501,239.5],[0,0,1]],"
                  "\"distortion_coefficients\":[]}"),
              0, NULL),
      read_as(
          put("r.yaml",
              "image_width: 640\nimage_height: 480\ncamera_name: x\ncamera_matrix:\n  rows: "
              "3\n  cols: 3\n"
              "  data: [500, 0, 319.5, 0, 501, 239.5, 0, 0, 1]\ndistortion_model: plumb_bob\n"
              "distortion_coefficients: {rows: 1, cols: 5, data: [0, 0, 0, 0, 0]}\n"
              "projection_matrix:\n  rows: 3\n  cols: 4\n  data: [1,0,0,0,0,1,0,0,0,0,1,0]\n"),
          0, NULL),
      read_as(put("k.yaml",
                  "cam0:\n  camera_model: pinhole\n  intrinsics: [500, 501, 319.5, 239.5]\n"
                  "  distortion_model: none\n  resolution: [640, 480]\n"),
              0, NULL),
      read_as(put("half/cameras.txt", "# one\n1 PINHOLE 640 480 500 501 320 240\n"), 0, NULL),
      read_as(put("n.json",
                  "{\"w\":640,\"h\":480,\"fl_x\":500,\"fl_y\":501,\"cx\":320,\"cy\":240,"
                  "\"frames\":[{\"file_path\":\"a\","
                  "\"transform_matrix\":[[1,0,0,0],[0,-1,0,0],[0,0,-1,0],[0,0,0,1]]}]}"),
              0, NULL)};
  for (size_t i = 0; i < sizeof records / sizeof *records; i++) {
    vlCamera c;
    assert_int_equal(vl_camera_make(&records[i].camera, &c, NULL, NULL), VL_OK);
    assert_true(c.fx == 500.0 && c.fy == 501.0 && c.cx == 320.0 && c.cy == 240.0);
    const double point[3] = {0.1, -0.2, 2.0};
    double p[2], z;
    assert_true(vl_camera_project(&c, point, p, &z));
    assert_float_equal(p[0], 320 + 25, 1e-12);
    assert_float_equal(p[1], 240 - 50.1, 1e-12);
    assert_true(z == 2.0);
  }
}

static void test_blender_shift(void **state) {
  (void)state;
  const char *text =
      "{\"lens\":18,\"sensor_width\":36,\"shift_x\":%s,\"shift_y\":0.1,\"resolution_x\":640,"
      "\"resolution_y\":"
      "480,\"matrix_world\":[[1,0,0,0],[0,1,0,0],[0,0,1,5],[0,0,0,1]]}";
  char full[400];
  snprintf(full, sizeof full, text, "0.1");
  vlCameraRecord r = read_as(put("b.json", full), 0, NULL);
  assert_float_equal(r.camera.fx, 320, 1e-12);
  assert_float_equal(r.camera.cx, 320 - 64, 1e-12);
  assert_float_equal(r.camera.cy, 240 + 64, 1e-12);
  vlCamera c = make_or_fail(&r.camera);
  const double ahead[3] = {0, 0, 0}, above[3] = {0, 1, 0};
  double p[2], q[2], z;
  assert_true(vl_camera_project(&c, ahead, p, &z) && z == 5.0);
  assert_true(vl_camera_project(&c, above, q, &z) && q[1] < p[1]);
}

static void test_colmap_images(void **state) {
  (void)state;
  mkdir(path_of("model"), 0700);
  put("model/cameras.txt",
      "1 PINHOLE 640 480 500 501 320 240\n7 SIMPLE_RADIAL 320 200 250 160 100 -0.1\n");
  put("model/images.txt", "1 1 0 0 0 0 0 0 1 a b.png\n\n2 0 0 1 0 1 2 3 7 c.png\n10 20 -1\n");
  vlCameraRecord r = read_as(path_of("model"), 0, "c.png");
  assert_int_equal(r.frames, 2);
  assert_int_equal(r.camera.width, 320);
  /* half a turn about y; the camera is at -R^T t */
  assert_float_equal(r.camera.world_from_camera[3], 1, 1e-15);
  assert_float_equal(r.camera.world_from_camera[7], -2, 1e-15);
  assert_float_equal(r.camera.world_from_camera[11], 3, 1e-15);
  assert_string_equal(read_as(path_of("model"), 0, NULL).name, "a b.png");
  vlError error;
  vlCameraFileDef def = vl_default_camera_file_def();
  def.frame = "none";
  assert_int_equal(vl_camera_read(context, path_of("model"), &def, &r, &error), VL_ERROR_SCENE);
}

static void test_kalibr_chain(void **state) {
  (void)state;
  const char *path = put("chain.yaml",
                         "cam0:\n"
                         "  camera_model: pinhole\n"
                         "  intrinsics: [500, 501, 319.5, 239.5]\n"
                         "  distortion_model: none\n"
                         "  resolution: [640, 480]\n"
                         "cam1:\n"
                         "  T_cn_cnm1:\n"
                         "  - [1.0, 0.0, 0.0, -0.11]\n"
                         "  - [0.0, 1.0, 0.0, 0.0]\n"
                         "  - [0.0, 0.0, 1.0, 0.0]\n"
                         "  - [0.0, 0.0, 0.0, 1.0]\n"
                         "  camera_model: pinhole\n"
                         "  distortion_model: equidistant\n"
                         "  distortion_coeffs: [0.01, 0.0, 0.0, 0.0]\n"
                         "  intrinsics: [500, 501, 319.5, 239.5]\n"
                         "  resolution: [640, 480]\n");
  vlCameraRecord r = read_as(path, 0, "cam1");
  assert_float_equal(r.camera.world_from_camera[3], 0.11, 1e-15);
  assert_int_equal(r.camera.projection, VL_PROJECTION_EQUIDISTANT);
}

/* A scene that is written is read back as the same camera. */
static void there_and_back_by_scene(const vlCameraRecord *record) {
  vlError error;
  if (vl_camera_write(context, path_of("s.pbrt"), NULL, record, &error) != VL_OK)
    fail_msg("%s", error.message);
  vlScene *scene;
  assert_int_equal(vl_scene_create(context, &scene), VL_OK);
  if (vl_scene_load(scene, path_of("s.pbrt"), NULL, &error) != VL_OK)
    fail_msg("%s", error.message);
  /* pbrt's parameters are single precision */
  compare(&record->camera, &vl_scene_defs(scene)->camera, 1e-3);
  vl_scene_destroy(scene);
}

static void test_pbrt(void **state) {
  (void)state;
  static const vlProjection spheres[] = {VL_PROJECTION_EQUIRECTANGULAR,
                                         VL_PROJECTION_EQUAL_AREA};
  vlCameraRecord r = some_camera();
  vlError error;
  there_and_back_by_scene(&r);
  for (int i = 0; i < 2; i++) {
    r = some_camera();
    r.camera.projection = spheres[i];
    assert_int_equal(vl_camera_write(context, path_of("s.pbrt"), NULL, &r, &error),
                     VL_ERROR_UNSUPPORTED); /* not the whole sphere */
    r.camera.fx = r.camera.fy = r.camera.cx = r.camera.cy = VL_UNSET;
    there_and_back_by_scene(&r);
    r.camera.lens_radius = 0.1;
    r.camera.focus_distance = 2;
    assert_int_equal(vl_camera_write(context, path_of("s.pbrt"), NULL, &r, &error),
                     VL_ERROR_UNSUPPORTED);
  }
}

static void test_wrong_files(void **state) {
  (void)state;
  SAYS("e.yaml", "", "empty");
  SAYS("e.json", "{\"a\": }", "not JSON");
  SAYS("e.yaml", "a: [1, 2\nb: 3\n", "not YAML");
  SAYS("e.yaml", "left:\n  focal: 3\n", "its fields are: left");
  SAYS("e.yaml", "b: *x\n", "whose anchor is not there");
  SAYS("e.yaml", "image_width: 640\nimage_height: 480\n", "\"camera_matrix\" is missing");
  SAYS("e.yaml", "image_width: 64.5\nimage_height: 480\ncamera_matrix: [1]\n", "image_width");
  SAYS("e.json", "{\"velo_camera\": 1, \"width\": 4, \"height\": 3, \"focal\": 2}",
       "unknown field \"focal\"");
  SAYS("e.json", "{\"velo_camera\": 1, \"width\": 4, \"height\": 3, \"projection\": \"panin\"}",
       "panini");
  SAYS("cameras.txt", "1 PINHOL 640 480 1 1 2 2\n", "PINHOLE");
  assert_int_equal(refused("cameras.txt", "# a\n\n1 PINHOLE 640 480 1 nan 2 2\n").line, 3);
  char deep[400] = "a: ";
  for (int i = 0; i < 100; i++)
    strcat(deep, "[");
  SAYS("e.yaml", deep, "nested");
  SAYS("e.yaml",
       "image_width: 640\nimage_height: 480\ncamera_matrix: [500, 0, 3, 0, 500, 3, 0, 0, 1]\n"
       "distortion_coefficients: [0, 0, 0, 0]\nrvec: [.nan, 0, 0]\ntvec: [0, 0, 0]\n",
       "rvec");
  vlCameraRecord record;
  vlError error;
  vlCameraFileDef def = vl_default_camera_file_def();
  def.dialect = VL_CAMERA_DIALECT_KALIBR;
  assert_int_equal(vl_camera_read(context, put("o.yaml", opencv_text), &def, &record, &error),
                   VL_ERROR_SCENE);
  assert_non_null(strstr(error.message, "opencv, not of kalibr"));
}

static void test_refusals(void **state) {
  (void)state;
  const char *skew[] = {"skew", "pose"};
  static const struct {
    vlCameraDialect dialect;
    const char *name, *bent; /* bent: what is said of a projection that is not flat */
  } all[] = {{VL_CAMERA_DIALECT_OPENCV, "x.yaml", "Panini"},
             {VL_CAMERA_DIALECT_ROS, "x.yaml", "Panini"},
             {VL_CAMERA_DIALECT_COLMAP, "cameras.txt", "Panini"},
             {VL_CAMERA_DIALECT_NERF, "x.json", "Panini"},
             {VL_CAMERA_DIALECT_KALIBR, "x.yaml", "Panini"},
             {VL_CAMERA_DIALECT_BLENDER, "x.json", "\"projection\""},
             {VL_CAMERA_DIALECT_PBRT, "x.pbrt", "\"projection\""}};
  for (size_t i = 0; i < sizeof all / sizeof *all; i++) {
    vlCameraRecord r = some_camera();
    vlError error;
    vlCameraFileDef def = vl_default_camera_file_def();
    def.dialect = all[i].dialect;
    r.camera.skew = 2.0;
    def.drop = skew + 1;
    def.drop_count = 1;
    assert_int_equal(vl_camera_write(context, path_of(all[i].name), &def, &r, &error),
                     VL_ERROR_UNSUPPORTED);
    assert_non_null(strstr(error.message, "\"skew\""));
    def.drop = skew;
    def.drop_count = 2;
    assert_int_equal(vl_camera_write(context, path_of(all[i].name), &def, &r, &error), VL_OK);
    r.camera.projection = VL_PROJECTION_PANINI;
    assert_int_equal(vl_camera_write(context, path_of(all[i].name), &def, &r, &error),
                     VL_ERROR_UNSUPPORTED);
    assert_non_null(strstr(error.message, all[i].bent));
    r = some_camera();
    r.camera.near_plane = 0.5;
    if (def.dialect == VL_CAMERA_DIALECT_BLENDER)
      continue;
    assert_int_equal(vl_camera_write(context, path_of(all[i].name), &def, &r, &error),
                     VL_ERROR_UNSUPPORTED);
    assert_non_null(strstr(error.message, "near_plane"));
  }
}

/* Names of fields that no camera has are errors, before a file is written. */
static void test_drop_names(void **state) {
  (void)state;
  static const struct {
    const char *name, *words;
  } wrong[] = {{"skw", "\"skw\"; the nearest is \"skew\""},
               {"", "\"\"; known are aperture, "},
               {"everything", "tilt, vignetting"}, /* the last of the list */
               {"Skew", "the nearest is \"skew\""},
               {NULL, "drop[1] is null"}};
  const vlCameraRecord record = some_camera();
  for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++) {
    const char *drop[] = {"pose", wrong[i].name};
    vlCameraFileDef def = vl_default_camera_file_def();
    vlError error;
    def.dialect = VL_CAMERA_DIALECT_ROS;
    def.drop = drop;
    def.drop_count = 2;
    const char *path = path_of("dropped.yaml");
    assert_int_equal(vl_camera_write(context, path, &def, &record, &error), VL_ERROR_ARGUMENT);
    if (!strstr(error.message, wrong[i].words))
      fail_msg("%s", error.message);
    assert_int_equal(access(path, F_OK), -1);
  }
}

/* Makes a locale with a decimal comma that of this program. False: there is no localedef. */
static bool choose_comma(void) {
  char command[512];
  const char *source = put("comma",
                           "comment_char %\nescape_char /\nLC_NUMERIC\n"
                           "decimal_point \",\"\nthousands_sep \".\"\ngrouping 3\n"
                           "END LC_NUMERIC\n");
  snprintf(command, sizeof command, "localedef -c -i %s %s/xx >%s/said 2>&1", source, folder,
           folder);
  return system(command) >= 0 && setenv("LOCPATH", folder, 1) == 0 &&
         setlocale(LC_NUMERIC, "xx");
}

/* Numbers have a decimal point, though the program's locale has a comma. */
static void test_decimal_comma(void **state) {
  (void)state;
  char command[32];
  if (!choose_comma())
    skip();
  const vlCameraRecord record = some_camera();
  vlCameraFileDef def = vl_default_camera_file_def();
  vlError error;
  def.dialect = VL_CAMERA_DIALECT_VELO;
  vlResult wrote = vl_camera_write(context, path_of("comma.json"), &def, &record, &error);
  const vlCameraRecord back = read_with(path_of("comma.json"), NULL);
  const char *poses = put("comma.csv", "1.5 0.5 2.5 3.5 0 0 0 1\n");
  vlTrajectory *trajectory = NULL;
  vlTrajectoryFrame frame;
  vlResult loaded = vl_trajectory_load(context, poses, NULL, &trajectory, &error);
  snprintf(command, sizeof command, "%.1f", 0.5);
  setlocale(LC_NUMERIC, "C");
  assert_string_equal(command, "0,5"); /* the locale is the program's again */
  assert_int_equal(wrote, VL_OK);
  assert_true(back.camera.fx == record.camera.fx);
  assert_int_equal(loaded, VL_OK);
  assert_int_equal(vl_trajectory_frame(trajectory, 0, &frame), VL_OK);
  assert_true(frame.time == 1.5);
  vl_trajectory_destroy(trajectory);
}

/* Lens files, sensor files, scenes and the headers of images. */
static void test_other_files_with_comma(void **state) {
  (void)state;
  if (!choose_comma())
    skip();
  vlError error;
  vlOpticsDef lens = vl_default_optics_def();
  vlOptics *optics = NULL;
  lens.aperture_diameter = 10;
  lens.focus_distance = 2;
  const char *surfaces = put("comma.dat", "50.5 4.5 1.5 20\n-50.5 0.5 1 20\n");
  vlResult loaded = vl_optics_load(context, surfaces, &lens, &optics, &error);
  vlSensorDef sensor;
  vlResult sensed =
      vl_sensor_read(context, put("comma.yaml", "pixel: 3.45 um\n"), &sensor, &error);
  vlImageDef small = vl_default_image_def(4, 4, 1);
  vlImage *image = NULL;
  assert_int_equal(vl_image_create(context, &small, &image), VL_OK);
  vlScene *scene = NULL;
  assert_int_equal(vl_scene_create(context, &scene), VL_OK);
  vlSceneDefs *defs = vl_scene_defs(scene);
  defs->camera = vl_default_camera_def(4, 4);
  defs->camera.distortion = VL_DISTORTION_RADIAL;
  defs->camera.distortion_count = 1;
  defs->camera.distortion_coefficients[0] = -0.125;
  vlCamera camera;
  assert_int_equal(vl_camera_make(&defs->camera, &camera, NULL, &error), VL_OK);
  vlHeaderDef header = vl_default_header_def();
  header.camera = &camera;
  header.defs = defs;
  vlResult described = vl_image_set_header(image, &header);
  setlocale(LC_NUMERIC, "C");
  assert_int_equal(loaded, VL_OK);
  assert_int_equal(sensed, VL_OK);
  assert_true(sensor.pixel == 3.45);
  assert_int_equal(described, VL_OK);
  vlAttribute attribute;
  assert_int_equal(vl_image_find_attribute(image, "velo.distortionCoefficients", &attribute),
                   VL_OK);
  assert_string_equal(attribute.string, "-0.125");
  vl_image_destroy(image);
  vl_optics_destroy(optics);
  vl_scene_destroy(scene);
}

static void test_memory(void **state) {
  (void)state;
  vlCameraRecord record = some_camera();
  check_memory(path_of("memory.yaml"), &record, NULL);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(test_round_trips),
      cmocka_unit_test(test_round_trips_at_the_origin),
      cmocka_unit_test(test_related_dialects),
      cmocka_unit_test(test_velo_is_exact),
      cmocka_unit_test(test_half_pixel_table),
      cmocka_unit_test(test_blender_shift),
      cmocka_unit_test(test_colmap_images),
      cmocka_unit_test(test_kalibr_chain),
      cmocka_unit_test(test_pbrt),
      cmocka_unit_test(test_wrong_files),
      cmocka_unit_test(test_refusals),
      cmocka_unit_test(test_drop_names),
      cmocka_unit_test(test_decimal_comma),
      cmocka_unit_test(test_other_files_with_comma),
      cmocka_unit_test(test_memory),
  };
  return cmocka_run_group_tests(tests, files_setup, files_teardown);
}
