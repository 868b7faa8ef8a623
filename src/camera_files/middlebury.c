/* camera_files/middlebury.c: calib.txt of the Middlebury stereo datasets (2014, 2021): cam0 and
 * cam1 as [f 0 cx; 0 f cy; 0 0 1], baseline, width, height. x right, y down, z forward; the
 * world's space is camera 0's, in the baseline's unit; the first pixel's centre is (0, 0). */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "camera_files/fields.h"
#include "camera_files/lines.h"

/* Finds the line "key=" and returns what follows, or null. */
static const char *find(const char *text, size_t size, const char *key, vlCameraLines *line) {
  const size_t length = strlen(key);
  *line = (vlCameraLines){.at = text, .end = text + size};
  while (vl_camera_next_line(line))
    if (strncmp(line->text, key, length) == 0 && line->text[length] == '=')
      return line->text + length + 1;
  return NULL;
}

static vlResult read_number(const vlCameraFile *file, const char *text, size_t size,
                            const char *key, double *value, bool *found) {
  vlCameraLines line;
  const char *at = find(text, size, key, &line);
  if (found)
    *found = at != NULL;
  if (at)
    return vl_camera_line_numbers(file, &line, at, value, 1, 1);
  return found ? VL_OK
               : vl_camera_wrong_at(file, 1, 1, "middlebury: the line \"%s=\" is missing", key);
}

static vlResult read_size(const vlCameraFile *file, const char *text, size_t size, int number,
                          vlCameraRecord *record) {
  double sides[2];
  bool found[2];
  VL_TRY(read_number(file, text, size, "width", &sides[0], &found[0]));
  VL_TRY(read_number(file, text, size, "height", &sides[1], &found[1]));
  if (!found[0] && !found[1])
    return vl_camera_size_beside(
        file, (const char *const[]){number ? "im1.png" : "im0.png", NULL}, record);
  if (found[0] && found[1] && vl_camera_set_sides(&record->camera, sides))
    return VL_OK;
  return vl_camera_wrong_at(
      file, 1, 1, "middlebury: \"width\" and \"height\" must be whole numbers of pixels");
}

static vlResult read_middlebury(const vlCameraFile *file, const char *text, size_t size,
                                vlCameraRecord *record) {
  static const char *const names[2] = {"cam0", "cam1"};
  vlCameraLines line;
  int chosen = -1;
  record->frames = 0;
  for (int i = 0; i < 2; i++) {
    if (find(text, size, names[i], &line) &&
        vl_camera_count(file, chosen >= 0, names[i], record))
      chosen = i;
  }
  if (chosen < 0)
    return vl_camera_no_frame(file, "camera", record);
  const char *at = find(text, size, names[chosen], &line);
  double k[9];
  for (int i = 0; i < 9; i++) {
    char *end;
    at += strspn(at, "[; ,\t");
    k[i] = strtod(at, &end);
    if (end == at || !isfinite(k[i]))
      return vl_camera_wrong_line(file, &line, at, "%s must have nine numbers", names[chosen]);
    at = end;
  }
  if (at[strspn(at, "] ;")])
    return vl_camera_wrong_line(file, &line, at, "unexpected text");
  if (!vl_camera_set_intrinsics(&record->camera, k, false))
    return vl_camera_wrong_line(file, &line, line.text, "%s must be [fx 0 cx; 0 fy cy; 0 0 1]",
                                names[chosen]);
  vl_camera_set_origin(&record->camera);
  if (chosen == 1)
    VL_TRY(
        read_number(file, text, size, "baseline", &record->camera.world_from_camera[3], NULL));
  vl_camera_name(record, names[chosen]);
  return read_size(file, text, size, chosen, record);
}

static bool is_middlebury(const char *text, size_t size) {
  vlCameraLines lines = {.at = text, .end = text + size};
  return vl_camera_next_line(&lines) && strncmp(lines.text, "cam0=[", 6) == 0;
}

const vlCameraFormat vl_format_middlebury = {
    .name = "middlebury",
    .rotates = true,
    .known = "cam0 cam1 doffs baseline width height ndisp isint vmin vmax dyavg dymax",
    .separator = '=',
    .is_text = is_middlebury,
    .read_text = read_middlebury,
    .lenses = {VL_LENSES_PINHOLE},
    .form = "cam0=[$fx 0 $cx0; 0 $fy $cy0; 0 0 1]\nwidth=$width\nheight=$height\n"};
