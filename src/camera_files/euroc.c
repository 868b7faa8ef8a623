/* camera_files/euroc.c: sensor.yaml of the EuRoC datasets (ASL's format). Camera axes: x right, y down, z forward.
 * T_BS is body (IMU) from camera, and the world's space is that of the body. The first pixel's centre is (0, 0). */
#include <string.h>

#include "camera_files/files.h"

static vlResult read_lens(const vlCameraFile *file, const json_t *tree, vlCameraDef *d) {
  double k[5];
  uint32_t n = 0;
  const char *model = vl_camera_text(tree, "distortion_model");
  if (!vl_camera_has(tree, "distortion_model") || (model && strcmp(model, "none") == 0)) return VL_OK;
  vlResult result = vl_camera_numbers(file, tree, "distortion_coefficients", k, 4, 5, &n);
  if (result != VL_OK) return result;
  if (model && (strcmp(model, "radial-tangential") == 0 || strcmp(model, "radtan") == 0)) {
    vl_camera_set_opencv(d, k, n);
  } else if (model && strcmp(model, "equidistant") == 0 && n == 4) {
    vl_camera_set_fisheye(d, k);
  } else {
    return vl_camera_wrong_in(file, tree, "distortion_model",
                              "euroc: unknown distortion_model \"%s\" of %u coefficients; there are "
                              "radial-tangential, equidistant, none",
                              vl_short_text(model).text, n);
  }
  return VL_OK;
}

static vlResult read_euroc(const vlCameraFile *file, const json_t *tree, vlCameraRecord *record) {
  vlCameraDef *d = &record->camera;
  double k[4], m[16];
  const char *model = vl_camera_text(tree, "camera_model"), *sensor = vl_camera_text(tree, "sensor_type");
  if (sensor && strcmp(sensor, "camera") != 0)
    return vl_camera_wrong_in(file, tree, "sensor_type", "euroc: the sensor is \"%s\", no camera",
                              vl_short_text(sensor).text);
  if (model && strcmp(model, "pinhole") != 0)
    return vl_camera_wrong_in(file, tree, "camera_model", "euroc: unknown camera_model \"%s\"; there is pinhole",
                              vl_short_text(model).text);
  vlResult result = vl_camera_numbers(file, tree, "intrinsics", k, 4, 4, NULL);
  if (result == VL_OK) result = vl_camera_numbers(file, tree, "T_BS", m, 16, 16, NULL);
  if (result == VL_OK)
    result = vl_camera_has(tree, "resolution") ? vl_camera_side_pair(file, tree, "resolution", record)
                                               : vl_camera_size_beside(file, NULL, record);
  if (result == VL_OK) result = read_lens(file, tree, d);
  if (result != VL_OK) return result;
  vl_camera_set_centred(d, k[0], k[1], k[2], k[3]);
  vl_camera_set_matrix(d, m, false);
  vl_camera_name(record, vl_camera_text(tree, "comment"));
  return VL_OK;
}

static bool is_euroc(const json_t *tree) {
  return vl_camera_has(tree, "T_BS") || vl_camera_has(tree, "sensor_type");
}

static vlResult write_euroc(const vlCameraFile *file, const vlCameraRecord *record, vlCameraText *text) {
  vlCamera c;
  vlFittedLens fit;
  vlResult result = vl_camera_fit_lens(file, record, VL_HOLDS_POSE, VL_LENSES_COMMON, 5, &c, &fit);
  if (result != VL_OK) return result;
  if (fit.count == 0) fit.count = 4;
  vl_camera_put(text, "sensor_type: camera\ncomment: ");
  vl_camera_put_string(text, record->name[0] ? record->name : "camera");
  vl_camera_put(text, "\nT_BS:\n  cols: 4\n  rows: 4\n  data: [");
  vl_camera_put_numbers(text, c.world_from_camera, 16);
  vl_camera_put(text, "]\nresolution: [%u, %u]\ncamera_model: pinhole\nintrinsics: [", c.width, c.height);
  vl_camera_put_numbers(text, (double[]){c.fx, c.fy, c.cx - 0.5, c.cy - 0.5}, 4);
  vl_camera_put(text, "]\ndistortion_model: %s\ndistortion_coefficients: [",
                fit.family == VL_LENS_FISHEYE ? "equidistant" : "radial-tangential");
  vl_camera_put_numbers(text, fit.k, fit.count);
  vl_camera_put(text, "]\n");
  return VL_OK;
}

const vlCameraFormat vl_format_euroc = {.name = "euroc", .is_tree = is_euroc, .read = read_euroc, .write = write_euroc};
