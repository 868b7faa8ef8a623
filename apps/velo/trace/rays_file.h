/* trace/rays_file.h: files of rays: .csv (or stdin) and .npy. */
#ifndef APP_TRACE_RAYS_FILE_H
#define APP_TRACE_RAYS_FILE_H

#include <stdint.h>

/* Numbers of a ray in a file, in the order of a file without a header. */
enum {
  RAY_ORIGIN = 0,
  RAY_DIRECTION = 3,
  RAY_T_MAX = 6,
  RAY_TIME = 7,
  RAY_T_MIN = 8,
  RAY_NUMBERS
};

typedef struct RaysFile {
  double (*rows)[RAY_NUMBERS]; /* as the file has them; without a column 0, t_max infinity */
  uint64_t count;
} RaysFile;

/* Reads a file; "-": stdin, as .csv. Returns -1, or the exit code after a report. */
int rays_file_read(const char *path, RaysFile *rays);
/* The same for the format of NumPy's arrays (rays_npy.c). */
int rays_npy_read(const char *path, RaysFile *rays);
void rays_file_free(RaysFile *rays);

#endif
