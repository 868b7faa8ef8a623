/* camera_files/svo.c: SVO's camera files of version 1 (cam_model: Pinhole or ATAN) and version
 * 2 (a rig of cameras, each with camera and T_B_C). Camera axes: x right, y down, z forward.
 * T_B_C is body from camera, and the world's space is that of the body. The first pixel's
 * centre is (0, 0). ATAN's numbers are fractions of the image's sides, and its image begins at
 * (-0.5, -0.5); so cx in velo's pixels is cam_cx times the width. */

#include "base/text.h"
#include "camera_files/fields.h"
#include "velo/projection.h"

static vlResult read_version_1(const vlCameraFile *file, const json_t *tree,
                               vlCameraRecord *record) {
  static const char *const names[] = {"cam_fx", "cam_fy", "cam_cx", "cam_cy"};
  static const char *const lens[] = {"cam_d0", "cam_d1", "cam_d2", "cam_d3"};
  const char *model = vl_camera_text(tree, "cam_model");
  vlCameraDef *d = &record->camera;
  double f[4], k[4] = {0};
  bool atan = vl_text_is(model, "ATAN");
  if (!atan && !vl_text_is(model, "Pinhole"))
    return vl_camera_unknown(file, tree, "cam_model", model, "there are Pinhole, ATAN");
  VL_TRY(vl_camera_sides(file, tree, "cam_width", "cam_height", record));
  VL_TRY(vl_camera_read_named(file, tree, names, 4, false, f));
  VL_TRY(vl_camera_read_named(file, tree, lens, atan ? 1 : 4, true, k));
  vl_camera_set_origin(d);
  if (atan) {
    d->fx = f[0] * d->width;
    d->fy = f[1] * d->height;
    d->cx = f[2] * d->width;
    d->cy = f[3] * d->height;
    if (k[0] != 0.0) {
      d->projection = VL_PROJECTION_FOV;
      d->shape[0] = k[0];
    }
  } else {
    vl_camera_set_centred(d, f);
    vl_camera_set_opencv(d, k, vl_camera_all_zero(k, 4) ? 0 : 4);
  }
  return VL_OK;
}

static const vlLensName lenses[] = {{"radial-tangential", VL_LENS_OPENCV, 4, 4},
                                    {"equidistant", VL_LENS_FISHEYE, 4, 4},
                                    {"fisheye", VL_LENS_FOV, 1, 1},
                                    {0}};

static vlResult read_rig_camera(const vlCameraFile *file, const json_t *item,
                                vlCameraRecord *record) {
  const json_t *camera;
  vlCameraDef *d = &record->camera;
  double k[5], m[16];
  VL_TRY(vl_camera_field(file, item, "camera", &camera));
  const char *type = vl_camera_text(camera, "type");
  bool unified = vl_text_is(type, "omni"); /* its intrinsics begin with xi */
  if (!unified && type && !vl_text_is(type, "pinhole"))
    return vl_camera_unknown(file, camera, "type", type, "there are pinhole, omni");
  VL_TRY(vl_camera_list(file, camera, "intrinsics", k, unified ? 5 : 4));
  VL_TRY(vl_camera_sides(file, camera, "image_width", "image_height", record));
  if (unified) {
    d->projection = VL_PROJECTION_UNIFIED;
    d->shape[0] = k[0];
  }
  double delay = 0;
  VL_TRY(vl_camera_optional(file, camera, "line-delay-nanoseconds", &delay));
  if (delay != 0.0)
    return vl_camera_wrong_in(file, camera, "line-delay-nanoseconds",
                              "svo: rows of an image at different times are not taken");
  vl_camera_set_centred(d, unified ? k + 1 : k);
  const json_t *lens = json_object_get(camera, "distortion");
  if (lens)
    VL_TRY(
        vl_camera_read_lens(file, lens, "type", "parameters", lenses, "distortion",
                            "there are radial-tangential and equidistant of 4, fisheye of 1, "
                            "none",
                            d));
  vl_camera_set_origin(d);
  if (vl_camera_has(item, "T_B_C")) {
    VL_TRY(vl_camera_list(file, item, "T_B_C", m, 16));
    vl_camera_set_matrix(d, m, false);
  }
  vl_camera_name(record, vl_camera_text(camera, "label"));
  return VL_OK;
}

static vlResult read_svo(const vlCameraFile *file, const json_t *tree, vlCameraRecord *record) {
  const json_t *cameras = json_object_get(tree, "cameras");
  if (vl_camera_has(tree, "cam_model"))
    return read_version_1(file, tree, record);
  const json_t *item, *chosen = NULL;
  record->frames = 0;
  VL_EACH(item, cameras)
    vl_camera_offer(file, item, vl_camera_text(json_object_get(item, "camera"), "label"),
                    record, &chosen);
  return chosen ? read_rig_camera(file, chosen, record)
                : vl_camera_none_in(file, tree, "cameras", "camera", record);
}

static bool is_svo(const json_t *tree) {
  return vl_camera_has(tree, "cam_model") || vl_camera_has_in(tree, "cameras", "camera");
}

static vlResult write_svo(const vlFittedCamera *fit, vlCameraText *text) {
  static const char *const lens_words[] = {"none", "radial-tangential", "equidistant",
                                           "fisheye"};
  const vlCamera *c = &fit->camera;
  const bool unified = fit->family == VL_LENS_UNIFIED;
  const double xi = c->shape[0], numbers[2] = {unified ? 5.0 : 4.0, fit->count};
  return VL_PUT_FORM(text, fit,
                     "label: rig\n"
                     "cameras:\n"
                     "- camera:\n"
                     "    label: $name\n"
                     "    type: $type\n"
                     "    image_width: $width\n"
                     "    image_height: $height\n"
                     "    intrinsics:\n"
                     "      cols: 1\n"
                     "      rows: $numbers@0\n"
                     "      data: [$mirror$fx, $fy, $cx0, $cy0]\n"
                     "    distortion:\n"
                     "      type: $lens\n"
                     "$coefficients  T_B_C:\n"
                     "    cols: 4\n"
                     "    rows: 4\n"
                     "    data: [$pose]\n",
                     VL_WORD("type", unified ? "omni" : "pinhole"),
                     VL_VALUES("numbers", numbers, 2), VL_PART("mirror", unified, "$xi, "),
                     VL_VALUES("xi", &xi, 1),
                     VL_WORD("lens", lens_words[unified ? fit->count > 0 : fit->family]),
                     VL_PART("coefficients", fit->count,
                             "      parameters:\n"
                             "        cols: 1\n"
                             "        rows: $numbers@1\n"
                             "        data: [$k]\n"),
                     VL_VALUES("k", fit->k, fit->count));
}

const vlCameraFormat vl_format_svo = {
    .name = "svo",
    .rotates = true,
    .is_tree = is_svo,
    .known =
        "cam_model cam_width cam_height cam_cx cam_cy cam_fx cam_fy cam_d0 cam_d1 cam_d2 cam_d3 "
        "cameras camera label type intrinsics parameters distortion image_height "
        "image_width T_B_C cols rows data line-delay-nanoseconds id time-delay "
        "serialno imu_params imu_initialization mask",
    .read = read_svo,
    .holds = VL_HOLDS_POSE,
    .lenses = {VL_LENSES_COMMON | 1 << VL_LENS_FOV | 1 << VL_LENS_UNIFIED, 0, 4},
    .unnamed = "cam0",
    .write = write_svo};
