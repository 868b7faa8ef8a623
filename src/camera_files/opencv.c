/* camera_files/opencv.c: OpenCV's camera files, and ROS's camera_info, which derives from them. x right, y down, z
 * forward; camera from world; the first pixel's centre is (0, 0): velo's cx and cy are larger by 0.5. */
#include <math.h>
#include <string.h>

#include "base/text.h"
#include "camera_files/files.h"

/* The names of lens models in both dialects; without a name the number of coefficients decides. */
static vlResult read_lens(const vlCameraFile *file, const json_t *tree, const char *coefficients, vlCameraDef *d) {
  static const char *const names[] = {"opencv",     "pinhole", "plumb_bob", "rational_polynomial",
                                      "thin_prism", "tilted",  "fisheye",   "equidistant",
                                      "none"};
  const char *model = vl_camera_text(tree, "distortion_model");
  if (json_object_get(tree, "distortion_model") && !model)
    return vl_camera_wrong(file, "%s: \"distortion_model\" must be a word", file->dialect);
  bool fisheye = json_number_value(json_object_get(tree, "fisheye_model")) != 0.0;
  size_t found = 0, count = sizeof names / sizeof *names;
  while (model && model[0] && found < count && strcmp(model, names[found]) != 0) found++;
  if (found == count) {
    char known[300];
    vl_tell_names(known, sizeof known, model, names, count);
    return vl_camera_wrong(file, "%s: unknown distortion_model \"%s\"%s", file->dialect, vl_short_text(model).text,
                           known);
  }
  fisheye = fisheye || (model && (strcmp(model, "fisheye") == 0 || strcmp(model, "equidistant") == 0));
  double *k = d->distortion_coefficients;
  uint32_t n = 0;
  vlResult result = vl_camera_numbers(file, tree, coefficients, k, 0, 14, &n);
  if (result != VL_OK) return result;
  bool zero = true;
  for (uint32_t i = 0; i < n; i++) zero = zero && k[i] == 0.0;
  if (fisheye) {
    if (n != 4 && n != 0)
      return vl_camera_wrong(file, "%s: \"%s\" holds %u numbers; a fisheye has 4", file->dialect, coefficients, n);
    d->projection = VL_PROJECTION_EQUIDISTANT;
    d->distortion = n ? VL_DISTORTION_RADIAL : VL_DISTORTION_NONE;
  } else {
    if (n != 0 && n != 4 && n != 5 && n != 8 && n != 12 && n != 14)
      return vl_camera_wrong(file, "%s: \"%s\" holds %u numbers; there are 0, 4, 5, 8, 12 or 14", file->dialect,
                             coefficients, n);
    if (model && strcmp(model, "none") == 0 && !zero)
      return vl_camera_wrong(file, "%s: distortion_model is \"none\", but \"%s\" is not zero", file->dialect,
                             coefficients);
    d->distortion = n ? VL_DISTORTION_OPENCV : VL_DISTORTION_NONE;
  }
  d->distortion_count = n;
  return VL_OK;
}

static vlResult read_matrix(const vlCameraFile *file, const json_t *tree, const char *key, vlCameraDef *d) {
  double k[9];
  vlResult result = vl_camera_numbers(file, tree, key, k, 9, 9, NULL);
  if (result != VL_OK) return result;
  if (k[3] != 0.0 || k[6] != 0.0 || k[7] != 0.0 || k[8] != 1.0)
    return vl_camera_wrong(file, "%s: \"%s\" must be [fx 0 cx; 0 fy cy; 0 0 1]", file->dialect, key);
  if (k[1] != 0.0)
    return vl_camera_wrong(file,
                           "%s: \"%s\" has a skew of %g, which OpenCV's projection takes no notice of; set it to 0",
                           file->dialect, key, k[1]);
  d->fx = k[0], d->fy = k[4];
  d->cx = k[2] + 0.5, d->cy = k[5] + 0.5;
  return VL_OK;
}

/* A negative fy (as in ICL-NUIM's RGB-D sequences): a camera with y up, in a left-handed world. Converted to fy > 0
 * and a pose that mirrors y, which gives the same pixels. */
static vlResult turn_y(const vlCameraFile *file, vlCameraDef *d) {
  if (!(d->fy < 0.0)) return VL_OK;
  for (uint32_t i = 0; i < d->distortion_count; i++)
    if (d->distortion_coefficients[i] != 0.0)
      return vl_camera_wrong(file, "%s: fy is %g; below zero it goes without distortion only", file->dialect, d->fy);
  d->fy = -d->fy;
  for (int row = 0; row < 3; row++) d->world_from_camera[4 * row + 1] = 0.0 - d->world_from_camera[4 * row + 1];
  return VL_OK;
}

/* rvec, tvec: camera from world; both or neither. */
static vlResult read_pose(const vlCameraFile *file, const json_t *tree, vlCameraDef *d) {
  double v[3] = {0, 0, 0}, t[3] = {0, 0, 0}, r[9];
  bool any = json_object_get(tree, "rvec") || json_object_get(tree, "tvec");
  vlResult result = VL_OK;
  if (any) result = vl_camera_numbers(file, tree, "rvec", v, 3, 3, NULL);
  if (any && result == VL_OK) result = vl_camera_numbers(file, tree, "tvec", t, 3, 3, NULL);
  vl_rotation_from_vector(v, r);
  vl_camera_set_pose(d, r, t);
  return result;
}

vlResult vl_camera_read_opencv(const vlCameraFile *file, const json_t *tree, vlCameraRecord *record) {
  vlCameraDef *d = &record->camera;
  vlResult result = vl_camera_side(file, tree, "image_width", &d->width);
  if (result == VL_OK) result = vl_camera_side(file, tree, "image_height", &d->height);
  if (result == VL_OK) result = read_matrix(file, tree, "camera_matrix", d);
  if (result == VL_OK) result = read_lens(file, tree, "distortion_coefficients", d);
  if (result == VL_OK) result = read_pose(file, tree, d);
  if (result == VL_OK) result = turn_y(file, d);
  vl_camera_name(record, vl_camera_text(tree, "camera_name"));
  return result;
}

vlResult vl_camera_read_ros(const vlCameraFile *file, const json_t *tree, vlCameraRecord *record) {
  vlCameraDef *d = &record->camera;
  /* field names of the ROS message (either version), or of the file */
  const char *k = json_object_get(tree, "K") ? "K" : json_object_get(tree, "k") ? "k" : "camera_matrix";
  const char *c = json_object_get(tree, "D") ? "D" : json_object_get(tree, "d") ? "d" : "distortion_coefficients";
  bool message = k[0] != 'c';
  double binning[2] = {0, 0};
  vlResult result = vl_camera_side(file, tree, message ? "width" : "image_width", &d->width);
  if (result == VL_OK) result = vl_camera_side(file, tree, message ? "height" : "image_height", &d->height);
  if (result == VL_OK) result = read_matrix(file, tree, k, d);
  if (result == VL_OK) result = read_lens(file, tree, c, d);
  if (result == VL_OK) result = vl_camera_optional(file, tree, "binning_x", &binning[0]);
  if (result == VL_OK) result = vl_camera_optional(file, tree, "binning_y", &binning[1]);
  if (result == VL_OK && (binning[0] > 1.0 || binning[1] > 1.0))
    return vl_camera_wrong(file, "ros: binning of %g x %g pixels is not taken; give the full image's camera",
                           binning[0], binning[1]);
  double identity[9], none[3] = {0, 0, 0};
  vl_rotation_from_vector(none, identity);
  vl_camera_set_pose(d, identity, none);
  vl_camera_name(record, vl_camera_text(tree, "camera_name"));
  return result;
}

/* The lens as both dialects write it: coefficients, and whether it is a fisheye. */
static vlResult lens_of(const vlCameraFile *file, const vlCameraDef *d, double k[14], uint32_t *n, bool *fisheye) {
  *fisheye = d->projection == VL_PROJECTION_EQUIDISTANT;
  *n = 0;
  if (*fisheye && d->distortion <= VL_DISTORTION_RADIAL && d->distortion != VL_DISTORTION_OPENCV) {
    memset(k, 0, 14 * sizeof *k);
    memcpy(k, d->distortion_coefficients, d->distortion_count * sizeof *k);
    *n = 4;
    return VL_OK;
  }
  if (d->projection != VL_PROJECTION_PERSPECTIVE || !vl_camera_as_opencv(d, k, n)) return vl_camera_no_model(file, d);
  return VL_OK;
}

static void put_matrix(vlCameraText *text, const char *name, int rows, int columns, const double *data, bool tagged) {
  vl_camera_put(text, "%s: %s\n  rows: %d\n  cols: %d\n", name, tagged ? "!!opencv-matrix" : "", rows, columns);
  if (tagged) vl_camera_put(text, "  dt: d\n");
  vl_camera_put(text, "  data: [");
  vl_camera_put_numbers(text, data, (uint32_t)(rows * columns));
  vl_camera_put(text, "]\n");
}

static void put_list(vlCameraText *text, const char *name, const double *data, uint32_t count) {
  vl_camera_put(text, ",\n  \"%s\": [", name);
  vl_camera_put_numbers(text, data, count);
  vl_camera_put(text, "]");
}

vlResult vl_camera_write_opencv(const vlCameraFile *file, const vlCameraRecord *record, vlCameraText *text) {
  vlCamera c;
  double k[14], r[9], v[3], t[3];
  uint32_t n = 0;
  bool fisheye = false;
  vlResult result = vl_camera_fit(file, record, VL_HOLDS_POSE, &c);
  if (result == VL_OK) result = lens_of(file, &record->camera, k, &n, &fisheye);
  if (result != VL_OK) return result;
  vl_camera_get_pose(&c, r, t);
  vl_rotation_to_vector(r, v);
  const double m[9] = {c.fx, 0, c.cx - 0.5, 0, c.fy, c.cy - 0.5, 0, 0, 1};
  if (vl_ends_with(file->path, ".json")) {
    vl_camera_put(text, "{\n  \"image_width\": %u,\n  \"image_height\": %u,\n  \"camera_matrix\": [", c.width,
                  c.height);
    for (int i = 0; i < 3; i++) {
      vl_camera_put(text, "%s[", i ? ", " : "");
      vl_camera_put_numbers(text, m + 3 * i, 3);
      vl_camera_put(text, "]");
    }
    vl_camera_put(text, "]");
    if (fisheye) vl_camera_put(text, ",\n  \"distortion_model\": \"fisheye\"");
    put_list(text, "distortion_coefficients", k, n);
    put_list(text, "rvec", v, 3);
    put_list(text, "tvec", t, 3);
    vl_camera_put(text, "\n}\n");
    return VL_OK;
  }
  vl_camera_put(text, "%%YAML:1.0\n---\nimage_width: %u\nimage_height: %u\n", c.width, c.height);
  put_matrix(text, "camera_matrix", 3, 3, m, true);
  if (fisheye) vl_camera_put(text, "distortion_model: fisheye\n");
  if (n == 0) n = 4; /* FileStorage has no empty matrix; four zeros are equivalent */
  put_matrix(text, "distortion_coefficients", (int)n, 1, k, true);
  put_matrix(text, "rvec", 3, 1, v, true);
  put_matrix(text, "tvec", 3, 1, t, true);
  return VL_OK;
}

vlResult vl_camera_write_ros(const vlCameraFile *file, const vlCameraRecord *record, vlCameraText *text) {
  vlCamera c;
  double k[14];
  uint32_t n = 0;
  bool fisheye = false;
  vlResult result = vl_camera_fit(file, record, 0, &c);
  if (result == VL_OK) result = lens_of(file, &record->camera, k, &n, &fisheye);
  if (result != VL_OK) return result;
  if (n > 8) {
    bool present = false;
    for (int i = 8; i < 14; i++) present = present || k[i] != 0.0;
    result = vl_camera_refuse(file, "distortion", present); /* s1 to s4, tilt: ROS has no such coefficients */
    if (result != VL_OK) return result;
    n = 8;
  }
  if (!fisheye && n < 5) n = 5;
  const double m[9] = {c.fx, 0, c.cx - 0.5, 0, c.fy, c.cy - 0.5, 0, 0, 1};
  const double identity[9] = {1, 0, 0, 0, 1, 0, 0, 0, 1};
  const double p[12] = {m[0], m[1], m[2], 0, m[3], m[4], m[5], 0, 0, 0, 1, 0};
  vl_camera_put(text, "image_width: %u\nimage_height: %u\ncamera_name: ", c.width, c.height);
  vl_camera_put_string(text, record->name[0] ? record->name : "camera");
  vl_camera_put(text, "\n");
  put_matrix(text, "camera_matrix", 3, 3, m, false);
  vl_camera_put(text, "distortion_model: %s\n", fisheye ? "equidistant" : n == 8 ? "rational_polynomial" : "plumb_bob");
  put_matrix(text, "distortion_coefficients", 1, (int)n, k, false);
  put_matrix(text, "rectification_matrix", 3, 3, identity, false);
  put_matrix(text, "projection_matrix", 3, 4, p, false);
  return VL_OK;
}
