/* base/file_record.h: the list of files that a context has read, with digests of their
 * contents. It is kept while vl_context_record_files is on. */
#ifndef BASE_FILE_RECORD_H
#define BASE_FILE_RECORD_H

#include <stddef.h>

#include "velo/base.h"

/* Records the bytes read from a file, if the context records files. A file that is read again
 * replaces its record. Any thread. False: out of memory. */
bool vl_file_record(vlContext *context, const char *path, const void *data, size_t size);

#endif
