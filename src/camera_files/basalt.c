/* camera_files/basalt.c: Basalt's calibration JSON. value0 holds T_imu_cam (IMU from camera: px
 * py pz, qx qy qz qw), intrinsics and resolution. Camera axes: x right, y down, z forward. The
 * world's space is that of the IMU. The first pixel's centre is (0, 0). */

#include "base/text.h"
#include "camera_files/fields.h"

typedef struct {
  const char *name;
  vlLensFamily family;
  const char *shapes[2], *lens[8]; /* in OpenCV's order */
} Model;

static const Model models[] = {{"pinhole", VL_LENS_PINHOLE, {NULL}, {NULL}},
                               {"kb4", VL_LENS_FISHEYE, {NULL}, {"k1", "k2", "k3", "k4"}},
                               {"ds", VL_LENS_DOUBLE_SPHERE, {"xi", "alpha"}, {NULL}},
                               {"eucm", VL_LENS_EUCM, {"alpha", "beta"}, {NULL}},
                               {"ucm", VL_LENS_EUCM, {"alpha", NULL}, {NULL}}, /* beta is 1 */
                               {"fov", VL_LENS_FOV, {NULL}, {"w"}},
                               {"pinhole-radtan8",
                                VL_LENS_OPENCV,
                                {NULL},
                                {"k1", "k2", "p1", "p2", "k3", "k4", "k5", "k6"}}};
enum { MODELS = VL_LENGTH(models) };

static vlResult read_model(const vlCameraFile *file, const json_t *camera, vlCameraDef *d) {
  const json_t *values;
  const char *name;
  double f[4], k[8] = {0.0};
  VL_TRY(vl_camera_word(file, camera, "camera_type", &name));
  VL_TRY(vl_camera_field(file, camera, "intrinsics", &values));
  const Model *model = VL_CAMERA_ROW(models, name);
  if (!model)
    return vl_camera_unknown(file, camera, "camera_type", name,
                             "there are pinhole, pinhole-radtan8, kb4, ds, eucm, ucm, fov");
  VL_TRY(vl_camera_read_named(file, values, vl_camera_matrix_names, 4, false, f));
  VL_TRY(vl_camera_read_named(file, values, model->shapes, 2, false, d->shape));
  VL_TRY(vl_camera_read_named(file, values, model->lens, 8, false, k));
  vl_camera_set_centred(d, f);
  vl_camera_set_lens(d, model->family, k, 8);
  if (model->family == VL_LENS_EUCM && !model->shapes[1])
    d->shape[1] = 1.0;
  return VL_OK;
}

static vlResult read_pose(const vlCameraFile *file, const json_t *pose, vlCameraDef *d) {
  static const char *const names[] = {"px", "py", "pz", "qw", "qx", "qy", "qz"};
  double v[7], r[9];
  VL_TRY(vl_camera_read_named(file, pose, names, 7, false, v));
  if (!vl_rotation_from_quaternion(v + 3, r))
    return vl_camera_wrong_in(file, pose, "qw", "basalt: the quaternion of T_imu_cam is zero");
  vl_camera_set_rigid(d, r, v);
  return VL_OK;
}

static vlResult read_basalt(const vlCameraFile *file, const json_t *tree,
                            vlCameraRecord *record) {
  const json_t *root, *cameras;
  vlCameraDef *d = &record->camera;
  double size[2];
  VL_TRY(vl_camera_field(file, tree, "value0", &root));
  VL_TRY(vl_camera_field(file, root, "intrinsics", &cameras));
  const json_t *camera = vl_camera_choose(file, cameras, NULL, record);
  if (!camera)
    return vl_camera_none_in(file, root, "intrinsics", "camera", record);
  size_t index = 0;
  while (json_array_get(cameras, index) != camera)
    index++;
  const json_t *pose = json_array_get(json_object_get(root, "T_imu_cam"), index);
  const json_t *pair = json_array_get(json_object_get(root, "resolution"), index);
  VL_TRY(read_model(file, camera, d));
  vl_camera_set_origin(d);
  if (pose)
    VL_TRY(read_pose(file, pose, d));
  if (!pair)
    return vl_camera_size_beside(file, NULL, record);
  for (size_t i = 0; i < 2; i++)
    size[i] = json_number_value(json_array_get(pair, i));
  if (!vl_camera_set_sides(d, size))
    return vl_camera_wrong_in(file, pair, NULL,
                              "basalt: \"resolution\" must be two whole numbers of pixels");
  return VL_OK;
}

static vlResult write_basalt(const vlFittedCamera *fit, vlCameraText *text) {
  const vlCamera *c = &fit->camera;
  double r[9], q[4];
  const Model *model = NULL;
  for (int i = 0; i < MODELS; i++)
    if (models[i].family == fit->family && !model)
      model = &models[i];
  if (!model || fit->count > 8)
    return vl_camera_no_model(fit->file, &fit->record->camera);
  for (int i = 0; i < 9; i++)
    r[i] = c->world_from_camera[4 * (i / 3) + i % 3];
  vl_rotation_to_quaternion(r, q);
  return VL_PUT_FORM(
      text, fit,
      "{\n"
      "  \"value0\": {\n"
      "    \"T_imu_cam\": [\n"
      "      {\"px\": $centre@0, \"py\": $centre@1, \"pz\": $centre@2, \"qx\": $q@1, "
      "\"qy\": $q@2, \"qz\": $q@3, \"qw\": $q@0}\n"
      "    ],\n"
      "    \"intrinsics\": [\n"
      "      {\"camera_type\": \"$type\", \"intrinsics\": {"
      "\"fx\": $fx, \"fy\": $fy, \"cx\": $cx0, \"cy\": $cy0$shapes$lens$limit}}\n"
      "    ],\n"
      "    \"resolution\": [[$width, $height]]\n"
      "  }\n"
      "}\n",
      VL_WORD("type", model->name), VL_VALUES("q", q, 4),
      VL_NAMED("shapes", model->shapes, c->shape, 2, ", \"$item\": $value"),
      VL_NAMED("lens", model->lens, fit->k, 8, ", \"$item\": $value"),
      VL_PART("limit", fit->family == VL_LENS_OPENCV, ", \"rpmax\": 0"));
}

const vlCameraFormat vl_format_basalt = {
    .name = "basalt",
    .rotates = true,
    .marks = "intrinsics",
    .marks_in = "value0",
    .known =
        "value0 T_imu_cam px py pz qx qy qz qw w x y z intrinsics camera_type fx fy cx cy k1 k2 k3 "
        "k4 k5 k6 p1 p2 xi alpha beta rpmax resolution "
        /* of the IMU, of brightness and of clocks */
        "calib_accel_bias calib_gyro_bias imu_update_rate accel_noise_std gyro_noise_std "
        "accel_bias_std gyro_bias_std cam_time_offset_ns T_mocap_world T_imu_marker "
        "mocap_time_offset_ns mocap_to_imu_offset_ns vignette view_offset",
    .read = read_basalt,
    .holds = VL_HOLDS_POSE,
    .write = write_basalt};
