/* camera_files/nerf.c: NeRF's transforms.json. Camera axes x right, y up, z back; world from
 * camera; pixels count from the image's corner, as in velo. */
#include <math.h>

#include "camera_files/fields.h"
#include "camera_files/trajectory.h"

#include "base/text.h"
#include "math/elementary.h"
#include "velo/distortion.h"
#include "velo/projection.h"

/* Returns the object that holds a key. The value in a frame overrides the value of the file. */
static const json_t *holder(const json_t *frame, const json_t *tree, const char *key) {
  return json_object_get(frame, key) ? frame : tree;
}

/* Project Aria's Fisheye624, as nerfstudio writes it: k0 to k5, p0 p1, s0 to s3. */
static vlResult read_fisheye624(const vlCameraFile *file, const json_t *frame,
                                const json_t *tree, vlCameraDef *d) {
  const char *key = "distortion_params";
  d->projection = VL_PROJECTION_EQUIDISTANT;
  d->distortion = VL_DISTORTION_RAD_TAN_THIN_PRISM;
  d->distortion_count = 12;
  return vl_camera_list(file, holder(frame, tree, key), key, d->distortion_coefficients, 12);
}

static vlResult read_lens(const vlCameraFile *file, const json_t *frame, const json_t *tree,
                          vlCameraDef *d) {
  static const char *const names[] = {"k1", "k2", "p1", "p2", "k3", "k4"};
  double k[6] = {0};
  for (int i = 0; i < 6; i++)
    VL_TRY(vl_camera_optional(file, holder(frame, tree, names[i]), names[i], &k[i]));
  const char *model = vl_camera_text(holder(frame, tree, "camera_model"), "camera_model");
  if (model && vl_text_is(model, "FISHEYE624")) {
    for (int i = 0; i < 6; i++)
      if (k[i] != 0.0)
        return vl_camera_wrong_in(file, holder(frame, tree, names[i]), names[i],
                                  "nerf: FISHEYE624 has \"distortion_params\" and no \"%s\"",
                                  names[i]);
    return read_fisheye624(file, frame, tree, d);
  }
  if (json_object_get(holder(frame, tree, "distortion_params"), "distortion_params"))
    return vl_camera_wrong_in(file, holder(frame, tree, "distortion_params"),
                              "distortion_params",
                              "nerf: \"distortion_params\" is taken with the camera_model "
                              "FISHEYE624 only");
  bool fisheye = model && vl_has_word("OPENCV_FISHEYE RADIAL_FISHEYE", model);
  fisheye = fisheye || json_is_true(json_object_get(tree, "is_fisheye"));
  if (model && !fisheye &&
      !vl_has_word("OPENCV PINHOLE SIMPLE_PINHOLE RADIAL SIMPLE_RADIAL", model))
    return vl_camera_unknown(file, holder(frame, tree, "camera_model"), "camera_model", model,
                             "there are PINHOLE, SIMPLE_PINHOLE, SIMPLE_RADIAL, RADIAL, "
                             "OPENCV, OPENCV_FISHEYE, FISHEYE624");
  const bool tangential = !vl_camera_all_zero(k + 2, 2);
  if (fisheye && tangential)
    return vl_camera_wrong(file, "nerf: a fisheye has no \"p1\" and \"p2\"");
  if (!fisheye && k[5] != 0.0)
    return vl_camera_wrong(file, "nerf: \"k4\" is taken for fisheyes only");
  if (fisheye) {
    vl_camera_set_fisheye(d, (double[]){k[0], k[1], k[4], k[5]});
  } else if (!vl_camera_all_zero(k, 5)) {
    vl_camera_set_opencv(d, k, k[4] != 0.0 ? 5 : 4);
  }
  return VL_OK;
}

/* Fields of instant-ngp that make another camera of it: refused, so that none is read as a
 * pinhole. */
static vlResult refuse_others(const vlCameraFile *file, const json_t *frame,
                              const json_t *tree) {
  static const char *const polynomial[] = {"ftheta_p0", "ftheta_p1", "ftheta_p2", "ftheta_p3",
                                           "ftheta_p4"};
  static const char *const flags[] = {"latlong", "equirectangular"};
  for (size_t i = 0; i < VL_LENGTH(polynomial); i++)
    if (vl_camera_has(holder(frame, tree, polynomial[i]), polynomial[i]))
      return vl_camera_wrong_in(file, holder(frame, tree, polynomial[i]), polynomial[i],
                                "nerf: \"%s\": the f-theta projection is not taken",
                                polynomial[i]);
  for (size_t i = 0; i < VL_LENGTH(flags); i++)
    if (json_is_true(json_object_get(holder(frame, tree, flags[i]), flags[i])))
      return vl_camera_wrong_in(
          file, holder(frame, tree, flags[i]), flags[i],
          "nerf: \"%s\" is not taken; there are perspective cameras and fisheyes", flags[i]);
  const char *start = "transform_matrix_start", *end = "transform_matrix_end";
  const json_t *first = json_object_get(frame, start), *last = json_object_get(frame, end);
  if ((first || last) && (!first || !last || !json_equal(first, last)))
    return vl_camera_wrong_in(
        file, frame, first ? start : end,
        "nerf: \"%s\": the pose of a rolling shutter, which moves, is not taken",
        first ? start : end);
  return VL_OK;
}

/* w and h; the synthetic scenes have none: the size is that of the frame's image. */
static vlResult read_size(const vlCameraFile *file, const json_t *frame, const json_t *tree,
                          vlCameraRecord *record) {
  const json_t *w = holder(frame, tree, "w"), *h = holder(frame, tree, "h");
  if (!vl_camera_has(w, "w") && !vl_camera_has(h, "h")) {
    const char *image = vl_camera_text(frame, "file_path");
    return vl_camera_size_beside(file, (const char *const[]){image ? image : "", NULL}, record);
  }
  VL_TRY(vl_camera_side(file, w, "w", &record->camera.width));
  return vl_camera_side(file, h, "h", &record->camera.height);
}

/* Where one object has a focal length and the angle of the same axis, both must agree. */
static vlResult check_angle(const vlCameraFile *file, const json_t *object, const char *focal,
                            const char *angle, uint32_t side) {
  double pixels = 0.0, radians = 0.0;
  if (!vl_camera_has(object, focal) || !vl_camera_has(object, angle))
    return VL_OK;
  VL_TRY(vl_camera_number(file, object, focal, &pixels));
  VL_TRY(vl_camera_number(file, object, angle, &radians));
  if (!(radians > 0.0 && radians < 3.14159))
    return VL_OK;
  const double other = 0.5 * side / vl_precise_tan(0.5 * radians);
  if (fabs(other - pixels) <= 0.02 * fabs(pixels)) /* rounding */
    return VL_OK;
  return vl_camera_wrong_in(file, object, focal,
                            "nerf: \"%s\" is %.7g, but \"%s\" and the image's size make it "
                            "%.7g; remove one",
                            focal, pixels, angle, other);
}

vlResult vl_camera_read_nerf_frame(const vlCameraFile *file, const json_t *frame,
                                   const json_t *tree, vlCameraRecord *record) {
  vlCameraDef *d = &record->camera;
  double m[16] = {0}, angle_x = VL_UNSET, angle_y = VL_UNSET;
  uint32_t count;
  VL_TRY(read_size(file, frame, tree, record));
  const struct {
    const char *key;
    double *value;
  } fields[] = {{"fl_x", &d->fx},
                {"fl_y", &d->fy},
                {"cx", &d->cx},
                {"cy", &d->cy},
                {"camera_angle_x", &angle_x},
                {"camera_angle_y", &angle_y}};
  for (size_t i = 0; i < 6; i++)
    VL_TRY(vl_camera_optional(file, holder(frame, tree, fields[i].key), fields[i].key,
                              fields[i].value));
  VL_TRY(check_angle(file, holder(frame, tree, "fl_x"), "fl_x", "camera_angle_x", d->width));
  VL_TRY(check_angle(file, holder(frame, tree, "fl_y"), "fl_y", "camera_angle_y", d->height));
  VL_TRY(refuse_others(file, frame, tree));
  VL_TRY(read_lens(file, frame, tree, d));
  VL_TRY(vl_camera_numbers(file, frame, "transform_matrix", m, 12, 16, &count));
  /* the angles give the focal length without distortion; fl_x overrides them */
  if (vl_is_unset(d->fx) && !vl_is_unset(angle_x))
    d->fx = 0.5 * d->width / vl_precise_tan(0.5 * angle_x);
  if (vl_is_unset(d->fy) && !vl_is_unset(angle_y))
    d->fy = 0.5 * d->height / vl_precise_tan(0.5 * angle_y);
  if (vl_is_unset(d->fx) && vl_is_unset(d->fy))
    return vl_camera_wrong(file,
                           "nerf: the field \"fl_x\" is missing, and \"camera_angle_x\" too");
  if (count == 12)
    m[15] = 1.0;
  vl_camera_set_flipped(d, m);
  vl_camera_name(record, vl_camera_text(frame, "file_path"));
  return VL_OK;
}

static vlResult read_nerf(const vlCameraFile *file, const json_t *tree,
                          vlCameraRecord *record) {
  const json_t *frames;
  VL_TRY(vl_camera_field(file, tree, "frames", &frames));
  if (!json_is_array(frames))
    return vl_camera_wrong_in(file, tree, "frames", "nerf: \"frames\" must be a list");
  record->frames = (uint32_t)json_array_size(frames);
  for (uint32_t i = 0; i < record->frames; i++) {
    const json_t *frame = json_array_get(frames, i);
    if (!json_is_object(frame))
      return vl_camera_wrong_in(file, frames, NULL, "nerf: frame %u is no object", i);
    if (vl_camera_is_frame(file, i, vl_camera_text(frame, "file_path")))
      return vl_camera_read_nerf_frame(file, frame, tree, record);
  }
  return vl_camera_no_frame(file, "frame", record);
}

static vlResult write_nerf(const vlFittedCamera *fit, vlCameraText *text) {
  static const char *const radial[] = {"k1", "k2", "k3", "k4"};
  static const char *const brown[] = {"k1", "k2", "p1", "p2", "k3"};
  const vlCameraDef *d = &fit->record->camera;
  const bool aria = d->projection == VL_PROJECTION_EQUIDISTANT &&
                    d->distortion == VL_DISTORTION_RAD_TAN_THIN_PRISM;
  const bool fisheye = fit->family == VL_LENS_FISHEYE;
  if ((!aria && fit->family > VL_LENS_FISHEYE) || !vl_camera_all_zero(fit->k + 5, 9))
    return vl_camera_no_model(fit->file, d);
  return VL_PUT_FORM(text, fit,
                     "{\n"
                     "  \"camera_model\": \"$model\",\n"
                     "  \"w\": $width,\n"
                     "  \"h\": $height,\n"
                     "  \"fl_x\": $fx,\n"
                     "  \"fl_y\": $fy,\n"
                     "  \"cx\": $cx,\n"
                     "  \"cy\": $cy$lens$aria,\n"
                     "  \"frames\": [\n"
                     "    {\"file_path\": $name,\n"
                     "     \"transform_matrix\": [$flipped:4]}\n"
                     "  ]\n"
                     "}\n",
                     VL_WORD("model", aria         ? "FISHEYE624"
                                      : fisheye    ? "OPENCV_FISHEYE"
                                      : fit->count ? "OPENCV"
                                                   : "PINHOLE"),
                     VL_NAMED("lens", fisheye ? radial : brown, fit->k,
                              fisheye      ? 4
                              : fit->count ? 5
                                           : 0,
                              ",\n  \"$item\": $value"),
                     VL_PART("aria", aria, ",\n  \"distortion_params\": [$params]"),
                     VL_VALUES("params", d->distortion_coefficients, 12));
}

const vlCameraFormat vl_format_nerf = {
    .name = "nerf",
    .marks = "frames fl_x camera_angle_x",
    .one_mark = true,
    .known =
        "w h fl_x fl_y cx cy k1 k2 k3 k4 p1 p2 camera_angle_x camera_angle_y camera_model is_fisheye "
        "latlong equirectangular frames file_path transform_matrix transform_matrix_start "
        "transform_matrix_end "
        /* of the synthetic scenes, instant-ngp and nerfstudio; not those that move the world
         * (scale, offset, applied_transform): the poses are taken as they are */
        "rolling_shutter rotation time aabb_scale sharpness depth_file_path mask_path colmap_im_id ply_file_path "
        "train_filenames val_filenames test_filenames integer_depth_scale enable_depth_loading "
        "depth_unit_scale_factor "
        /* the coefficients of FISHEYE624, and in which pixels of it to train */
        "distortion_params fisheye_crop_radius",
    .read = read_nerf,
    .holds = VL_HOLDS_POSE | VL_HOLDS_SCALE,
    .unnamed = "",
    .write = write_nerf};
