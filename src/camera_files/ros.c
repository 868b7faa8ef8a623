/* camera_files/ros.c: ROS's camera_info: YAML as the calibrator writes it, the message's
 * fields, and the older .ini. As OpenCV: x right, y down, z forward; the first pixel's centre
 * is (0, 0). No pose. */
#include <math.h>
#include <stdio.h>

#include "base/text.h"
#include "camera_files/fields.h"
#include "camera_files/lines.h"
#include "camera_files/opencv.h"

static vlResult read_ros(const vlCameraFile *file, const json_t *tree, vlCameraRecord *record) {
  vlCameraDef *d = &record->camera;
  /* field names of the ROS message (either version), or of the file */
  const char *k = json_object_get(tree, "K")   ? "K"
                  : json_object_get(tree, "k") ? "k"
                                               : "camera_matrix";
  const char *c = json_object_get(tree, "D")   ? "D"
                  : json_object_get(tree, "d") ? "d"
                                               : "distortion_coefficients";
  bool message = k[0] != 'c';
  VL_TRY(VL_READ_FIELDS(file, tree, VL_FIELD_SIDE(message ? "width" : "image_width", &d->width),
                        VL_FIELD_SIDE(message ? "height" : "image_height", &d->height)));
  VL_TRY(vl_opencv_read_matrix(file, tree, k, d));
  VL_TRY(vl_opencv_read_lens(file, tree, c, d));
  VL_TRY(vl_opencv_refuse_part(file, tree, d));
  vl_camera_set_origin(d);
  vl_camera_name(record, vl_camera_text(tree, "camera_name"));
  return VL_OK;
}

/* ---- .ini -------------------------------------------------------------------------------- */

typedef struct {
  const vlCameraFile *file;
  vlCameraLines lines;
} Ini;

/* Reads between `min` and `max` numbers from the next lines. The line after the last number
 * stays unread. */
static vlResult ini_numbers(Ini *ini, const char *key, double *values, uint32_t min,
                            uint32_t max, uint32_t *count) {
  uint32_t line = ini->lines.number;
  bool more = true;
  *count = 0;
  while (more && *count < max) {
    vlCameraLines ahead = ini->lines;
    if (!vl_camera_next_line(&ahead))
      break;
    const char *at = ahead.text;
    if (*at == '[' || (*count > 0 && !*at))
      break;
    for (char *end; *at; at = end) {
      double value = vl_camera_parse(at, &end);
      if (end == at && *count == 0)
        return vl_camera_wrong_line(ini->file, &ahead, at, "\"%s\" needs numbers", key);
      if (end == at) {
        more = false; /* the next key */
        break;
      }
      if (*count == max)
        return vl_camera_wrong_line(ini->file, &ahead, at, "more than %u numbers", max);
      if (!isfinite(value))
        return vl_camera_wrong_line(ini->file, &ahead, at, "a number is not finite");
      values[(*count)++] = value;
      end += strspn(end, " \t");
    }
    if (more)
      ini->lines = ahead;
  }
  if (*count >= min)
    return VL_OK;
  return vl_camera_wrong_at(ini->file, line, 1, "ros: \"%s\" holds %u numbers; it must hold %u",
                            key, *count, min);
}

/* Every section except [image] and [externals] is a camera. */
static vlResult read_ini(const vlCameraFile *file, const char *text, size_t size,
                         vlCameraRecord *record) {
  Ini ini = {.file = file, .lines = {.at = text, .end = text + size}};
  vlCameraDef *d = &record->camera;
  double side[2] = {0, 0}, k[9], lens[8];
  /* where a missing value should be */
  uint32_t count, lenses = 0, side_line = 1, matrix_line = 1;
  bool wanted = false, found = false, matrix = false;
  vlResult result = VL_OK;
  record->frames = 0;
  while (result == VL_OK && vl_camera_next_line(&ini.lines)) {
    const char *line = ini.lines.text;
    if (*line == '[') {
      char name[64];
      snprintf(name, sizeof name, "%.*s", (int)strcspn(line + 1, "]"), line + 1);
      if (vl_text_is(name, "image"))
        side_line = ini.lines.number;
      if (vl_has_word("image externals", name))
        continue;
      wanted = vl_camera_count(file, found, name, record);
      if (!wanted)
        continue;
      found = true;
      vl_camera_name(record, name);
      matrix_line = ini.lines.number;
    } else if (vl_text_is(line, "width") || vl_text_is(line, "height")) {
      side_line = ini.lines.number;
      result = ini_numbers(&ini, line[0] == 'w' ? "width" : "height", &side[line[0] == 'h'], 1,
                           1, &count);
    } else if (wanted && vl_text_is(line, "camera matrix")) {
      matrix_line = ini.lines.number;
      result = ini_numbers(&ini, "camera matrix", k, 9, 9, &count);
      matrix = result == VL_OK;
    } else if (wanted && vl_text_is(line, "distortion")) {
      result = ini_numbers(&ini, "distortion", lens, 4, 8, &lenses);
    }
  }
  if (result != VL_OK)
    return result;
  if (!found)
    return vl_camera_wrong(file, "ros: there is no camera \"%s\"",
                           vl_camera_asked(file, "0").text);
  if (!vl_camera_set_sides(d, side))
    return vl_camera_wrong_at(file, side_line, 1,
                              "ros: [image] needs width and height in whole pixels");
  if (!matrix || !vl_camera_set_intrinsics(d, k, false))
    return vl_camera_wrong_at(
        file, matrix_line, 1,
        "ros: \"camera matrix\" must be there and be fx 0 cx, 0 fy cy, 0 0 1");
  vl_camera_set_opencv(d, lens, lenses);
  vl_camera_set_origin(d);
  return VL_OK;
}

static bool is_ini(const char *text, size_t size) {
  vlCameraLines lines = {.at = text, .end = text + size};
  return vl_camera_next_line(&lines) && lines.text[0] == '[' && strstr(text, "camera matrix");
}

static bool is_ros(const json_t *tree) {
  bool k = vl_camera_has(tree, "K") || vl_camera_has(tree, "k"),
       d = vl_camera_has(tree, "D") || vl_camera_has(tree, "d");
  return vl_camera_has(tree, "projection_matrix") ||
         vl_camera_has(tree, "rectification_matrix") ||
         (k &&
          (vl_camera_has(tree, "distortion_model") || (d && vl_camera_has(tree, "width"))));
}

/* ---- writing ----------------------------------------------------------------------------- */

static const char ini_form[] =
    "[image]\n"
    "\n"
    "width\n"
    "$width\n"
    "\n"
    "height\n"
    "$height\n"
    "\n"
    "[$own]\n"
    "\n"
    "camera matrix\n"
    "$fx 0 $cx0\n"
    "0 $fy $cy0\n"
    "0 0 1\n"
    "\n"
    "distortion\n"
    "$k:s\n"
    "\n"
    "rectification\n"
    "1 0 0\n"
    "0 1 0\n"
    "0 0 1\n"
    "\n"
    "projection\n"
    "$fx 0 $cx0 0\n"
    "0 $fy $cy0 0\n"
    "0 0 1 0\n";

static const char yaml_form[] =
    "image_width: $width\n"
    "image_height: $height\n"
    "camera_name: $name\n"
    "camera_matrix: \n"
    "  rows: 3\n"
    "  cols: 3\n"
    "  data: [$K]\n"
    "distortion_model: $model\n"
    "distortion_coefficients: \n"
    "  rows: 1\n"
    "  cols: $count\n"
    "  data: [$k]\n"
    "rectification_matrix: \n"
    "  rows: 3\n"
    "  cols: 3\n"
    "  data: [1, 0, 0, 0, 1, 0, 0, 0, 1]\n"
    "projection_matrix: \n"
    "  rows: 3\n"
    "  cols: 4\n"
    "  data: [$fx, 0, $cx0, 0, 0, $fy, $cy0, 0, 0, 0, 1, 0]\n";

static vlResult write_ros(const vlFittedCamera *fit, vlCameraText *text) {
  const bool fisheye = fit->family == VL_LENS_FISHEYE;
  const bool ini = vl_ends_with(fit->file->path, ".ini");
  /* s1 to s4, tilt: ROS has no such coefficients */
  VL_TRY(vl_camera_refuse(fit->file, "distortion", !vl_camera_all_zero(fit->k + 8, 6)));
  if (ini && fisheye)
    return vl_camera_no_model(fit->file, &fit->record->camera);
  const uint32_t n = fisheye ? 4 : fit->count > 5 ? 8 : 5;
  const double count = n;
  const char *name = fit->record->name[0] ? fit->record->name : "camera";
  return VL_PUT_FORM(text, fit, ini ? ini_form : yaml_form, VL_WORD("own", name),
                     VL_WORD("model", fisheye  ? "equidistant"
                                      : n == 8 ? "rational_polynomial"
                                               : "plumb_bob"),
                     VL_VALUES("count", &count, 1), VL_VALUES("k", fit->k, n));
}

const vlCameraFormat vl_format_ros = {
    .name = "ros",
    .is_tree = is_ros,
    .is_text = is_ini,
    .known =
        "image_width image_height width height camera_name camera_matrix K k distortion_model "
        "distortion_coefficients D d rows cols data dt binning_x binning_y roi x_offset "
        "y_offset "
        /* of rectified images, and of the message */
        "rectification_matrix projection_matrix R r P p do_rectify header seq stamp secs "
        "nsecs sec nanosec frame_id",
    .read = read_ros,
    .read_text = read_ini,
    .lenses = {VL_LENSES_COMMON, 0, 14},
    .write = write_ros};
