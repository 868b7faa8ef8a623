/* camera_files/kitti.c: KITTI's calibrations: calib.txt with P0 to P3 (odometry, object
 * detection) and calib_cam_to_cam.txt (raw data: S_00, K_00, D_00, R_00, T_00). x right, y
 * down, z forward; camera from world; the first pixel's centre is (0, 0). P = K [I | t]: the
 * world's space is the rectified camera 0's; R and T: camera 0's. */
#include <stdio.h>
#include <string.h>

#include "camera_files/fields.h"
#include "camera_files/lines.h"

/* The numbers after a key such as "P2:". */
typedef struct {
  char key[16];
  double values[12];
  vlCameraLines line;
} Row;

static vlResult find_row(const vlCameraFile *file, const char *text, size_t size, Row *row,
                         uint32_t min, bool *found) {
  row->line = (vlCameraLines){.at = text, .end = text + size};
  *found = false;
  size_t length = strlen(row->key);
  while (vl_camera_next_line(&row->line)) {
    const char *line = row->line.text;
    if (strncmp(line, row->key, length) != 0 || (line[length] != ':' && line[length] != ' '))
      continue;
    *found = true;
    return vl_camera_line_numbers(file, &row->line, line + length + 1, row->values, min, min);
  }
  return VL_OK;
}

static vlResult missing(const vlCameraFile *file, const char *key) {
  return vl_camera_wrong(file, "kitti: the line \"%s:\" is missing", key);
}

/* P: the projection of a rectified camera. */
static vlResult read_projection(const vlCameraFile *file, const Row *row, uint32_t camera,
                                vlCameraRecord *record) {
  const double *p = row->values;
  vlCameraDef *d = &record->camera;
  char odometry[32], object[32];
  if (p[1] != 0.0 || p[4] != 0.0 || p[8] != 0.0 || p[9] != 0.0 || p[10] != 1.0 ||
      !(p[0] > 0.0 && p[5] > 0.0))
    return vl_camera_wrong_line(file, &row->line, row->line.text,
                                "%s must be fx 0 cx tx, 0 fy cy ty, 0 0 1 tz", row->key);
  /* the images beside the two kinds of file */
  snprintf(odometry, sizeof odometry, "image_%u/000000.png", camera);
  snprintf(object, sizeof object, "../image_%u/000000.png", camera);
  vl_camera_set_centred(d, (double[]){p[0], p[5], p[2], p[6]});
  const double r[9] = {1, 0, 0, 0, 1, 0, 0, 0, 1};
  const double t[3] = {(p[3] - p[2] * p[11]) / p[0], (p[7] - p[6] * p[11]) / p[5], p[11]};
  vl_camera_set_pose(d, r, t);
  return vl_camera_size_beside(file, (const char *const[]){odometry, object, NULL}, record);
}

static vlResult read_raw(const vlCameraFile *file, const char *text, size_t size,
                         uint32_t camera, vlCameraRecord *record) {
  static const struct {
    char letter;
    uint32_t count;
  } wanted[] = {{'S', 2}, {'K', 9}, {'D', 5}, {'R', 9}, {'T', 3}};
  Row rows[5] = {{.key = ""}};
  vlCameraDef *d = &record->camera;
  for (int i = 0; i < 5; i++) {
    bool found;
    snprintf(rows[i].key, sizeof rows[i].key, "%c_%02u", wanted[i].letter, camera);
    VL_TRY(find_row(file, text, size, &rows[i], wanted[i].count, &found));
    if (!found)
      return missing(file, rows[i].key);
  }
  const double *k = rows[1].values;
  if (!vl_camera_set_sides(d, rows[0].values))
    return vl_camera_wrong_line(file, &rows[0].line, rows[0].line.text,
                                "%s must be two whole numbers of pixels", rows[0].key);
  if (!vl_camera_set_intrinsics(d, k, false))
    return vl_camera_wrong_line(file, &rows[1].line, rows[1].line.text,
                                "%s must be fx 0 cx, 0 fy cy, 0 0 1", rows[1].key);
  vl_camera_set_opencv(d, rows[2].values, 5);
  vl_camera_set_pose(d, rows[3].values, rows[4].values);
  return VL_OK;
}

static vlResult read_kitti(const vlCameraFile *file, const char *text, size_t size,
                           vlCameraRecord *record) {
  Row chosen = {.key = ""};
  uint32_t taken = UINT32_MAX;
  bool raw = false;
  record->frames = 0;
  for (uint32_t i = 0; i < 100; i++) {
    Row row = {.key = ""};
    bool found = false, unrectified = false;
    snprintf(row.key, sizeof row.key, "K_%02u", i);
    VL_TRY(find_row(file, text, size, &row, 9, &unrectified));
    snprintf(row.key, sizeof row.key, "P%u", i);
    if (!unrectified)
      VL_TRY(find_row(file, text, size, &row, 12, &found));
    if (!found && !unrectified)
      continue;
    char name[16];
    snprintf(name, sizeof name, unrectified ? "%02u" : "P%u", i);
    if (vl_camera_count(file, taken != UINT32_MAX, name, record)) {
      taken = i;
      raw = unrectified;
      chosen = row;
      vl_camera_name(record, name);
    }
  }
  if (!record->frames)
    return missing(file, "P0");
  if (taken == UINT32_MAX)
    return vl_camera_no_frame(file, "camera", record);
  return raw ? read_raw(file, text, size, taken, record)
             : read_projection(file, &chosen, taken, record);
}

static bool is_kitti(const char *text, size_t size) {
  vlCameraLines lines = {.at = text, .end = text + size};
  if (!vl_camera_next_line(&lines))
    return false;
  if (strncmp(lines.text, "calib_time:", 11) == 0 ||
      strncmp(lines.text, "corner_dist:", 12) == 0)
    return true;
  bool p = lines.text[0] == 'P' && strspn(lines.text + 1, "0123456789") == 1 &&
           strchr(": ", lines.text[2]);
  return p || strncmp(lines.text, "S_0", 3) == 0 || strncmp(lines.text, "K_0", 3) == 0;
}

const vlCameraFormat vl_format_kitti = {
    .name = "kitti",
    .rotates = true,
    .known = "P0 P1 P2 P3 P_* S_* K_* D_* R_* T_* R0_rect Tr* calib_time corner_dist",
    .separator = ':',
    .is_text = is_kitti,
    .read_text = read_kitti,
    .holds = VL_HOLDS_POSE,
    .lenses = {VL_LENSES_OPENCV, 5, 5},
    .form = "S_00: $width $height\nK_00: $K:s\nD_00: $k:s\nR_00: $R:s\nT_00: $t:s\n"};
