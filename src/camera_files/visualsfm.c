/* camera_files/visualsfm.c: VisualSFM's .nvm (NVM_V3): a line for each camera: image, focal
 * length, quaternion w x y z (camera from world), the camera's centre, radial distortion r, 0.
 * Camera axes: x right, y down, z forward. The principal point is the image's middle, or that
 * of FixedK in the first line. The file has no image size.
 *
 * r maps pixels to rays: with m the pixel's point in units of f, the ray is (1 + r |m|^2) m.
 * The opposite direction, m = g(r |u|^2) u with g (1 + s g^2) = 1, is OpenCV's rational model
 * with the coefficients of g's Pade approximant [3/3]: its relative error is 8e-9 at r |u|^2 =
 * 0.05 and 5e-7 at 0.1. */
#include <string.h>

#include "camera_files/fields.h"
#include "camera_files/lines.h"

/* The Pade approximant of g: numerator and denominator of s, s^2, s^3. */
static const double above[3] = {113.0 / 13.0, 243.0 / 13.0, 85.0 / 13.0};
static const double below[3] = {126.0 / 13.0, 330.0 / 13.0, 193.0 / 13.0};

static void set_distortion(double r, vlCameraDef *d) {
  double k[8] = {0.0}, power = 1.0;
  static const int indices[3] = {0, 1, 4}; /* k1, k2, k3 */
  if (r == 0.0)
    return;
  for (int i = 0; i < 3; i++) {
    power *= r;
    k[indices[i]] = above[i] * power;
    k[5 + i] = below[i] * power;
  }
  vl_camera_set_opencv(d, k, 8);
}

/* The length of the name: up to the tab, or to the first blank after a possible quotation
 * mark. */
static size_t name_length(const char *line) {
  const char *quote = *line == '"' ? strchr(line + 1, '"') : NULL;
  if (quote)
    return (size_t)(quote + 1 - line);
  size_t tab = strcspn(line, "\t");
  return line[tab] ? tab : strcspn(line, " ");
}

static vlResult read_visualsfm(const vlCameraFile *file, const char *text, size_t size,
                               vlCameraRecord *record) {
  vlCameraLines lines = {.at = text, .end = text + size};
  vlCameraDef *d = &record->camera;
  double fixed[5] = {0.0}, count = 0.0, v[10], r[9];
  bool taken = false;
  vl_camera_next_line(&lines);
  const char *k = strstr(lines.text, "FixedK");
  if (k)
    VL_TRY(vl_camera_line_numbers(file, &lines, k + 6, fixed, 4, 5));
  if (!vl_camera_next_line(&lines))
    return vl_camera_wrong(file, "visualsfm: the file has no camera");
  VL_TRY(vl_camera_line_numbers(file, &lines, lines.text, &count, 1, 1));
  if (!(count >= 1.0 && count <= 1e7))
    return vl_camera_wrong_line(file, &lines, lines.text, "the file has no camera");
  record->frames = (uint32_t)count;
  for (uint32_t i = 0; i < record->frames && !taken; i++) {
    char name[sizeof record->name];
    if (!vl_camera_next_line(&lines))
      return vl_camera_wrong(file, "visualsfm: the file ends within the cameras");
    size_t length = name_length(lines.text), bare = lines.text[0] == '"' ? length - 2 : length;
    if (bare > sizeof name - 1)
      bare = sizeof name - 1;
    memcpy(name, lines.text + (bare < length ? 1 : 0), bare);
    name[bare] = 0;
    taken = vl_camera_is_frame(file, i, name);
    if (!taken)
      continue;
    /* the name is in front of the last ten numbers */
    VL_TRY(vl_camera_line_numbers(file, &lines, lines.text + length, v, 10, 10));
    vl_camera_name(record, name);
  }
  if (!taken)
    return vl_camera_no_frame(file, "camera", record);
  if (!vl_rotation_from_quaternion(v + 1, r))
    return vl_camera_wrong_line(file, &lines, lines.text, "the quaternion is no rotation");
  vl_camera_set_centre(d, r, v + 5);
  VL_TRY(vl_camera_size_beside(file, (const char *const[]){record->name, NULL}, record));
  d->fx = d->fy = v[0];
  d->cx = 0.5 * d->width;
  d->cy = 0.5 * d->height;
  if (k) {
    d->fx = fixed[0];
    d->cx = fixed[1];
    d->fy = fixed[2];
    d->cy = fixed[3];
  }
  set_distortion(v[8], d);
  return VL_OK;
}

static bool is_visualsfm(const char *text, VL_UNUSED size_t size) {
  return strncmp(text, "NVM_V3", 6) == 0;
}

static vlResult write_visualsfm(const vlFittedCamera *fit, vlCameraText *text) {
  const vlCamera *c = &fit->camera;
  double r[9], t[3], q[4];
  vl_camera_get_pose(c, r, t);
  vl_rotation_to_quaternion(r, q);
  const char *name = vl_camera_name_without(fit, "\"\n", "image.jpg");
  return VL_PUT_FORM(
      text, fit,
      "NVM_V3 FixedK $fx $cx $fy $cy 0\n\n1\n\"$own\"\t$fx $q:s $centre:s 0 0\n\n0\n",
      VL_WORD("own", name), VL_VALUES("q", q, 4));
}

const vlCameraFormat vl_format_visualsfm = {.name = "visualsfm",
                                            .rotates = true,
                                            .is_text = is_visualsfm,
                                            .read_text = read_visualsfm,
                                            .holds = VL_HOLDS_POSE,
                                            .lenses = {VL_LENSES_PINHOLE},
                                            .write = write_visualsfm};
