/* trace/tracer/kinds.h: the function of each kind of tracer. */
#ifndef TRACE_TRACER_KINDS_H
#define TRACE_TRACER_KINDS_H

#include "trace/stages.h"
#include "velo/tracer.h"

/* Each kind of tracer has one function, vl_trace_ and its name. */
void vl_trace_path(vlTracing *t);
void vl_trace_raycast(vlTracing *t);
void vl_trace_ambient_occlusion(vlTracing *t);
void vl_trace_random_walk(vlTracing *t);
void vl_trace_volpath(vlTracing *t);
void vl_trace_bidirectional(vlTracing *t);
void vl_trace_merging(vlTracing *t);
void vl_trace_sppm(vlTracing *t);
void vl_trace_light_path(vlTracing *t);

static inline void vl_trace_kind(vlTracing *t, vlTracer kind) {
  switch (kind) {
    case VL_TRACER_PATH:
      vl_trace_path(t);
      break;
    case VL_TRACER_RAYCAST:
      vl_trace_raycast(t);
      break;
    case VL_TRACER_AMBIENT_OCCLUSION:
      vl_trace_ambient_occlusion(t);
      break;
    case VL_TRACER_VOLPATH:
      vl_trace_volpath(t);
      break;
    case VL_TRACER_BIDIRECTIONAL:
      vl_trace_bidirectional(t);
      break;
    case VL_TRACER_MERGING:
      vl_trace_merging(t);
      break;
    case VL_TRACER_SPPM:
      vl_trace_sppm(t);
      break;
    case VL_TRACER_LIGHT_PATH:
      vl_trace_light_path(t);
      break;
    case VL_TRACER_RANDOM_WALK:
      vl_trace_random_walk(t);
      break;
  }
}

#endif
