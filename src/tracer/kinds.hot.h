/* tracer/kinds.hot.h: the functions of all kinds of tracers (tracer/kinds.row.h). */
#ifndef TRACER_KINDS_HOT_H
#define TRACER_KINDS_HOT_H

#include "trace/stages.h"
#include "tracer/kinds.row.h"

/* Traces a batch of camera paths. */
typedef void vlTracerFn(vlTracing *t);
#define VL_TRACER_DECLARE(kind, row, trace) vlTracerFn trace;
VL_TRACER_FUNCTIONS(VL_TRACER_DECLARE)
#undef VL_TRACER_DECLARE

#endif
