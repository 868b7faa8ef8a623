/* camera_files/kalibr.c: Kalibr's camchain: cam0, cam1, ...; world space is cam0's space. OpenCV's axes; the first
 * pixel's centre is (0, 0). */
#include <stdio.h>
#include <string.h>

#include "base/text.h"
#include "camera_files/files.h"
#include "math/transform.h"

typedef struct {
  const char *name;
  vlProjection projection;
  uint32_t shapes; /* numbers before fu fv pu pv */
} Model;
static const Model models[] = {{"pinhole", VL_PROJECTION_PERSPECTIVE, 0},
                               {"omni", VL_PROJECTION_UNIFIED, 1},
                               {"eucm", VL_PROJECTION_EUCM, 2},
                               {"ds", VL_PROJECTION_DOUBLE_SPHERE, 2}};
enum { MODELS = sizeof models / sizeof *models };

static vlResult unknown_word(const vlCameraFile *file, const char *key, const char *text, const char *known) {
  return vl_camera_wrong(file, "kalibr: unknown %s \"%s\"; there are %s", key, vl_short_text(text).text, known);
}

static vlResult read_lens(const vlCameraFile *file, const json_t *cam, vlCameraDef *d) {
  const json_t *field;
  double k[4] = {0};
  uint32_t n = 0;
  vlResult result = vl_camera_field(file, cam, "distortion_model", &field);
  if (result != VL_OK) return result;
  const char *lens = json_string_value(field);
  bool plain = d->projection == VL_PROJECTION_PERSPECTIVE;
  if (lens && strcmp(lens, "none") == 0) return VL_OK;
  result = vl_camera_numbers(file, cam, "distortion_coeffs", k, 0, 4, &n);
  if (result != VL_OK) return result;
  bool radtan = lens && strcmp(lens, "radtan") == 0, equi = lens && strcmp(lens, "equidistant") == 0;
  bool fov = lens && strcmp(lens, "fov") == 0;
  if (!radtan && !equi && !fov) return unknown_word(file, "distortion_model", lens, "radtan, equidistant, fov, none");
  if (!plain && !radtan)
    return vl_camera_wrong(file, "kalibr: distortion_model \"%s\" goes with the pinhole only", lens);
  if (n != (fov ? 1u : 4u))
    return vl_camera_wrong(file, "kalibr: \"distortion_coeffs\" holds %u numbers; %s has %d", n, lens, fov ? 1 : 4);
  if (fov) {
    d->projection = VL_PROJECTION_FOV;
    d->shape[0] = k[0];
    return VL_OK;
  }
  if (equi) d->projection = VL_PROJECTION_EQUIDISTANT;
  d->distortion = equi ? VL_DISTORTION_RADIAL : VL_DISTORTION_OPENCV;
  d->distortion_count = 4;
  memcpy(d->distortion_coefficients, k, sizeof k);
  return VL_OK;
}

static vlResult read_cam(const vlCameraFile *file, const json_t *cam, vlCameraDef *d) {
  const json_t *field;
  double size[2] = {0}, k[6] = {0};
  vlResult result = vl_camera_field(file, cam, "camera_model", &field);
  if (result != VL_OK) return result;
  const char *name = json_string_value(field);
  const Model *model = NULL;
  for (int i = 0; i < MODELS; i++)
    if (name && strcmp(name, models[i].name) == 0) model = &models[i];
  if (!model) return unknown_word(file, "camera_model", name, "pinhole, omni, eucm, ds");
  d->projection = model->projection;
  result = vl_camera_numbers(file, cam, "intrinsics", k, model->shapes + 4, model->shapes + 4, NULL);
  if (result == VL_OK) result = vl_camera_numbers(file, cam, "resolution", size, 2, 2, NULL);
  if (result != VL_OK) return result;
  for (int i = 0; i < 2; i++)
    if (!(size[i] >= 1.0 && size[i] <= 1 << 24) || size[i] != (double)(uint32_t)size[i])
      return vl_camera_wrong(file, "kalibr: \"resolution\" is %g x %g; it must be whole pixels", size[0], size[1]);
  d->width = (uint32_t)size[0], d->height = (uint32_t)size[1];
  for (uint32_t i = 0; i < model->shapes; i++) d->shape[i] = k[i];
  const double *f = k + model->shapes;
  d->fx = f[0], d->fy = f[1];
  d->cx = f[2] + 0.5, d->cy = f[3] + 0.5;
  return read_lens(file, cam, d);
}

vlResult vl_camera_read_kalibr(const vlCameraFile *file, const json_t *tree, vlCameraRecord *record) {
  vlMat4 from_world = vl_mat4_identity();
  record->frames = (uint32_t)json_object_size(tree);
  for (uint32_t i = 0; i < record->frames; i++) {
    char key[16];
    snprintf(key, sizeof key, "cam%u", i);
    const json_t *cam = json_object_get(tree, key);
    if (!cam) break;
    if (!json_is_object(cam)) return vl_camera_wrong(file, "kalibr: \"%s\" holds no fields", key);
    if (i > 0) {
      vlMat4 step;
      vlResult result = vl_camera_numbers(file, cam, "T_cn_cnm1", step.m, 16, 16, NULL);
      if (result != VL_OK) return result;
      from_world = vl_mat4_multiply(step, from_world);
    }
    if (!vl_camera_is_frame(file, i, key)) continue;
    vlMat4 pose;
    if (!vl_mat4_inverse(from_world, &pose))
      return vl_camera_wrong(file, "kalibr: the pose of \"%s\" is singular", key);
    record->camera.has_matrix = true;
    for (int e = 0; e < 16; e++) record->camera.world_from_camera[e] = e < 12 ? pose.m[e] + 0.0 : e == 15;
    vl_camera_name(record, key);
    return read_cam(file, cam, &record->camera);
  }
  return vl_camera_wrong(file, "kalibr: there is no camera \"%.60s\"", file->def->frame ? file->def->frame : "cam0");
}

vlResult vl_camera_write_kalibr(const vlCameraFile *file, const vlCameraRecord *record, vlCameraText *text) {
  const vlCameraDef *d = &record->camera;
  vlCamera c;
  double k[14] = {0};
  uint32_t n = 0;
  vlResult result = vl_camera_fit(file, record, 0, &c);
  if (result != VL_OK) return result;
  bool fov = d->projection == VL_PROJECTION_FOV, equi = d->projection == VL_PROJECTION_EQUIDISTANT;
  const char *lens = "none";
  const Model *model = fov || equi ? &models[0] : NULL;
  for (int i = 0; i < MODELS; i++)
    if (d->projection == models[i].projection) model = &models[i];
  if (!model) return vl_camera_no_model(file, d);
  if (fov) {
    if (d->distortion != VL_DISTORTION_NONE) return vl_camera_no_model(file, d);
    k[0] = d->shape[0], n = 1, lens = "fov";
  } else if (equi) {
    if (d->distortion != VL_DISTORTION_NONE && d->distortion != VL_DISTORTION_RADIAL)
      return vl_camera_no_model(file, d);
    memcpy(k, d->distortion_coefficients, d->distortion_count * sizeof *k);
    n = 4, lens = "equidistant";
  } else if (d->distortion != VL_DISTORTION_NONE) {
    bool fits = vl_camera_as_opencv(d, k, &n);
    for (int i = 4; i < 14; i++) fits = fits && k[i] == 0.0;
    if (!fits || model->shapes == 2) return vl_camera_no_model(file, d);
    n = 4, lens = "radtan";
  }
  vl_camera_put(text, "cam0:\n  camera_model: %s\n  intrinsics: [", model->name);
  for (uint32_t i = 0; i < model->shapes; i++) vl_camera_put(text, "%.17g, ", c.shape[i]);
  vl_camera_put(text, "%.17g, %.17g, %.17g, %.17g]\n  distortion_model: %s\n  distortion_coeffs: [", c.fx, c.fy,
                c.cx - 0.5, c.cy - 0.5, lens);
  vl_camera_put_numbers(text, k, n);
  vl_camera_put(text, "]\n  resolution: [%u, %u]\n", c.width, c.height);
  return VL_OK;
}
