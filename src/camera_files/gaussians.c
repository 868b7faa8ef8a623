/* camera_files/gaussians.c: cameras.json of 3D Gaussian splatting: a list of cameras with position (the camera's
 * centre) and rotation (world from camera). Camera axes: x right, y down, z forward. The principal point is the
 * image's middle. */
#include <string.h>

#include "camera_files/files.h"

static vlResult read_gaussians(const vlCameraFile *file, const json_t *tree, vlCameraRecord *record) {
  const json_t *list = json_object_get(tree, "[]"), *camera = NULL;
  vlCameraDef *d = &record->camera;
  double p[3], r[9], m[16] = {[15] = 1.0};
  record->frames = (uint32_t)json_array_size(list);
  for (uint32_t i = 0; i < record->frames && !camera; i++)
    if (vl_camera_is_frame(file, i, vl_camera_text(json_array_get(list, i), "img_name")))
      camera = json_array_get(list, i);
  if (!camera) return vl_camera_no_frame(file, "camera", record->frames);
  vlResult result = vl_camera_side(file, camera, "width", &d->width);
  if (result == VL_OK) result = vl_camera_side(file, camera, "height", &d->height);
  if (result == VL_OK) result = vl_camera_number(file, camera, "fx", &d->fx);
  if (result == VL_OK) result = vl_camera_number(file, camera, "fy", &d->fy);
  if (result == VL_OK) result = vl_camera_numbers(file, camera, "position", p, 3, 3, NULL);
  if (result == VL_OK) result = vl_camera_numbers(file, camera, "rotation", r, 9, 9, NULL);
  if (result != VL_OK) return result;
  for (int i = 0; i < 12; i++) m[i] = i % 4 < 3 ? r[3 * (i / 4) + i % 4] : p[i / 4];
  vl_camera_set_matrix(d, m, false);
  vl_camera_name(record, vl_camera_text(camera, "img_name"));
  return VL_OK;
}

static bool is_gaussians(const json_t *tree) {
  return vl_camera_has_in(tree, "[]", "position") && vl_camera_has_in(tree, "[]", "rotation") &&
         vl_camera_has_in(tree, "[]", "fx");
}

static vlResult write_gaussians(const vlCameraFile *file, const vlCameraRecord *record, vlCameraText *text) {
  vlCamera c;
  vlResult result = vl_camera_fit_pinhole(file, record, VL_HOLDS_POSE, &c);
  if (result != VL_OK) return result;
  result = vl_camera_refuse_off_centre(file, &c);
  if (result != VL_OK) return result;
  const double *m = c.world_from_camera;
  vl_camera_put(text, "[\n  {\"id\": 0, \"img_name\": ");
  vl_camera_put_string(text, record->name[0] ? record->name : "camera");
  vl_camera_put(text, ", \"width\": %u, \"height\": %u,\n   \"position\": [", c.width, c.height);
  vl_camera_put_numbers(text, (double[]){m[3], m[7], m[11]}, 3);
  vl_camera_put(text, "],\n   \"rotation\": [");
  for (int i = 0; i < 3; i++) {
    vl_camera_put(text, "%s[", i ? ", " : "");
    vl_camera_put_numbers(text, m + 4 * i, 3);
    vl_camera_put(text, "]");
  }
  vl_camera_put(text, "],\n   \"fy\": %.17g, \"fx\": %.17g}\n]\n", c.fy, c.fx);
  return VL_OK;
}

const vlCameraFormat vl_format_gaussians = {
    .name = "gaussians", .is_tree = is_gaussians, .read = read_gaussians, .write = write_gaussians};
