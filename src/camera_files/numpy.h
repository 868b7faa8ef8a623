/* camera_files/numpy.h: arrays in NumPy's files. */
#ifndef CAMERA_FILES_NUMPY_H
#define CAMERA_FILES_NUMPY_H

#include <stdbool.h>
#include <stddef.h>

typedef struct vlNumpyArray {
  const char *data;
  /* of numbers; of the first two dimensions, or 1; of a number */
  size_t count, sides[2], bytes;
  int dimensions;
  bool whole, by_columns; /* whole numbers; Fortran's order, of at most two dimensions */
} vlNumpyArray;

/* Reads the header of an array of little-endian float64, float32, int64 or int32. Returns false
 * if the text is none. */
bool vl_numpy_open(const char *text, size_t size, vlNumpyArray *array);
/* Number `index`, counted by rows. */
double vl_numpy_at(const vlNumpyArray *array, size_t index);

#endif
