/* test/camera_files/test_refused.c: one place of a good camera file is changed (the files are
 * those of test/fuzz/corpus/camera_file): the error says what is wrong there, with line and
 * column where the format has them. Cameras that a file does not hold, files that are cut off,
 * memory that runs out. */
#include "camera_files/files.h"
#include "velo/projection.h"

#include <dirent.h>

#define CORPUS VELO_SOURCE_DIR "/test/fuzz/corpus/camera_file"

/* The bytes of a file of the corpus; the caller frees them. */
static char *sample(const char *name, size_t *size) {
  char path[512];
  snprintf(path, sizeof path, "%s/%s", CORPUS, name);
  FILE *file = fopen(path, "rb");
  if (!file)
    fail_msg("%s is missing", path);
  char *text = calloc(1, 1 << 16);
  assert_non_null(text);
  *size = fread(text, 1, (1 << 16) - 1, file);
  fclose(file);
  return text;
}

/* With `from` replaced by `to`, where it first stands; without `from`, `to` is the whole text;
 * without both, the file is unchanged. Where the file gives no size: 64 x 48. */
static vlResult read_changed(const char *name, const char *from, const char *to,
                             const char *frame, vlCameraRecord *record, vlError *error) {
  size_t size;
  char *text = sample(name, &size);
  if (from) {
    char *at = strstr(text, from);
    if (!at)
      fail_msg("%s does not hold \"%s\"", name, from);
    size_t old = strlen(from), fresh = strlen(to);
    assert_true(size + fresh < 1 << 16);
    memmove(at + fresh, at + old, size - (size_t)(at - text) - old + 1);
    memcpy(at, to, fresh);
    size += fresh - old;
  } else if (to) {
    size = strlen(to);
    memcpy(text, to, size);
  }
  vlCameraFileDef def = vl_default_camera_file_def();
  def.width = 64;
  def.height = 48;
  def.frame = frame;
  vlResult result = vl_camera_read(context, put_bytes(name, text, size), &def, record, error);
  free(text);
  return result;
}

typedef struct Row {
  const char *name, *from, *to;
  uint32_t line, column;
  const char *words;
} Row;

static const Row rows[] = {
    {"basalt.json", "\"pinhole\"", "\"pinehole\"", 25, 24,
     "unknown camera_type \"pinehole\"; there are pinhole,"},
    {"basalt.json", "\"qw\": 1", "\"qw\": 0", 11, 15, "the quaternion of T_imu_cam is zero"},
    {"basalt.json", "        640,", "        640.5,", 46, 7,
     "\"resolution\" must be two whole numbers of pixels"},
    {"blender.json", "PERSP", "PANO", 3, 11, "unknown type \"PANO\"; there are PERSP, ORTHO"},
    {"blender.json", "AUTO", "BOTH", 5, 17,
     "unknown sensor_fit \"BOTH\"; there are AUTO, HORIZONTAL,"},
    {"blender.json", "\"lens\": 28", "\"lens\": -28", 1, 1,
     "lens, sensor, scale and pixel aspect must be above zero"},
    {"bop.json", "[500, 0", "[500, 0.1", 1, 17, "\"cam_K\" must be [fx 0 cx; 0 fy cy; 0 0 1]"},
    {"bop.json", "245.5, 0, 0, 1]", "245.5, 0, 0, 2]", 1, 17,
     "\"cam_K\" must be [fx 0 cx; 0 fy cy; 0 0 1]"},
    {"bundler.out", "3 1\n", "0 1\n", 2, 1, "the file has no camera"},
    {"bundler.out", "1.0 -2.0 -3.0", "1.0 -2.0", 12, 1, "2 numbers; it must be 3"},
    {"collada.dae", "<translate>0 0 5</translate>", "<skew>1 2 3 4 5 6 7</skew>", 20, 9,
     "<skew> is not read"},
    {"collada.dae", ">0 0 5<", ">0 0<", 20, 9, "<translate> must hold 3 finite numbers"},
    {"collada.dae", "65.2", "265.2", 8, 11, "<xfov> gives no image"},
    {"collada.dae", "<perspective>", "<perspective><!--", 7, 22, "not XML: unclosed token"},
    {"collada.dae", "#lens", "#lense", 22, 9, "the node names a camera that does not exist"},
    {"euroc.yaml", "radial-tangential", "radial", 15, 19,
     "unknown distortion_model \"radial\" of 4 coefficients; there"},
    {"euroc.yaml", "sensor_type: camera", "sensor_type: imu", 3, 14,
     "the sensor is \"imu\", no camera"},
    {"euroc.yaml", "pinhole", "omni", 13, 15,
     "unknown camera_model \"omni\"; there is pinhole"},
    {"meshroom.json", "\"36\"", "\"-36\"", 35, 28, "the sensor's sides must be above zero"},
    {"meshroom.json", "\"pinhole\"", "\"equirectangular\"", 37, 21,
     "type \"equirectangu…\" is no model of velo"},
    {"meshroom.json", "radialk3", "radialk4", 44, 31,
     "unknown distortionType \"radialk4\"; there are none,"},
    {"meshroom.json",
     "            \"width\": \"640\",\n            \"height\": \"480\",\n            \"serial",
     "            \"width\": \"640.5\",\n            \"height\": \"480\",\n            "
     "\"serial",
     31, 22, "the image is 640.5 x 480; it must be whole pixels"},
    {"meshroom.json", "\"77\",\n            \"path\": \"/data/b",
     "\"78\",\n            \"path\": \"/data/b", 22, 28,
     "the view's \"intrinsicId\" is not among the intrinsics"},
    {"metashape.xml", "<k4>-0.003</k4>", "<p3>0.1</p3>", 19, 9,
     "p3 and p4 are no terms of velo's distortion"},
    {"metashape.xml", "\"640\" height=\"480\"/>\n          <f>510",
     "\"640.5\" height=\"480\"/>\n          <f>510", 20, 11,
     "\"width\" must be a whole number of pixels"},
    {"metashape.xml", "\"frame\" class=\"adjusted\"", "\"rolling\" class=\"adjusted\"", 12, 7,
     "type \"rolling\" is no model of velo; there are frame,"},
    {"mitsuba.xml", "<integer name=\"width\" value=\"64\"/>", "<integer name=\"width\"/>", 11,
     7, "\"value\" of <integer> must hold 1 finite number"},
    {"mitsuba.xml", "<matrix value", "<rotate angle=\"30\"/><matrix value", 5, 7,
     "<rotate> has no axis"},
    {"mitsuba.xml", "<film type", "<string name=\"focal_length\" value=\"50mm\"/><film type", 3,
     3, "fov and focal_length are given; there is room for one"},
    {"mitsuba.xml", "value=\"x\"", "value=\"z\"", 3, 3,
     "unknown fov_axis \"z\"; there are x, y, diagonal, smaller,"},
    {"scene.xml", "<float name=\"aperture_radius\" value=\"0.1\"/>", "", 3, 1,
     "a thinlens needs its aperture_radius"},
    {"nerf.json", "PINHOLE", "ORTHOPHOTO", 2, 19,
     "unknown camera_model \"ORTHOPHOTO\"; there are PINHOLE,"},
    {"nerf.json", "\"camera_model\"", "\"distortion_params\": [0, 0.1], \"camera_model\"", 2,
     24, "\"distortion_params\" is taken with the camera_model FISHEYE624 only"},
    {"nerf.json", "PINHOLE\"", "FISHEYE624\", \"distortion_params\": [0, 0.1]", 2, 54,
     "\"distortion_params\" holds 2 numbers; it must hold 12"},
    {"nerf.json", "PINHOLE\"", "FISHEYE624\", \"k3\": 0.1", 2, 39,
     "FISHEYE624 has \"distortion_params\" and no \"k3\""},
    {"nerf.json", "\"camera_model\"", "\"ftheta_p1\": 0.01, \"camera_model\"", 2, 16,
     "\"ftheta_p1\": the f-theta projection is not taken"},
    {"nerf.json", "\"camera_model\"", "\"latlong\": true, \"camera_model\"", 2, 14,
     "\"latlong\" is not taken; there are"},
    {"nerf.json", "\"transform_matrix\"",
     "\"transform_matrix_start\": [0], \"transform_matrix\"", 11, 32,
     "\"transform_matrix_start\": the pose of a rolling shutter"},
    {"nerf.json", "\"camera_model\"", "\"crop_x\": 4, \"camera_model\"", 2, 13,
     "\"crop_x\" is not understood, and by its name it changes the image"},
    {"nerf.json", "\"transform_matrix\"", "\"K5\": [0, 0.1], \"transform_matrix\"", 11, 12,
     "\"K5\" is not understood, and by its name"},
    {"nerf.json", "\"fl_x\": 50,\n  \"fl_y\": 50,", "", 1, 1,
     "the field \"fl_x\" is missing, and \"camera_angle_x\" too"},
    {"nerfstudio.json", "\"perspective\"", "\"omnidirectional\"", 3, 17,
     "camera_type \"omnidirectio…\" is none of velo; there are"},
    {"nerfstudio.json", "\"fov\": 50", "\"fov\": 180", 28, 11,
     "\"fov\" is 180; it must be between 0 and 180 degrees"},
    {"okvis.yaml", "radialtangential", "radialtangential8", 7, 26,
     "unknown distortion_type \"radialtangen…\" of 4 coefficients;"},
    {"open3d.json", "[500.0, 0, 0, 0, 510.0", "[500.0, 0, 7, 0, 510.0", 1, 232,
     "\"intrinsic_matrix\" must be fx 0 0, skew fy 0, cx cy 1: it"},
    {"open3d.json", "[1.0, 0, 0, 0.0, 0, 1.0", "[0.0, 0, 0, 0.0, 0, 1.0", 1, 113,
     "\"extrinsic\" is singular"},
    {"open3d.json", "PinholeCameraTrajectory", "ViewTrajectory", 1, 16,
     "a ViewTrajectory depends on the viewer's window and model;"},
    {"opencv.yaml", "[50, 0, 31.5", "[50, 3, 31.5", 5, 16,
     "\"camera_matrix\" has a skew of 3, which OpenCV's projection"},
    {"opencv.yaml", "0, 0, 1]", "0, 0, 2]", 5, 16,
     "\"camera_matrix\" must be [fx 0 cx; 0 fy cy; 0 0 1]"},
    {"ros.yaml", "plumb_bob", "plum_bob", 8, 19,
     "unknown distortion_model \"plum_bob\"; the nearest is"},
    {"ros.yaml", "plumb_bob", "[1]", 8, 19, "\"distortion_model\" must be a word"},
    {"ros.yaml", "plumb_bob", "equidistant", 10, 3,
     "\"distortion_coefficients\" holds 5 numbers; a fisheye has 4"},
    {"ros.yaml", "plumb_bob\ndistortion_coefficients: \n  rows: 1\n  cols: 5\n  data: [0",
     "none\ndistortion_coefficients: \n  rows: 1\n  cols: 5\n  data: [1", 10, 3,
     "distortion_model is \"none\", but \"distortion_coefficients\""},
    {"ros.yaml", "camera_name: \"c\"", "binning_x: 2", 3, 12,
     "binning of 2 x 0 pixels is not taken; give the full image's"},
    {"ros.yaml", "camera_name: \"c\"",
     "roi: {x_offset: 8, y_offset: 4, height: 20, width: 30, do_rectify: false}", 3, 6,
     "a region of interest, 30 x 20 pixels at 8,4, is not taken"},
    {"ros.yaml", "camera_name: \"c\"", "image_flip: {vertical: true}", 3, 13,
     "\"image_flip\" is not understood, and by its name"},
    {"opencv.yaml", "camera_matrix:", "binning_x: 2\ncamera_matrix:", 5, 12,
     "binning of 2 x 0 pixels is not taken"},
    {"ros.ini", "640\n", "640.5\n", 9, 1, "[image] needs width and height in whole pixels"},
    {"ros.ini", "0.0 0.0 1.0\n", "0.0 0.0\n", 14, 1,
     "\"camera matrix\" holds 8 numbers; it must hold 9"},
    {"openmvg.json", "pinhole_brown_t2", "pinhole_brown_t3", 69, 3,
     "\"pinhole_brow…\" is no model of velo; there are pinhole,"},
    {"openmvg.json", "\"polymorphic_id\": 1,", "\"polymorphic_id\": 2,", 69, 3,
     "an intrinsic without \"polymorphic_name\""},
    {"openmvg.json", "\"id_intrinsic\": 1,\n      \"id_pose\": 5",
     "\"id_intrinsic\": 2,\n      \"id_pose\": 5", 35, 23, "the view's intrinsic is missing"},
    {"opensfm.json", "\"brown\"", "\"browne\"", 5, 28,
     "projection_type \"browne\" is no model of velo; there are"},
    {"opensfm.json", "\"camera\": \"v2", "\"camera\": \"v3", 31, 19,
     "the shot's camera \"v3 cam 640 480\" is not there"},
    {"realitycapture.xmp", "brown3t2", "division", 3, 5,
     "xcr:DistortionModel \"division\" is no model of velo; there"},
    {"realitycapture.xmp", "AspectRatio=\"1\"", "AspectRatio=\"2\"", 3, 5,
     "xcr:AspectRatio must be 1 and xcr:Skew 0"},
    {"realitycapture.csv", "heading", "head", 2, 1, "the column \"heading\" is missing"},
    {"realitycapture.csv", "90,90,0,28.125,0,0,0,0,0,0,0,0", "90,90,0", 3, 23,
     "realitycapture: \"f\" is \"\"; it must be a finite number"},
    {"svo_atan.yaml", "ATAN", "TAN", 1, 12,
     "unknown cam_model \"TAN\"; there are Pinhole, ATAN"},
    {"svo.yaml", "equidistant", "radial", 16, 13,
     "unknown distortion \"radial\" of 4 coefficients; there are"},
    {"svo.yaml", "pinhole", "pinehole", 10, 11,
     "unknown type \"pinehole\"; there are pinhole, omni"},
    {"visualsfm.nvm", "\n2\n", "\n-5\n", 3, 1, "the file has no camera"},
    {"visualsfm.nvm", "\n2\n", "\n-5 x\n", 3, 4, "no finite number: \"x\""},
    {"threejs.json", "\"zoom\": 0.5", "\"zoom\": 0", 10, 10,
     "these sides, fov or zoom give no image"},
    {"usd.usda", "[\"xformOp:transform\"]", "[\"transform\"]", 9, 11,
     "\"transform\" in xformOpOrder is no xformOp"},
    {"usd.usda", "[\"xformOp:transform\"]", "[\"xformOp:skew\"]", 9, 11,
     "unknown xformOp \"xformOp:skew\""},
    {"usd.usda", "(64, 48)", "(64, 0)", 9, 11,
     "a resolution of 0; an image's side is 1 to 16777216 whole"},
    {"usd.usda", "uniform token[] xform", "= 3", 18, 5,
     "not USD: something stands where a property or a prim should"},
    {"rig.usda", "variantSet \"v\"", "variantSet v", 8, 14,
     "not USD: a variant set has no name"},
    {"rig.usda", "= { \"a\"", "{ \"a\"", 8, 18, "not USD: a variant set is empty"},
    {"rig.usda", "(1, 0, 0, 0)\n  uniform token[] xformOpOrder = [",
     "(0, 0, 0, 0)\n  float3 xformOp:scale = (1, 0, 1)\n  uniform token[] xformOpOrder = "
     "[\"!invert!xformOp:scale\", ",
     10, 13, "\"xformOp:scal…\" cannot be inverted"},
    {"rig.usda", "(1, 0, 0, 0)", "(0, 0, 0, 0)", 9, 13, "\"xformOp:orie…\" is no rotation"},
    {"rig.usda", "\"!invert!xformOp:orient\"", "\"!invert!xformOp:skew\"", 9, 13,
     "unknown xformOp \"xformOp:skew\""},
    {"kitti.txt", NULL, "P0: 700 0 600 0 0.5 700 180 0 0 0 1 0\n", 1, 1,
     "P0 must be fx 0 cx tx, 0 fy cy ty, 0 0 1 tz"},
    {"kitti.txt", "S_00: 640 480", "S_00: 640 480.5", 3, 1,
     "S_00 must be two whole numbers of pixels"},
    {"kitti.txt", "K_00: 500.0 0.0 315.25 0.0", "K_00: 500.0 0.0 315.25 0.1", 4, 1,
     "K_00 must be fx 0 cx, 0 fy cy, 0 0 1"},
    {"middlebury.txt", "245.5; 0 0 1]", "245.5; 0 0 2]", 1, 1,
     "cam0 must be [fx 0 cx; 0 fy cy; 0 0 1]"},
    {"mvsnet.txt", "0 510.0 245.5", "1 510.0 245.5", 10, 1,
     "\"intrinsic\" must be fx skew cx, 0 fy cy, 0 0 1"},
    {"mvsnet.txt", "0.48 0.64 0.6 3.0", "0.36 0.48 -0.8 3.0", 5, 1,
     "\"extrinsic\" is singular"},
};

/* Changes that give another camera. */
static const struct {
  const char *name, *from, *to;
  vlProjection projection;
} others[] = {
    {"collada.dae", "<translate>0 0 5</translate>", "<scale>1 1 1</scale>",
     VL_PROJECTION_PERSPECTIVE},
    {"euroc.yaml", "radial-tangential", "equidistant", VL_PROJECTION_EQUIDISTANT},
    {"metashape.xml", "\"frame\" class=\"adjusted\"",
     "\"equisolid_fisheye\" class=\"adjusted\"", VL_PROJECTION_EQUISOLID},
    {"metashape.xml", "\"frame\" class=\"adjusted\"", "\"spherical\" class=\"adjusted\"",
     VL_PROJECTION_EQUIRECTANGULAR},
    {"mitsuba.xml", "<matrix value",
     "<scale x=\"1\" y=\"1\"/><rotate x=\"1\" angle=\"30\"/><matrix value",
     VL_PROJECTION_PERSPECTIVE},
    {"nerfstudio.json", "\"perspective\"", "\"fisheye\"", VL_PROJECTION_EQUIDISTANT},
    {"nerfstudio.json", "\"perspective\"", "\"equirectangular\"",
     VL_PROJECTION_EQUIRECTANGULAR},
    {"opensfm.json", "\"brown\"", "\"spherical\"", VL_PROJECTION_EQUIRECTANGULAR},
    {"openmvg.json", "\"key\": 5", "\"key\": 6",
     VL_PROJECTION_PERSPECTIVE}, /* before the reconstruction */
    {"rig.usda", "\"!invert!xformOp:orient\"",
     "\"!resetXformStack!\", \"!invert!xformOp:orient\"", VL_PROJECTION_PERSPECTIVE},
    {"threejs.json", "\"PerspectiveCamera\"",
     "\"OrthographicCamera\",\n\"left\": -2, \"right\": 2, \"top\": 1.5, \"bottom\": -1.5",
     VL_PROJECTION_ORTHOGRAPHIC},
    {"realitycapture.xmp", "0.01 0.0 0.001", "0.01 -0.003 0.001", VL_PROJECTION_PERSPECTIVE},
};

static void test_other_cameras(void **state) {
  (void)state;
  for (size_t i = 0; i < sizeof others / sizeof *others; i++) {
    vlCameraRecord before, after;
    vlError error;
    if (read_changed(others[i].name, NULL, NULL, NULL, &before, &error) != VL_OK ||
        read_changed(others[i].name, others[i].from, others[i].to, NULL, &after, &error) !=
            VL_OK)
      fail_msg("%s with %s: %s", others[i].name, others[i].to, error.message);
    if (after.camera.projection != others[i].projection)
      fail_msg("%s with %s: projection %d", others[i].name, others[i].to,
               (int)after.camera.projection);
    if (memcmp(&before.camera, &after.camera, sizeof before.camera) == 0)
      fail_msg("%s with %s: the same camera", others[i].name, others[i].to);
  }
}

static void test_changed_places(void **state) {
  (void)state;
  int wrong = 0;
  for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
    const Row *row = &rows[i];
    vlCameraRecord record;
    vlError error = {0};
    vlResult result = read_changed(row->name, row->from, row->to, NULL, &record, &error);
    if (result == VL_ERROR_SCENE && error.line == row->line && error.column == row->column &&
        strstr(error.message, row->words) && !strchr(error.message, '\n'))
      continue;
    print_error("%s: \"%s\" for \"%s\": result %d at %u:%u: %s\n", row->name, row->to,
                row->from, (int)result, error.line, error.column, error.message);
    wrong++;
  }
  assert_int_equal(wrong, 0);
}

/* Fields that a dialect does not know and that do not speak of the image are counted, with the
 * line of the first. */
static void test_unread(void **state) {
  (void)state;
  vlCameraRecord record;
  vlError error;
  assert_int_equal(read_changed("nerf.json", NULL, NULL, NULL, &record, &error), VL_OK);
  assert_int_equal(record.unread, 0);
  assert_int_equal(read_changed("ros.yaml", NULL, NULL, NULL, &record, &error), VL_OK);
  assert_int_equal(record.unread, 0);
  assert_int_equal(read_changed("nerf.json", "\"cy\": 20,",
                                "\"cy\": 20,\n\"offset\": [1, 2, 3], \"crop\": false, "
                                "\"gain\": 2, \"k6\": [0, [0]],",
                                NULL, &record, &error),
                   VL_OK);
  assert_int_equal(record.unread, 4);
  assert_int_equal(record.unread_line, 9);
  assert_string_equal(record.unread_names, "\"offset\", \"crop\", \"gain\"");
  assert_int_equal(
      read_changed("ros.yaml", "camera_name", "gain: 2\ncamera_name", NULL, &record, &error),
      VL_OK);
  assert_int_equal(record.unread, 1);
  assert_int_equal(record.unread_line, 3);
  assert_string_equal(record.unread_names, "\"gain\"");
}

/* Calls a function with each file of the corpus. */
static void each_sample(void (*use)(const char *name)) {
  DIR *files = opendir(CORPUS);
  assert_non_null(files);
  for (struct dirent *entry; (entry = readdir(files));)
    if (entry->d_name[0] != '.')
      use(entry->d_name);
  closedir(files);
}

/* No file has a camera of this name, and the message says so; each has a first one. */
static void refuse_frame(const char *name) {
  vlCameraRecord record;
  vlError error;
  if (read_changed(name, NULL, NULL, NULL, &record, &error) != VL_OK)
    return;
  if (read_changed(name, NULL, NULL, "0", &record, &error) != VL_OK)
    fail_msg("%s: %s", name, error.message);
  vlResult result = read_changed(name, NULL, NULL, "no such camera", &record, &error);
  if (result != VL_ERROR_SCENE || !strstr(error.message, "\"no such camera\""))
    fail_msg("%s: %d: %s", name, (int)result, error.message);
}

static void test_no_such_camera(void **state) {
  (void)state;
  each_sample(refuse_frame);
}

/* The first bytes of a file are a camera, or none with one line that says why; never more
 * memory than the file. */
static void cut(const char *name) {
  size_t size;
  char *text = sample(name, &size);
  vlCameraFileDef def = vl_default_camera_file_def();
  def.width = 64;
  def.height = 48;
  for (size_t n = 0; n < size; n += 1 + size / 40) {
    vlCameraRecord record;
    vlError error;
    vlResult result = vl_camera_read(context, put_bytes(name, text, n), &def, &record, &error);
    assert_true(result == VL_OK || result == VL_ERROR_SCENE || result == VL_ERROR_MISSING);
    if (result != VL_OK && (!error.message[0] || strchr(error.message, '\n')))
      fail_msg("%s: %s", name, error.message);
  }
  free(text);
}

static void test_cut_off(void **state) {
  (void)state;
  each_sample(cut);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(test_changed_places), cmocka_unit_test(test_unread),
      cmocka_unit_test(test_other_cameras),  cmocka_unit_test(test_no_such_camera),
      cmocka_unit_test(test_cut_off),
  };
  return cmocka_run_group_tests(tests, files_setup, files_teardown);
}
