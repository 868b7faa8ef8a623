/* trace/rays_npy.c: rays of a NumPy array (.npy; NumPy's documentation, numpy.lib.format):
 * float32 or float64, little-endian, one row of 6 to 9 numbers for each ray. */
#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "cli/report.h"
#include "trace/rays_file.h"

enum { MAGIC = 8, MAX_HEADER = 4096 };

/* What the header says. */
typedef struct Layout {
  int bytes; /* of a number: 4 or 8 */
  unsigned long long rows, columns;
} Layout;

static int wrong(const char *path, const char *what) {
  return report_failure(STATUS_SCENE, "%s: %s", path, what);
}

/* Reads the text of the header, which ends with a zero. */
static int read_header(FILE *file, const char *path, char header[MAX_HEADER]) {
  unsigned char start[MAGIC + 4] = {0};
  if (fread(start, 1, MAGIC, file) != MAGIC || memcmp(start, "\x93NUMPY", 6) != 0)
    return wrong(path, "this is not an array of NumPy (.npy)");
  size_t size = start[6] == 1 ? 2 : 4;
  if (start[6] < 1 || start[6] > 3 || fread(start + MAGIC, 1, size, file) != size)
    return wrong(path, "its version of the format is not known");
  size_t length =
      start[8] | (size_t)start[9] << 8 | (size_t)start[10] << 16 | (size_t)start[11] << 24;
  if (length >= MAX_HEADER || fread(header, 1, length, file) != length)
    return wrong(path, "its header is not whole, or too long");
  header[length] = 0;
  return -1;
}

static int read_layout(const char *path, const char *header, Layout *layout) {
  const char *type = strstr(header, "'descr': '"), *shape = strstr(header, "'shape': (");
  if (!type || !shape ||
      (strncmp(type + 10, "<f4'", 4) != 0 && strncmp(type + 10, "<f8'", 4) != 0))
    return wrong(path, "its type must be float32 or float64 (little-endian)");
  if (!strstr(header, "'fortran_order': False"))
    return wrong(path, "it is stored by columns; save numpy.ascontiguousarray(rays)");
  layout->bytes = type[12] - '0';
  if (sscanf(shape + 10, "%llu, %llu)", &layout->rows, &layout->columns) != 2 ||
      strchr(shape, ')') < strchr(shape, ','))
    return wrong(path, "its shape must be n x 6 to n x 9: ox oy oz dx dy dz t_max time t_min");
  if (layout->columns < RAY_T_MAX || layout->columns > RAY_NUMBERS)
    return report_failure(STATUS_SCENE,
                          "%s: its rows have %llu numbers; rays have 6 to 9: ox oy oz dx dy dz "
                          "t_max time t_min",
                          path, layout->columns);
  return -1;
}

/* The file's length is checked before memory is taken for its rows. */
static bool is_long_enough(FILE *file, const Layout *layout) {
  long begin = ftell(file);
  if (begin < 0 || fseek(file, 0, SEEK_END) != 0)
    return false;
  long end = ftell(file);
  unsigned long long size = layout->columns * (unsigned long long)layout->bytes;
  bool enough = end >= begin && layout->rows <= (unsigned long long)(end - begin) / size;
  return fseek(file, begin, SEEK_SET) == 0 && enough;
}

static int read_rows(FILE *file, const char *path, const Layout *layout, RaysFile *rays) {
  if (!is_long_enough(file, layout))
    return wrong(path, "it is shorter than its header says");
  rays->rows = malloc(layout->rows * sizeof *rays->rows + 1);
  if (!rays->rows)
    return report_failure(STATUS_OTHER, "%s: out of memory", path);
  for (; rays->count < layout->rows; rays->count++) {
    double *row = rays->rows[rays->count], doubles[RAY_NUMBERS];
    float floats[RAY_NUMBERS];
    void *to = layout->bytes == 8 ? (void *)doubles : (void *)floats;
    if (fread(to, (size_t)layout->bytes, layout->columns, file) != layout->columns)
      return report_failure(STATUS_IO, "%s: it cannot be read", path);
    memset(row, 0, sizeof *rays->rows);
    row[RAY_T_MAX] = (double)INFINITY;
    for (size_t k = 0; k < layout->columns; k++)
      row[k] = layout->bytes == 8 ? doubles[k] : (double)floats[k];
  }
  return -1;
}

int rays_npy_read(const char *path, RaysFile *rays) {
  FILE *file = fopen(path, "rb");
  if (!file)
    return report_failure(errno == ENOENT ? STATUS_MISSING : STATUS_IO, "%s: %s", path,
                          strerror(errno));
  char header[MAX_HEADER];
  Layout layout = {0};
  int status = read_header(file, path, header);
  if (status < 0)
    status = read_layout(path, header, &layout);
  if (status < 0)
    status = read_rows(file, path, &layout, rays);
  fclose(file);
  return status;
}
