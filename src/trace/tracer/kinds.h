/* trace/tracer/kinds.h: the function of each kind of tracer. */
#ifndef TRACE_TRACER_KINDS_H
#define TRACE_TRACER_KINDS_H

#include "trace/stages.h"
#include "velo/tracer.h"

/* Each kind of tracer has one function, vl_trace_ and its name; tracer/tracers.hot.c calls it.
 */
#define VL_TRACER_FUNCTION(K, k) void vl_trace_##k(vlTracing *t);
VL_TRACER_KINDS(VL_TRACER_FUNCTION)
#undef VL_TRACER_FUNCTION

#endif
