/* camera_files/euroc.c: sensor.yaml of the EuRoC datasets (ASL's format). Camera axes: x right,
 * y down, z forward. T_BS is body (IMU) from camera, and the world's space is that of the body.
 * The first pixel's centre is (0, 0). */

#include "base/text.h"
#include "camera_files/fields.h"

/* Sets the distortion: 4 or 5 coefficients, by the name of their model. */
static vlResult read_lens(const vlCameraFile *file, const json_t *tree, vlCameraDef *d) {
  double k[5];
  uint32_t n = 0;
  const char *model = vl_camera_text(tree, "distortion_model");
  if (!vl_camera_has(tree, "distortion_model") || vl_text_is(model, "none"))
    return VL_OK;
  VL_TRY(vl_camera_numbers(file, tree, "distortion_coefficients", k, 4, 5, &n));
  if (model && (vl_text_is(model, "radial-tangential") || vl_text_is(model, "radtan"))) {
    vl_camera_set_opencv(d, k, n);
  } else if (vl_text_is(model, "equidistant") && n == 4) {
    vl_camera_set_fisheye(d, k);
  } else {
    return vl_camera_wrong_in(
        file, tree, "distortion_model",
        "euroc: unknown distortion_model \"%s\" of %u coefficients; there are "
        "radial-tangential, equidistant, none",
        vl_short_text(model).text, n);
  }
  return VL_OK;
}

static vlResult read_euroc(const vlCameraFile *file, const json_t *tree,
                           vlCameraRecord *record) {
  vlCameraDef *d = &record->camera;
  double intrinsics[4], pose[16];
  const char *model = vl_camera_text(tree, "camera_model"),
             *sensor = vl_camera_text(tree, "sensor_type");
  if (sensor && !vl_text_is(sensor, "camera"))
    return vl_camera_wrong_in(file, tree, "sensor_type",
                              "euroc: the sensor is \"%s\", no camera",
                              vl_short_text(sensor).text);
  if (model && !vl_text_is(model, "pinhole"))
    return vl_camera_unknown(file, tree, "camera_model", model, "there is pinhole");
  VL_TRY(VL_READ_FIELDS(file, tree, VL_FIELD_LIST("intrinsics", intrinsics, 4),
                        VL_FIELD_LIST("T_BS", pose, 16)));
  VL_TRY(vl_camera_has(tree, "resolution")
             ? vl_camera_side_pair(file, tree, "resolution", record)
             : vl_camera_size_beside(file, NULL, record));
  VL_TRY(read_lens(file, tree, d));
  vl_camera_set_centred(d, intrinsics[0], intrinsics[1], intrinsics[2], intrinsics[3]);
  vl_camera_set_matrix(d, pose, false);
  vl_camera_name(record, vl_camera_text(tree, "comment"));
  return VL_OK;
}

const vlCameraFormat vl_format_euroc = {
    .name = "euroc",
    .rotates = true,
    .marks = {"T_BS", "sensor_type"},
    .one_mark = true,
    .known =
        "sensor_type comment T_BS cols rows data resolution camera_model intrinsics "
        "distortion_model distortion_coefficients rate_hz",
    .read = read_euroc,
    .holds = VL_HOLDS_POSE,
    .lenses = VL_LENSES_COMMON,
    .least = 4,
    .most = 5,
    .lens_words = {"radial-tangential", "radial-tangential", "equidistant"},
    .form =
        "sensor_type: camera\ncomment: $name\nT_BS:\n  cols: 4\n  rows: 4\n  data: [$pose]\n"
        "resolution: [$width, $height]\ncamera_model: pinhole\nintrinsics: [$fx, $fy, $cx0, "
        "$cy0]\n"
        "distortion_model: $lens\ndistortion_coefficients: [$k]\n"};
