/* camera_files/llff.c: LLFF's poses_bounds.npy: for each image 17 numbers: a matrix of 3 x 5 by
 * rows, and two depths, which are ignored. The columns are the camera's axes down, right, back
 * in the world, its centre, and (height, width, focal length). The principal point is the
 * image's middle. */
#include <math.h>
#include <stdio.h>

#include "camera_files/fields.h"
#include "camera_files/numpy.h"

enum { NUMBERS = 17 };

/* N x 17 numbers. */
static bool open_poses(const char *text, size_t size, vlNumpyArray *array) {
  return vl_numpy_open(text, size, array) && array->dimensions == 2 &&
         array->sides[1] == NUMBERS && !array->whole;
}

static vlResult read_llff(const vlCameraFile *file, const char *text, size_t size,
                          vlCameraRecord *record) {
  vlNumpyArray array;
  vlCameraDef *d = &record->camera;
  uint32_t chosen = UINT32_MAX;
  double v[NUMBERS], m[16] = {[15] = 1.0};
  if (!open_poses(text, size, &array))
    return vl_camera_wrong(file, "llff: the array must have N x 17 numbers");
  record->frames = array.sides[0] < UINT32_MAX ? (uint32_t)array.sides[0] : UINT32_MAX;
  for (uint32_t i = 0; i < record->frames && chosen == UINT32_MAX; i++)
    if (vl_camera_is_frame(file, i, NULL))
      chosen = i;
  if (chosen == UINT32_MAX)
    return vl_camera_no_frame(file, "camera", record);
  for (size_t i = 0; i < NUMBERS; i++)
    v[i] = vl_numpy_at(&array, (size_t)chosen * NUMBERS + i);
  const double height = v[4], width = v[9], sides[2] = {width, height};
  for (int i = 0; i < 15; i++)
    if (!isfinite(v[i]))
      return vl_camera_wrong(file, "llff: image %u has a number that is not finite", chosen);
  if (!vl_camera_set_sides(d, sides))
    return vl_camera_wrong(file, "llff: image %u is %g x %g; it must be whole pixels", chosen,
                           width, height);
  /* from the axes down, right, back to right, down, forward; 0.0 - x is never -0 */
  for (int i = 0; i < 3; i++) {
    m[4 * i] = v[5 * i + 1];
    m[4 * i + 1] = v[5 * i];
    m[4 * i + 2] = 0.0 - v[5 * i + 2];
    m[4 * i + 3] = v[5 * i + 3];
  }
  vl_camera_set_matrix(d, m, false);
  d->fx = d->fy = v[14];
  d->cx = 0.5 * width;
  d->cy = 0.5 * height;
  return VL_OK;
}

static bool is_llff(const char *text, size_t size) {
  vlNumpyArray array;
  return open_poses(text, size, &array);
}

const vlCameraFormat vl_format_llff = {
    .name = "llff",
    .is_text = is_llff,
    .read_text = read_llff,
    .not_written = "it is a NumPy array that also has the scene's depths"};
