/* test/camera_files/test_wrong_dialects.c: invalid glTF, Mitsuba, USD and matrix files: one
 * clear line each, with the line number where the format has lines; bounded memory and time. */
#include "camera_files/files.h"

static void test_gltf(void **state) {
  (void)state;
#define NODE "\"asset\":{},\"nodes\":[{\"camera\":0}],\"cameras\":["
#define LENS "\"perspective\":{\"yfov\":1,\"znear\":1}"
  REFUSED("a.gltf", 1, "{\"asset\":{}}", "\"cameras\" is missing");
  REFUSED("a.gltf", 1, "{\"asset\":{},\"cameras\":[]}", "no node holds a camera");
  REFUSED("a.gltf", 1, "{" NODE "]}", "names a camera that does not exist");
  REFUSED("a.gltf", 1, "{" NODE "{\"type\":\"fisheye\"}]}", "unknown camera type \"fisheye\"");
  REFUSED("a.gltf", 1, "{" NODE "{\"type\":\"perspective\"}]}", "\"perspective\" is missing");
  REFUSED("a.gltf", 1,
          "{" NODE "{\"type\":\"perspective\",\"perspective\":{\"yfov\":4,\"znear\":1}}]}",
          "yfov");
  REFUSED("a.gltf", 1,
          "{" NODE "{\"type\":\"perspective\",\"perspective\":{\"yfov\":\"x\",\"znear\":1}}]}",
          "yfov");
  REFUSED("a.gltf", 1,
          "{" NODE
          "{\"type\":\"perspective\",\"perspective\":{\"yfov\":1,\"znear\":1,\"aspectRatio\":"
          "1e300}}]}",
          "aspect ratio");
  REFUSED("a.gltf", 1,
          "{\"asset\":{},\"nodes\":[{\"camera\":0,\"children\":[0]}],"
          "\"cameras\":[{\"type\":\"perspective\"," LENS "}]}",
          "among its own children");
  REFUSED("a.gltf", 1,
          "{\"asset\":{},\"nodes\":[{\"camera\":0,\"children\":[7]}],"
          "\"cameras\":[{\"type\":\"perspective\"," LENS "}]}",
          "a child that does not exist");
  REFUSED("a.gltf", 1,
          "{\"asset\":{},\"nodes\":[{\"camera\":0,\"rotation\":[0,0,0,0]}],"
          "\"cameras\":[{\"type\":\"perspective\"," LENS "}]}",
          "no rotation");
  REFUSED("a.gltf", 2, "{\n\"asset\": }", "not JSON");
  REFUSED("a.gltf", 1, "glTF\2", "");
  /* glTF's own members were changed, but the extras were not */
  vlCameraRecord r = {.camera = vl_default_camera_def(64, 48), .frames = 1};
  vlError error;
  r.camera.fov = 1.0;
  r.camera.fov_axis = VL_FOV_VERTICAL;
  assert_int_equal(vl_camera_write(context, path_of("w.gltf"), NULL, &r, &error), VL_OK);
  FILE *file = fopen(path_of("w.gltf"), "r");
  char text[4096], *at;
  text[fread(text, 1, sizeof text - 1, file)] = 0;
  fclose(file);
  at = strstr(text, "\"yfov\": 1");
  assert_non_null(at);
  at[8] = '2';
  REFUSED("w.gltf", 12, text, "\"yfov\" is 2");
}

static void test_mitsuba(void **state) {
  (void)state;
  REFUSED("a.xml", 1, "<scene><sensor></scene>", "not XML: mismatched tag");
  REFUSED("a.xml", 3, "<scene>\n<sensor type=\"perspective\">\n", "not XML");
  REFUSED("a.xml", 0, "<scene><shape/></scene>", "holds no <sensor>");
  REFUSED("a.xml", 0, "<scene><include filename=\"x\"/></scene>",
          "included files are not followed");
  REFUSED("a.xml", 2, "<scene>\n<sensor type=\"perspectve\"/></scene>",
          "the nearest is \"perspective\"");
  REFUSED("a.xml", 2,
          "<scene><sensor type=\"perspective\">\n<float name=\"fov\" "
          "value=\"$f\"/></sensor></scene>",
          "\"$f\" has no <default>");
  REFUSED("a.xml", 2,
          "<scene><sensor type=\"perspective\">\n<float name=\"fov\" "
          "value=\"nan\"/></sensor></scene>",
          "\"value\" of <float> must hold 1 finite number");
  REFUSED("a.xml", 1,
          "<scene><sensor type=\"perspective\"><float name=\"fov\" "
          "value=\"200\"/></sensor></scene>",
          "fov is 200 degrees");
  REFUSED(
      "a.xml", 2,
      "<sensor type=\"perspective\"><transform name=\"to_world\">\n<lookat origin=\"0 0 0\" "
      "target=\"0 0 0\" "
      "up=\"0 1 0\"/></transform></sensor>",
      "give no direction");
  REFUSED("a.xml", 2,
          "<sensor type=\"perspective\"><transform "
          "name=\"to_world\">\n<skew/></transform></sensor>",
          "unknown transform <skew>");
  REFUSED("a.xml", 1,
          "<sensor type=\"perspective\"><film><integer name=\"width\" "
          "value=\"0.5\"/></film></sensor>",
          "whole pixels");
  REFUSED("a.xml", 1,
          "<sensor type=\"perspective\"><string name=\"focal_length\" "
          "value=\"50\xc2\xb5m\"/></sensor>",
          "must be like \"50mm\"");
  /* a billion laughs */
  REFUSED("a.xml", 2,
          "<?xml version=\"1.0\"?>\n<!DOCTYPE scene [\n<!ENTITY a \"aaaaaaaaaa\">\n<!ENTITY b "
          "\"&a;&a;&a;&a;&a;&a;\">\n"
          "]>\n<scene>&b;</scene>",
          "document type");
  REFUSED("a.xml", 1, "<scene>&undefined;</scene>", "not XML: undefined entity");
  char *deep = calloc(1, 70000);
  assert_non_null(deep);
  strcpy(deep, "<scene><sensor>");
  for (int i = 0; i < 100; i++)
    strcat(deep, "<a>");
  REFUSED("a.xml", 1, deep, "nested too deeply");
  strcpy(deep, "<sensor>");
  for (int i = 0; i < 15000; i++)
    memcpy(deep + 8 + 4 * i, "<a/>", 5);
  REFUSED("a.xml", 1, deep, "not XML"); /* no end; 15000 elements alone are taken */
  free(deep);
}

static void test_usd(void **state) {
  (void)state;
#define HEAD "#usda 1.0\n"
  REFUSED("a.usda", 1, HEAD "def Xform \"a\" {}\n", "holds no Camera");
  REFUSED("a.usda", 3, HEAD "def Camera \"a\"\n", "not USD: a prim has no body");
  REFUSED("a.usda", 3, HEAD "def Camera \"a\" {\n", "a prim is not closed");
  REFUSED("a.usda", 3, HEAD "def Camera \"a\" {\n float focalLength = }", "a value is missing");
  REFUSED("a.usda", 3, HEAD "def Camera \"a\" {\n float focalLength = (1, 2", "");
  REFUSED("a.usda", 2, HEAD "def Camera \"a\" { float focalLength = nan }",
          "\"focalLength\" holds \"nan\"");
  REFUSED("a.usda", 2, HEAD "def Camera \"a\" { float focalLength = 0 }", "must be above zero");
  REFUSED("a.usda", 2, HEAD "def Camera \"a\" { token projection = \"fisheye\" }",
          "unknown projection \"fisheye\"");
  REFUSED("a.usda", 2,
          HEAD "def Camera \"a\" { float focalLength.timeSamples = { 1: 5, 2: 6 } }",
          "change with time");
  REFUSED("a.usda", 2,
          HEAD "def Camera \"a\" { uniform token[] xformOpOrder = [\"xformOp:transform\"] }",
          "missing");
  REFUSED("a.usda", 2,
          HEAD "def Camera \"a\" { uniform token[] xformOpOrder = [\"xformOp:wobble\"] }",
          "wobb");
  REFUSED("a.usda", 2, HEAD "def Camera \"a { }", "a string has no end");
  char *deep = calloc(1, 20000);
  assert_non_null(deep);
  strcpy(deep, HEAD);
  for (int i = 0; i < 500; i++)
    strcat(deep, "def \"a\" {");
  REFUSED("a.usda", 2, deep, "nested too deeply");
  strcpy(deep, HEAD "def Camera \"a\" { float x = ");
  for (int i = 0; i < 5000; i++)
    strcat(deep, "[");
  REFUSED("a.usda", 2, deep, "nested too deeply");
  free(deep);
}

static void test_matrices(void **state) {
  (void)state;
#define M "\"width\":2,\"height\":2,\"order\":\"row-major\",\"vectors\":\"column\","
#define UNIT "[1,0,0,0,0,1,0,0,0,0,1,0,0,0,0,1]"
#define LENS_MATRIX "[1,0,0,0,0,1,0,0,0,0,-1,-1,0,0,-1,0]"
  REFUSED("m.json", 1, "{\"graphics_api\":\"opngl\"}", "the nearest is \"opengl\"");
  REFUSED("m.json", 1, "{\"graphics_api\":\"opengl\",\"width\":2,\"height\":2}",
          "\"order\" is missing");
  REFUSED("m.json", 1, "{\"graphics_api\":\"opengl\"," M "\"projection_matrix\":[1,2]}",
          "holds 2 numbers");
  REFUSED("m.json", 1, "{\"graphics_api\":\"opengl\"," M "\"projection_matrix\":\"1 2 x\"}",
          "must hold 16 numbers");
  REFUSED("m.json", 1,
          "{\"graphics_api\":\"opengl\"," M
          "\"projection_matrix\":[1,0,0,0,0,1,0,0,0,0,-1,-1,0,0,-2,0,0],"
          "\"view_matrix\":" UNIT "}",
          "more than 16");
  /* columns given for rows */
  REFUSED("m.json", 1,
          "{\"graphics_api\":\"opengl\"," M
          "\"projection_matrix\":[1,0,0,0,0,1,0,0,0,0,-1,-1,0,0,-0.2,0],"
          "\"view_matrix\":[1,0,0,0,0,1,0,0,0,0,1,0,0,0,5,1]}",
          "no pose");
  REFUSED("m.json", 1,
          "{\"graphics_api\":\"opengl\"," M
          "\"projection_matrix\":[0,0,0,0,0,1,0,0,0,0,-1,-1,0,0,-1,0],"
          "\"view_matrix\":" UNIT "}",
          "singular");
  REFUSED("m.json", 1,
          "{\"graphics_api\":\"opengl\"," M
          "\"clip_z\":[0,2],\"projection_matrix\":" LENS_MATRIX ",\"view_matrix\":" UNIT "}",
          "clip_z");
  REFUSED("m.json", 1,
          "{\"graphics_api\":\"opengl\"," M "\"projection_matrix\":" LENS_MATRIX
          ",\"view_matrix\":[0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,1]}",
          "no pose");
}

/* Files of other programs are named by their first bytes, with what to give instead. */
static void test_foreign(void **state) {
  (void)state;
  REFUSED("a.blend", 0, "BLENDER-v300\1", "Blender's own file; export glTF");
  REFUSED("a.fbx", 0, "Kaydara FBX Binary  \1", "an FBX file; export glTF");
  REFUSED("a.abc", 0, "Ogawa\xff\1", "an Alembic file; export glTF");
  REFUSED("a.mat", 0, "MATLAB 5.0 MAT-file, Platform: GLNXA64\1", "MATLAB's binary file; give");
  REFUSED("a.h5", 0, "\x89HDF\r\n\x1a\n", "an HDF5 file; give OpenCV's YAML");
  REFUSED("a.db", 0, "SQLite format 3\1", "a database, as COLMAP's; give the model's");
  REFUSED("a.bag", 0, "#ROSBAG V2.0\nE\1", "a recording of ROS; give the YAML");
  REFUSED("a.mcap", 0, "\x89MCAP0\r\n", "a recording of ROS 2; give the YAML");
  REFUSED("a.png", 0, "\x89PNG\r\n\x1a\n", "an image; give the camera's file");
  REFUSED("a.jpg", 0, "\xff\xd8\xff\xe0", "an image; give the camera's file");
  const char *const texts[][3] = {
      {"a.unity", "%YAML 1.1\n%TAG !u! tag:unity3d.com,2011:\n--- !u!29 &1\nA:\n b: 1\n",
       "a scene of Unity; export glTF"},
      {"a.t3d", "Begin Map\n Begin Level\n", "a scene of Unreal Engine; export glTF"},
      {"a.txt", "fileName imageWidth imageHeight \ncamera matrix K [3x3]\n",
       "parameters of Pix4D; export the cameras for COLMAP"},
      {"opk.txt", "# Cameras (2)\n# PhotoID, X, Y, Z, Omega, Phi, Kappa\n",
       "Metashape's angles; export the cameras as XML"},
      {"a.dat", "# INTERNAL CAMERA PARAMETERS\n\nParGroup: Cam\n", "HALCON"},
      {"b.xml", "<BlocksExchange version=\"2.1\"><Block/></BlocksExchange>", "ContextCapture"},
      {"a.sdf", "<sdf version=\"1.6\"><model/></sdf>", "a model of Gazebo; give the YAML"},
      {"city.json", "{\"extrinsic\": {\"pitch\": 1}, \"intrinsic\": {\"u0\": 2}}",
       "Cityscapes' camera"},
      {"settings.json", "{\"SettingsVersion\": 1.2, \"SimMode\": \"Car\"}",
       "AirSim's settings; give camera_angle_x"},
      {"carla.json", "{\"type\": \"sensor.camera.rgb\", \"fov\": 90}", "CARLA"},
      {"a.nk", "Camera2 {\n translate {0 0 1}\n}\n", "a script of Nuke; export glTF"},
  };
  for (size_t i = 0; i < sizeof texts / sizeof *texts; i++)
    if (!strstr(refused(texts[i][0], texts[i][1]).message, texts[i][2]))
      fail_msg("%s", texts[i][0]);
}

/* A word of a stranger's file is cut between characters, not between bytes; "…" follows. */
static void test_long_words(void **state) {
  (void)state;
  REFUSED("o.yaml", 2, "Camera.fx: 1\nCamera.type: \"ééééééééééééé\"\n", "\"éééééééééééé…\"");
  REFUSED("m.yaml", 1, "model_type: ééééééééééééé\ncamera_name: a\n", "\"éééééééééééé…\"");
}

/* Every allocation of every dialect fails once. */
static void test_memory(void **state) {
  (void)state;
  static const char *const names[] = {"m.gltf", "m.xml", "m.usda", "m.json"};
  for (int k = 0; k < 4; k++) {
    vlCameraRecord record = {.camera = vl_default_camera_def(64, 48), .frames = 1};
    vlCameraFileDef file = vl_default_camera_file_def();
    if (k == 3)
      file.dialect = VL_CAMERA_DIALECT_VULKAN;
    check_memory(path_of(names[k]), &record, &file);
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(test_gltf),       cmocka_unit_test(test_mitsuba),
      cmocka_unit_test(test_usd),        cmocka_unit_test(test_matrices),
      cmocka_unit_test(test_long_words), cmocka_unit_test(test_foreign),
      cmocka_unit_test(test_memory)};
  return cmocka_run_group_tests(tests, files_setup, files_teardown);
}
