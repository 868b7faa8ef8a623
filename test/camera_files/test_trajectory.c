/* test/camera_files/test_trajectory.c: files of many frames: the frames of each dialect,
 * agreement of a frame with the camera that vl_camera_read gives for it, invalid lines reported
 * with their place. */
#include <sys/stat.h>
#include <unistd.h>

#include "camera_files/files.h"
#include "velo/trajectory.h"

static vlTrajectory *load(const char *path) {
  vlTrajectory *t = NULL;
  vlError error;
  if (vl_trajectory_load(context, path, NULL, &t, &error) != VL_OK)
    fail_msg("%s:%u: %s", error.file, error.line, error.message);
  return t;
}

static vlTrajectoryFrame frame_of(const vlTrajectory *t, uint32_t i) {
  vlTrajectoryFrame frame;
  assert_int_equal(vl_trajectory_frame(t, i, &frame), VL_OK);
  return frame;
}

/* The same pose and, but for the pose, the same camera as vl_camera_read's frame. */
static void same_as_single(const vlTrajectory *t, const char *path, uint32_t i) {
  char number[16];
  snprintf(number, sizeof number, "%u", i);
  vlCameraFileDef def = vl_default_camera_file_def();
  def.frame = number;
  vlCameraRecord record;
  vlError error;
  if (vl_camera_read(context, path, &def, &record, &error) != VL_OK)
    fail_msg("%s", error.message);
  vlTrajectoryFrame frame = frame_of(t, i);
  vlCamera one, base, moved;
  assert_int_equal(vl_camera_make(&record.camera, &one, NULL, NULL), VL_OK);
  assert_int_equal(vl_camera_make(&vl_trajectory_camera(t, (uint32_t)frame.camera)->camera,
                                  &base, NULL, NULL),
                   VL_OK);
  assert_int_equal(vl_camera_move(&base, frame.world_from_camera, &moved, NULL), VL_OK);
  assert_memory_equal(&one, &moved, sizeof one);
}

static void colmap_has_images_and_cameras(void **state) {
  (void)state;
  mkdir(path_of("model"), 0777);
  put("model/cameras.txt",
      "# comment\n2 SIMPLE_RADIAL 64 48 60 32 24 0.01\n7 PINHOLE 100 80 90 91 50 40\n");
  put("model/images.txt",
      "# comment\n1 1 0 0 0 0 0 0 7 a.png\n\n2 0.5 0.5 0.5 0.5 1 2 3 2 b c.png\n1 2 3\n9 0 1 0 "
      "0 0 "
      "0 4 2 d.png\n\n");
  vlTrajectory *t = load(path_of("model"));
  assert_int_equal(vl_trajectory_frames(t), 3);
  assert_int_equal(vl_trajectory_cameras(t), 2);
  for (uint32_t i = 0; i < 3; i++)
    same_as_single(t, path_of("model"), i);
  assert_string_equal(frame_of(t, 1).name, "b c.png");
  assert_int_equal(frame_of(t, 1).line, 4);
  assert_int_equal(vl_trajectory_camera(t, (uint32_t)frame_of(t, 0).camera)->camera.width, 100);
  assert_true(isnan(frame_of(t, 0).time));
  vl_trajectory_destroy(t);
}

static const char nerf[] =
    "{\"w\": 64, \"h\": 48, \"fl_x\": 50, \"k1\": 0.01, \"frames\": [\n"
    "{\"file_path\": \"images/0.png\", \"time\": 0.25, \"transform_matrix\": "
    "[[1,0,0,1],[0,1,0,2],[0,0,1,3],[0,0,0,1]]},\n"
    "{\"file_path\": \"images/1.png\", \"transform_matrix\": "
    "[[0,0,1,1],[0,1,0,2],[-1,0,0,3],[0,0,0,1]]},\n"
    "{\"file_path\": \"images/2.png\", \"w\": 100, \"cx\": 50,\n"
    " \"transform_matrix\": [[0,0,1,1],[0,1,0,2],[-1,0,0,3],[0,0,0,1]]}]}\n";

static void nerf_has_frames(void **state) {
  (void)state;
  const char *path = put("transforms.json", nerf);
  vlTrajectory *t = load(path);
  assert_int_equal(vl_trajectory_frames(t), 3);
  assert_int_equal(vl_trajectory_cameras(t), 2);
  for (uint32_t i = 0; i < 3; i++)
    same_as_single(t, path, i);
  assert_true(frame_of(t, 0).time == 0.25 && isnan(frame_of(t, 1).time));
  assert_string_equal(frame_of(t, 2).name, "images/2.png");
  vl_trajectory_destroy(t);
}

static void kalibr_is_a_rig(void **state) {
  (void)state;
  const char *path =
      put("camchain.yaml",
          "cam0:\n  camera_model: pinhole\n  intrinsics: [60, 61, 32, 24]\n  distortion_model: "
          "none\n"
          "  resolution: [64, 48]\n"
          "cam1:\n  camera_model: pinhole\n  intrinsics: [70, 71, 40, 30]\n  distortion_model: "
          "none\n"
          "  resolution: [80, 60]\n  T_cn_cnm1:\n  - [1, 0, 0, -0.1]\n  - [0, 1, 0, 0]\n"
          "  - [0, 0, 1, 0]\n  - [0, 0, 0, 1]\n");
  vlTrajectory *t = load(path);
  assert_int_equal(vl_trajectory_frames(t), 2);
  assert_int_equal(vl_trajectory_cameras(t), 2);
  for (uint32_t i = 0; i < 2; i++)
    same_as_single(t, path, i);
  assert_string_equal(frame_of(t, 1).name, "cam1");
  assert_true(fabs(frame_of(t, 1).world_from_camera[3] - 0.1) < 1e-12);
  vl_trajectory_destroy(t);
}

static void opencv_calibrations_have_views(void **state) {
  (void)state;
  vlTrajectory *t =
      load(put("calibration.yml",
               "%YAML:1.0\n"
               "---\n"
               "image_width: 64\n"
               "image_height: 48\n"
               "camera_matrix: !!opencv-matrix\n"
               "  rows: 3\n"
               "  cols: 3\n"
               "  dt: d\n"
               "  data: [60, 0, 31.5, 0, 60, 23.5, 0, 0, 1]\n"
               "distortion_coefficients: [0.1, 0, 0, 0]\n"
               "extrinsic_parameters: !!opencv-matrix\n"
               "  rows: 2\n"
               "  cols: 6\n"
               "  dt: d\n"
               "  data: [0, 0, 0, 1, 2, 3, 0, 1.5707963267948966, 0, 0, 0, 4]\n"));
  assert_int_equal(vl_trajectory_frames(t), 2);
  assert_int_equal(vl_trajectory_cameras(t), 1);
  vlTrajectoryFrame a = frame_of(t, 0), b = frame_of(t, 1);
  assert_true(a.world_from_camera[3] == -1 && a.world_from_camera[7] == -2 &&
              a.world_from_camera[11] == -3);
  /* turned by 90 degrees about y: the world's z is the camera's x */
  assert_true(fabs(b.world_from_camera[2] + 1) < 1e-12 &&
              fabs(b.world_from_camera[3] - 4) < 1e-12);
  vl_trajectory_destroy(t);
}

static void lists_of_poses(void **state) {
  (void)state;
  /* a quarter turn about y: the camera's z points along the world's x */
  const double q = sqrt(0.5);
  char text[2000];
  double first[16];
  for (int i = 0; i < 9; i++) {
    const char *name = "p.csv";
    switch (i) {
      case 0:
        snprintf(
            text, sizeof text,
            "name, time, tx, ty, tz, qx, qy, qz, qw\n\"a,b.png\",2.5,1,2,3,0,%.17g,0,%.17g\n",
            q, q);
        break;
      case 1:
        snprintf(text, sizeof text,
                 "# hello\r\n\r\nqw;qx;qy;qz;X;Y;Z\r\n%.17g;0;%.17g;0;1;2;3\r\n", q, q);
        break;
      case 2:
        snprintf(text, sizeof text, "2.5 1 2 3 0 %.17g 0 %.17g\n", q, q);
        name = "tum.txt";
        break;
      case 3:
        snprintf(text, sizeof text, "0 0 1 1 0 1 0 2 -1 0 0 3\n");
        name = "kitti.txt";
        break;
      case 4:
        snprintf(
            text, sizeof text,
            "# axes: opengl\nm00 m01 m02 m03 m10 m11 m12 m13 m20 m21 m22 m23\n0 0 -1 1 0 -1 0 "
            "2 -1 0 0 3\n");
        break;
      case 5: /* camera from world: transposed, and the place seen from the camera */
        snprintf(
            text, sizeof text,
            "# pose: "
            "camera_from_world\nm00,m01,m02,m03,m10,m11,m12,m13,m20,m21,m22,m23\n0,0,-1,3,0,1,"
            "0,-2,1,0,0,"
            "-1");
        break;
      case 6: /* EuRoC: nanoseconds; the velocity is ignored */
        snprintf(
            text, sizeof text,
            "#timestamp [ns], p_RS_R_x [m], p_RS_R_y [m], p_RS_R_z [m], q_RS_w [], q_RS_x [], "
            "q_RS_y [], q_RS_z "
            "[], v_RS_R_x [m s^-1], v_RS_R_y [m s^-1], v_RS_R_z [m "
            "s^-1]\n2500000000,1,2,3,%.17g,0,%.17g,0,7,8,9\n",
            q, q);
        break;
      case 7: /* Stray Scanner: the intrinsics are ignored, with a warning */
        snprintf(text, sizeof text,
                 "tx,ty,tz,qx,qy,qz,qw,fx,fy,cx,cy\n1,2,3,0,%.17g,0,%.17g,900,900,300,200\n", q,
                 q);
        break;
      default:
        snprintf(text, sizeof text,
                 "eye_x,eye_y,eye_z,lookat_x,lookat_y,lookat_z,up_x,up_y,up_z\n1,2,3, 11,2,3, "
                 "0,-1,0\n");
    }
    vlTrajectory *t = load(put(name, text));
    assert_int_equal(vl_trajectory_frames(t), 1);
    assert_int_equal(vl_trajectory_cameras(t), 0);
    vlTrajectoryFrame frame = frame_of(t, 0);
    assert_int_equal(frame.camera, VL_NO_CAMERA);
    const double expected[16] = {0, 0, 1, 1, 0, 1, 0, 2, -1, 0, 0, 3, 0, 0, 0, 1};
    for (int k = 0; k < 16; k++)
      if (!(fabs(frame.world_from_camera[k] - expected[k]) < 1e-12))
        fail_msg("case %d, element %d", i, k);
    if (i == 0)
      memcpy(first, frame.world_from_camera, sizeof first);
    if (i == 0)
      assert_string_equal(frame.name, "a,b.png");
    assert_true(i == 0 || i == 2 || i == 6 ? frame.time == 2.5 : isnan(frame.time));
    vl_trajectory_destroy(t);
  }
}

static void keep_message(void *user, vlLogLevel level, const vlError *place,
                         const char *message) {
  (void)level;
  (void)place;
  char *all = user;
  const size_t length = strlen(all);
  snprintf(all + length, 2000 - length, "%s\n", message);
}

/* What a table has beyond poses is ignored, each column by its name. */
static void ignored_columns_are_told(void **state) {
  (void)state;
  static char said[2000];
  vlContextDef def = vl_default_context_def();
  def.threads = 1;
  def.log = keep_message;
  def.log_user = said;
  vlContext *telling = NULL;
  assert_int_equal(vl_context_create(&def, &telling), VL_OK);
  vlTrajectory *t = NULL;
  const char *path =
      put("lens.csv", "tx,ty,tz,cx,qx,qy,qz,qw,fx,fy,cy\n0,0,0,300,0,0,0,1,900,900,200\n");
  assert_int_equal(vl_trajectory_load(telling, path, NULL, &t, NULL), VL_OK);
  vl_trajectory_destroy(t);
  vl_context_destroy(telling);
  const char *at = said;
  static const char *const columns[] = {"cx", "fx", "fy", "cy"};
  for (size_t i = 0; i < sizeof columns / sizeof *columns; i++) {
    char line[80];
    snprintf(line, sizeof line, "the column \"%s\" is ignored", columns[i]);
    at = strstr(at, line);
    if (!at)
      fail_msg("%s: not in its place in: %s", line, said);
  }
}

static void a_camera_file_is_one_frame(void **state) {
  (void)state;
  vlTrajectory *t =
      load(put("one.json",
               "{\"velo_camera\": 1, \"width\": 8, \"height\": 8, \"eye\": [1, 2, 3], "
               "\"lookat\": [1, 2, 9]}"));
  assert_int_equal(vl_trajectory_frames(t), 1);
  assert_int_equal(vl_trajectory_cameras(t), 1);
  assert_true(frame_of(t, 0).world_from_camera[11] == 3);
  vl_trajectory_destroy(t);
}

static void wrong_lines_are_told(void **state) {
  (void)state;
  static const struct {
    const char *name, *text;
    uint32_t line;
    const char *part;
  } cases[] = {
      {"a.csv", "tx,ty,tz,qx,qy,qz,qw\n0,0,0,0,0,0,1\n0,nan,0,0,0,0,1\n", 3,
       "frame 1: \"ty\" is \"nan\""},
      {"a.csv", "tx,ty,tz,qx,qy,qz,qw\n0,0,0,0,0,0,0.5\n", 2, "length is 0.5"},
      {"a.csv", "tx,ty,tz,qx,qy,qz,qw\n0,0,0,0,0,0\n", 2, "6 fields; the header has 7"},
      {"a.csv", "\n\ntx,ty,tz,qx,qy,qz,ww\n0,0,0,0,0,0,1\n", 3,
       "unknown column \"ww\"; did you mean \"qw\"?"},
      {"a.csv", "tx,ty,tz,qx,qy,qz\n", 1, "the column \"qw\" is missing"},
      {"a.csv", "tx,tx\n", 1, "stands twice"},
      {"a.csv", "name,time\na,1\n", 1, "say no pose"},
      {"a.csv", "tx,ty,tz,qx,qy,qz,qw,roll\n0,0,0,0,0,0,1,9\n", 1,
       "go with eye and lookat only"},
      {"a.csv", "# axes: blender\n", 1, "axes are opencv or opengl"},
      {"a.csv", "1 2 3 4\n", 1, "lists of TUM have 8"},
      {"a.csv", "", 0, "holds no pose"},
      {"a.csv", "eye_x,eye_y,eye_z,lookat_x,lookat_y,lookat_z\n0,0,0,0,0,1\n1,2,3,1,2,3\n", 3,
       "the same point"},
      {"kitti.txt", "1 0 0 0 0 1 0 0 0 0 1 0\n1 0 0 0 0 2 0 0 0 0 1 0\n", 2,
       "frame 1: the pose is no rotation"},
      {"kitti.txt", "1 0 0 0 0 1 0 0 0 0 -1 0\n", 1, "it mirrors"},
      {"t.json",
       "{\"w\": 8, \"h\": 8, \"fl_x\": 5, \"frames\": [\n{\"transform_matrix\": "
       "[[1,0,0,0],[0,1,0,0],[0,0,1,0]]},\n"
       "{\"file_path\": \"b.png\",\n\"transform_matrix\": [[1,0,0,0],[0,1,0,0],[0,0,3,0]]}]}",
       4, "frame 1 (b.png): the pose is no rotation"},
      {"t.json",
       "{\"w\": 8, \"h\": 8, \"fl_x\": 5, \"frames\": [\n{\"transform_matrix\": "
       "[[1,0,0,NaN]]}]}",
       2, ""},
      {"t.json",
       "{\"w\": 8, \"h\": 8, \"fl_x\": 5, \"frames\": [\n{\"transform_matrix\": [[1,0]]}]}", 2,
       "frame 0"},
      {"t.json", "{\"w\": 8, \"h\": 8, \"fl_x\": 5, \"frames\": [3]}", 0, "frame 0"},
  };
  for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
    vlTrajectory *t = NULL;
    vlError error;
    const char *path = put(cases[i].name, cases[i].text);
    assert_int_equal(vl_trajectory_load(context, path, NULL, &t, &error), VL_ERROR_SCENE);
    assert_null(t);
    if (!strstr(error.message, cases[i].part) || error.line != cases[i].line ||
        strchr(error.message, '\n') || !strstr(error.file, cases[i].name))
      fail_msg("case %zu: %s:%u: %s", i, error.file, error.line, error.message);
  }
  put("model/images.txt", "1 1 0 0 0 0 0 0 7 a.png\n\n2 1 0 0 0 0 0 0 3 b.png\n\n");
  vlTrajectory *t;
  vlError error;
  assert_int_equal(vl_trajectory_load(context, path_of("model"), NULL, &t, &error),
                   VL_ERROR_SCENE);
  assert_non_null(strstr(error.message, "frame 1 (b.png): there is no camera 3"));
  assert_int_equal(error.line, 3);
  put("model/images.txt", "1 1 0 0 0 0 nan 0 7 a.png\n\n");
  assert_int_equal(vl_trajectory_load(context, path_of("model"), NULL, &t, &error),
                   VL_ERROR_SCENE);
  assert_int_equal(error.line, 1);
  assert_int_equal(vl_trajectory_load(context, path_of("no.csv"), NULL, &t, &error),
                   VL_ERROR_MISSING);
}

/* Hundreds of thousands of lines and images in no more than the time that reading takes. */
static void many_frames(void **state) {
  (void)state;
  enum { N = 50000 };
  const char *path = path_of("many.csv");
  FILE *file = fopen(path, "w");
  assert_non_null(file);
  fprintf(file, "name,tx,ty,tz,qx,qy,qz,qw\n");
  for (int i = 0; i < N; i++)
    fprintf(file, "%05d,%d,0,0,0,0,0,1\n", i, i);
  fclose(file);
  vlTrajectory *t = load(path);
  assert_int_equal(vl_trajectory_frames(t), N);
  assert_string_equal(frame_of(t, N - 1).name, "49999");
  assert_true(frame_of(t, 777).world_from_camera[3] == 777);
  vl_trajectory_destroy(t);
}

static vlResult load_once(vlContext *poor, void *user) {
  vlTrajectory *t = NULL;
  vlResult result = vl_trajectory_load(poor, user, NULL, &t, NULL);
  vl_trajectory_destroy(t);
  return result;
}

static void memory_runs_out(void **state) {
  (void)state;
  mkdir(path_of("model"), 0777);
  put("model/cameras.txt",
      "2 SIMPLE_RADIAL 64 48 60 32 24 0.01\n7 PINHOLE 100 80 90 91 50 40\n");
  put("model/images.txt", "1 1 0 0 0 0 0 0 7 a.png\n\n2 0.5 0.5 0.5 0.5 1 2 3 2 b.png\n\n");
  put("transforms.json", nerf);
  put("a.csv", "name,tx,ty,tz,qx,qy,qz,qw\na,0,0,0,0,0,0,1\n");
  const char *const files[] = {"model", "transforms.json", "a.csv"};
  for (int i = 0; i < 3; i++)
    fail_everywhere(load_once, (void *)path_of(files[i]), 3);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(colmap_has_images_and_cameras),
      cmocka_unit_test(nerf_has_frames),
      cmocka_unit_test(kalibr_is_a_rig),
      cmocka_unit_test(opencv_calibrations_have_views),
      cmocka_unit_test(lists_of_poses),
      cmocka_unit_test(ignored_columns_are_told),
      cmocka_unit_test(a_camera_file_is_one_frame),
      cmocka_unit_test(wrong_lines_are_told),
      cmocka_unit_test(many_frames),
      cmocka_unit_test(memory_runs_out),
  };
  return cmocka_run_group_tests(tests, files_setup, files_teardown);
}
