/* trace/trace.c: the tables of the instruction sets. */
#include "trace/trace.h"

#include "trace/stages.h"

size_t vl_trace_scratch_size(void) {
  return sizeof(struct vlTraceScratch);
}
