/* trace/scratch.c: the size of a worker's working memory. */
#include "trace/trace.h"

#include "trace/stages.h"

size_t vl_trace_scratch_size(void) {
  return sizeof(struct vlTraceScratch);
}

void vl_trace_scratch_begin(vlTraceScratch *scratch) {
  scratch->occluders.world = NULL;
}
