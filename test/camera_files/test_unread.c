/* test/camera_files/test_unread.c: fields that a dialect's reader does not know are named. */
#include "camera_files/files.h"

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
               {VL_CAMERA_DIALECT_GAUSSIANS, "gaussians.json"}};
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

/* The text with a field more: in the first object of JSON, at the end of YAML. */
static void insert(char *to, size_t size, const char *text, const char *json,
                   const char *yaml) {
  const char *brace = strchr(text, '{');
  if (text[0] == '{' || text[0] == '[')
    snprintf(to, size, "%.*s%s,%s", (int)(brace + 1 - text), text, json, brace + 1);
  else
    snprintf(to, size, "%s%s\n", text, yaml);
}

static void what_velo_writes_is_known(void **state) {
  (void)state;
  static char text[4096];
  for (int i = 0; i < CHECKED; i++) {
    written(i, text, sizeof text);
    const vlCameraRecord back = read_with(path_of(checked[i].name), NULL);
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
    insert(more, sizeof more, text, "\"made_up\":{\"fx\":3}", "made_up:\n  fx: 3");
    const vlCameraRecord back = read_with(put(checked[i].name, more), NULL);
    if (back.unread != 1)
      fail_msg("%s: %u", checked[i].name, back.unread);
    assert_string_equal(back.unread_names, "\"made_up\"");
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
           "{%s\"w\":64,\"h\":48,\"fl_x\":50,\"frames\":[{\"twice\":1,\"transform_matrix\":"
           "[[1,0,0,0],[0,1,0,0],[0,0,1,0]]},{\"twice\":1,\"transform_matrix\":"
           "[[1,0,0,0],[0,1,0,0],[0,0,1,0]]}]}",
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
      cmocka_unit_test(names_are_counted),
      cmocka_unit_test(rows_at_different_times_are_refused),
  };
  return cmocka_run_group_tests(tests, files_setup, files_teardown);
}
