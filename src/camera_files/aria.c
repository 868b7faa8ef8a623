/* camera_files/aria.c: the calibration of Project Aria's glasses, as JSON (the factory's, and
 * one line of online_calibration.jsonl): CameraCalibrations, each with Label, Projection (Name,
 * Params) and T_Device_Camera, device from camera (Translation; UnitQuaternion: w, [x, y, z]).
 * Camera axes: x right, y down, z forward; the world's space is the device's. The first pixel's
 * centre is (0, 0) ("Camera Intrinsic Models" and "2D Image Coordinate System Conventions" of
 * Project Aria's documentation). */

#include "base/text.h"
#include "camera_files/fields.h"
#include "velo/distortion.h"
#include "velo/projection.h"

typedef struct {
  const char *name;
  vlProjection projection;
  vlDistortion distortion;
  uint32_t coefficients;
} Model;

static const Model models[] = {
    {"Linear", VL_PROJECTION_PERSPECTIVE, VL_DISTORTION_NONE, 0},
    {"Spherical", VL_PROJECTION_EQUIDISTANT, VL_DISTORTION_NONE, 0},
    {"KannalaBrandtK3", VL_PROJECTION_EQUIDISTANT, VL_DISTORTION_RADIAL, 4},
    {"FisheyeRadTanThinPrism", VL_PROJECTION_EQUIDISTANT, VL_DISTORTION_RAD_TAN_THIN_PRISM, 12},
    {"Fisheye624", VL_PROJECTION_EQUIDISTANT, VL_DISTORTION_RAD_TAN_THIN_PRISM, 12}};

/* The parameters are fx, fy, cx, cy, or f, cx, cy; then the coefficients. */
static vlResult read_projection(const vlCameraFile *file, const json_t *camera,
                                vlCameraDef *d) {
  const json_t *projection, *name;
  double p[16];
  uint32_t count = 0;
  VL_TRY(vl_camera_field(file, camera, "Projection", &projection));
  VL_TRY(vl_camera_field(file, projection, "Name", &name));
  VL_TRY(vl_camera_numbers(file, projection, "Params", p, 0, VL_LENGTH(p), &count));
  const Model *model = VL_CAMERA_ROW(models, json_string_value(name));
  if (!model)
    return vl_camera_unknown(file, projection, "Name", json_string_value(name),
                             "there are Linear, Spherical, KannalaBrandtK3, "
                             "FisheyeRadTanThinPrism");
  const uint32_t first = count - model->coefficients;
  if (count < model->coefficients || first < 3 || first > 4)
    return vl_camera_wrong_in(file, projection, "Params",
                              "aria: \"Params\" of %s holds %u numbers; it must hold %u or %u",
                              model->name, count, model->coefficients + 3,
                              model->coefficients + 4);
  vl_camera_set_centred(d, (double[]){p[0], p[first - 3], p[first - 2], p[first - 1]});
  d->projection = model->projection;
  d->distortion = model->distortion;
  d->distortion_count = model->coefficients;
  memcpy(d->distortion_coefficients, p + first, model->coefficients * sizeof *p);
  return VL_OK;
}

static vlResult read_pose(const vlCameraFile *file, const json_t *camera, vlCameraDef *d) {
  const json_t *pose;
  double t[3], q[4], r[9];
  VL_TRY(vl_camera_field(file, camera, "T_Device_Camera", &pose));
  VL_TRY(vl_camera_list(file, pose, "Translation", t, 3));
  VL_TRY(vl_camera_list(file, pose, "UnitQuaternion", q, 4));
  if (!vl_rotation_from_quaternion(q, r))
    return vl_camera_wrong_in(file, pose, "UnitQuaternion",
                              "aria: the quaternion \"UnitQuaternion\" is zero");
  vl_camera_set_rigid(d, r, t);
  return VL_OK;
}

/* The size of camera `index` is in the list ImageSizes; the factory's calibration has none. It
 * is that of the sensor, and a smaller image has other numbers. */
static vlResult read_size(const vlCameraFile *file, const json_t *tree, uint32_t index,
                          vlCameraRecord *record) {
  vlCameraDef *d = &record->camera;
  const json_t *sizes = json_object_get(tree, "ImageSizes"), *pair;
  double size[2] = {0.0, 0.0};
  if (!sizes) {
    VL_TRY(vl_camera_size_beside(file, NULL, record));
  } else {
    pair = json_array_get(sizes, index);
    for (size_t i = 0; i < 2; i++)
      size[i] = json_number_value(json_array_get(pair, i));
    if (json_array_size(sizes) != record->frames || !vl_camera_set_sides(d, size))
      return vl_camera_wrong_in(
          file, tree, "ImageSizes",
          "aria: \"ImageSizes\" must hold two whole numbers of pixels for each camera");
  }
  if (d->cx > 0.0 && d->cy > 0.0 && d->cx < d->width && d->cy < d->height)
    return VL_OK;
  return vl_camera_wrong_in(file, tree, "CameraCalibrations",
                            "aria: the axis %g, %g lies outside the image of %u x %u: the "
                            "numbers are those of another size",
                            d->cx - 0.5, d->cy - 0.5, d->width, d->height);
}

static vlResult read_aria(const vlCameraFile *file, const json_t *tree,
                          vlCameraRecord *record) {
  const json_t *list = json_object_get(tree, "CameraCalibrations");
  const json_t *camera = vl_camera_choose(file, list, "Label", record);
  if (!camera)
    return vl_camera_no_frame(file, "camera", record);
  uint32_t index = 0;
  while (json_array_get(list, index) != camera)
    index++;
  if (json_is_false(json_object_get(camera, "Calibrated")))
    return vl_camera_wrong_in(file, camera, "Calibrated", "aria: the camera is not calibrated");
  VL_TRY(read_projection(file, camera, &record->camera));
  VL_TRY(read_pose(file, camera, &record->camera));
  return read_size(file, tree, index, record);
}

const vlCameraFormat vl_format_aria = {
    .name = "aria",
    .rotates = true,
    .marks = "CameraCalibrations",
    .known =
        "ImageSizes Label Calibrated Projection Name Params Description T_Device_Camera "
        "Translation UnitQuaternion SerialNumber "
        /* of other sensors, of time, of the device */
        "ImuCalibrations Gyroscope Accelerometer Bias Model Offset RectificationMatrix "
        "GSensitivityMatrix T_Device_Imu TimeOffset* MagnetometerCalibrations "
        "BarometerCalibrations MicCalibrations MicrophoneCalibrations Slope OffsetPa "
        "DSensitivity1KDbv T_Device_* OriginSpecification ChildLabel Pose DeviceClassInfo "
        "BuildVersion DeviceClass tracking_timestamp_us utc_timestamp_ns TimeSyncMode",
    .read = read_aria,
    .not_written = "it is the calibration of a device, with its other sensors"};
