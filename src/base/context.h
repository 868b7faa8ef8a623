/* base/context.h: the context that all objects refer to: counted allocation, log, workers.
 * Internal to the library; the public part is velo/base.h. */
#ifndef BASE_CONTEXT_H
#define BASE_CONTEXT_H

#include <pthread.h>
#include <stdarg.h>

#include "base/attributes.h"
#include "base/file_stamp.h"
#include "base/pool.h"
#include "velo/base.h"

/* Counted allocation through the context. Null on failure or if count * size overflows.
 * vl_alloc_zero zeroes the block; vl_realloc_array keeps its content. All blocks are released
 * with vl_free. Thread-safe. */
void *vl_alloc(vlContext *context, size_t size);
void *vl_alloc_zero(vlContext *context, size_t count, size_t size);
void *vl_alloc_array(vlContext *context, size_t count, size_t size);
void *vl_realloc_array(vlContext *context, void *block, size_t count, size_t size);
void vl_free(vlContext *context, void *block);
char *vl_strdup(vlContext *context, const char *text); /* null for null text, or on failure */

/* Counts memory that another library allocates (bytes < 0: frees) for this context. False: the
 * memory exceeds the limit and is not counted. With `taken` it is already allocated and always
 * counted. */
bool vl_count_foreign(vlContext *context, int64_t bytes, bool taken);
/* Whether a scene may name this file. Symbolic links are resolved. True if there is no
 * sandbox. */
bool vl_context_allows(const vlContext *context, const char *path);
/* Tests whether as many threads as the context has workers can be started in addition to the
 * workers. Libraries that start their own threads end the process if a thread cannot be
 * started. Errors: MEMORY. */
vlResult vl_try_threads(vlContext *context, vlError *error);
uint64_t vl_context_max_texture_pixels(const vlContext *context);

/* The files that were read, with digests of their contents (file_record.h). Laid out as
 * VL_ARRAY (array.h), whose growth needs this header. */
typedef struct vlFileRecords {
  pthread_mutex_t mutex;
  bool on;
  struct {
    vlFileRecord *items; /* by path, each once */
    size_t count, capacity;
  } files;
} vlFileRecords;
vlFileRecords *vl_context_file_records(vlContext *context);
/* The files that were read, whatever they contain (file_input.h). */
typedef struct vlFileInput {
  char *path; /* as it was opened */
  vlFileStamp stamp;
  bool other; /* it was read as another file than a film */
} vlFileInput;
typedef struct vlFileInputs {
  pthread_mutex_t mutex;
  struct {
    vlFileInput *items; /* by device and inode */
    size_t count, capacity;
  } list;
} vlFileInputs;
/* Null: the context does not keep them. */
vlFileInputs *vl_context_file_inputs(vlContext *context);
/* Whether writes must no longer wait (vlContextDef.interrupted). */
bool vl_context_interrupted(const vlContext *context);

/* Logs a message; where may be null. printf-like. */
void vl_log(vlContext *context, vlLogLevel level, const vlError *where, const char *format, ...)
    VL_PRINTF(4, 5);

/* A number that no other call with this context returns; from 1. */
uint64_t vl_context_number(vlContext *context);

/* Runs body for each index in [0, count) on the context's workers (or by the caller's
 * parallel_for). Returns when all are done. Must not be called from inside a body. Loops of
 * several threads run at the same time; their workers have the same numbers. */
void vl_parallel_for_at(vlContext *context, const vlLoopDef *def, uint32_t count,
                        vlParallelFn *body, void *loop_user);
/* The same with the default def. */
void vl_parallel_for(vlContext *context, uint32_t count, vlParallelFn *body, void *loop_user);

/* Creates a context like this one that has one thread and logs nothing. */
vlResult vl_context_create_quiet(const vlContext *context, vlContext **result);

#endif
