/* trace/scratch.c: the size of a worker's working memory. */
#include "trace/trace.h"

#include "trace/stages.h"

/* What every scene touches should fit the L2 cache of a core (1 to 2 MB). docs/performance.md has these numbers. */
_Static_assert(sizeof(struct vlTraceScratch) <= 1920000, "a worker's memory");
_Static_assert(sizeof(struct vlTraceScratch) - sizeof(vlVolumeScratch) - sizeof(vlSubsurfaceScratch) -
                       sizeof(((struct vlTraceScratch *)NULL)->rows) <=
                   1000000,
               "what every scene touches of it");

size_t vl_trace_scratch_size(void) {
  return sizeof(struct vlTraceScratch);
}

void vl_trace_scratch_begin(vlTraceScratch *scratch) {
  scratch->occluders.world = NULL;
}
