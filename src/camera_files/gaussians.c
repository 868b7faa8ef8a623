/* camera_files/gaussians.c: cameras.json of 3D Gaussian splatting: a list of cameras with position (the camera's
 * centre) and rotation (world from camera). Camera axes: x right, y down, z forward. The principal point is the
 * image's middle. */

#include "camera_files/fields.h"

static vlResult read_gaussians(const vlCameraFile *file, const json_t *tree, vlCameraRecord *record) {
  const json_t *list = json_object_get(tree, "[]"), *camera = NULL;
  vlCameraDef *d = &record->camera;
  double p[3], r[9], m[16] = {[15] = 1.0};
  record->frames = (uint32_t)json_array_size(list);
  for (uint32_t i = 0; i < record->frames && !camera; i++)
    if (vl_camera_is_frame(file, i, vl_camera_text(json_array_get(list, i), "img_name")))
      camera = json_array_get(list, i);
  if (!camera) return vl_camera_no_frame(file, "camera", record->frames);
  vlResult result = VL_READ_FIELDS(file, camera, VL_FIELD_SIDE("width", &d->width), VL_FIELD_SIDE("height", &d->height),
                                   VL_FIELD("fx", &d->fx), VL_FIELD("fy", &d->fy), VL_FIELD_LIST("position", p, 3),
                                   VL_FIELD_LIST("rotation", r, 9));
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

const vlCameraFormat vl_format_gaussians = {
    .name = "gaussians",
    .is_tree = is_gaussians,
    .read = read_gaussians,
    .holds = VL_HOLDS_POSE,
    .centred = true,
    .lenses = 1 << VL_LENS_PINHOLE,
    .form =
        "[\n  {\"id\": 0, \"img_name\": $name, \"width\": $width, \"height\": $height,\n"
        "   \"position\": [$centre],\n   \"rotation\": [$axes:3],\n   \"fy\": $fy, \"fx\": $fx}\n]\n"};
