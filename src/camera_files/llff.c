/* camera_files/llff.c: LLFF's poses_bounds.npy: for each image 17 numbers: a matrix of 3 x 5 by
 * rows, and two depths, which are ignored. The columns are the camera's axes down, right, back
 * in the world, its centre, and (height, width, focal length). The principal point is the
 * image's middle. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "camera_files/fields.h"

enum { NUMBERS = 17 };

typedef struct {
  const unsigned char *data;
  size_t rows, bytes; /* bytes: of a number, 4 or 8 */
  bool by_columns;    /* Fortran's order */
} Array;

/* Reads NumPy's header. False: it is not an array of N x 17 little-endian floating-point
 * numbers. */
static bool read_header(const char *text, size_t size, Array *array) {
  const unsigned char *b = (const unsigned char *)text;
  char header[512];
  if (size < 12 || memcmp(b, "\x93NUMPY", 6) != 0)
    return false;
  /* format 1 gives the length of the header in 2 bytes, later formats in 4 */
  const size_t start = b[6] == 1 ? 10 : 12;
  size_t length = (size_t)b[8] | (size_t)b[9] << 8;
  if (start == 12)
    length |= (size_t)b[10] << 16 | (size_t)b[11] << 24;
  if (length >= sizeof header || start + length > size)
    return false;
  memcpy(header, b + start, length);
  header[length] = 0;
  const char *shape = strstr(header, "'shape': ("), *type = strstr(header, "'descr': '<f");
  unsigned long rows = 0, columns = 0;
  if (!shape || !type || sscanf(shape + 10, "%lu, %lu)", &rows, &columns) != 2 ||
      columns != NUMBERS)
    return false;
  array->bytes = type[12] == '4' ? 4 : 8;
  array->by_columns = strstr(header, "'fortran_order': True") != NULL;
  array->rows = rows;
  array->data = b + start + length;
  return rows >= 1 && rows <= (size - start - length) / NUMBERS / array->bytes;
}

static double number_at(const Array *array, size_t row, size_t column) {
  size_t at = array->by_columns ? column * array->rows + row : row * NUMBERS + column;
  const unsigned char *b = array->data + at * array->bytes;
  uint64_t bits = 0;
  for (size_t i = 0; i < array->bytes; i++)
    bits |= (uint64_t)b[i] << 8 * i;
  if (array->bytes == 4) {
    const uint32_t float_bits = (uint32_t)bits;
    float number;
    memcpy(&number, &float_bits, sizeof number);
    return (double)number;
  }
  double number;
  memcpy(&number, &bits, sizeof number);
  return number;
}

static vlResult read_llff(const vlCameraFile *file, const char *text, size_t size,
                          vlCameraRecord *record) {
  Array array;
  vlCameraDef *d = &record->camera;
  uint32_t chosen = UINT32_MAX;
  double v[NUMBERS], m[16] = {[15] = 1.0};
  if (!read_header(text, size, &array))
    return vl_camera_wrong(file, "llff: the array must have N x 17 numbers");
  record->frames = array.rows < UINT32_MAX ? (uint32_t)array.rows : UINT32_MAX;
  for (uint32_t i = 0; i < record->frames && chosen == UINT32_MAX; i++)
    if (vl_camera_is_frame(file, i, NULL))
      chosen = i;
  if (chosen == UINT32_MAX)
    return vl_camera_no_frame(file, "camera", record->frames);
  for (int i = 0; i < NUMBERS; i++)
    v[i] = number_at(&array, chosen, (size_t)i);
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
  Array array;
  return read_header(text, size, &array);
}

const vlCameraFormat vl_format_llff = {
    .name = "llff",
    .is_text = is_llff,
    .read_text = read_llff,
    .not_written = "it is a NumPy array that also has the scene's depths"};
