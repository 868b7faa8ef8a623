/* tracer/record.h: records the paths of a batch for vl_trace_paths (velo/paths.h). The
 * stages of the path tracer and of the volumetric path tracer call it once per stage, if
 * vlTraceBatch.recorder is set. It reads what the stage left in the working memory, and
 * computes again what the stage did not keep; it changes nothing that the tracer reads. */
#ifndef TRACER_RECORD_H
#define TRACER_RECORD_H

#include "trace/stages.h"
#include "velo/paths.h"

/* Room for the paths of a batch: lane i has vertices from i * max_vertices on, and
 * contributions likewise. What does not fit is counted in lost. */
typedef struct vlPathRecorder {
  vlPath *paths; /* by lane; the counts are written */
  vlPathVertex *vertices;
  vlPathContribution *contributions;
  uint32_t max_vertices, max_contributions, lost;
} vlPathRecorder;

/* The n rays reached these hits. */
void vl_record_arrivals(vlTracing *t, uint32_t n, uint32_t bounce, const vlPaths *rays,
                        const vlHits *hits);
/* The lights that the rays hit, as vl_stage_emission adds them. */
void vl_record_emission(vlTracing *t, uint32_t n, const vlPaths *rays, const vlHits *hits);
/* The n shaded vertices, before light is sampled. */
void vl_record_shaded(vlTracing *t, uint32_t n, const vlVertices *at);
/* The `count` shadow rays of the path tracer, after they were traced. */
void vl_record_direct_light(vlTracing *t, uint32_t n, uint32_t count, const vlVertices *at,
                            const vlLightSamples *light, const vlBsdfValues *values,
                            const vlShadowRays *shadow);
/* What vl_stage_scatter sampled at the n vertices. next: the rays, ray i from vertex i; those
 * that go on are the `count` of order. */
void vl_record_scatter(vlTracing *t, uint32_t n, uint32_t depth, const vlVertices *at,
                       const vlBsdfSamples *samples, const vlPaths *next, const uint32_t *order,
                       uint32_t count);
/* The path of a lane ends because it has its largest number of bounces, or of one kind. */
void vl_record_limit(const vlTracing *t, uint32_t lane);
/* The same for the paths of n rays. */
void vl_record_depth(const vlTracing *t, uint32_t n, const vlPaths *rays);

/* ---- media and subsurface materials ------------------------------------------------------ */

/* vl_record_arrival adds a vertex to the path of ray i: the ray left the scene; null if there
 * is no room. vl_record_surface makes it the surface that the ray hits. */
vlPathVertex *vl_record_arrival(vlTracing *t, const vlPaths *rays, uint32_t i, uint32_t bounce);
void vl_record_surface(vlTracing *t, const vlPaths *rays, const vlHits *hits, uint32_t i,
                       vlPathVertex *v);
/* Adds a contribution to the path of a lane of the batch. The vertex is its last. */
void vl_record_light(vlTracing *t, uint32_t lane, const vlPathContribution *light);
/* Adds what a light that ray i has hit gives: its radiance times the path's throughput and the
 * factor. weight: against light sampling. sky: the ray left the scene. */
void vl_record_hit_light(vlTracing *t, const vlPaths *rays, uint32_t i, const vlHitLight *met,
                         bool sky, float weight, float factor);
/* Says which light sample i has and where it lies: type, object, distant, light, target. */
void vl_record_sampled(const vlWorld *world, const vlLightSamples *samples, uint32_t i,
                       vlPathContribution *to);
/* The n paths of p scatter in media: densities are normalised. */
void vl_record_scattering(vlTracing *t, const vlPaths *p, uint32_t n);
/* The same paths after the phase function was sampled; kept lists the `count` paths that go on.
 * depth: as in vl_volume_phase_scatter. */
void vl_record_phase(vlTracing *t, uint32_t n, uint32_t depth, const vlPaths *p,
                     const uint32_t *kept, uint32_t count);
/* The n probes were followed: paths whose probe found no exit end. */
void vl_record_probes(vlTracing *t, uint32_t n, const vlPaths *p, const uint32_t *found);
/* The n paths of p leave subsurface materials. */
void vl_record_exits(vlTracing *t, uint32_t n, const vlPaths *p, const vlHits *hits,
                     const vlSurface *surface);
/* The same paths after they left or ended (alive). */
void vl_record_left(vlTracing *t, uint32_t n, const vlPaths *p, const uint8_t *alive);

#endif
