/* camera_files/kalibr.c: Kalibr's camchain: cam0, cam1, ...; world space is cam0's space, or
 * the IMU's where the cameras have T_cam_imu (camera from IMU) and no chain. OpenCV's axes; the
 * first pixel's centre is (0, 0). */
#include <math.h>
#include <stdio.h>

#include "base/text.h"
#include "camera_files/fields.h"
#include "math/transform.h"
#include "velo/distortion.h"
#include "velo/projection.h"

typedef struct {
  const char *name;
  vlProjection projection;
  uint32_t shapes; /* count of the numbers before fu fv pu pv */
} Model;
static const Model models[] = {{"pinhole", VL_PROJECTION_PERSPECTIVE, 0},
                               {"omni", VL_PROJECTION_UNIFIED, 1},
                               {"eucm", VL_PROJECTION_EUCM, 2},
                               {"ds", VL_PROJECTION_DOUBLE_SPHERE, 2}};
enum { MODELS = VL_LENGTH(models) };

static vlResult read_lens(const vlCameraFile *file, const json_t *cam, vlCameraDef *d) {
  const char *lens;
  double k[4] = {0};
  uint32_t n = 0;
  VL_TRY(vl_camera_word(file, cam, "distortion_model", &lens));
  bool plain = d->projection == VL_PROJECTION_PERSPECTIVE;
  if (vl_text_is(lens, "none"))
    return VL_OK;
  VL_TRY(vl_camera_numbers(file, cam, "distortion_coeffs", k, 0, 4, &n));
  bool radtan = vl_text_is(lens, "radtan"), equi = vl_text_is(lens, "equidistant");
  bool fov = vl_text_is(lens, "fov");
  if (!radtan && !equi && !fov)
    return vl_camera_unknown(file, cam, "distortion_model", lens,
                             "there are radtan, equidistant, fov, none");
  if (!plain && !radtan)
    return vl_camera_wrong_in(file, cam, "distortion_model",
                              "kalibr: distortion_model \"%s\" goes with the pinhole only",
                              lens);
  if (n != (fov ? 1u : 4u))
    return vl_camera_wrong_in(file, cam, "distortion_coeffs",
                              "kalibr: \"distortion_coeffs\" holds %u numbers; %s has %d", n,
                              lens, fov ? 1 : 4);
  vl_camera_set_lens(d, fov ? VL_LENS_FOV : equi ? VL_LENS_FISHEYE : VL_LENS_OPENCV, k, n);
  return VL_OK;
}

static vlResult read_cam(const vlCameraFile *file, const json_t *cam, vlCameraRecord *record) {
  vlCameraDef *d = &record->camera;
  const char *name;
  double k[6] = {0};
  VL_TRY(vl_camera_word(file, cam, "camera_model", &name));
  const Model *model = VL_CAMERA_ROW(models, name);
  if (!model)
    return vl_camera_unknown(file, cam, "camera_model", name,
                             "there are pinhole, omni, eucm, ds");
  d->projection = model->projection;
  VL_TRY(vl_camera_list(file, cam, "intrinsics", k, model->shapes + 4));
  VL_TRY(vl_camera_size_pair(file, cam, "resolution", record));
  for (uint32_t i = 0; i < model->shapes; i++)
    d->shape[i] = k[i];
  vl_camera_set_centred(d, k + model->shapes);
  return read_lens(file, cam, d);
}

static uint32_t cameras_of(const json_t *tree) {
  char key[16];
  uint32_t count = 0;
  do
    snprintf(key, sizeof key, "cam%u", count);
  while (json_object_get(tree, key) && ++count);
  return count;
}

/* The key of a camera's pose relative to the IMU: camera from IMU, or OpenVINS' IMU from
 * camera. */
static const char *imu_key(const json_t *cam, bool *inverse) {
  *inverse = !vl_camera_has(cam, "T_cam_imu") && vl_camera_has(cam, "T_imu_cam");
  return *inverse ? "T_imu_cam" : "T_cam_imu";
}

/* Returns whether the poses are relative to the IMU, because the chain from camera to camera is
 * missing. */
static bool is_by_imu(const json_t *tree, uint32_t cameras) {
  bool chain = cameras > 1, imu = true;
  for (uint32_t i = 0; i < cameras; i++) {
    char key[16];
    snprintf(key, sizeof key, "cam%u", i);
    imu = imu && (vl_camera_has_in(tree, key, "T_cam_imu") ||
                  vl_camera_has_in(tree, key, "T_imu_cam"));
    chain = chain && (i == 0 || vl_camera_has_in(tree, key, "T_cn_cnm1"));
  }
  return imu && !chain;
}

vlResult vl_camera_read_kalibr(const vlCameraFile *file, const json_t *tree,
                               vlCameraRecord *record) {
  vlMat4 from_world = vl_mat4_identity();
  record->frames = cameras_of(tree);
  bool by_imu = is_by_imu(tree, record->frames);
  for (uint32_t i = 0; i < record->frames; i++) {
    char key[16];
    snprintf(key, sizeof key, "cam%u", i);
    const json_t *cam = json_object_get(tree, key);
    if (!json_is_object(cam))
      return vl_camera_wrong_in(file, tree, key, "kalibr: \"%s\" holds no fields", key);
    if (i > 0 || by_imu) {
      vlMat4 step = vl_mat4_identity();
      bool inverse;
      const char *name = imu_key(cam, &inverse);
      VL_TRY(vl_camera_list(file, cam, by_imu ? name : "T_cn_cnm1", step.m, 16));
      if (by_imu && inverse && !vl_mat4_inverse(step, &step))
        return vl_camera_wrong_in(file, cam, name, "kalibr: \"%s\" is singular", name);
      from_world = by_imu ? step : vl_mat4_multiply(step, from_world);
    }
    if (!vl_camera_is_frame(file, i, key))
      continue;
    vlMat4 pose;
    if (!vl_mat4_inverse(from_world, &pose) || !isfinite(pose.m[0]))
      return vl_camera_wrong_in(file, tree, key, "kalibr: the pose of \"%s\" is singular", key);
    record->camera.has_matrix = true;
    for (int e = 0; e < 16; e++)
      record->camera.world_from_camera[e] = pose.m[e] + 0.0;
    vl_camera_name(record, key);
    return read_cam(file, cam, record);
  }
  return vl_camera_wrong(file, "kalibr: there is no camera \"%s\"",
                         vl_camera_asked(file, "cam0").text);
}

static vlResult write_kalibr(const vlFittedCamera *fit, vlCameraText *text) {
  const vlCameraDef *d = &fit->record->camera;
  const vlCamera *c = &fit->camera;
  const bool fov = fit->family == VL_LENS_FOV, equi = fit->family == VL_LENS_FISHEYE;
  const uint32_t n = fov ? 1 : equi || d->distortion != VL_DISTORTION_NONE ? 4 : 0;
  const Model *model = &models[0];
  for (int i = 0; i < MODELS; i++)
    if (d->projection == models[i].projection)
      model = &models[i];
  if (fit->family == VL_LENS_OTHER || !vl_camera_all_zero(fit->k + 4, 10))
    return vl_camera_no_model(fit->file, d);
  bool posed = false;
  for (int i = 0; i < 16; i++)
    posed = posed || c->camera_from_world[i] != (i % 5 == 0 ? 1.0 : 0.0);
  /* the world's space is the IMU's */
  return VL_PUT_FORM(text, fit,
                     "cam0:\n"
                     "  camera_model: $model\n"
                     "  intrinsics: [$shapes$fx, $fy, $cx0, $cy0]\n"
                     "  distortion_model: $lens\n"
                     "  distortion_coeffs: [$k]\n"
                     "  resolution: [$width, $height]\n"
                     "$imu",
                     VL_WORD("model", model->name),
                     {.key = "shapes",
                      .part = model->shapes == 2   ? "$shape, "
                              : model->shapes == 1 ? "$shape@0, "
                                                   : ""},
                     VL_VALUES("shape", c->shape, 2),
                     VL_WORD("lens", fov    ? "fov"
                                     : equi ? "equidistant"
                                     : n    ? "radtan"
                                            : "none"),
                     VL_VALUES("k", fit->k, n),
                     VL_PART("imu", posed,
                             "  T_cam_imu:\n"
                             "  - [$view@0, $view@1, $view@2, $view@3]\n"
                             "  - [$view@4, $view@5, $view@6, $view@7]\n"
                             "  - [$view@8, $view@9, $view@10, $view@11]\n"
                             "  - [$view@12, $view@13, $view@14, $view@15]\n"));
}

const vlCameraFormat vl_format_kalibr = {
    .name = "kalibr",
    .rotates = true,
    .marks = "cam0",
    .known =
        "cam* T_cam_imu T_cn_cnm1 T_imu_cam camera_model distortion_coeffs distortion_model "
        "intrinsics resolution "
        /* of topics and clocks */
        "rostopic timeshift_cam_imu",
    .read = vl_camera_read_kalibr,
    .holds = VL_HOLDS_POSE,
    .write = write_kalibr};
