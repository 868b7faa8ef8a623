/* base/file.h: whole files in, whole files out. */
#ifndef BASE_FILE_H
#define BASE_FILE_H

#include "base/context.h"

/* The whole file in one block with a zero byte after it (not counted in size). A gzip file (by its first bytes) is
 * unpacked when gunzip is set. Errors: MISSING (with the nearest name in that folder, where one is near), IO, MEMORY.
 */
vlResult vl_file_read(vlContext *context, const char *path, bool gunzip, char **data, size_t *size, vlError *error);

/* Writing that is whole or not at all: bytes go to a temporary file beside the target; commit syncs and renames it;
 * abandon removes it. A failed write is remembered and reported by commit. */
typedef struct vlFileWriter {
  int descriptor;
  int failed_errno;
  char path[4096];
  char temporary[4096 + 32];
} vlFileWriter;
vlResult vl_file_open_write(vlFileWriter *writer, const char *path, vlError *error);
void vl_file_write(vlFileWriter *writer, const void *data, size_t size);
/* At an absolute offset (OpenEXR's callback). */
void vl_file_write_at(vlFileWriter *writer, const void *data, size_t size, uint64_t offset);
vlResult vl_file_commit(vlFileWriter *writer, vlError *error);
void vl_file_abandon(vlFileWriter *writer);

double vl_seconds(void); /* monotonic */

#endif
