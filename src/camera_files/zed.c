/* camera_files/zed.c: the calibration of a ZED stereo camera (SN….conf): sections like
 * [LEFT_CAM_HD] with fx fy cx cy and k1 k2 p1 p2 k3, and [STEREO] with Baseline, TY, TZ
 * (millimetres, which stay) and the rotation vector RX, CV, RZ of each resolution. Axes: x
 * right, y down, z forward; the first pixel's centre is (0, 0). The world's space is the left
 * camera's: x' = R x - (Baseline, TY, TZ) is camera from world of the right one. The sections'
 * names tell the image's size. */
#include <stdio.h>

#include "base/text.h"
#include "camera_files/lines.h"

typedef struct {
  const char *name;
  uint32_t width, height;
} Mode;
static const Mode modes[] = {
    {"2K", 2208, 1242},      {"FHD1200", 1920, 1200}, {"FHD", 1920, 1080},
    {"QHDPLUS", 3200, 1800}, {"4K", 3840, 2160},      {"HD1200", 1920, 1200},
    {"HD", 1280, 720},       {"SVGA", 960, 600},      {"VGA", 672, 376}};

/* Returns the section's resolution; null: it is no camera. right: set to whether it is the
 * right camera's. */
static const Mode *mode_of(const char *section, bool *right) {
  *right = strncmp(section, "RIGHT_CAM_", 10) == 0;
  if (!*right && strncmp(section, "LEFT_CAM_", 9) != 0)
    return NULL;
  return VL_CAMERA_ROW(modes, section + (*right ? 10 : 9));
}

/* Reads [NAME]; false: the line is another one. */
static bool is_section(const char *line, char name[64]) {
  size_t length = strcspn(line, "]");
  if (line[0] != '[' || !line[length] || length > 64)
    return false;
  memcpy(name, line + 1, length - 1);
  name[length - 1] = 0;
  return true;
}

/* Whether the file has this section: newer files have sections for the lenses. */
static bool has_section(const char *text, size_t size, const char *section) {
  vlCameraLines lines = {.at = text, .end = text + size};
  char name[64];
  while (vl_camera_next_line(&lines))
    if (is_section(lines.text, name) && vl_text_is(name, section))
      return true;
  return false;
}

/* Reads key=value in a section. *found is false if it is not there. */
static vlResult find_value(const vlCameraFile *file, const char *text, size_t size,
                           const char *section, const char *key, double *value, bool *found) {
  vlCameraLines lines = {.at = text, .end = text + size};
  char name[64] = "";
  size_t length = strlen(key);
  *found = false;
  while (vl_camera_next_line(&lines)) {
    if (is_section(lines.text, name) || !vl_text_is(name, section))
      continue;
    if (strncmp(lines.text, key, length) != 0)
      continue;
    const char *sign = lines.text + length + strspn(lines.text + length, " \t");
    if (*sign != '=')
      continue;
    *found = true;
    return vl_camera_line_numbers(file, &lines, sign + 1, value, 1, 1);
  }
  return VL_OK;
}

static vlResult read_right(const vlCameraFile *file, const char *text, size_t size,
                           const Mode *mode, vlCameraDef *d) {
  static const char *const shifts[] = {"Baseline", "TY", "TZ"};
  static const char *const turns[] = {"RX", "CV", "RZ"};
  double t[3] = {0.0}, v[3] = {0.0}, r[9];
  bool found;
  for (int i = 0; i < 3; i++) {
    char key[32];
    VL_TRY(find_value(file, text, size, "STEREO", shifts[i], &t[i], &found));
    if (i == 0 && !found)
      return vl_camera_wrong(file, "zed: [STEREO] has no Baseline");
    snprintf(key, sizeof key, "%s_%s", turns[i], mode->name);
    VL_TRY(find_value(file, text, size, "STEREO", key, &v[i], &found));
    t[i] = 0.0 - t[i];
  }
  vl_rotation_from_vector(v, r);
  vl_camera_set_pose(d, r, t);
  return VL_OK;
}

static vlResult read_zed(const vlCameraFile *file, const char *text, size_t size,
                         vlCameraRecord *record) {
  static const char *const keys[] = {"fx", "fy", "cx", "cy", "k1", "k2", "p1", "p2", "k3"};
  vlCameraLines lines = {.at = text, .end = text + size};
  vlCameraDef *d = &record->camera;
  char name[64], section[64] = "";
  bool right = false, other;
  const Mode *mode = NULL, *found;
  double v[9] = {0.0};
  record->frames = 0;
  while (vl_camera_next_line(&lines)) {
    found = is_section(lines.text, name) ? mode_of(name, &other) : NULL;
    if (found && vl_camera_count(file, mode, name, record)) {
      mode = found;
      right = other;
      memcpy(section, name, sizeof section);
    }
  }
  if (!mode)
    return vl_camera_no_frame(file, "camera", record);
  if (has_section(text, size, right ? "RIGHT_DISTO" : "LEFT_DISTO"))
    return vl_camera_wrong(file, "zed: the lens of [%s] is not taken",
                           right ? "RIGHT_DISTO" : "LEFT_DISTO");
  for (int i = 0; i < 9; i++) {
    bool there;
    VL_TRY(find_value(file, text, size, section, keys[i], &v[i], &there));
    if (!there && i < 4)
      return vl_camera_wrong(file, "zed: [%s] has no %s", section, keys[i]);
  }
  d->width = mode->width;
  d->height = mode->height;
  vl_camera_set_centred(d, v);
  vl_camera_set_opencv(d, v + 4, vl_camera_all_zero(v + 4, 5) ? 0 : 5);
  vl_camera_name(record, section);
  vl_camera_set_origin(d);
  return right ? read_right(file, text, size, mode, d) : VL_OK;
}

static bool is_zed(const char *text, size_t size) {
  vlCameraLines lines = {.at = text, .end = text + size};
  char name[64];
  bool right;
  while (vl_camera_next_line(&lines))
    if (is_section(lines.text, name) && mode_of(name, &right))
      return true;
  return false;
}

const vlCameraFormat vl_format_zed = {
    .name = "zed",
    .rotates = true,
    .known =
        "fx fy cx cy k1 k2 k3 p1 p2 Baseline TY TZ RX_* RY_* RZ_* CV_* CX_* R_* T_* Sensor_ID* "
        "ConvergenceType* StereoLeft* StereoRight*",
    .separator = '=',
    .is_text = is_zed,
    .read_text = read_zed,
    .not_written = "it is the factory calibration of a stereo pair"};
