/* camera_files/okvis.c: the cameras of OKVIS's configuration files. Camera axes: x right, y
 * down, z forward. T_SC is sensor (IMU) from camera, and the world's space is that of the
 * sensor. The first pixel's centre is (0, 0). */

#include "camera_files/fields.h"

static const vlLensName lenses[] = {{"radialtangential", VL_LENS_OPENCV, 4, 4},
                                    {"radialtangential8", VL_LENS_OPENCV, 8, 8},
                                    {"equidistant", VL_LENS_FISHEYE, 4, 4},
                                    {0}};

static vlResult read_okvis(const vlCameraFile *file, const json_t *tree,
                           vlCameraRecord *record) {
  const json_t *camera = vl_camera_choose(file, json_object_get(tree, "cameras"), NULL, record);
  vlCameraDef *d = &record->camera;
  double m[16], f[4];
  const json_t *name;
  if (!camera)
    return vl_camera_none_in(file, tree, "cameras", "camera", record);
  VL_TRY(VL_READ_FIELDS(file, camera, VL_FIELD_LIST("T_SC", m, 16),
                        VL_FIELD_LIST("focal_length", f, 2),
                        VL_FIELD_LIST("principal_point", f + 2, 2)));
  VL_TRY(vl_camera_size_pair(file, camera, "image_dimension", record));
  VL_TRY(vl_camera_field(file, camera, "distortion_type", &name));
  VL_TRY(vl_camera_read_lens(file, camera, "distortion_type", "distortion_coefficients", lenses,
                             "distortion_type",
                             "there are radialtangential and equidistant of 4, "
                             "radialtangential8 of 8, none",
                             d));
  vl_camera_set_centred(d, f);
  vl_camera_set_matrix(d, m, false);
  return VL_OK;
}

static vlResult write_okvis(const vlFittedCamera *fit, vlCameraText *text) {
  const bool full = fit->count > 4;
  const char *brown = full ? "radialtangential8" : "radialtangential";
  return VL_PUT_FORM(text, fit,
                     "%YAML:1.0\n"
                     "cameras:\n"
                     "  - {T_SC: [$pose],\n"
                     "     image_dimension: [$width, $height],\n"
                     "     distortion_coefficients: [$k],\n"
                     "     distortion_type: $lens,\n"
                     "     focal_length: [$fx, $fy],\n"
                     "     principal_point: [$cx0, $cy0]}\n",
                     VL_VALUES("k", fit->k, full ? 8 : 4),
                     VL_WORD("lens", fit->family == VL_LENS_FISHEYE ? "equidistant" : brown));
}

const vlCameraFormat vl_format_okvis = {
    .name = "okvis",
    .rotates = true,
    .marks = "T_SC",
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
    .lenses = {VL_LENSES_COMMON, 0, 8},
    .write = write_okvis};
