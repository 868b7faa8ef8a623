/* camera_files/open3d.c: Open3D's JSON: PinholeCameraIntrinsic, PinholeCameraParameters,
 * PinholeCameraTrajectory. Camera axes: x right, y down, z forward. extrinsic is camera from
 * world. Matrices are stored by columns. The first pixel's centre is (0, 0). */

#include "base/text.h"
#include "camera_files/fields.h"

static vlResult read_intrinsic(const vlCameraFile *file, const json_t *intrinsic,
                               vlCameraRecord *record) {
  double k[9];
  VL_TRY(vl_camera_sides(file, intrinsic, "width", "height", record));
  VL_TRY(vl_camera_list(file, intrinsic, "intrinsic_matrix", k, 9));
  if (k[1] != 0.0 || k[2] != 0.0 || k[5] != 0.0 || k[8] != 1.0)
    return vl_camera_wrong_in(
        file, intrinsic, "intrinsic_matrix",
        "open3d: \"intrinsic_matrix\" must be fx 0 0, skew fy 0, cx cy 1: it is written by "
        "columns");
  vl_camera_set_centred(&record->camera, (double[]){k[0], k[4], k[6], k[7]});
  record->camera.skew = k[3];
  return VL_OK;
}

static vlResult read_parameters(const vlCameraFile *file, const json_t *parameters,
                                vlCameraRecord *record) {
  const json_t *intrinsic;
  double by_columns[16], m[16];
  VL_TRY(vl_camera_field(file, parameters, "intrinsic", &intrinsic));
  VL_TRY(read_intrinsic(file, intrinsic, record));
  VL_TRY(vl_camera_list(file, parameters, "extrinsic", by_columns, 16));
  vl_camera_transpose(by_columns, m);
  if (!vl_camera_set_matrix(&record->camera, m, true))
    return vl_camera_wrong_in(file, parameters, "extrinsic",
                              "open3d: \"extrinsic\" is singular");
  return VL_OK;
}

static vlResult read_open3d(const vlCameraFile *file, const json_t *tree,
                            vlCameraRecord *record) {
  const char *name = vl_camera_text(tree, "class_name");
  const json_t *list = json_object_get(tree, "parameters");
  if (vl_text_is(name, "ViewTrajectory"))
    return vl_camera_wrong_in(file, tree, "class_name",
                              "open3d: a ViewTrajectory depends on the viewer's window and "
                              "model; save the camera with P (PinholeCameraParameters)");
  if (!list && vl_camera_has(tree, "intrinsic_matrix")) {
    vl_camera_set_origin(&record->camera);
    return read_intrinsic(file, tree, record);
  }
  if (!list)
    return read_parameters(file, tree, record);
  const json_t *chosen = vl_camera_choose(file, list, NULL, record);
  if (chosen)
    return read_parameters(file, chosen, record);
  return vl_camera_none_in(file, tree, "parameters", "camera", record);
}

/* Recognises a lone intrinsic_matrix. Open3D stores it by columns, so the principal point is in
 * its last numbers. In OpenCV's matrices, stored by rows, it is in the third number. */
static bool is_open3d(const json_t *tree) {
  const char *name = vl_camera_text(tree, "class_name");
  const json_t *k = json_object_get(tree, "intrinsic_matrix");
  if (name)
    return strncmp(name, "PinholeCamera", 13) == 0 || vl_text_is(name, "ViewTrajectory");
  bool flat = json_array_size(k) == 9 && json_number_value(json_array_get(k, 2)) == 0.0;
  return flat || (vl_camera_has(tree, "extrinsic") &&
                  vl_camera_has_in(tree, "intrinsic", "intrinsic_matrix"));
}

const vlCameraFormat vl_format_open3d = {
    .name = "open3d",
    .rotates = true,
    .known =
        "class_name extrinsic intrinsic intrinsic_matrix width height parameters "
        "version_major version_minor",
    .is_tree = is_open3d,
    .read = read_open3d,
    .holds = VL_HOLDS_POSE | VL_HOLDS_SKEW,
    .lenses = {VL_LENSES_PINHOLE},
    .form =
        "{\n"
        "  \"class_name\": \"PinholeCameraParameters\",\n"
        "  \"extrinsic\": [$viewcolumns],\n"
        "  \"intrinsic\": {\n"
        "    \"height\": $height,\n"
        "    \"intrinsic_matrix\": [$fx, 0, 0, $skew, $fy, 0, $cx0, $cy0, 1],\n"
        "    \"width\": $width\n"
        "  },\n"
        "  \"version_major\": 1,\n"
        "  \"version_minor\": 0\n"
        "}\n"};
