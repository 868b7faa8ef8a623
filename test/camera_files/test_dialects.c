/* test/camera_files/test_dialects.c: cameras of glTF, Mitsuba, USD, OpenGL, Vulkan, Direct3D:
 * round trips of random cameras, published examples with numbers computed by hand, matrices as
 * those APIs use them, rejected content by name. */
#include "camera_files/files.h"
#include "velo/distortion.h"
#include "velo/projection.h"

static void lens(vlCameraDef *d, vlDistortion kind, uint32_t count, const double *k) {
  d->distortion = kind;
  d->distortion_count = count;
  memcpy(d->distortion_coefficients, k, count * sizeof *k);
}

/* What a dialect of this file can hold. */
enum {
  SHIFT = 1,
  ASPECT = 2,
  SKEW = 4,
  LENS = 8,
  PLANES = 16,
  TIME = 32,
  SCALE = 64,
  EXPOSURE = 128,
  FLAT_SHIFT = 256
};
typedef struct {
  vlCameraDialect dialect;
  const char *file;
  int holds;
} Holds;
static const Holds all[] = {
    {VL_CAMERA_DIALECT_VELO, "v.json",
     SHIFT | ASPECT | SKEW | LENS | PLANES | TIME | SCALE | EXPOSURE | FLAT_SHIFT},
    {VL_CAMERA_DIALECT_GLTF, "g.gltf", ASPECT | PLANES | SCALE},
    {VL_CAMERA_DIALECT_MITSUBA, "m.xml", SHIFT | LENS | PLANES | TIME},
    {VL_CAMERA_DIALECT_USD, "u.usda",
     SHIFT | ASPECT | LENS | PLANES | TIME | SCALE | EXPOSURE | FLAT_SHIFT},
    {VL_CAMERA_DIALECT_OPENGL, "gl.json", SHIFT | ASPECT | SKEW | PLANES | SCALE | FLAT_SHIFT},
    {VL_CAMERA_DIALECT_VULKAN, "vk.json", SHIFT | ASPECT | SKEW | PLANES | SCALE | FLAT_SHIFT},
    {VL_CAMERA_DIALECT_D3D, "d3d.json", SHIFT | ASPECT | SKEW | PLANES | SCALE | FLAT_SHIFT},
    {VL_CAMERA_DIALECT_BLENDER, "b.json", SHIFT | ASPECT | PLANES | FLAT_SHIFT},
};
enum { DIALECTS = sizeof all / sizeof *all };

static vlCameraRecord random_camera(uint64_t *seed, int holds) {
  uint32_t w = 64 + (uint32_t)(next_unit(seed) * 2000),
           h = 64 + (uint32_t)(next_unit(seed) * 2000);
  vlCameraRecord r = {.camera = vl_default_camera_def(w, h), .frames = 1, .name = "left"};
  vlCameraDef *d = &r.camera;
  bool flat = next_unit(seed) < 0.25, lensed = (holds & LENS) && !flat && next_unit(seed) < 0.5;
  if (flat)
    d->projection = VL_PROJECTION_ORTHOGRAPHIC;
  set3(d->eye, next_between(seed, -9, 9), next_between(seed, -9, 9), next_between(seed, -9, 9));
  set3(d->lookat, next_between(seed, -9, 9), next_between(seed, -9, 9),
       next_between(seed, 10, 20));
  d->roll = next_between(seed, -3, 3);
  d->fx = next_between(seed, 0.3, 4) * w;
  d->fy = holds & ASPECT ? d->fx * next_between(seed, 0.6, 1.6) : d->fx;
  /* Mitsuba's thin lens has its axis in the middle */
  if ((holds & (flat ? FLAT_SHIFT : SHIFT)) && !(lensed && !(holds & ASPECT))) {
    d->cx = next_between(seed, -0.2, 1.2) * w;
    d->cy = next_between(seed, -0.2, 1.2) * h;
  }
  if (holds & SKEW)
    d->skew = next_between(seed, -9, 9);
  if (lensed) {
    d->lens_radius = next_between(seed, 0.001, 0.2);
    d->focus_distance = next_between(seed, 0.5, 20);
  }
  if ((holds & PLANES) && next_unit(seed) < 0.5)
    d->near_plane = next_between(seed, 0.01, 1);
  if ((holds & PLANES) && next_unit(seed) < 0.5)
    d->far_plane = next_between(seed, 10, 1000);
  if ((holds & TIME) && next_unit(seed) < 0.5) {
    d->shutter_open = 0.25;
    d->shutter_close = next_between(seed, 1, 2);
  }
  if (holds & EXPOSURE)
    d->exposure_time = next_between(seed, 0.1, 9);
  if ((holds & SCALE) && next_unit(seed) < 0.3) { /* a pose that mirrors and scales */
    vlCamera c = make_or_fail(d);
    d->has_matrix = true;
    d->roll = 0.0;
    for (int i = 0; i < 12; i++)
      d->world_from_camera[i] = c.world_from_camera[i] * (i % 4 == 0   ? -2.0
                                                          : i % 4 == 3 ? 1.0
                                                                       : 2.0);
  }
  return r;
}

static void near_to(double a, double b, double tolerance, const char *what,
                    const char *dialect) {
  if (a == b)
    return;
  if (!(fabs(a - b) <= tolerance * fmax(1.0, fmax(fabs(a), fabs(b)))))
    fail_msg("%s: %s is %.17g, was %.17g", dialect, what, b, a);
}

static void compare(const vlCameraDef *before, const vlCameraDef *after, double tolerance,
                    const char *dialect) {
  vlCamera a = make_or_fail(before), b = make_or_fail(after);
  assert_int_equal(a.projection, b.projection);
  assert_int_equal(a.width, b.width);
  assert_int_equal(a.height, b.height);
  const double x[] = {a.fx,
                      a.fy,
                      a.skew,
                      a.cx,
                      a.cy,
                      a.lens_radius,
                      a.near_plane,
                      a.shutter_open,
                      a.shutter_close,
                      a.exposure_time,
                      isinf(a.focus_distance) ? -1 : a.focus_distance,
                      isinf(a.far_plane) ? -1 : a.far_plane};
  const double y[] = {b.fx,
                      b.fy,
                      b.skew,
                      b.cx,
                      b.cy,
                      b.lens_radius,
                      b.near_plane,
                      b.shutter_open,
                      b.shutter_close,
                      b.exposure_time,
                      isinf(b.focus_distance) ? -1 : b.focus_distance,
                      isinf(b.far_plane) ? -1 : b.far_plane};
  static const char *const names[] = {"fx",
                                      "fy",
                                      "skew",
                                      "cx",
                                      "cy",
                                      "lens_radius",
                                      "near_plane",
                                      "shutter_open",
                                      "shutter_close",
                                      "exposure_time",
                                      "focus_distance",
                                      "far_plane"};
  for (size_t i = 0; i < sizeof x / sizeof *x; i++)
    near_to(x[i], y[i], tolerance, names[i], dialect);
  for (int i = 0; i < 16; i++)
    near_to(a.world_from_camera[i], b.world_from_camera[i], tolerance, "world_from_camera",
            dialect);
}

static vlCameraRecord through(const vlCameraRecord *record, const Holds *to) {
  char path[256];
  vlError error;
  vlCameraFileDef def = vl_default_camera_file_def();
  snprintf(path, sizeof path, "%s", path_of(to->file));
  def.dialect = to->dialect;
  if (vl_camera_write(context, path, &def, record, &error) != VL_OK)
    fail_msg("%s: %s", vl_camera_dialect_name(to->dialect), error.message);
  vlCameraRecord back = read_with(path, NULL);
  assert_int_equal(back.dialect, to->dialect);
  return back;
}

/* Each dialect with what it holds; then on into every other one with what both hold, and
 * back. */
static void test_round_trips(void **state) {
  (void)state;
  uint64_t seed = 11;
  for (int i = 0; i < DIALECTS; i++)
    for (int n = 0; n < 100; n++) {
      vlCameraRecord r = random_camera(&seed, all[i].holds), back = through(&r, &all[i]);
      bool exact =
          all[i].dialect == VL_CAMERA_DIALECT_VELO || all[i].dialect == VL_CAMERA_DIALECT_GLTF;
      compare(&r.camera, &back.camera, exact ? 0.0 : 1e-12,
              vl_camera_dialect_name(all[i].dialect));
      assert_false(back.size_assumed);
    }
  for (int i = 0; i < DIALECTS; i++)
    for (int j = 0; j < DIALECTS; j++)
      for (int n = 0; n < 10; n++) {
        vlCameraRecord r = random_camera(&seed, all[i].holds & all[j].holds);
        vlCameraRecord there = through(&r, &all[i]), again = through(&there, &all[j]);
        compare(&r.camera, &again.camera, 1e-11, vl_camera_dialect_name(all[j].dialect));
      }
}

/* The lens and time in full, in velo's JSON and glTF's extras: the same bits; others refuse
 * each by name. */
static void test_lens_and_time(void **state) {
  (void)state;
  uint64_t seed = 77;
  static const char *const fields[] = {"blades",  "aperture_ratio", "focus_pixel",
                                       "tilt",    "vignetting",     "shutter_curve",
                                       "readout", "motion",         "stereo"};
  enum { FIELDS = sizeof fields / sizeof *fields };
  for (int n = 0; n < 200; n++) {
    vlCameraRecord r = random_camera(&seed, all[0].holds), back;
    vlCameraDef *d = &r.camera;
    d->projection = VL_PROJECTION_PERSPECTIVE;
    d->fx = d->fy = VL_UNSET;
    d->focal_mm = next_between(&seed, 10, 90);
    d->sensor_width_mm = 36;
    d->exposure_time = 1.0;
    d->lens = (vlLensDef){.f_number = next_between(&seed, 1, 9),
                          .unit_mm = next_between(&seed, 1, 2000),
                          .focus_point = {VL_UNSET, VL_UNSET, VL_UNSET},
                          .focus_pixel = {VL_UNSET, VL_UNSET},
                          .blades = 5,
                          .rotation = 0.3,
                          .ratio = 2.0,
                          .lens_tilt_x = 0.1,
                          .vignetting = true,
                          .iso = 100,
                          .seconds = n & 1 ? 0.01 : VL_UNSET};
    d->lens_radius = 0.0;
    d->focus_distance = next_between(&seed, 1, 5);
    if (n & 2) {
      d->lens.focus_pixel[0] = 3.5;
      d->lens.focus_pixel[1] = 4.25;
      d->focus_distance = VL_UNSET;
    }
    if (n & 4) {
      d->lens.lens_tilt_x = 0.0;
      d->lens.tilt_y = 0.2;
    }
    d->shutter_points = 3;
    for (int i = 0; i < 3; i++) {
      d->shutter_at[i] = 0.5 * i;
      d->shutter_value[i] = next_between(&seed, 0.1, 1);
    }
    d->readout = 0.02;
    d->readout_direction = VL_READOUT_LEFT;
    if (d->has_matrix) {
      d->has_matrix_close = true;
      memcpy(d->world_from_camera_close, d->world_from_camera, sizeof d->world_from_camera);
      d->world_from_camera_close[3] += 1.0;
    } else {
      set3(d->eye_close, 1, 2, 3);
    }
    d->pose_times[0] = 0.1;
    d->pose_times[1] = 0.7;
    d->stereo = (vlStereo){VL_STEREO_OFF_AXIS, 0.07, 3.0};
    d->stereo_eye = n & 8 ? VL_EYE_LEFT : VL_EYE_BOTH;
    vlCamera one = {0}, two = {0};
    vlError error;
    const char *warning;
    if (vl_camera_make(d, &one, &warning, &error) != VL_OK)
      fail_msg("%s", error.message);
    back = through(&r, &all[0]);
    assert_int_equal(vl_camera_make(&back.camera, &two, NULL, NULL), VL_OK);
    assert_memory_equal(&one, &two, sizeof one);
    assert_int_equal(back.camera.stereo.mode, d->stereo.mode);
    assert_int_equal(back.camera.stereo_eye, d->stereo_eye);
  }
  for (int k = 1; k < DIALECTS; k++)
    for (int f = 0; f < FIELDS; f++) {
      vlCameraRecord r = {.camera = vl_default_camera_def(64, 48), .frames = 1};
      vlCameraDef *d = &r.camera;
      vlCameraFileDef def = vl_default_camera_file_def();
      vlError error;
      d->lens_radius = all[k].holds & LENS ? 0.1 : 0.0;
      d->focus_distance = all[k].holds & LENS ? 3.0 : VL_UNSET;
      switch (f) {
        case 0:
          d->lens.blades = 6;
          break;
        case 1:
          d->lens.ratio = 2.0;
          break;
        case 2:
          d->lens.focus_pixel[0] = d->lens.focus_pixel[1] = 3.0;
          d->focus_distance = VL_UNSET;
          break;
        case 3:
          d->lens.tilt_x = 0.1;
          break;
        case 4:
          d->lens.vignetting = true;
          break;
        case 5:
          d->shutter_points = 2;
          d->shutter_at[1] = 1.0;
          d->shutter_value[0] = 1.0;
          break;
        case 6:
          d->readout = 0.1;
          break;
        case 7:
          set3(d->eye_close, 1, 2, 3);
          break;
        default:
          d->stereo.mode = VL_STEREO_PARALLEL;
          break;
      }
      def.dialect = all[k].dialect;
      assert_int_equal(vl_camera_write(context, path_of("r"), &def, &r, &error),
                       VL_ERROR_UNSUPPORTED);
      if (!strstr(error.message, fields[f]))
        fail_msg("%s: %s", fields[f], error.message);
    }
}

/* Fields that glTF's own members cannot hold are refused. If they are dropped by name, the
 * extras still hold them. */
static void test_gltf_extras(void **state) {
  (void)state;
  static const double k[5] = {-0.21, 0.07, 0.0011, -0.0007, 0.013};
  const char *drops[] = {"skew",           "cx",         "cy",        "lens_radius",
                         "focus_distance", "distortion", "projection"};
  uint64_t seed = 5;
  vlCameraRecord r = random_camera(&seed, all[0].holds);
  r.camera.projection = VL_PROJECTION_EQUIDISTANT;
  r.camera.shutter_open = 0.0;
  r.camera.shutter_close = 1.0;
  r.camera.exposure_time = 1.0;
  r.camera.lens_radius = 0.1;
  r.camera.focus_distance = 4.0;
  lens(&r.camera, VL_DISTORTION_RADIAL, 4, k);
  vlCameraFileDef def = vl_default_camera_file_def();
  vlError error;
  def.drop = drops;
  for (def.drop_count = 0; def.drop_count < 7; def.drop_count++) {
    assert_int_equal(vl_camera_write(context, path_of("e.gltf"), &def, &r, &error),
                     VL_ERROR_UNSUPPORTED);
    assert_non_null(strstr(error.message, "gltf cannot hold"));
  }
  if (vl_camera_write(context, path_of("e.gltf"), &def, &r, &error) != VL_OK)
    fail_msg("%s", error.message);
  vlCameraRecord back = read_with(path_of("e.gltf"), NULL);
  vlCamera a = make_or_fail(&r.camera), b = make_or_fail(&back.camera);
  assert_memory_equal(&a, &b, sizeof a);
}

/* The minimal cameras of the glTF tutorial and specification's matrices: yfov 0.7, aspectRatio
 * 1; TRS nodes. */
static void test_gltf_example(void **state) {
  (void)state;
  const char *text =
      "{\"asset\":{\"version\":\"2.0\"},\"nodes\":[{\"name\":\"root\",\"children\":[1,2],"
      "\"translation\":[0,10,0]},{\"rotation\":[-0.3826834323650898,0,0,0.9238795325112867],"
      "\"translation\":[0.5,0.5,3.0],\"camera\":0},"
      "{\"name\":\"flat\",\"translation\":[0.5,0.5,3.0],\"camera\":1}],"
      "\"cameras\":[{\"type\":\"perspective\",\"perspective\":{\"aspectRatio\":1.0,"
      "\"yfov\":0.7,\"zfar\":100,\"znear\":0.01}},"
      "{\"type\":\"orthographic\",\"orthographic\":{\"xmag\":2.0,\"ymag\":1.0,\"zfar\":100,"
      "\"znear\":0.01}}]}";
  vlCameraFileDef def = vl_default_camera_file_def();
  def.width = def.height = 200;
  vlCameraRecord r = read_with(put("x.gltf", text), &def);
  assert_int_equal(r.frames, 2);
  assert_false(r.size_assumed);
  vlCamera c = make_or_fail(&r.camera);
  /* the specification's projection matrix: m11 = 1/tan(yfov/2), x = m00 X/-Z; half a turn down
   * by 45 degrees about x */
  const double deep = 4.0, up = 0.3, right = 0.2, s = sqrt(0.5);
  const double point[3] = {0.5 + right, 10.5 + s * up - s * deep, 3.0 - s * up - s * deep};
  double p[2], z;
  assert_true(vl_camera_project(&c, point, p, &z));
  assert_float_equal(z, deep, 1e-12);
  assert_float_equal(p[0], 100 + 100 / tan(0.35) * right / deep, 1e-9);
  assert_float_equal(p[1], 100 - 100 / tan(0.35) * up / deep, 1e-9);
  assert_float_equal(r.camera.near_plane, 0.01, 0);
  def.frame = "flat";
  def.width = 0;
  r = read_with(path_of("x.gltf"), &def);
  assert_true(r.size_assumed);
  assert_int_equal(r.camera.width, 1440);
  c = make_or_fail(&r.camera);
  const double corner[3] = {0.5 + 2.0, 10.5 + 1.0, -2.0};
  assert_true(vl_camera_project(&c, corner, p, &z));
  assert_float_equal(p[0], 1440, 1e-9);
  assert_float_equal(p[1], 0, 1e-9);
  /* the same as .glb: header, chunk of JSON */
  char glb[2048] = "glTF\2\0\0\0????????JSON";
  size_t n = strlen(text);
  memset(glb + 8, 0, 8);
  glb[12] = (char)(n & 255);
  glb[13] = (char)(n >> 8);
  memcpy(glb + 16, "JSON", 4);
  memcpy(glb + 20, text, n);
  r = read_with(put_bytes("x.glb", glb, 20 + n), NULL);
  assert_int_equal(r.frames, 2);
}

/* The documentation's sensor: looks from (1, 1, 1) to (1, 2, 1), (0, 0, 1) is up; fov 45
 * degrees along x. */
static void test_mitsuba_example(void **state) {
  (void)state;
  const char *text =
      "<?xml version=\"1.0\"?>\n<scene version=\"3.0.0\">\n<default name=\"w\" "
      "value=\"800\"/>\n"
      "<shape type=\"sphere\"><bsdf type=\"diffuse\"/></shape>\n<sensor type=\"perspective\" "
      "id=\"main\">\n"
      "<float name=\"fov\" value=\"45\"/><float name=\"principal_point_offset_x\" "
      "value=\"0.1\"/>\n"
      "<float name=\"principalPointOffsetY\" value=\"-0.05\"/>\n"
      "<transform name=\"to_world\"><lookat origin=\"1, 1, 1\" target=\"1, 2, 1\" up=\"0, 0, "
      "1\"/></transform>\n"
      "<film type=\"hdrfilm\"><integer name=\"width\" value=\"$w\"/><integer name=\"height\" "
      "value=\"600\"/></film>\n"
      "</sensor>\n<sensor type=\"orthographic\" id=\"flat\"><transform name=\"toWorld\"><scale "
      "x=\"10\" y=\"10\"/>\n"
      "<look_at origin=\"1 1 1\" target=\"1 2 1\" up=\"0 0 1\"/></transform></sensor></scene>";
  vlCameraRecord r = read_with(put("x.xml", text), NULL);
  assert_int_equal(r.frames, 2);
  assert_string_equal(r.name, "main");
  vlCamera c = make_or_fail(&r.camera);
  double p[2], z, f = 400 / tan(RADIANS(22.5));
  /* looking along y with z up, x is on the right */
  const double point[3] = {1.5, 5.0, 1.25};
  assert_true(vl_camera_project(&c, point, p, &z));
  assert_float_equal(z, 4.0, 1e-12);
  assert_float_equal(p[0], 800 * (0.5 - 0.1) + f * 0.5 / 4, 1e-9);
  assert_float_equal(p[1], 600 * (0.5 + 0.05) - f * 0.25 / 4, 1e-9);
  vlCameraFileDef def = vl_default_camera_file_def();
  def.frame = "flat";
  r = read_with(path_of("x.xml"), &def);
  c = make_or_fail(&r.camera);
  assert_int_equal(c.width, 768);              /* Mitsuba's own film */
  assert_float_equal(c.fx, 768 / 20.0, 1e-12); /* 20 units wide */
  const double edge[3] = {11.0, 7.0, 1.0};
  assert_true(vl_camera_project(&c, edge, p, &z));
  assert_float_equal(p[0], 768, 1e-9);
  assert_float_equal(p[1], 288, 1e-9);
  /* 50 mm without a fov: the diagonal of 36 x 24 mm */
  r = read_with(put("y.xml",
                    "<sensor type=\"perspective\"><film><integer name=\"width\" value=\"360\"/>"
                    "<integer name=\"height\" value=\"240\"/></film></sensor>"),
                NULL);
  assert_float_equal(r.camera.fx, 500, 1e-9);
  assert_float_equal(r.camera.world_from_camera[0], -1, 0); /* x left */
  assert_float_equal(r.camera.world_from_camera[10], 1, 0);
}

/* UsdGeomCamera: apertures in tenths of a unit; row vectors; rotateXYZ turns about x first. */
static void test_usd_example(void **state) {
  (void)state;
  const char *text =
      "#usda 1.0\n"
      "(\n"
      "    \"a comment\"\n"
      "    upAxis = \"Y\"\n"
      "    customLayerData = { string a = \"}\" }\n"
      ")\n"
      "def Mesh \"m\" ( prepend apiSchemas = [\"MaterialBindingAPI\"] )\n"
      "{\n"
      "    point3f[] points = [(0, 0, 0), (1, 2, 3)]\n"
      "    rel material:binding = </a/b>\n"
      "    uniform token subdivisionScheme = \"none\" ( doc = \"x\" )\n"
      "}\n"
      "def Xform \"rig\"\n"
      "{\n"
      "    double3 xformOp:translate = (1, 2, 3)\n"
      "    float3 xformOp:rotateXYZ = (0, 90, 0)\n"
      "    uniform token[] xformOpOrder = [\"xformOp:translate\", \"xformOp:rotateXYZ\"]\n"
      "\n"
      "    def Camera \"cam\"\n"
      "    {\n"
      "        float focalLength = 50\n"
      "        float horizontalAperture = 36 # mm of a cm\n"
      "        float verticalAperture = 24\n"
      "        float horizontalApertureOffset = 3.6\n"
      "        float verticalApertureOffset = 2.4\n"
      "        float2 clippingRange = (1, 10000)\n"
      "        float fStop = 2.5\n"
      "        float focusDistance = 12\n"
      "        token projection = \"perspective\"\n"
      "        matrix4d xformOp:transform = ( (1, 0, 0, 0), (0, 1, 0, 0), (0, 0, 1, 0), (0, "
      "0, 4, 1) )\n"
      "        uniform token[] xformOpOrder = [\"xformOp:transform\"]\n"
      "    }\n"
      "}\n"
      "def Scope \"Render\" { def RenderSettings \"s\" { uniform int2 resolution = (360, "
      "240) } }\n";
  vlCameraRecord r = read_with(put("x.usda", text), NULL);
  assert_string_equal(r.name, "cam");
  vlCamera c = make_or_fail(&r.camera);
  assert_float_equal(c.fx, 500, 1e-9);
  assert_float_equal(c.fy, 500, 1e-9);
  assert_float_equal(c.cx, 180 - 36, 1e-9);
  assert_float_equal(c.cy, 120 + 24, 1e-9);
  assert_float_equal(c.lens_radius, 1.0, 1e-12); /* 5 units / 2.5 / 2 */
  assert_float_equal(c.focus_distance, 12, 0);
  /* a quarter turn about y: the camera's back (z) is the world's x; 4 along it from (1, 2,
   * 3) */
  assert_float_equal(c.world_from_camera[3], 5, 1e-12);
  assert_float_equal(c.world_from_camera[7], 2, 1e-12);
  assert_float_equal(c.world_from_camera[11], 3, 1e-12);
  assert_float_equal(c.world_from_camera[2], -1, 1e-12);
}

/* clip = P V X, and the viewport's rule of each API, land on velo's pixel. */
static void test_matrices_land_on_the_pixel(void **state) {
  (void)state;
  uint64_t seed = 21;
  for (int k = 4; k < 7; k++)
    for (int n = 0; n < 50; n++) {
      vlCameraRecord r = random_camera(&seed, all[k].holds);
      r.camera.near_plane = 0.5;
      r.camera.far_plane = 50.0;
      (void)through(&r, &all[k]);
      vlCamera c = make_or_fail(&r.camera);
      FILE *file = fopen(path_of(all[k].file), "r");
      static char text[4096];
      text[fread(text, 1, sizeof text - 1, file)] = 0;
      fclose(file);
      double m[2][16], x[4] = {0, 0, 0, 1}, view[4] = {0}, clip[4] = {0}, p[2], z;
      for (int i = 0; i < 2; i++) {
        char *at = strstr(text, i ? "\"view_matrix\": [" : "\"projection_matrix\": [");
        assert_non_null(at);
        at = strchr(at, '[') + 1;
        for (int j = 0; j < 16; j++) {
          m[i][j] = strtod(at, &at);
          at += strspn(at, ", \n");
        }
      }
      double o[3], v[3], px = next_between(&seed, 0, c.width),
                         py = next_between(&seed, 0, c.height);
      assert_true(vl_camera_unproject(&c, px, py, o, v));
      for (int i = 0; i < 3; i++)
        x[i] = o[i] + 7.0 * v[i];
      assert_true(vl_camera_project(&c, x, p, &z));
      /* all three keep a column of the column form together in memory */
      for (int i = 0; i < 4; i++)
        for (int j = 0; j < 4; j++)
          view[i] += m[1][4 * j + i] * x[j];
      for (int i = 0; i < 4; i++)
        for (int j = 0; j < 4; j++)
          clip[i] += m[0][4 * j + i] * view[j];
      double ndc[3] = {clip[0] / clip[3], clip[1] / clip[3], clip[2] / clip[3]};
      bool down = all[k].dialect == VL_CAMERA_DIALECT_VULKAN,
           gl = all[k].dialect == VL_CAMERA_DIALECT_OPENGL;
      assert_float_equal((ndc[0] + 1) / 2 * c.width, p[0], 1e-7);
      assert_float_equal((down ? 1 + ndc[1] : 1 - ndc[1]) / 2 * c.height, p[1], 1e-7);
      double depth = gl ? (ndc[2] + 1) / 2 : ndc[2];
      bool flat = c.projection == VL_PROJECTION_ORTHOGRAPHIC;
      assert_float_equal(
          depth, flat ? (z - 0.5) / 49.5 : (1 / 0.5 - 1 / z) / (1 / 0.5 - 1 / 50.0), 1e-9);
    }
}

/* glm::perspective(90 degrees, 2, 1, 100) and others' usual matrices, by hand; text and rows
 * instead of lists. */
static void test_matrices_of_others(void **state) {
  (void)state;
  const char *yaml =
      "graphics_api: opengl\nwidth: 200\nheight: 100\norder: row-major\nvectors: "
      "column\nprojection_matrix:\n"
      "  0.5 0 0 0\n  0 1 0 0\n  0 0 -1.02020202020202 -2.02020202020202\n  0 0 -1 0\n"
      "view_matrix: [[1, 0, 0, 0], [0, 1, 0, 0], [0, 0, 1, -5], [0, 0, 0, 1]]\n";
  vlCameraRecord r = read_with(put("gl.yaml", yaml), NULL);
  vlCamera c = make_or_fail(&r.camera);
  assert_true(c.fx == 50 && c.fy == 50 && c.cx == 100 && c.cy == 50);
  assert_float_equal(c.near_plane, 1, 1e-9);
  assert_float_equal(c.far_plane, 100, 1e-6);
  assert_float_equal(c.world_from_camera[11], 5, 0);
  assert_float_equal(c.world_from_camera[10], -1, 0);
  /* Vulkan, y down and z forward in view space, reversed z without an end */
  r = read_with(put("vk.json",
                    "{\"graphics_api\":\"vulkan\",\"width\":200,\"height\":100,"
                    "\"order\":\"column-major\",\"vectors\":\"column\","
                    "\"projection_matrix\":[0.5,0,0,0, 0,1,0,0, 0,0,0,1, 0,0,0.1,0],"
                    "\"view_matrix\":[1,0,0,0,0,1,0,0,0,0,1,0,0,0,0,1]}"),
                NULL);
  c = make_or_fail(&r.camera);
  assert_true(c.world_from_camera[0] == 1 && c.world_from_camera[5] == 1 &&
              c.world_from_camera[10] == 1);
  assert_float_equal(c.near_plane, 0.1, 1e-15);
  assert_true(isinf(c.far_plane));
  /* Direct3D's left-handed perspective, row vectors: x right, y up, z forward; the world is
   * mirrored */
  r = read_with(
      put("dx.json",
          "{\"graphics_api\":\"d3d\",\"width\":200,\"height\":100,\"order\":\"row-major\","
          "\"vectors\":\"row\",\"projection_matrix\":[0.5,0,0,0, 0,1,0,0, 0,0,1.25,1, "
          "0,0,-1.25,0],"
          "\"view_matrix\":[1,0,0,0,0,1,0,0,0,0,1,0,0,0,5,1]}"),
      NULL);
  c = make_or_fail(&r.camera);
  assert_true(c.world_from_camera[5] == -1 && c.world_from_camera[10] == 1 &&
              c.world_from_camera[11] == -5);
  assert_float_equal(c.near_plane, 1, 1e-12);
  assert_float_equal(c.far_plane, 5, 1e-12);
}

/* UsdRender's rules for images whose aspect ratio is not that of the aperture. */
static void test_usd_conforms(void **state) {
  (void)state;
  static const char usd[] =
      "#usda 1.0\ndef Camera \"c\" {\n float focalLength = 20\n float horizontalAperture = 20\n"
      " float verticalAperture = 20\n}\ndef RenderSettings \"s\" {\n int2 resolution = (%s)\n%s}\n";
  static const struct {
    const char *size, *more;
    double fx, fy;
  } rows[] = {
      {"400, 200", "", 200, 200}, /* the aperture is made wider */
      {"200, 400", "", 200, 200}, /* or higher */
      {"400, 200", " token aspectRatioConformPolicy = \"cropAperture\"\n", 400, 400},
      {"200, 400", " token aspectRatioConformPolicy = \"cropAperture\"\n", 400, 400},
      {"400, 200", " token aspectRatioConformPolicy = \"adjustApertureWidth\"\n", 200, 200},
      {"400, 200", " token aspectRatioConformPolicy = \"adjustApertureHeight\"\n", 400, 400},
      {"400, 200", " token aspectRatioConformPolicy = \"adjustPixelAspectRatio\"\n", 400, 200},
      {"400, 200", " float pixelAspectRatio = 0.5\n", 400, 200},
      {"400, 400", " float pixelAspectRatio = 2\n", 200, 400}};
  char text[512];
  for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
    snprintf(text, sizeof text, usd, rows[i].size, rows[i].more);
    const vlCameraRecord r = read_with(put("fit.usda", text), NULL);
    assert_float_equal(r.camera.fx, rows[i].fx, 1e-9);
    assert_float_equal(r.camera.fy, rows[i].fy, 1e-9);
  }
  snprintf(text, sizeof text, usd, "4, 4", " float4 dataWindowNDC = (0, 0, 0.5, 1)\n");
  assert_non_null(strstr(refused("fit.usda", text).message, "dataWindowNDC"));
  snprintf(text, sizeof text, usd, "4, 4", " float pixelAspectRatio = -1\n");
  assert_non_null(strstr(refused("fit.usda", text).message, "pixelAspectRatio"));
  snprintf(text, sizeof text, usd, "4, 4",
           " token aspectRatioConformPolicy = \"cropApertur\"\n");
  assert_non_null(strstr(refused("fit.usda", text).message, "the nearest is \"cropAperture\""));
}

/* Written fields that a dialect lacks are refused by name; dropped, the rest is written. */
static void test_refusals(void **state) {
  (void)state;
  static const struct {
    int holds; /* who has it is not asked */
    const char *field;
  } fields[] = {{SHIFT, "cx"},
                {SKEW, "skew"},
                {LENS, "lens_radius"},
                {TIME, "shutter_close"},
                {EXPOSURE, "exposure_time"},
                {0, "projection"}};
  for (int k = 1; k < DIALECTS; k++)
    for (size_t f = 0; f < sizeof fields / sizeof *fields; f++) {
      if (all[k].holds & fields[f].holds)
        continue;
      vlCameraRecord r = {.camera = vl_default_camera_def(64, 48), .frames = 1};
      vlCameraFileDef def = vl_default_camera_file_def();
      vlError error;
      const char *drop[] = {fields[f].field};
      def.dialect = all[k].dialect;
      if (fields[f].holds == SHIFT)
        r.camera.cx = 3.0;
      if (fields[f].holds == SKEW)
        r.camera.skew = 3.0;
      if (fields[f].holds == LENS)
        r.camera.lens_radius = 0.1;
      if (fields[f].holds == TIME)
        r.camera.shutter_close = 0.5;
      if (fields[f].holds == EXPOSURE)
        r.camera.exposure_time = 2.0;
      if (!fields[f].holds) {
        r.camera.projection = VL_PROJECTION_PANINI;
        r.camera.fx = r.camera.fy = 24.0; /* the default of perspective cameras of this size */
      }
      assert_int_equal(vl_camera_write(context, path_of("r"), &def, &r, &error),
                       VL_ERROR_UNSUPPORTED);
      if (!strstr(error.message, fields[f].field))
        fail_msg("%s: %s", fields[f].field, error.message);
      def.drop = drop;
      def.drop_count = 1;
      if (vl_camera_write(context, path_of("r"), &def, &r, &error) != VL_OK)
        fail_msg("%s", error.message);
      if (all[k].dialect == VL_CAMERA_DIALECT_GLTF)
        continue; /* whose extras hold it */
      vlCameraDef plain = vl_default_camera_def(64, 48);
      vlCameraRecord back = read_with(path_of("r"), NULL);
      compare(&plain, &back.camera, 1e-12, "dropped");
    }
}

/* A file of two cameras has two, whichever is read. */
static void test_usd_counts(void **state) {
  (void)state;
  static const char usd[] = "#usda 1.0\ndef Camera \"a\" {\n}\ndef Camera \"b\" {\n}\n";
  vlCameraFileDef def = vl_default_camera_file_def();
  const vlCameraRecord first = read_with(put("two.usda", usd), &def);
  def.frame = "b";
  const vlCameraRecord second = read_with(path_of("two.usda"), &def);
  assert_int_equal(first.frames, 2);
  assert_string_equal(first.name, "a");
  assert_int_equal(second.frames, 2);
  assert_string_equal(second.name, "b");
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(test_round_trips),
      cmocka_unit_test(test_lens_and_time),
      cmocka_unit_test(test_gltf_extras),
      cmocka_unit_test(test_gltf_example),
      cmocka_unit_test(test_mitsuba_example),
      cmocka_unit_test(test_usd_example),
      cmocka_unit_test(test_matrices_land_on_the_pixel),
      cmocka_unit_test(test_matrices_of_others),
      cmocka_unit_test(test_usd_conforms),
      cmocka_unit_test(test_usd_counts),
      cmocka_unit_test(test_refusals),
  };
  return cmocka_run_group_tests(tests, files_setup, files_teardown);
}
