/* trace/surface/probes.h: the arrays of subsurface scattering (subsurface.hot.c). */
#ifndef TRACE_SURFACE_PROBES_H
#define TRACE_SURFACE_PROBES_H

#include "trace/stages.h"

/* Where paths enter solids, by probe. */
typedef struct vlEntries {
  vlUintRow path, material; /* path: index of the ray */
  vlVec3Row p, n;
  vlFloatRow sigma[4], albedo[4];
} vlEntries;

/* Segments through solids; vlPaths have their origins and directions. */
typedef struct vlProbes {
  vlFloatRow length; /* 0: no segment */
  vlUintRow found;   /* number of crossings */
  vlHits chosen;     /* one of them, chosen at random */
} vlProbes;

struct vlSubsurfaceScratch {
  vlPaths paths; /* copy of all paths of the bounce */
  vlVolumeRows rows;
  VL_ROW uint8_t alive[VL_ROW_SIZE]; /* by path: 1 if the path goes on */
  vlEntries entries;
  vlProbes probes;
  vlUintRow probe; /* by exit: its probe */
};

/* Subsurface scattering for the n rays, which were just sampled at the vertices s->order. A
 * path that entered a subsurface material is moved to an exit point, where lights are sampled,
 * or ends. Returns the number of all paths that go on. Uses s->at, which has done its work. */
uint32_t vl_stage_subsurface(vlTracing *t, uint32_t n, uint32_t depth);

#endif
