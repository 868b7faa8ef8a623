/* base/file_record.h: which files a context read, with digests of their contents, while it is asked to record them
 * (vl_context_record_files). */
#ifndef BASE_FILE_RECORD_H
#define BASE_FILE_RECORD_H

#include <stddef.h>

#include "velo/base.h"

/* Records what was read from a file, if the context records. A file that is read again replaces its record. Any thread.
 * False: out of memory. */
bool vl_file_record(vlContext *context, const char *path, const void *data, size_t size);

#endif
