/* base/context.h: what every object holds on to: the allocator with its count, the log, the workers.
 * Internal to the library; the public face is velo/base.h. */
#ifndef BASE_CONTEXT_H
#define BASE_CONTEXT_H

#include <stdarg.h>

#include "velo/base.h"

/* Counted allocation through the context. Null on failure or when size overflows; zeroed where said. All blocks must be
 * released with vl_free, realloc keeps the content. count*size is checked. Thread-safe. */
void *vl_alloc(vlContext *context, size_t size);
void *vl_alloc_zero(vlContext *context, size_t count, size_t size);
void *vl_alloc_array(vlContext *context, size_t count, size_t size);
void *vl_realloc_array(vlContext *context, void *block, size_t count, size_t size);
void vl_free(vlContext *context, void *block);
char *vl_strdup(vlContext *context, const char *text); /* null for null or on failure */

/* Memory that another library takes (bytes below 0: gives back) for this context. false: beyond the limit, and not
 * counted; what is taken already is counted in any case. */
bool vl_count_foreign(vlContext *context, int64_t bytes, bool taken);
/* May a scene name this file? Its links are followed. True where there is no sandbox. */
bool vl_context_allows(const vlContext *context, const char *path);
bool vl_context_has_sandbox(const vlContext *context);
uint64_t vl_context_max_texture_pixels(const vlContext *context);

/* Log a warning/info; where may be null. printf-like. */
void vl_log(vlContext *context, vlLogLevel level, const vlError *where, const char *format, ...)
    __attribute__((format(printf, 4, 5)));

/* Runs body for each index in [0, count) on the context's workers (or the caller's parallel_for). Returns when all are
 * done. Not from inside a body. */
void vl_parallel_for(vlContext *context, uint32_t count, vlParallelFn *body, void *loop_user);

#endif
