/* camera_files/camodocal.c: camodocal's camera files, which VINS-Mono and VINS-Fusion also
 * read, directly or through a configuration file that names them. Camera axes: x right, y down,
 * z forward. The first pixel's centre is (0, 0). A configuration's body_T_cam0 (or
 * extrinsicRotation, extrinsicTranslation) is body (IMU) from camera, and the world's space is
 * that of the body. */
#include <stdio.h>

#include "base/error.h"
#include "base/file.h"
#include "base/text.h"
#include "camera_files/fields.h"

typedef struct {
  const char *name;
  vlLensFamily family;
  const char *intrinsics[4]; /* names in projection_parameters */
  const char *lens[8]; /* names in OpenCV's order, in distortion_parameters; for a fisheye in
                          projection_parameters */
} Model;

static const Model models[] = {
    {"PINHOLE", VL_LENS_OPENCV, {"fx", "fy", "cx", "cy"}, {"k1", "k2", "p1", "p2"}},
    {"MEI", VL_LENS_UNIFIED, {"gamma1", "gamma2", "u0", "v0"}, {"k1", "k2", "p1", "p2"}},
    {"KANNALA_BRANDT", VL_LENS_FISHEYE, {"mu", "mv", "u0", "v0"}, {"k2", "k3", "k4", "k5"}},
    {"PINHOLE_FULL",
     VL_LENS_OPENCV,
     {"fx", "fy", "cx", "cy"},
     {"k1", "k2", "p1", "p2", "k3", "k4", "k5", "k6"}}};
enum { MODELS = VL_LENGTH(models) };

static vlResult read_model(const vlCameraFile *file, const json_t *tree, const Model *model,
                           vlCameraDef *d) {
  const json_t *plane, *lens, *mirror;
  double f[4], k[8] = {0.0};
  VL_TRY(vl_camera_field(file, tree, "projection_parameters", &plane));
  VL_TRY(vl_camera_read_named(file, plane, model->intrinsics, 4, false, f));
  lens = plane;
  if (model->family != VL_LENS_FISHEYE)
    VL_TRY(vl_camera_field(file, tree, "distortion_parameters", &lens));
  VL_TRY(vl_camera_read_named(file, lens, model->lens, 8, false, k));
  if (model->family == VL_LENS_UNIFIED) {
    VL_TRY(vl_camera_field(file, tree, "mirror_parameters", &mirror));
    VL_TRY(vl_camera_number(file, mirror, "xi", &d->shape[0]));
  }
  vl_camera_set_centred(d, f);
  vl_camera_set_lens(d, model->family, k, model->lens[4] ? 8 : 4);
  return VL_OK;
}

static vlResult read_camera(const vlCameraFile *file, const json_t *tree,
                            vlCameraRecord *record) {
  const char *name;
  VL_TRY(vl_camera_word(file, tree, "model_type", &name));
  if (name && vl_has_word("SCARAMUZZA scaramuzza", name))
    return vl_camera_wrong_in(
        file, tree, "model_type",
        "camodocal: SCARAMUZZA's polynomial is no projection of velo; calibrate as MEI or "
        "KANNALA_BRANDT");
  const Model *model = VL_CAMERA_ROW(models, name);
  if (!model)
    return vl_camera_unknown(file, tree, "model_type", name,
                             "there are PINHOLE, PINHOLE_FULL, MEI, KANNALA_BRANDT");
  VL_TRY(vl_camera_sides(file, tree, "image_width", "image_height", record));
  VL_TRY(read_model(file, tree, model, &record->camera));
  vl_camera_set_origin(&record->camera);
  vl_camera_name(record, vl_camera_text(tree, "camera_name"));
  return VL_OK;
}

/* Reads the camera file whose name is in a configuration file. */
static vlResult read_named(const vlCameraFile *file, const json_t *tree, const char *key,
                           vlCameraRecord *record) {
  char path[4096], *text;
  size_t size;
  json_t *inner = NULL;
  const char *name = vl_camera_text(tree, key);
  if (!name || !vl_path_join(file->path, name, path, sizeof path))
    return vl_camera_wrong_in(file, tree, key, "camodocal: \"%s\" must be a file's name", key);
  VL_TRY(vl_file_read_given(file->context, path, false, &text, &size, file->error));
  vlCameraLocations locations = {.root = NULL};
  vlCameraFile other = *file;
  other.path = path;
  other.locations = &locations;
  vlResult result = vl_camera_tree(&other, text, size, &inner);
  if (result == VL_OK)
    result = read_camera(&other, inner, record);
  json_decref(inner);
  vl_camera_locations_free(&other);
  vl_free(file->context, text);
  return result;
}

static vlResult read_pose(const vlCameraFile *file, const json_t *tree, uint32_t index,
                          vlCameraDef *d) {
  char key[32];
  double m[16], r[9], t[3];
  snprintf(key, sizeof key, "body_T_cam%u", index);
  if (vl_camera_has(tree, key)) {
    VL_TRY(vl_camera_list(file, tree, key, m, 16));
    vl_camera_set_matrix(d, m, false);
  } else if (index == 0 && vl_camera_has(tree, "extrinsicRotation")) {
    VL_TRY(VL_READ_FIELDS(file, tree, VL_FIELD_LIST("extrinsicRotation", r, 9),
                          VL_FIELD_LIST("extrinsicTranslation", t, 3)));
    vl_camera_set_rigid(d, r, t);
  }
  return VL_OK;
}

static vlResult read_camodocal(const vlCameraFile *file, const json_t *tree,
                               vlCameraRecord *record) {
  char key[32];
  double rolling = 0;
  const vlResult read = vl_camera_optional(file, tree, "rolling_shutter", &rolling);
  if (read != VL_OK)
    return read;
  if (rolling != 0.0)
    return vl_camera_wrong_in(file, tree, "rolling_shutter",
                              "camodocal: rows of an image at different times are not taken");
  if (vl_camera_has(tree, "model_type")) {
    VL_TRY(read_camera(file, tree, record));
    return read_pose(file, tree, 0, &record->camera);
  }
  record->frames = 0;
  uint32_t found = UINT32_MAX;
  for (uint32_t i = 0; i < 64; i++) {
    char name[16];
    snprintf(key, sizeof key, "cam%u_calib", i);
    snprintf(name, sizeof name, "cam%u", i);
    if (!vl_camera_has(tree, key))
      break;
    if (vl_camera_count(file, found != UINT32_MAX, name, record))
      found = i;
  }
  if (found == UINT32_MAX)
    return vl_camera_no_frame(file, "camera", record);
  snprintf(key, sizeof key, "cam%u_calib", found);
  uint32_t frames = record->frames;
  VL_TRY(read_named(file, tree, key, record));
  VL_TRY(read_pose(file, tree, found, &record->camera));
  record->frames = frames;
  return VL_OK;
}

static vlResult write_camodocal(const vlFittedCamera *fit, vlCameraText *text) {
  const vlCamera *c = &fit->camera;
  vlLensFamily family = fit->family;
  if (family == VL_LENS_PINHOLE)
    family = VL_LENS_OPENCV;
  bool full = family == VL_LENS_OPENCV && fit->count > 4, fits = !full || fit->count <= 8;
  const Model *model = NULL;
  for (int i = 0; i < MODELS && fits; i++)
    if (models[i].family == family && (!full || models[i].lens[4]) && !model)
      model = &models[i];
  if (!model || (family == VL_LENS_UNIFIED && fit->count > 4))
    return vl_camera_no_model(fit->file, &fit->record->camera);
  const double f[4] = {c->fx, c->fy, c->cx - 0.5, c->cy - 0.5}, xi = c->shape[0];
  const bool fisheye = family == VL_LENS_FISHEYE;
  return VL_PUT_FORM(
      text, fit,
      "%YAML:1.0\n"
      "---\n"
      "model_type: $model\n"
      "camera_name: $name\n"
      "image_width: $width\n"
      "image_height: $height\n"
      "$mirror$before:\n"
      "$lens$between$plane",
      VL_WORD("model", model->name),
      VL_PART("mirror", family == VL_LENS_UNIFIED, "mirror_parameters:\n  xi: $xi\n"),
      VL_VALUES("xi", &xi, 1),
      VL_WORD("before", fisheye ? "projection_parameters" : "distortion_parameters"),
      VL_NAMED("lens", model->lens, fit->k, 8, "  $item: $value\n"),
      VL_PART("between", !fisheye, "projection_parameters:\n"),
      VL_NAMED("plane", model->intrinsics, f, 4, "  $item: $value\n"));
}

const vlCameraFormat vl_format_camodocal = {
    .name = "camodocal",
    .rotates = true,
    .marks = "model_type cam0_calib projection_parameters",
    .one_mark = true,
    .known =
        "model_type camera_name image_width image_height distortion_parameters "
        "projection_parameters mirror_parameters fx fy cx cy k1 k2 k3 k4 k5 k6 p1 p2 xi mu mv "
        "u0 v0 gamma1 gamma2 cam0_calib cam1_calib body_T_cam0 body_T_cam1 "
        "extrinsicRotation extrinsicTranslation data rows cols dt "
        /* of the estimator */
        "imu imu_topic image_topic image0_topic image1_topic num_of_cam output_path "
        "multiple_thread max_cnt min_dist freq F_threshold show_track flow_back equalize "
        "fisheye max_solver_time max_num_iterations keyframe_parallax acc_n gyr_n acc_w "
        "gyr_w g_norm td estimate_* rolling_shutter rolling_shutter_tr load_previous_pose_graph "
        "pose_graph_save_path save_image loop_closure visualize_* fast_relocalization",
    .read = read_camodocal,
    .write = write_camodocal};
