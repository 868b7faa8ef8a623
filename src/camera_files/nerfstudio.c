/* camera_files/nerfstudio.c: nerfstudio's camera_path.json: the cameras of a film, each with
 * camera_to_world (16 numbers by rows) and the vertical fov in degrees. Camera axes: x right, y
 * up, z back. The principal point is the image's middle. */

#include "base/text.h"
#include "camera_files/fields.h"
#include "math/elementary.h"
#include "velo/projection.h"

static vlResult read_type(const vlCameraFile *file, const json_t *tree, vlCameraDef *d) {
  const char *type = vl_camera_text(tree, "camera_type");
  if (!type || vl_text_is(type, "perspective"))
    return VL_OK;
  if (vl_text_is(type, "fisheye"))
    d->projection = VL_PROJECTION_EQUIDISTANT;
  else if (vl_text_is(type, "equirectangular"))
    d->projection = VL_PROJECTION_EQUIRECTANGULAR;
  else
    return vl_camera_wrong_in(
        file, tree, "camera_type",
        "nerfstudio: camera_type \"%s\" is none of velo; there are perspective, fisheye, "
        "equirectangular",
        vl_short_text(type).text);
  return VL_OK;
}

static vlResult read_nerfstudio(const vlCameraFile *file, const json_t *tree,
                                vlCameraRecord *record) {
  const json_t *camera =
      vl_camera_choose(file, json_object_get(tree, "camera_path"), NULL, record);
  vlCameraDef *d = &record->camera;
  double m[16], fov = 0.0;
  if (!camera)
    return vl_camera_no_frame(file, "camera", record);
  VL_TRY(vl_camera_sides(file, tree, "render_width", "render_height", record));
  VL_TRY(read_type(file, tree, d));
  VL_TRY(vl_camera_list(file, camera, "camera_to_world", m, 16));
  if (d->projection != VL_PROJECTION_EQUIRECTANGULAR)
    VL_TRY(vl_camera_number(file, camera, "fov", &fov));
  vl_camera_set_flipped(d, m);
  if (d->projection == VL_PROJECTION_EQUIRECTANGULAR)
    return VL_OK;
  if (!(fov > 0.0 && fov < 180.0))
    return vl_camera_wrong_in(file, camera, "fov",
                              "nerfstudio: \"fov\" is %g; it must be between 0 and 180 degrees",
                              fov);
  d->fx = d->fy = 0.5 * d->height / vl_precise_tan(0.5 * VL_DEGREE * fov);
  return VL_OK;
}

const vlCameraFormat vl_format_nerfstudio = {
    .name = "nerfstudio",
    .known =
        "camera_path camera_to_world fov aspect camera_type render_height render_width "
        "keyframes! fps seconds smoothness_value is_cycle default_fov default_transition_sec "
        "export_indices! crop! render_time appearance!",
    .marks = "camera_to_world",
    .marks_in = "camera_path",
    .read = read_nerfstudio,
    .holds = VL_HOLDS_POSE,
    .centred = true,
    .square = true,
    .lenses = {VL_LENSES_PINHOLE},
    .form =
        "{\n"
        "  \"camera_type\": \"perspective\",\n"
        "  \"render_width\": $width,\n"
        "  \"render_height\": $height,\n"
        "  \"fps\": 24,\n"
        "  \"seconds\": 1,\n"
        "  \"keyframes\": [],\n"
        "  \"camera_path\": [\n"
        "    {\"camera_to_world\": [$flipped],\n"
        "     \"fov\": $yfov, \"aspect\": $ratio}\n"
        "  ]\n"
        "}\n"};
