/* base/file_record.h: which files a context read, with digests of their contents, while it is asked to record them
 * (vl_context_record_files). */
#ifndef BASE_FILE_RECORD_H
#define BASE_FILE_RECORD_H

#include <pthread.h>

#include "base/array.h"

/* A part of the context. */
typedef struct vlFileRecords {
  pthread_mutex_t mutex;
  bool on;
  VL_ARRAY(vlFileRecord) files; /* by path, each once */
} vlFileRecords;

vlFileRecords *vl_context_file_records(vlContext *context);
/* Records what was read from a file, if the context records. A file that is read again replaces its record. Any thread.
 * False: out of memory. */
bool vl_file_record(vlContext *context, const char *path, const void *data, size_t size);
void vl_file_records_free(vlContext *context);

#endif
