/* raw/tiff_memory.h: TIFF files in memory, by libtiff. Only builds with VELO_TIFF have it. */
#ifndef RAW_TIFF_MEMORY_H
#define RAW_TIFF_MEMORY_H

#include <tiffio.h>

#include "base/file.h"

/* Memory that libtiff may allocate at once. It needs little: the numbers go from and to velo's
 * own memory. */
enum { VL_TIFF_MAX_MEMORY = 1 << 16, VL_TIFF_MAX_ENTRIES = 128 };

/* Tags that libtiff 4.5 does not name. */
enum { VL_TIFF_NOISE_PROFILE = 51041 };
/* EXIF's codes of light sources. */
enum { VL_TIFF_LIGHT_A = 17, VL_TIFF_LIGHT_D65 = 21 };

typedef struct vlTiffMemory {
  vlContext *context;
  const uint8_t *data; /* the file that is read */
  size_t size;         /* its bytes */
  bool writes;
  vlFileWriter writer; /* the file that is written, in memory */
  uint64_t at;         /* the offset of the next byte */
  char message[160];   /* libtiff's last error */
  TIFF *tiff;
} vlTiffMemory;

/* Opens a file for reading: its bytes must stay until the end. name: for messages. False: it is
 * no TIFF file that libtiff reads, or memory ran out. */
bool vl_tiff_open_read(vlTiffMemory *memory, vlContext *context, const char *name,
                       const void *data, size_t size);
/* Begins a little-endian file of one directory, and one of EXIF. */
bool vl_tiff_open_write(vlTiffMemory *memory, vlContext *context, const char *name);
/* Closes what was read. */
void vl_tiff_close(vlTiffMemory *memory);
/* Closes the file and writes it to `path` if it is whole, else reports what failed. */
vlResult vl_tiff_finish(vlTiffMemory *memory, bool whole, const char *path, vlError *error);

#endif
