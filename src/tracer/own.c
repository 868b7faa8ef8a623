/* tracer/own.c: the public functions of velo/trace.h. */
#include "tracer/own.h"

/* Defines a public function whose arguments are `names`. */
#define QUERY(function, member, parameters, names) \
  void function parameters {                       \
    trace->queries->member names;                  \
  }
QUERY(vl_world_trace, hits, (vlTrace * trace, const vlTraceRays *rays, vlTraceHits *hits),
      (trace, rays, hits))
QUERY(vl_world_occluded, occluded,
      (vlTrace * trace, const vlTraceRays *rays, uint8_t occluded[VL_OWN_BATCH]),
      (trace, rays, occluded))
QUERY(vl_trace_leave, leave,
      (vlTrace * trace, float (*direction)[VL_OWN_BATCH], vlTraceRays *rays),
      (trace, direction, rays))
QUERY(vl_trace_lights, lights, (vlTrace * trace, uint32_t bounce, vlTraceLights *lights),
      (trace, bounce, lights))
QUERY(vl_trace_bsdf, bsdf,
      (vlTrace * trace, float (*direction)[VL_OWN_BATCH], float (*value)[VL_OWN_BATCH],
       float *pdf),
      (trace, direction, value, pdf))
QUERY(vl_trace_bounce, bounce, (vlTrace * trace, uint32_t bounce, vlTraceBounce *next),
      (trace, bounce, next))

/* Dimensions of the sampler behind those of all bounces. */
enum { PURPOSES = 1 << 21 };

void vl_trace_numbers(vlTrace *trace, uint32_t purpose, float *u, float *v) {
  const vlTraceBatch *b = &trace->batch;
  const vlSamplerKernels *k = trace->t.sampler;
  uint32_t dimension = PURPOSES + 2 * (purpose % (PURPOSES / 4));
  if (v)
    k->get_2d(trace->t.def->sampler, b->n, b->px, b->py, b->index, dimension, u, v);
  else
    k->get_1d(trace->t.def->sampler, b->n, b->px, b->py, b->index, dimension, u);
}
