/* trace/tracer/record.h: records the paths of a batch for vl_trace_paths (velo/paths.h). The stages of the path tracer
 * and of the volumetric path tracer call it once per stage, if vlTraceBatch.recorder is set. It reads what the stage
 * left in the working memory, and computes again what the stage did not keep; it changes nothing that the tracer
 * reads. */
#ifndef TRACE_TRACER_RECORD_H
#define TRACE_TRACER_RECORD_H

#include "trace/stages.h"
#include "velo/paths.h"

/* Room for the paths of a batch: lane i has vertices from i * most_vertices on, and contributions likewise. What does
 * not fit is counted in lost. */
typedef struct vlPathRecorder {
  vlPath *paths; /* by lane; the counts are written */
  vlPathVertex *vertices;
  vlPathContribution *contributions;
  uint32_t most_vertices, most_contributions, lost;
} vlPathRecorder;

/* The n paths of a reached what vlTraceScratch.hits_a says. */
void vl_record_arrivals(vlTracing *t, uint32_t n, uint32_t bounce);
/* The lights that the rays of a hit, as vl_stage_emission adds them. */
void vl_record_emission(vlTracing *t, uint32_t n);
/* The n shaded lanes of b, before light is sampled. */
void vl_record_shaded(vlTracing *t, uint32_t n);
/* The shadow rays of the path tracer, after they were traced. */
void vl_record_direct_light(vlTracing *t, uint32_t n, uint32_t count);
/* The n lanes of b after vl_stage_scatter, which returned `count`; depth: as there. */
void vl_record_scatter(vlTracing *t, uint32_t n, uint32_t count, uint32_t depth);
/* Paths end here because they have their largest number of bounces. */
void vl_record_depth(vlTracing *t, uint32_t n);

/* ---- media and subsurface materials ------------------------------------------------------------------------------ */

/* vl_record_arrival adds a vertex to path i of a: the ray left the scene; null if there is no room. vl_record_surface
 * makes it the surface of hits_a. */
vlPathVertex *vl_record_arrival(vlTracing *t, uint32_t i, uint32_t bounce);
void vl_record_surface(vlTracing *t, uint32_t i, vlPathVertex *v);
/* Adds a contribution to the path of a lane of the batch. The vertex is its last. */
void vl_record_light(vlTracing *t, uint32_t lane, const vlPathContribution *light);
/* What a light is: fills type, object, distant and light. */
void vl_record_name_light(const vlWorld *world, uint32_t light, vlPathContribution *to);
/* The n paths of p scatter in media: densities are normalised. */
void vl_record_scattering(vlTracing *t, const vlPaths *p, uint32_t n);
/* The same paths after the phase function was sampled; volume.kept lists the `count` paths that go on. depth: as
 * in vl_volume_phase_scatter. */
void vl_record_phase(vlTracing *t, const vlPaths *p, uint32_t n, uint32_t count, uint32_t depth);
/* The n probes of b were followed: paths whose probe found no exit end. */
void vl_record_probes(vlTracing *t, uint32_t n);
/* The n paths of a leave subsurface materials, at the surfaces of s->surface and hits_b. */
void vl_record_exits(vlTracing *t, uint32_t n);
/* The same paths after they left or ended. */
void vl_record_left(vlTracing *t, uint32_t n);

#endif
