/* camera_files/gaussians.c: cameras.json of 3D Gaussian splatting: a list of cameras with
 * position (the camera's centre) and rotation (world from camera). Camera axes: x right, y
 * down, z forward. The principal point is the image's middle. */

#include "camera_files/fields.h"

static vlResult read_gaussians(const vlCameraFile *file, const json_t *tree,
                               vlCameraRecord *record) {
  const json_t *camera =
      vl_camera_choose(file, json_object_get(tree, "[]"), "img_name", record);
  vlCameraDef *d = &record->camera;
  double p[3], r[9];
  if (!camera)
    return vl_camera_no_frame(file, "camera", record);
  VL_TRY(VL_READ_FIELDS(file, camera, VL_FIELD_SIDE("width", &d->width),
                        VL_FIELD_SIDE("height", &d->height), VL_FIELD("fx", &d->fx),
                        VL_FIELD("fy", &d->fy), VL_FIELD_LIST("position", p, 3),
                        VL_FIELD_LIST("rotation", r, 9)));
  vl_camera_set_rigid(d, r, p);
  return VL_OK;
}

const vlCameraFormat vl_format_gaussians = {
    .name = "gaussians",
    .rotates = true,
    .marks = "position rotation fx",
    .marks_in = "[]",
    .known = "id img_name width height position rotation fx fy",
    .read = read_gaussians,
    .holds = VL_HOLDS_POSE,
    .centred = true,
    .lenses = {VL_LENSES_PINHOLE},
    .form =
        "[\n"
        "  {\"id\": 0, \"img_name\": $name, \"width\": $width, \"height\": $height,\n"
        "   \"position\": [$centre],\n"
        "   \"rotation\": [$axes:3],\n"
        "   \"fy\": $fy, \"fx\": $fx}\n"
        "]\n"};
