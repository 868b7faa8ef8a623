/* test/camera_files/test_unread.c: fields that a dialect's reader does not know are named. */
#include "camera_files/files.h"
#include "velo/trajectory.h"

/* Dialects whose readers have a list of names, and the names of files by which they are
 * recognised. */
static const struct {
  vlCameraDialect dialect;
  const char *name;
} checked[] = {{VL_CAMERA_DIALECT_OPENCV, "opencv.yaml"},
               {VL_CAMERA_DIALECT_OPENCV, "opencv.json"},
               {VL_CAMERA_DIALECT_ROS, "ros.yaml"},
               {VL_CAMERA_DIALECT_NERF, "transforms.json"},
               {VL_CAMERA_DIALECT_KALIBR, "kalibr.yaml"},
               {VL_CAMERA_DIALECT_BLENDER, "blender.json"},
               {VL_CAMERA_DIALECT_EUROC, "euroc.yaml"},
               {VL_CAMERA_DIALECT_CAMODOCAL, "camodocal.yaml"},
               {VL_CAMERA_DIALECT_BASALT, "basalt.json"},
               {VL_CAMERA_DIALECT_ORBSLAM, "orbslam.yaml"},
               {VL_CAMERA_DIALECT_OKVIS, "okvis.yaml"},
               {VL_CAMERA_DIALECT_SVO, "svo.yaml"},
               {VL_CAMERA_DIALECT_GAUSSIANS, "gaussians.json"},
               {VL_CAMERA_DIALECT_OPENGL, "opengl.json"},
               {VL_CAMERA_DIALECT_VULKAN, "vulkan.json"},
               {VL_CAMERA_DIALECT_D3D, "d3d.json"},
               {VL_CAMERA_DIALECT_BOP, "scene_camera.json"},
               {VL_CAMERA_DIALECT_METASHAPE, "metashape.xml"},
               {VL_CAMERA_DIALECT_MESHROOM, "cameras.sfm"},
               {VL_CAMERA_DIALECT_OPENSFM, "reconstruction.json"},
               {VL_CAMERA_DIALECT_OPEN3D, "open3d.json"},
               {VL_CAMERA_DIALECT_VISP, "visp.xml"},
               {VL_CAMERA_DIALECT_OPENMVG, "sfm_data.json"},
               {VL_CAMERA_DIALECT_REALITYCAPTURE, "image.xmp"},
               {VL_CAMERA_DIALECT_NERFSTUDIO, "camera_path.json"},
               {VL_CAMERA_DIALECT_POLYCAM, "polycam.json"},
               {VL_CAMERA_DIALECT_REALSENSE, "realsense.json"},
               {VL_CAMERA_DIALECT_PANOPTIC, "panoptic.json"},
               {VL_CAMERA_DIALECT_NERFIES, "nerfies.json"},
               {VL_CAMERA_DIALECT_THREEJS, "threejs.json"},
               {VL_CAMERA_DIALECT_MIDDLEBURY, "calib.txt"},
               {VL_CAMERA_DIALECT_KITTI, "calib_cam_to_cam.txt"}};
enum { CHECKED = sizeof checked / sizeof *checked };

static vlCameraRecord some_camera(void) {
  vlCameraRecord record = {.camera = vl_default_camera_def(640, 480), .frames = 1};
  record.camera.fx = record.camera.fy = 500;
  return record;
}

static void written(int i, char *text, size_t size) {
  const vlCameraRecord record = some_camera();
  vlCameraFileDef def = vl_default_camera_file_def();
  vlError error;
  static const char *const pose[] = {"pose"};
  def.dialect = checked[i].dialect;
  def.drop = pose;
  def.drop_count = 1;
  const char *path = path_of(checked[i].name);
  if (vl_camera_write(context, path, &def, &record, &error) != VL_OK)
    fail_msg("%s: %s", checked[i].name, error.message);
  FILE *file = fopen(path, "r");
  assert_non_null(file);
  text[fread(text, 1, size - 1, file)] = 0;
  fclose(file);
}

/* The text with a field more: in the first object of JSON, at the end of YAML, in the root of
 * XML. */
static void insert(char *to, size_t size, const char *text, const char *name, int value) {
  const char *brace = strchr(text, '{'), *end = strrchr(text, '<');
  if (strstr(text, "cam_K")) /* BOP: the first object holds the images */
    brace = strchr(brace + 1, '{');
  if (text[0] == '{' || text[0] == '[')
    snprintf(to, size, "%.*s\"%s\":%d,%s", (int)(brace + 1 - text), text, name, value,
             brace + 1);
  else if (text[0] == '<')
    snprintf(to, size, "%.*s<%s>%d</%s>%s", (int)(end - text), text, name, value, name, end);
  else
    snprintf(to, size, "%s%s%s%d\n", text, name, strncmp(text, "cam0=", 5) ? ": " : "=", value);
}

/* The files of some dialects have no size. */
static vlCameraFileDef sized(void) {
  vlCameraFileDef def = vl_default_camera_file_def();
  def.width = 640;
  def.height = 480;
  return def;
}

static void what_velo_writes_is_known(void **state) {
  (void)state;
  static char text[4096];
  for (int i = 0; i < CHECKED; i++) {
    written(i, text, sizeof text);
    const vlCameraFileDef def = sized();
    const vlCameraRecord back = read_with(path_of(checked[i].name), &def);
    assert_int_equal(back.dialect, checked[i].dialect);
    if (back.unread)
      fail_msg("%s: %s", checked[i].name, back.unread_names);
    assert_string_equal(back.unread_names, "");
  }
}

static void a_new_field_is_named(void **state) {
  (void)state;
  static char text[4096], more[8192];
  for (int i = 0; i < CHECKED; i++) {
    written(i, text, sizeof text);
    insert(more, sizeof more, text, "made_up", 3);
    const vlCameraFileDef def = sized();
    const vlCameraRecord back = read_with(put(checked[i].name, more), &def);
    if (back.unread != 1)
      fail_msg("%s: %u", checked[i].name, back.unread);
    assert_string_equal(back.unread_names, "\"made_up\"");
  }
}

/* By its name, unless its value says that it has no effect. */
static void a_field_that_changes_the_image_is_refused(void **state) {
  (void)state;
  static char text[4096], more[8192];
  for (int i = 0; i < CHECKED; i++) {
    const vlCameraFileDef def = sized();
    vlCameraRecord record;
    vlError error;
    written(i, text, sizeof text);
    insert(more, sizeof more, text, "crop_left", 5);
    const char *path = put(checked[i].name, more);
    assert_int_equal(vl_camera_read(context, path, &def, &record, &error), VL_ERROR_SCENE);
    if (!strstr(error.message, "\"crop_left\" is not understood"))
      fail_msg("%s: %s", checked[i].name, error.message);
    insert(more, sizeof more, text, "crop_left", 0);
    const vlCameraRecord back = read_with(put(checked[i].name, more), &def);
    if (back.unread != 1)
      fail_msg("%s: %s", checked[i].name, back.unread_names);
  }
}

/* Further names, of one dialect alone, and names of cameras, which are no fields. */
static void names_of_one_dialect(void **state) {
  (void)state;
  const vlCameraFileDef def = sized();
  static const char view[] =
      "{\"0\":{\"cam_K\":[500,0,320,0,500,240,0,0,1],\"cam_R_w2c\":[1,0,0,0,1,0,0,0,1],"
      "\"cam_t_w2c\":[0,0,0]%s},\"crop\":{\"depth_scale\":1}}";
  char text[400];
  snprintf(text, sizeof text, view, "");
  assert_int_equal(read_with(put("scene_camera.json", text), &def).unread, 0);
  snprintf(text, sizeof text, view, ",\"cam_model\":{\"projection_params\":[1]}");
  vlCameraRecord record;
  vlError error;
  assert_int_equal(
      vl_camera_read(context, put("scene_camera.json", text), &def, &record, &error),
      VL_ERROR_SCENE);
  assert_non_null(strstr(error.message, "\"cam_model\""));
}

/* Files as tools write them, with what velo does not take of them. */
static void what_changes_the_image_is_refused(void **state) {
  (void)state;
  static const char lists[] =
      "[{\"id\":0,\"img_name\":\"a\",\"width\":64,\"height\":48,\"position\":[0,0,0],"
      "\"rotation\":[[1,0,0],[0,1,0],[0,0,1]],\"fx\":50,\"fy\":50,\"cx\":30,\"cy\":24}]";
  static const char blender[] =
      "{\"lens\":50,\"resolution_x\":64,\"resolution_y\":48,%s,"
      "\"matrix_world\":[1,0,0,0,0,1,0,0,0,0,1,0,0,0,0,1]}";
  static const char three[] =
      "{\"metadata\":{},\"object\":{\"type\":\"PerspectiveCamera\",\"fov\":50,\"aspect\":1,%s,"
      "\"matrix\":[1,0,0,0,0,1,0,0,0,0,1,0,0,0,0,1]}}";
  static const char zed[] = "[LEFT_CAM_HD]\nfx=700\nfy=700\ncx=640\ncy=360\n%s\n";
  const struct {
    const char *name, *text, *more, *message;
  } files[] = {
      {"cameras.json", lists, "", "\"cx\" is not"},
      {"tum.json", "{\"fx\":50,\"fy\":50,\"cx\":30,\"cy\":20%s}", ",\"d1\":0.1",
       "\"d1\" is not"},
      {"blender.json", blender, "\"resolution_percentage\":50", "must be 100"},
      {"blender.json", blender, "\"use_border\":true", "\"use_border\" is not"},
      {"three.json", three, "\"filmOffset\":5", "\"filmOffset\" other than 0"},
      {"three.json", three, "\"view\":{\"enabled\":true,\"offsetX\":10}", "\"view\", a part"},
      {"tum.json", "{\"fx\":50,\"fy\":50,\"cx\":30,\"cy\":20%s}", ",\"lens_mode\":\"FTheta\"",
       "\"lens_mode\" is not"},
      {"lens.usda", "#usda 1.0\ndef Camera \"c\"\n{\n token cameraProjectionType = \"%s\"\n}\n",
       "fisheyePolynomial", "\"cameraProjectionType\""},
      {"shift.dae",
       "<COLLADA version=\"1.4.1\"><library_cameras><camera id=\"c\"><optics><technique_common>"
       "<perspective><yfov>50</yfov><aspect_ratio>1</aspect_ratio></perspective></technique_common>"
       "</optics><extra><technique profile=\"blender\">%s</technique></extra></camera>"
       "</library_cameras><library_visual_scenes><visual_scene id=\"s\"><node id=\"n\">"
       "<instance_camera url=\"#c\"/></node></visual_scene></library_visual_scenes></COLLADA>",
       "<shiftx>0.2</shiftx>", "lens shift, <shiftx>"},
      {"m.cameramodel", "{\n 'lensmodel': 'LENSMODEL_OPENCV8%s'\n}\n", "", "mrcal"},
      {"SN1.conf", zed, "k4=0.2", "\"k4\" is not"},
      {"SN1.conf", zed, "[LEFT_DISTO]\nk1=0.2", "[LEFT_DISTO] is not taken"}};
  for (size_t i = 0; i < sizeof files / sizeof *files; i++) {
    const vlCameraFileDef def = sized();
    char text[800];
    vlCameraRecord record;
    vlError error;
    snprintf(text, sizeof text, files[i].text, files[i].more);
    const char *path = put(files[i].name, text);
    if (vl_camera_read(context, path, &def, &record, &error) != VL_ERROR_SCENE ||
        !strstr(error.message, files[i].message))
      fail_msg("%s: %s", files[i].name, error.message);
  }
}

/* A trajectory has the note in its first camera. */
static void trajectories_have_the_note(void **state) {
  (void)state;
  static const char frames[] =
      "{\"w\":64,\"h\":48,\"fl_x\":50,%s\"frames\":[{\"file_path\":\"a\","
      "\"transform_matrix\":[[1,0,0,0],[0,1,0,0],[0,0,1,0]]}]}";
  char text[300];
  vlTrajectory *trajectory = NULL;
  vlError error;
  snprintf(text, sizeof text, frames, "\"made_up\":3,");
  const char *path = put("transforms.json", text);
  assert_int_equal(vl_trajectory_load(context, path, NULL, &trajectory, &error), VL_OK);
  assert_int_equal(vl_trajectory_camera(trajectory, 0)->unread, 1);
  assert_string_equal(vl_trajectory_camera(trajectory, 0)->unread_names, "\"made_up\"");
  vl_trajectory_destroy(trajectory);
  snprintf(text, sizeof text, frames, "\"crop_left\":3,");
  path = put("transforms.json", text);
  assert_int_equal(vl_trajectory_load(context, path, NULL, &trajectory, &error),
                   VL_ERROR_SCENE);
  assert_non_null(strstr(error.message, "\"crop_left\""));
}

/* Files that hold whole scenes: of the camera alone. */
static void cameras_of_scenes(void **state) {
  (void)state;
  static const struct {
    const char *name, *text, *more; /* more: a format of a name and a number */
  } files[] = {
      {"s.gltf",
       "{\"asset\":{\"version\":\"2.0\"},\"made_up_too\":1,\"nodes\":[{\"camera\":0,"
       "\"extensions\":{\"X\":{}}}],\"cameras\":[{\"type\":\"perspective\",\"extras\":{\"x\":1},"
       "\"perspective\":{\"yfov\":1,\"znear\":1%s}}]}",
       ",\"%s\":%d"},
      {"node.gltf",
       "{\"asset\":{\"version\":\"2.0\"},\"nodes\":[{\"camera\":0%s}],"
       "\"cameras\":[{\"type\":\"perspective\",\"perspective\":{\"yfov\":1,\"znear\":1}}]}",
       ",\"%s\":%d"},
      {"s.dae",
       "<COLLADA version=\"1.4.1\"><library_cameras><camera id=\"c\"><optics><technique_common>"
       "<perspective><yfov>50</yfov><aspect_ratio>1</aspect_ratio>%s</perspective>"
       "</technique_common></optics><extra><x>1</x></extra></camera></library_cameras>"
       "<library_visual_scenes><visual_scene id=\"s\"><node id=\"n\"><matrix>1 0 0 0 0 1 0 0 0 0 1 "
       "0 0 0 0 1</matrix><instance_camera url=\"#c\"/></node></visual_scene>"
       "</library_visual_scenes></COLLADA>",
       "<%1$s>%2$d</%1$s>"},
      {"s.usda",
       "#usda 1.0\ndef Xform \"x\" {\n int other = 1\n def Camera \"c\" {\n float focalLength = 50\n"
       " string userProperties:a = \"b\"\n%s def Mesh \"m\" { int x = 3 }\n}\n}\n",
       " int %s = %d\n"},
      {"s.xml",
       "<scene version=\"3.0.0\"><shape type=\"x\"><float name=\"y\" value=\"1\"/></shape>"
       "<sensor type=\"perspective\"><float name=\"fov\" value=\"40\"/>%s</sensor></scene>",
       "<float name=\"%s\" value=\"%d\"/>"},
      {"film.xml",
       "<scene version=\"3.0.0\"><sensor type=\"thinlens\"><float name=\"fovAxis\" value=\"x\"/>"
       "<float name=\"apertureRadius\" value=\"1\"/><film type=\"hdrfilm\"><string "
       "name=\"pixel_format\" value=\"rgb\"/>%s</film></sensor></scene>",
       "<float name=\"%s\" value=\"%d\"/>"}};
  for (size_t i = 0; i < sizeof files / sizeof *files; i++) {
    const vlCameraFileDef def = vl_default_camera_file_def();
    char text[1024], more[100];
    snprintf(text, sizeof text, files[i].text, "");
    assert_string_equal(read_with(put(files[i].name, text), &def).unread_names, "");
    snprintf(more, sizeof more, files[i].more, "made_up", 3);
    snprintf(text, sizeof text, files[i].text, more);
    assert_string_equal(read_with(put(files[i].name, text), &def).unread_names, "\"made_up\"");
    snprintf(more, sizeof more, files[i].more, "crop_left", 0);
    snprintf(text, sizeof text, files[i].text, more);
    assert_string_equal(read_with(put(files[i].name, text), &def).unread_names,
                        "\"crop_left\"");
    snprintf(more, sizeof more, files[i].more, "crop_left", 5);
    snprintf(text, sizeof text, files[i].text, more);
    assert_non_null(strstr(refused(files[i].name, text).message, "\"crop_left\" is not"));
  }
  const char *reference =
      "<scene><sensor type=\"perspective\"><ref name=\"film\" id=\"f\"/></sensor></scene>";
  assert_non_null(strstr(refused("ref.xml", reference).message, "the film is a reference"));
}

/* Columns of RealityCapture's CSV; the size is given. */
static void columns_of_tables(void **state) {
  (void)state;
  static const struct {
    const char *column, *value, *names, *message;
  } rows[] = {{"t2", "0", "", NULL},
              {"color", "red", "\"color\"", NULL},
              {"k5", "0", "\"k5\"", NULL},
              {"k5", "0.1", NULL, "\"k5\" is not understood"},
              {"skew", "3", NULL, "\"skew\" is not understood"}};
  for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
    const vlCameraFileDef def = sized();
    char text[300];
    vlCameraRecord record;
    vlError error;
    snprintf(text, sizeof text,
             "#name,x,y,alt,heading,pitch,roll,f,%s\na.jpg,1,2,3,4,5,6,35,%s\n", rows[i].column,
             rows[i].value);
    vlResult result = vl_camera_read(context, put("reality.csv", text), &def, &record, &error);
    if (rows[i].names) {
      assert_int_equal(result, VL_OK);
      assert_string_equal(record.unread_names, rows[i].names);
    } else {
      assert_int_equal(result, VL_ERROR_SCENE);
      assert_non_null(strstr(error.message, rows[i].message));
    }
  }
}

/* The first three names are kept; all fields are counted. */
static void names_are_counted(void **state) {
  (void)state;
  static char text[4096];
  size_t used = 0;
  for (int i = 0; i < 40; i++)
    used += (size_t)snprintf(text + used, sizeof text - used, "\"field %d\":%d,", i, i);
  static char whole[16384];
  snprintf(whole, sizeof whole,
           "{%s\"w\":64,\"h\":48,\"fl_x\":50,\"frames\":[{\"twice\":1,"
           "\"transform_matrix\":[[1,0,0,0],[0,1,0,0],[0,0,1,0]]},"
           "{\"twice\":1,\"transform_matrix\":[[1,0,0,0],[0,1,0,0],[0,0,1,0]]}]}",
           text);
  const vlCameraRecord back = read_with(put("transforms.json", whole), NULL);
  if (back.unread != 42)
    fail_msg("%u: %s", back.unread, back.unread_names);
  assert_string_equal(back.unread_names, "\"field 0\", \"field 1\", \"field 2\"");
}

/* Fields that make another camera of a file. */
static void rows_at_different_times_are_refused(void **state) {
  (void)state;
  static char text[4096], more[8192];
  for (int i = 0; i < CHECKED; i++)
    if (checked[i].dialect == VL_CAMERA_DIALECT_CAMODOCAL) {
      written(i, text, sizeof text);
      snprintf(more, sizeof more, "%srolling_shutter: 0\n", text);
      assert_int_equal(read_with(put(checked[i].name, more), NULL).unread, 0);
      snprintf(more, sizeof more, "%srolling_shutter: 1\n", text);
      assert_non_null(strstr(refused(checked[i].name, more).message, "different times"));
    }
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(what_velo_writes_is_known),
      cmocka_unit_test(a_new_field_is_named),
      cmocka_unit_test(a_field_that_changes_the_image_is_refused),
      cmocka_unit_test(names_of_one_dialect),
      cmocka_unit_test(what_changes_the_image_is_refused),
      cmocka_unit_test(trajectories_have_the_note),
      cmocka_unit_test(cameras_of_scenes),
      cmocka_unit_test(columns_of_tables),
      cmocka_unit_test(names_are_counted),
      cmocka_unit_test(rows_at_different_times_are_refused),
  };
  return cmocka_run_group_tests(tests, files_setup, files_teardown);
}
