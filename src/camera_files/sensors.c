/* camera_files/sensors.c: the factory calibrations of depth cameras, as JSON. Axes: x right, y
 * down, z forward; the first pixel's centre is (0, 0). DepthAI (OAK): cameraData, a list of
 * (socket, camera), OpenCV's lenses; the world is the space of the camera that points to no
 * other one, in centimetres. Azure Kinect: CalibrationInformation; numbers are shares of the
 * image's sides, which begin at (-0.5, -0.5); the world is the depth camera's space, in metres.
 * RealSense: the fields of rs2_intrinsics; no pose. */
#include <stdio.h>
#include <string.h>

#include "camera_files/fields.h"
#include "math/transform.h"

static vlMat4 rigid(const double r[9], const double t[3]) {
  vlMat4 m = vl_mat4_identity();
  for (int i = 0; i < 9; i++)
    m.m[4 * (i / 3) + i % 3] = r[i];
  for (int i = 0; i < 3; i++)
    m.m[4 * i + 3] = t[i];
  return m;
}

/* ---- DepthAI ----------------------------------------------------------------------------- */

static const json_t *depthai_camera(const json_t *list, double socket) {
  const json_t *pair;
  VL_EACH(pair, list) {
    const json_t *own = json_array_get(pair, 0);
    if (json_is_number(own) && json_number_value(own) == socket)
      return json_array_get(pair, 1);
  }
  return NULL;
}

/* Follows extrinsics.toCameraSocket: the camera's space to that of the next one. */
static vlResult depthai_pose(const vlCameraFile *file, const json_t *list, const json_t *camera,
                             vlMat4 *world) {
  *world = vl_mat4_identity();
  for (int steps = 0; camera && steps < 16; steps++) {
    const json_t *extrinsics = json_object_get(camera, "extrinsics"),
                 *shift = json_object_get(extrinsics, "translation");
    double socket = -1.0, r[9], t[3] = {0.0};
    VL_TRY(vl_camera_optional(file, extrinsics, "toCameraSocket", &socket));
    if (socket < 0.0)
      return VL_OK;
    VL_TRY(vl_camera_list(file, extrinsics, "rotationMatrix", r, 9));
    VL_TRY(VL_READ_FIELDS(file, shift, VL_FIELD("x", &t[0]), VL_FIELD("y", &t[1]),
                          VL_FIELD("z", &t[2])));
    *world = vl_mat4_multiply(rigid(r, t), *world);
    camera = depthai_camera(list, socket);
  }
  return camera ? vl_camera_wrong(file, "depthai: the sockets of \"extrinsics\" go in a circle")
                : VL_OK;
}

static vlResult read_depthai(const vlCameraFile *file, const json_t *tree,
                             vlCameraRecord *record) {
  const json_t *list = json_object_get(tree, "cameraData"), *pair, *camera = NULL;
  vlCameraDef *d = &record->camera;
  double k[9], lens[14] = {0.0}, type = 0.0;
  uint32_t count = 0;
  vlMat4 world;
  record->frames = 0;
  VL_EACH(pair, list) {
    const json_t *one = json_array_get(pair, 1);
    char name[32];
    if (json_number_value(json_object_get(one, "width")) < 1.0)
      continue; /* a socket that is not used */
    snprintf(name, sizeof name, "socket%g", json_number_value(json_array_get(pair, 0)));
    vl_camera_offer(file, one, name, record, &camera);
  }
  if (!camera)
    return vl_camera_no_frame(file, "camera", record);
  VL_TRY(VL_READ_FIELDS(file, camera, VL_FIELD_SIDE("width", &d->width),
                        VL_FIELD_SIDE("height", &d->height),
                        VL_FIELD_LIST("intrinsicMatrix", k, 9),
                        VL_FIELD_LIST_OPTIONAL("distortionCoeff", lens, 14, &count),
                        VL_FIELD_OPTIONAL("cameraType", &type)));
  VL_TRY(vl_camera_set_k(file, camera, "intrinsicMatrix", k, d));
  VL_TRY(depthai_pose(file, list, camera, &world));
  if (type != 0.0 && type != 1.0)
    return vl_camera_wrong_in(file, camera, "cameraType",
                              "depthai: \"cameraType\" %g is no model of velo; there are 0 "
                              "(perspective), 1 (fisheye)",
                              type);
  if (type == 1.0)
    vl_camera_set_fisheye(d, lens);
  else
    vl_camera_set_shortest(d, lens, count);
  vl_camera_set_matrix(d, world.m, false);
  return VL_OK;
}

static bool is_depthai(const json_t *tree) {
  const json_t *first = json_array_get(json_object_get(tree, "cameraData"), 0);
  return vl_camera_has(json_array_get(first, 1), "intrinsicMatrix");
}

const vlCameraFormat vl_format_depthai = {
    .name = "depthai",
    .rotates = true,
    .known =
        "cameraData cameraType distortionCoeff extrinsics rotationMatrix translation "
        "specTranslation x y z toCameraSocket height width intrinsicMatrix lensPosition "
        "specHfovDeg imuExtrinsics! stereoRectificationData! stereoEnableDistortionCorrection "
        "stereoUseSpecTranslation housingExtrinsics! miscellaneousData! batchName batchTime "
        "boardConf boardCustom boardName boardOptions boardRev hardwareConf productName "
        "deviceName version verticalCameraSocket eepromDataVersion",
    .is_tree = is_depthai,
    .read = read_depthai,
    .not_written = "it is the factory calibration of a device"};

/* ---- Azure Kinect ------------------------------------------------------------------------ */

static vlResult read_kinect(const vlCameraFile *file, const json_t *tree,
                            vlCameraRecord *record) {
  const json_t *list =
                   json_object_get(json_object_get(tree, "CalibrationInformation"), "Cameras"),
               *one, *camera = NULL;
  vlCameraDef *d = &record->camera;
  double v[14], r[9], t[3];
  record->frames = 0;
  VL_EACH(one, list) {
    const char *name = vl_camera_text(one, "Location");
    if (name && strncmp(name, "CALIBRATION_CameraLocation", 26) == 0)
      name += 26; /* D0, PV0 */
    vl_camera_offer(file, one, name, record, &camera);
  }
  if (!camera)
    return vl_camera_no_frame(file, "camera", record);
  const json_t *intrinsics, *pose;
  VL_TRY(VL_READ_FIELDS(file, camera, VL_FIELD_SIDE("SensorWidth", &d->width),
                        VL_FIELD_SIDE("SensorHeight", &d->height)));
  VL_TRY(vl_camera_field(file, camera, "Intrinsics", &intrinsics));
  VL_TRY(vl_camera_field(file, camera, "Rt", &pose));
  VL_TRY(vl_camera_list(file, intrinsics, "ModelParameters", v, 14));
  VL_TRY(VL_READ_FIELDS(file, pose, VL_FIELD_LIST("Rotation", r, 9),
                        VL_FIELD_LIST("Translation", t, 3)));
  const char *model = vl_camera_text(intrinsics, "ModelType");
  if (model && !strstr(model, "BrownConrady"))
    return vl_camera_unknown(file, intrinsics, "ModelType", model, "there is BrownConrady");
  if (!vl_camera_all_zero(v + 10, 2))
    return vl_camera_wrong_in(file, intrinsics, "ModelParameters",
                              "kinect: the centre of the distortion must be 0, 0");
  d->cx = v[0] * d->width;
  d->cy = v[1] * d->height;
  d->fx = v[2] * d->width;
  d->fy = v[3] * d->height;
  vl_camera_set_shortest(d, (double[]){v[4], v[5], v[13], v[12], v[6], v[7], v[8], v[9]}, 8);
  vl_camera_set_pose(d, r, t);
  return VL_OK;
}

static bool is_kinect(const json_t *tree) {
  return vl_camera_has(json_object_get(tree, "CalibrationInformation"), "Cameras");
}

const vlCameraFormat vl_format_kinect = {
    .name = "kinect",
    .rotates = true,
    .known =
        "CalibrationInformation Cameras Intrinsics ModelParameterCount ModelParameters "
        "ModelType Location Purpose MetricRadius Rt Rotation Translation SensorHeight "
        "SensorWidth Shutter SupportedUV ThermalAdjustmentParams! InertialSensors! Metadata! "
        "CALIBRATION_*",
    .is_tree = is_kinect,
    .read = read_kinect,
    .not_written = "it is the factory calibration of a device"};

/* ---- RealSense --------------------------------------------------------------------------- */

static bool is_stream(const json_t *object) {
  return vl_camera_has(object, "ppx") && vl_camera_has(object, "ppy") &&
         vl_camera_has(object, "fx");
}

static vlResult read_stream(const vlCameraFile *file, const json_t *stream,
                            vlCameraRecord *record) {
  vlCameraDef *d = &record->camera;
  double f[4], k[5] = {0.0};
  uint32_t count = 0;
  const char *model = vl_camera_text(stream, "model");
  VL_TRY(vl_camera_sides(file, stream, "width", "height", record));
  VL_TRY(VL_READ_FIELDS(file, stream, VL_FIELD("fx", &f[0]), VL_FIELD("fy", &f[1]),
                        VL_FIELD("ppx", &f[2]), VL_FIELD("ppy", &f[3]),
                        VL_FIELD_LIST_OPTIONAL("coeffs", k, 5, &count)));
  vl_camera_set_centred(d, f);
  vl_camera_set_origin(d);
  char lower[64] = "";
  for (size_t i = 0; model && model[i] && i < sizeof lower - 1; i++)
    lower[i] = model[i] == ' '
                   ? '_'
                   : (char)(model[i] >= 'A' && model[i] <= 'Z' ? model[i] + 32 : model[i]);
  /* without coefficients the models of fisheyes are fisheyes */
  const bool fisheye = strstr(lower, "kannala") || strstr(lower, "theta");
  if (vl_camera_all_zero(k, 5) && !fisheye)
    return VL_OK;
  if (strstr(lower, "kannala")) {
    vl_camera_set_fisheye(d, k);
  } else if (strstr(lower, "brown") && !strstr(lower, "inverse") &&
             (!strstr(lower, "modified") || vl_camera_all_zero(k + 2, 2))) {
    vl_camera_set_shortest(d, k, 5);
  } else {
    return vl_camera_wrong_in(
        file, stream, vl_camera_has(stream, "model") ? "model" : "coeffs",
        "realsense: the model \"%s\" with these \"coeffs\" is none of velo; there are Brown "
        "Conrady and Kannala Brandt",
        vl_short_text(model ? model : "").text);
  }
  return VL_OK;
}

/* One stream, or an object with several by name. */
static vlResult read_realsense(const vlCameraFile *file, const json_t *tree,
                               vlCameraRecord *record) {
  const json_t *chosen = NULL;
  const char *name;
  json_t *stream;
  if (is_stream(tree))
    return read_stream(file, tree, record);
  record->frames = 0;
  json_object_foreach((json_t *)tree, name, stream) {
    if (is_stream(stream))
      vl_camera_offer(file, stream, name, record, &chosen);
  }
  return chosen ? read_stream(file, chosen, record)
                : vl_camera_no_frame(file, "camera", record);
}

static bool is_realsense(const json_t *tree) {
  const char *name;
  json_t *stream;
  if (is_stream(tree))
    return true;
  json_object_foreach((json_t *)tree, name, stream) if (is_stream(stream)) return true;
  return false;
}

const vlCameraFormat vl_format_realsense = {
    .name = "realsense",
    .known = "/ width height fx fy ppx ppy model coeffs",

    .is_tree = is_realsense,
    .read = read_realsense,
    .lenses = {VL_LENSES_COMMON, 5, 5},
    .lens_words = {"brown_conrady", "brown_conrady", "kannala_brandt4"},
    .form =
        "{\n"
        "  \"width\": $width, \"height\": $height,\n"
        "  \"ppx\": $cx0, \"ppy\": $cy0,\n"
        "  \"fx\": $fx, \"fy\": $fy,\n"
        "  \"model\": \"distortion.$lens\",\n"
        "  \"coeffs\": [$k]\n"
        "}\n"};
