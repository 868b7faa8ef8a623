/* base/file.h: whole files in, whole files out. */
#ifndef BASE_FILE_H
#define BASE_FILE_H

#include <sys/types.h>

#include "base/context.h"

/* The whole file in one block with a zero byte after it (not counted in size). A gzip file (by its first bytes) is
 * unpacked when gunzip is set. For files that a scene names: pipes, sockets and devices are refused, and what lies
 * outside of the context's sandbox. Errors: MISSING (with the nearest name in that folder, where one is near), IO,
 * MEMORY. */
vlResult vl_file_read(vlContext *context, const char *path, bool gunzip, char **data, size_t *size, vlError *error);
/* The same for files that the caller names himself: pipes are read, and there is no sandbox. */
vlResult vl_file_read_given(vlContext *context, const char *path, bool gunzip, char **data, size_t *size,
                            vlError *error);
/* A file as it lies on the disk, read as far as it is looked at; a zero byte follows. Regular files alone: for others
 * *data is null, and the result OK. Released with vl_file_unmap. */
vlResult vl_file_map(const char *path, const char **data, size_t *size, vlError *error);
void vl_file_unmap(const char *data, size_t size);

/* Writing that is whole or not at all: bytes go to a temporary file beside the target; commit syncs and renames it;
 * abandon removes it. A failed write is remembered and reported by commit. Symbolic links are followed, the permissions
 * of a file that is replaced are kept; a file that may not be written is not replaced. */
typedef struct vlFileWriter {
  int descriptor;
  int failed_errno;
  char path[4096];           /* as given, for messages */
  char target[4096];         /* the file that is replaced: links followed; empty: written in place */
  char temporary[4096 + 64]; /* empty: it has no name yet */
  bool replaces;             /* a file is there already, with these permissions */
  mode_t mode;
  uid_t owner;
  gid_t group;
} vlFileWriter;
vlResult vl_file_open_write(vlFileWriter *writer, const char *path, vlError *error);
void vl_file_write(vlFileWriter *writer, const void *data, size_t size);
/* At an absolute offset (OpenEXR's callback). */
void vl_file_write_at(vlFileWriter *writer, const void *data, size_t size, uint64_t offset);
vlResult vl_file_commit(vlFileWriter *writer, vlError *error);
void vl_file_abandon(vlFileWriter *writer);

double vl_seconds(void); /* monotonic */

#endif
