/* base/file.h: reading and writing whole files. */
#ifndef BASE_FILE_H
#define BASE_FILE_H

#include <sys/types.h>

#include "base/context.h"

/* Reads a whole file into one block, followed by a zero byte (not counted in size). gunzip: a
 * gzip file (by its first bytes) is decompressed, and UTF-16 with a byte order mark becomes
 * UTF-8. For files that a scene names: pipes, sockets, devices and files outside of the
 * context's sandbox are refused. The caller releases *data with vl_free. Errors: MISSING (with
 * the nearest name in that folder, if there is one; a Git LFS pointer counts as a missing
 * file), IO, MEMORY. */
vlResult vl_file_read(vlContext *context, const char *path, bool gunzip, char **data,
                      size_t *size, vlError *error);
/* The same for files that the caller names: pipes are allowed, and the sandbox does not
 * apply. */
vlResult vl_file_read_given(vlContext *context, const char *path, bool gunzip, char **data,
                            size_t *size, vlError *error);
/* Whether a file can be read as vl_file_read does: OK, or its error. */
vlResult vl_file_check(vlContext *context, const char *path, vlError *error);
/* Maps a file into memory: pages are read on access; a zero byte follows. Regular files only:
 * for others *data is null and the result is OK. Released with vl_file_unmap. */
vlResult vl_file_map(vlContext *context, const char *path, const char **data, size_t *size,
                     vlError *error);
void vl_file_unmap(const char *data, size_t size);

/* Atomic writing: bytes go to a temporary file beside the target; commit syncs and renames it;
 * abandon removes it. A failed write is remembered and reported by commit. Symbolic links are
 * followed, and the permissions of a replaced file are kept. A file without write permission is
 * not replaced, nor is an input of the context (file_input.h). Whatever is not a regular file
 * gets the bytes by commit: they are gathered in memory, so that every format can be written to
 * a pipe. */
typedef struct vlFileWriter {
  int descriptor;
  int failed_errno;
  char path[4096];                 /* as given, for messages */
  char target[4096];               /* the file to replace, with links resolved */
  char temporary[4096 + 64];       /* empty: no name yet */
  struct vlUnfinished *unfinished; /* the temporary file, once it has a name; else null */
  bool replaces;                   /* the file exists, with these permissions */
  mode_t mode;
  uid_t owner;
  gid_t group;
  vlContext *context;
  bool in_memory; /* the bytes go to memory: a stream, or a writer to memory */
  char *memory;   /* its bytes, a block of the context */
  size_t memory_size, memory_capacity;
} vlFileWriter;
vlResult vl_file_open_write(vlFileWriter *writer, vlContext *context, const char *path,
                            vlOutputKind kind, vlError *error);
/* As vl_file_open_write, for a file whose bytes another program writes to `temporary`, which
 * exists. Errors also: IO (a stream). */
vlResult vl_file_open_named(vlFileWriter *writer, vlContext *context, const char *path,
                            vlError *error);
/* Starts a writer to memory; name: for messages. It is not committed; the caller takes `memory`
 * and frees it with vl_free. If memory runs out, failed_errno is ENOMEM. */
void vl_file_open_memory(vlFileWriter *writer, vlContext *context, const char *name);
/* Makes the memory of a writer in memory at least this large, so that several threads may write
 * to parts of it. False: failed_errno is set. */
bool vl_file_reserve(vlFileWriter *writer, size_t size);
void vl_file_write(vlFileWriter *writer, const void *data, size_t size);
/* Writes at an absolute offset (for OpenEXR's callback). */
void vl_file_write_at(vlFileWriter *writer, const void *data, size_t size, uint64_t offset);
vlResult vl_file_commit(vlFileWriter *writer, vlError *error);
void vl_file_abandon(vlFileWriter *writer);

/* Resolves the symbolic links of `path`; the target need not exist. False: errno is set. */
bool vl_follow_links(const char *path, char *target, size_t size);

double vl_seconds(void); /* seconds of a monotonic clock */

#endif
