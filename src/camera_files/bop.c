/* camera_files/bop.c: the BOP challenge's scene_camera.json (images by their number: cam_K,
 * cam_R_w2c, cam_t_w2c) and camera.json (fx, fy, cx, cy, width, height). x right, y down, z
 * forward; camera from world; the first pixel's centre is (0, 0). Lengths stay as they are:
 * millimetres. */
#include <stdio.h>
#include <string.h>

#include "camera_files/fields.h"

static vlResult read_image(const vlCameraFile *file, const json_t *image, const char *name,
                           vlCameraRecord *record) {
  vlCameraDef *d = &record->camera;
  double k[9], r[9], t[3];
  char files[3][64];
  VL_TRY(vl_camera_list(file, image, "cam_K", k, 9));
  if (!vl_camera_set_intrinsics(d, k, false))
    return vl_camera_wrong_in(file, image, "cam_K",
                              "bop: \"cam_K\" must be [fx 0 cx; 0 fy cy; 0 0 1]");
  vl_camera_set_origin(d);
  if (vl_camera_has(image, "cam_R_w2c") || vl_camera_has(image, "cam_t_w2c")) {
    VL_TRY(VL_READ_FIELDS(file, image, VL_FIELD_LIST("cam_R_w2c", r, 9),
                          VL_FIELD_LIST("cam_t_w2c", t, 3)));
    vl_camera_set_pose(d, r, t);
  }
  if (vl_camera_has(image, "width"))
    return vl_camera_sides(file, image, "width", "height", record);
  static const char *const folders[] = {"rgb", "gray", "depth"};
  int zeros = 6 - (int)strlen(name);
  for (int i = 0; i < 3; i++)
    snprintf(files[i], sizeof files[i], "%s/%.*s%.20s", folders[i], zeros > 0 ? zeros : 0,
             "000000", name);
  return vl_camera_size_beside(file, (const char *const[]){files[0], files[1], files[2], NULL},
                               record);
}

static vlResult read_one(const vlCameraFile *file, const json_t *tree, vlCameraRecord *record) {
  double f[4];
  VL_TRY(vl_camera_read_named(file, tree, vl_camera_matrix_names, 4, false, f));
  VL_TRY(vl_camera_sides(file, tree, "width", "height", record));
  vl_camera_set_centred(&record->camera, f);
  vl_camera_set_origin(&record->camera);
  return VL_OK;
}

static vlResult read_bop(const vlCameraFile *file, const json_t *tree, vlCameraRecord *record) {
  const char *name, *chosen = NULL;
  json_t *image;
  if (vl_camera_has(tree, "fx"))
    return read_one(file, tree, record);
  record->frames = 0;
  /* the frame option first means a frame's name, which is the number of its image */
  if (!file->ordinal && file->def->frame &&
      json_is_object(json_object_get(tree, file->def->frame)))
    chosen = file->def->frame;
  json_object_foreach((json_t *)tree, name, image) {
    if (vl_camera_count(file, chosen, name, record))
      chosen = name;
  }
  if (!chosen)
    return vl_camera_no_frame(file, "image", record);
  vl_camera_name(record, chosen);
  return read_image(file, json_object_get(tree, chosen), chosen, record);
}

static bool is_bop(const json_t *tree) {
  void *first = json_object_iter((json_t *)tree);
  bool one =
      vl_camera_has(tree, "fx") && vl_camera_has(tree, "cx") && !vl_camera_has(tree, "fl_x");
  return one || (first && vl_camera_has(json_object_iter_value(first), "cam_K"));
}

const vlCameraFormat vl_format_bop = {
    .name = "bop",
    .rotates = true,
    .known =
        "/ cam_K cam_R_w2c cam_t_w2c depth_scale view_level fx fy cx cy width height elev "
        "mode azimuth",
    .geometry = "cam_model",
    .is_tree = is_bop,
    .read = read_bop,
    .holds = VL_HOLDS_POSE,
    .lenses = {VL_LENSES_PINHOLE},
    .form =
        "{\n"
        "  \"0\": {\n"
        "    \"cam_K\": [$K],\n"
        "    \"cam_R_w2c\": [$R],\n"
        "    \"cam_t_w2c\": [$t],\n"
        "    \"depth_scale\": 1.0,\n"
        "    \"width\": $width,\n"
        "    \"height\": $height\n"
        "  }\n"
        "}\n"};
