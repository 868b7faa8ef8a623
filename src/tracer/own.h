/* tracer/own.h: a tracer of one's own (velo/trace.h): a batch that it traces, and the
 * functions that answer its questions. own.hot.c has these once per instruction set, own.c the
 * public functions that call them. */
#ifndef TRACER_OWN_H
#define TRACER_OWN_H

#include "trace/stages.h"
#include "velo/trace.h"

typedef struct vlTraceQueries {
  void (*hits)(vlTrace *trace, const vlTraceRays *rays, vlTraceHits *hits);
  void (*occluded)(vlTrace *trace, const vlTraceRays *rays, uint8_t *occluded);
  void (*leave)(vlTrace *trace, float (*direction)[VL_OWN_BATCH], vlTraceRays *rays);
  void (*lights)(vlTrace *trace, uint32_t bounce, vlTraceLights *lights);
  void (*bsdf)(vlTrace *trace, float (*direction)[VL_OWN_BATCH], float (*value)[VL_OWN_BATCH],
               float *pdf);
  void (*bounce)(vlTrace *trace, uint32_t bounce, vlTraceBounce *next);
} vlTraceQueries;

struct vlTrace {
  const vlTraceQueries *queries;
  vlTracing t;        /* its batch is the one below */
  vlTraceBatch batch; /* the render's; only the outputs differ */
  uint32_t hits;      /* how many of the last rays hit something: elements of s->at.paths,
                         s->at.surface, s->at.shade */
  uint32_t lanes;     /* of the last rays */
  bool begun;
  vlFloatRow t_min, t_max;
  vlFloatRow radiance[4]; /* what stages add that no question asks for */
};

/* Runs the tracer def->own on the batch. Its paths are started. In own.hot.c. */
void vl_own_tracer(vlTracing *t);

#endif
