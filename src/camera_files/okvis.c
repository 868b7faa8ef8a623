/* camera_files/okvis.c: the cameras of OKVIS's configuration files. Camera axes: x right, y
 * down, z forward. T_SC is sensor (IMU) from camera, and the world's space is that of the
 * sensor. The first pixel's centre is (0, 0). */

#include "base/text.h"
#include "camera_files/fields.h"

static vlResult read_lens(const vlCameraFile *file, const json_t *camera, vlCameraDef *d) {
  const char *name;
  double k[8] = {0};
  uint32_t n = 0;
  VL_TRY(vl_camera_word(file, camera, "distortion_type", &name));
  if (vl_text_is(name, "none"))
    return VL_OK;
  VL_TRY(vl_camera_numbers(file, camera, "distortion_coefficients", k, 4, 8, &n));
  bool plain = vl_text_is(name, "radialtangential"),
       full = vl_text_is(name, "radialtangential8");
  bool fisheye = vl_text_is(name, "equidistant");
  if ((plain || fisheye) && n == 4) {
    fisheye ? vl_camera_set_fisheye(d, k) : vl_camera_set_opencv(d, k, n);
  } else if (full && n == 8) {
    vl_camera_set_opencv(d, k, n);
  } else {
    return vl_camera_wrong_in(
        file, camera, "distortion_type",
        "okvis: unknown distortion_type \"%s\" of %u coefficients; there are radialtangential "
        "and equidistant of 4, radialtangential8 of 8, none",
        vl_short_text(name).text, n);
  }
  return VL_OK;
}

static vlResult read_okvis(const vlCameraFile *file, const json_t *tree,
                           vlCameraRecord *record) {
  const json_t *camera = vl_camera_choose(file, json_object_get(tree, "cameras"), NULL, record);
  vlCameraDef *d = &record->camera;
  double m[16], f[2], c[2];
  if (!camera)
    return vl_camera_wrong_in(file, tree, "cameras",
                              "okvis: there is no camera \"%s\" among the %u",
                              vl_camera_asked(file, "0").text, record->frames);
  VL_TRY(VL_READ_FIELDS(file, camera, VL_FIELD_LIST("T_SC", m, 16),
                        VL_FIELD_LIST("focal_length", f, 2),
                        VL_FIELD_LIST("principal_point", c, 2)));
  VL_TRY(vl_camera_has(camera, "image_dimension")
             ? vl_camera_side_pair(file, camera, "image_dimension", record)
             : vl_camera_size_beside(file, NULL, record));
  VL_TRY(read_lens(file, camera, d));
  vl_camera_set_centred(d, f[0], f[1], c[0], c[1]);
  vl_camera_set_matrix(d, m, false);
  return VL_OK;
}

static vlResult write_okvis(const vlFittedCamera *fit, vlCameraText *text) {
  const bool full = fit->count > 4;
  const char *brown = full ? "radialtangential8" : "radialtangential";
  return VL_PUT_FORM(
      text, fit,
      "%YAML:1.0\ncameras:\n  - {T_SC: [$pose],\n     image_dimension: [$width, $height],\n"
      "     distortion_coefficients: [$k],\n     distortion_type: $lens,\n     focal_length: "
      "[$fx, "
      "$fy],\n"
      "     principal_point: [$cx0, $cy0]}\n",
      VL_VALUES("k", fit->k, full ? 8 : 4),
      VL_WORD("lens", fit->family == VL_LENS_FISHEYE ? "equidistant" : brown));
}

const vlCameraFormat vl_format_okvis = {
    .name = "okvis",
    .rotates = true,
    .marks = {"T_SC"},
    .marks_in = "cameras",
    .known =
        "cameras T_SC image_dimension distortion_coefficients distortion_type focal_length "
        "principal_point "
        /* of the estimator */
        "camera_params camera_rate imu_params estimator* detection_options imageDelay numKeyframes "
        "numImuFrames ceres_options displayImages useDriver publishing_options "
        "frontend* output_parameters",
    .read = read_okvis,
    .holds = VL_HOLDS_POSE,
    .lenses = VL_LENSES_COMMON,
    .most = 8,
    .write = write_okvis};
