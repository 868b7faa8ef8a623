/* trace/scratch.c: the size of the working memory of a worker. */
#include "trace/trace.h"

#include "trace/stages.h"

size_t vl_trace_scratch_size(void) {
  return sizeof(struct vlTraceScratch);
}
