/* base/file_stream.h: writing to what is not a regular file: pipes, sockets, devices, the
 * standard output. */
#ifndef BASE_FILE_STREAM_H
#define BASE_FILE_STREAM_H

#include <stdbool.h>
#include <stddef.h>

#include "velo/base.h"

/* The name of the process' standard output, whatever that is. */
#define VL_STDOUT "/dev/stdout"

/* Whether a file of this name is written as a stream. */
bool vl_path_is_stream(const char *path);
/* Writes all bytes. Waits for the other end, until the context is interrupted and nothing was
 * taken for a second (vlContextDef.interrupted). Returns 0 or an errno. */
int vl_stream_write(vlContext *context, const char *path, const char *data, size_t size);

#endif
