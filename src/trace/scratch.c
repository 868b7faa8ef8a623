/* trace/scratch.c: the size of a worker's working memory, and its parts. */
#include "trace/trace.h"

#include "trace/stages.h"
#include "trace/surface/probes.h"

/* What every scene has fits the L2 cache of a core (1 to 2 MB). docs/performance.md has these
 * numbers. */
_Static_assert(sizeof(struct vlTraceScratch) <= 954000,
               "a worker's memory for a world without media");

/* The parts in this order, each aligned to 64 bytes. */
typedef struct Parts {
  size_t by_channel, volume, subsurface, end; /* offsets */
} Parts;

static Parts parts_of(const vlWorld *world) {
  Parts p;
  bool volume = world->media.count > 0 || world->has_subsurface;
  p.by_channel = sizeof(struct vlTraceScratch);
  p.volume = p.by_channel + (world->by_channel ? sizeof(vlByChannel) : 0);
  p.subsurface = p.volume + (volume ? sizeof(vlVolumeScratch) : 0);
  p.end = p.subsurface + (world->has_subsurface ? sizeof(vlSubsurfaceScratch) : 0);
  return p;
}
_Static_assert(sizeof(struct vlTraceScratch) % 64 == 0 && sizeof(vlByChannel) % 64 == 0 &&
                   sizeof(vlVolumeScratch) % 64 == 0 && sizeof(vlSubsurfaceScratch) % 64 == 0,
               "aligned parts");

size_t vl_trace_scratch_size(const vlWorld *world) {
  return parts_of(world).end;
}

void vl_trace_scratch_begin(vlTraceScratch *scratch, const vlWorld *world) {
  Parts p = parts_of(world);
  char *memory = (char *)scratch;
  scratch->occluders.world = NULL;
  scratch->by_channel =
      p.volume > p.by_channel ? (vlByChannel *)(void *)(memory + p.by_channel) : NULL;
  scratch->at.shade.tint = scratch->by_channel ? &scratch->by_channel->tint : NULL;
  scratch->volume =
      p.subsurface > p.volume ? (vlVolumeScratch *)(void *)(memory + p.volume) : NULL;
  scratch->subsurface =
      p.end > p.subsurface ? (vlSubsurfaceScratch *)(void *)(memory + p.subsurface) : NULL;
}
