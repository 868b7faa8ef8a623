/* camera_files/bundler.c: Bundler's bundle.out (also of RealityCapture, Metashape and Theia).
 * For each camera f k1 k2, R, t: camera from world. Camera axes: x right, y up, z back. The
 * principal point is the image's middle. The file has no image size. Cameras with f = 0 were
 * not reconstructed and do not count; a camera's name is its number in the file. */
#include <stdio.h>
#include <string.h>

#include "camera_files/lines.h"

static vlResult next_numbers(const vlCameraFile *file, vlCameraLines *lines, double *values,
                             uint32_t count) {
  if (!vl_camera_next_line(lines))
    return vl_camera_wrong(file, "bundler: the file ends within a camera");
  return vl_camera_line_numbers(file, lines, lines->text, values, count, count);
}

static vlResult read_bundler(const vlCameraFile *file, const char *text, size_t size,
                             vlCameraRecord *record) {
  vlCameraLines lines = {.at = text, .end = text + size};
  double head[2] = {0.0, 0.0}, v[15];
  bool taken = false;
  VL_TRY(next_numbers(file, &lines, head, 2));
  if (!(head[0] >= 1.0 && head[0] <= 1e7))
    return vl_camera_wrong_line(file, &lines, lines.text, "the file has no camera");
  record->frames = 0;
  for (uint32_t i = 0; i < (uint32_t)head[0]; i++) {
    char name[16];
    for (uint32_t row = 0; row < 5; row++)
      VL_TRY(next_numbers(file, &lines, v + 3 * row, 3));
    if (v[0] == 0.0)
      continue;
    snprintf(name, sizeof name, "%u", i);
    if (vl_camera_count(file, taken, name, record)) {
      taken = true;
      vl_camera_name(record, name);
      vl_camera_set_opencv(&record->camera, (double[]){v[1], v[2], 0, 0}, 4);
      for (int k = 6; k < 15; k++) /* the rows y and z of R and of t */
        v[k] = k == 12 ? v[k] : -v[k];
      vl_camera_set_pose(&record->camera, v + 3, v + 12);
      record->camera.fx = record->camera.fy = v[0];
    }
  }
  if (!taken)
    return vl_camera_no_frame(file, "camera", record);
  VL_TRY(vl_camera_size_beside(file, (const char *const[]){NULL}, record));
  record->camera.cx = 0.5 * record->camera.width;
  record->camera.cy = 0.5 * record->camera.height;
  return VL_OK;
}

static bool is_bundler(const char *text, size_t size) {
  static const char begin[] = "# Bundle file";
  return size > sizeof begin && memcmp(text, begin, sizeof begin - 1) == 0;
}

static vlResult write_bundler(const vlFittedCamera *fit, vlCameraText *text) {
  const vlCamera *c = &fit->camera;
  double r[9], t[3];
  vl_camera_get_pose(c, r, t);
  vl_camera_put(text, "# Bundle file v0.3\n1 0\n%.17g %.17g %.17g\n", c->fx, fit->k[0],
                fit->k[1]);
  for (int i = 0; i < 3; i++) {
    double sign = i ? -1 : 1;
    vl_camera_put(text, "%.17g %.17g %.17g\n", sign * r[3 * i] + 0.0, sign * r[3 * i + 1] + 0.0,
                  sign * r[3 * i + 2] + 0.0);
  }
  vl_camera_put(text, "%.17g %.17g %.17g\n", t[0], -t[1] + 0.0, -t[2] + 0.0);
  return VL_OK;
}

const vlCameraFormat vl_format_bundler = {.name = "bundler",
                                          .rotates = true,
                                          .is_text = is_bundler,
                                          .read_text = read_bundler,
                                          .holds = VL_HOLDS_POSE,
                                          .lenses = {VL_LENSES_OPENCV, 0, 14, 2},
                                          .centred = true,
                                          .square = true,
                                          .write = write_bundler};
