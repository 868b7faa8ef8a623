/* camera_files/mvsnet.c: MVSNet's cam.txt (DTU, BlendedMVS): the words extrinsic and intrinsic,
 * each before a matrix. x right, y down, z forward; camera from world; the first pixel's centre
 * is (0, 0). The depth range is ignored. */
#include <stdio.h>

#include "base/text.h"
#include "camera_files/lines.h"

static vlResult read_matrix(const vlCameraFile *file, vlCameraLines *lines, const char *word,
                            uint32_t n, double *m) {
  if (!vl_camera_next_line(lines) || !vl_text_is(lines->text, word))
    return vl_camera_wrong(file, "mvsnet: \"%s\" is missing", word);
  for (uint32_t i = 0; i < n; i++) {
    if (!vl_camera_next_line(lines))
      return vl_camera_wrong(file, "mvsnet: \"%s\" must have %u rows", word, n);
    VL_TRY(vl_camera_line_numbers(file, lines, lines->text, m + (size_t)n * i, n, n));
  }
  return VL_OK;
}

/* The size of the image, which is in a folder beside that of NAME_cam.txt. */
static vlResult read_size(const vlCameraFile *file, vlCameraRecord *record) {
  enum { MAX_NAME = 200 };
  static const char *const folders[] = {"../images", "../blended_images"};
  static const char *const suffixes[] = {"jpg", "png"};
  char images[4][MAX_NAME + 40];
  const char *name = vl_file_name(file->path);
  const char *end = strstr(name, "_cam.txt");
  if (!end || end - name > MAX_NAME)
    return vl_camera_size_beside(file, (const char *const[]){NULL}, record);
  for (int i = 0; i < 4; i++)
    snprintf(images[i], sizeof images[i], "%s/%.*s.%s", folders[i / 2], (int)(end - name), name,
             suffixes[i % 2]);
  return vl_camera_size_beside(
      file, (const char *const[]){images[0], images[1], images[2], images[3], NULL}, record);
}

static vlResult read_mvsnet(const vlCameraFile *file, const char *text, size_t size,
                            vlCameraRecord *record) {
  vlCameraLines lines = {.at = text, .end = text + size};
  double m[16], k[9] = {0.0};
  VL_TRY(read_matrix(file, &lines, "extrinsic", 4, m));
  const vlCameraLines last = lines; /* of extrinsic */
  VL_TRY(read_matrix(file, &lines, "intrinsic", 3, k));
  if (!vl_camera_set_intrinsics(&record->camera, k, true))
    return vl_camera_wrong_line(file, &lines, lines.text,
                                "\"intrinsic\" must be fx skew cx, 0 fy cy, 0 0 1");
  if (!vl_camera_set_matrix(&record->camera, m, true))
    return vl_camera_wrong_line(file, &last, last.text, "\"extrinsic\" is singular");
  return read_size(file, record);
}

static bool is_mvsnet(const char *text, size_t size) {
  vlCameraLines lines = {.at = text, .end = text + size};
  return vl_camera_next_line(&lines) && vl_text_is(lines.text, "extrinsic");
}

static vlResult write_mvsnet(const vlFittedCamera *fit, vlCameraText *text) {
  const vlCamera *c = &fit->camera;
  const double *m = c->camera_from_world;
  vl_camera_put(text, "extrinsic\n");
  for (int i = 0; i < 4; i++)
    vl_camera_put(text, "%.17g %.17g %.17g %.17g\n", m[4 * i], m[4 * i + 1], m[4 * i + 2],
                  m[4 * i + 3]);
  vl_camera_put(text, "\nintrinsic\n%.17g %.17g %.17g\n0 %.17g %.17g\n0 0 1\n", c->fx, c->skew,
                c->cx - 0.5, c->fy, c->cy - 0.5);
  return VL_OK;
}

const vlCameraFormat vl_format_mvsnet = {.name = "mvsnet",
                                         .rotates = true,
                                         .is_text = is_mvsnet,
                                         .read_text = read_mvsnet,
                                         .holds = VL_HOLDS_POSE | VL_HOLDS_SKEW,
                                         .lenses = {VL_LENSES_PINHOLE},
                                         .write = write_mvsnet};
