/* camera_files/euroc.c: sensor.yaml of the EuRoC datasets (ASL's format). Camera axes: x right,
 * y down, z forward. T_BS is body (IMU) from camera, and the world's space is that of the body.
 * The first pixel's centre is (0, 0). */

#include "base/text.h"
#include "camera_files/fields.h"

static const vlLensName lenses[] = {{"radial-tangential", VL_LENS_OPENCV, 4, 5},
                                    {"radtan", VL_LENS_OPENCV, 4, 5},
                                    {"equidistant", VL_LENS_FISHEYE, 4, 4},
                                    {0}};

static vlResult read_euroc(const vlCameraFile *file, const json_t *tree,
                           vlCameraRecord *record) {
  vlCameraDef *d = &record->camera;
  double f[4], pose[16];
  const char *model = vl_camera_text(tree, "camera_model"),
             *sensor = vl_camera_text(tree, "sensor_type");
  if (sensor && !vl_text_is(sensor, "camera"))
    return vl_camera_wrong_in(file, tree, "sensor_type",
                              "euroc: the sensor is \"%s\", no camera",
                              vl_short_text(sensor).text);
  if (model && !vl_text_is(model, "pinhole"))
    return vl_camera_unknown(file, tree, "camera_model", model, "there is pinhole");
  VL_TRY(VL_READ_FIELDS(file, tree, VL_FIELD_LIST("intrinsics", f, 4),
                        VL_FIELD_LIST("T_BS", pose, 16)));
  VL_TRY(vl_camera_size_pair(file, tree, "resolution", record));
  if (vl_camera_has(tree, "distortion_model"))
    VL_TRY(vl_camera_read_lens(file, tree, "distortion_model", "distortion_coefficients",
                               lenses, "distortion_model",
                               "there are radial-tangential, equidistant, none", d));
  vl_camera_set_centred(d, f);
  vl_camera_set_matrix(d, pose, false);
  vl_camera_name(record, vl_camera_text(tree, "comment"));
  return VL_OK;
}

const vlCameraFormat vl_format_euroc = {
    .name = "euroc",
    .rotates = true,
    .marks = "T_BS sensor_type",
    .one_mark = true,
    .known =
        "sensor_type comment T_BS cols rows data resolution camera_model intrinsics "
        "distortion_model distortion_coefficients rate_hz",
    .read = read_euroc,
    .holds = VL_HOLDS_POSE,
    .lenses = {VL_LENSES_COMMON, 4, 5},
    .lens_words = {"radial-tangential", "radial-tangential", "equidistant"},
    .form =
        "sensor_type: camera\n"
        "comment: $name\n"
        "T_BS:\n"
        "  cols: 4\n"
        "  rows: 4\n"
        "  data: [$pose]\n"
        "resolution: [$width, $height]\n"
        "camera_model: pinhole\n"
        "intrinsics: [$fx, $fy, $cx0, $cy0]\n"
        "distortion_model: $lens\n"
        "distortion_coefficients: [$k]\n"};
