/* camera_files/basalt.c: Basalt's calibration JSON. value0 holds T_imu_cam (IMU from camera: px
 * py pz, qx qy qz qw), intrinsics and resolution. Camera axes: x right, y down, z forward. The
 * world's space is that of the IMU. The first pixel's centre is (0, 0). */

#include "base/text.h"
#include "camera_files/fields.h"
#include "velo/projection.h"

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
                               {"fov", VL_LENS_FOV, {"w", NULL}, {NULL}},
                               {"pinhole-radtan8",
                                VL_LENS_OPENCV,
                                {NULL},
                                {"k1", "k2", "p1", "p2", "k3", "k4", "k5", "k6"}}};
enum { MODELS = VL_LENGTH(models) };

static vlResult read_model(const vlCameraFile *file, const json_t *camera, vlCameraDef *d) {
  const json_t *values;
  const char *name;
  double f[4], k[8];
  vlResult result = vl_camera_word(file, camera, "camera_type", &name);
  if (result == VL_OK)
    result = vl_camera_field(file, camera, "intrinsics", &values);
  if (result != VL_OK)
    return result;
  const Model *model = NULL;
  for (int i = 0; i < MODELS; i++)
    if (vl_text_is(name, models[i].name))
      model = &models[i];
  if (!model)
    return vl_camera_unknown(file, camera, "camera_type", name,
                             "there are pinhole, pinhole-radtan8, kb4, ds, eucm, ucm, fov");
  if (result == VL_OK)
    result = vl_camera_read_named(file, values, vl_camera_matrix_names, 4, false, f);
  for (int i = 0; i < 2 && model->shapes[i] && result == VL_OK; i++)
    result = vl_camera_number(file, values, model->shapes[i], &d->shape[i]);
  uint32_t count = 0;
  while (count < 8 && model->lens[count] && result == VL_OK) {
    result = vl_camera_number(file, values, model->lens[count], &k[count]);
    count++;
  }
  if (result != VL_OK)
    return result;
  vl_camera_set_centred(d, f[0], f[1], f[2], f[3]);
  if (model->family == VL_LENS_OPENCV)
    vl_camera_set_opencv(d, k, count);
  if (model->family == VL_LENS_FISHEYE)
    vl_camera_set_fisheye(d, k);
  if (model->family == VL_LENS_DOUBLE_SPHERE)
    d->projection = VL_PROJECTION_DOUBLE_SPHERE;
  if (model->family == VL_LENS_FOV)
    d->projection = VL_PROJECTION_FOV;
  if (model->family == VL_LENS_EUCM)
    d->projection = VL_PROJECTION_EUCM;
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
  const json_t *root, *cameras, *poses = NULL, *sizes = NULL;
  vlCameraDef *d = &record->camera;
  double size[2];
  vlResult result = vl_camera_field(file, tree, "value0", &root);
  if (result == VL_OK)
    result = vl_camera_field(file, root, "intrinsics", &cameras);
  if (result != VL_OK)
    return result;
  poses = json_object_get(root, "T_imu_cam");
  sizes = json_object_get(root, "resolution");
  record->frames = (uint32_t)json_array_size(cameras);
  for (uint32_t i = 0; i < record->frames; i++) {
    if (!vl_camera_is_frame(file, i, NULL))
      continue;
    const json_t *pose = json_array_get(poses, i), *pair = json_array_get(sizes, i);
    result = read_model(file, json_array_get(cameras, i), d);
    vl_camera_set_origin(d);
    if (result == VL_OK && pose)
      result = read_pose(file, pose, d);
    if (result != VL_OK || !pair)
      return result == VL_OK ? vl_camera_size_beside(file, NULL, record) : result;
    for (int k = 0; k < 2; k++) {
      size[k] = json_number_value(json_array_get(pair, (size_t)k));
      if (!(size[k] >= 1.0 && size[k] <= 1 << 24) || size[k] != (double)(uint32_t)size[k])
        return vl_camera_wrong_in(file, pair, NULL,
                                  "basalt: \"resolution\" must be two whole numbers of pixels");
    }
    d->width = (uint32_t)size[0];
    d->height = (uint32_t)size[1];
    return VL_OK;
  }
  return vl_camera_wrong_in(file, root, "intrinsics",
                            "basalt: there is no camera \"%s\" among the %u",
                            vl_camera_asked(file, "0").text, record->frames);
}

static vlResult write_basalt(const vlFittedCamera *fit, vlCameraText *text) {
  const vlCamera *c = &fit->camera;
  double r[9], q[4];
  const Model *model = NULL;
  if (fit->family == VL_LENS_UNIFIED)
    return vl_camera_no_model(fit->file, &fit->record->camera);
  for (int i = 0; i < MODELS; i++)
    if (models[i].family == fit->family && !model)
      model = &models[i];
  if (!model || (fit->family == VL_LENS_OPENCV && fit->count > 8))
    return vl_camera_no_model(fit->file, &fit->record->camera);
  for (int i = 0; i < 9; i++)
    r[i] = c->world_from_camera[4 * (i / 3) + i % 3];
  vl_rotation_to_quaternion(r, q);
  VL_PUT_FORM(
      text, fit,
      "{\n  \"value0\": {\n    \"T_imu_cam\": [\n      {\"px\": $centre@0, \"py\": "
      "$centre@1, \"pz\": $centre@2, "
      "\"qx\": $q@1, \"qy\": $q@2, \"qz\": $q@3, \"qw\": $q@0}\n    ],\n"
      "    \"intrinsics\": [\n      {\"camera_type\": \"$type\", \"intrinsics\": {\"fx\": "
      "$fx, \"fy\": $fy, "
      "\"cx\": $cx0, \"cy\": $cy0",
      VL_WORD("type", model->name), VL_VALUES("q", q, 4));
  for (int i = 0; i < 2 && model->shapes[i]; i++)
    vl_camera_put(text, ", \"%s\": %.17g", model->shapes[i], c->shape[i]);
  for (int i = 0; i < 8 && model->lens[i]; i++)
    vl_camera_put(text, ", \"%s\": %.17g", model->lens[i], fit->k[i] + 0.0);
  if (fit->family == VL_LENS_OPENCV)
    vl_camera_put(text, ", \"rpmax\": 0");
  return vl_camera_put_form(text, fit, NULL,
                            "}}\n    ],\n    \"resolution\": [[$width, $height]]\n  }\n}\n");
}

const vlCameraFormat vl_format_basalt = {
    .name = "basalt",
    .rotates = true,
    .marks = {"intrinsics"},
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
