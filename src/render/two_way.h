/* render/two_way.h: the passes of the two-way tracers (trace/two_way/two_way.h). The light paths of a pass are traced
 * before its camera paths. Their splats are summed exactly, so that neither threads nor order change the result, and
 * are added to the film with the one sample that each pixel has in the pass. */
#ifndef RENDER_TWO_WAY_H
#define RENDER_TWO_WAY_H

#include "camera/rays.h"
#include "film/film.h"
#include "render/film_rays.h"
#include "render/stop.h"
#include "trace/two_way/two_way.h"

typedef struct vlTwoWayRun vlTwoWayRun;

enum { VL_MOST_LIGHT_PATHS = 1 << 24 };

/* Whether the tracer traces light paths, too. */
bool vl_two_way_tracer(vlTracer tracer);

/* trace: the definition for the camera paths; the caller sets its two_way to vl_two_way_of. rays: gives the camera
 * samples' times; must outlive the run. Error: MEMORY. */
vlResult vl_two_way_create(const vlWorld *world, const vlCamera *camera, vlFilm *film, const vlRenderDef *def,
                           const vlTraceDef *trace, const vlFilmRays *rays, vlTwoWayRun **run, vlError *error);
/* Estimated memory in bytes. */
uint64_t vl_two_way_memory(const vlWorld *world, const vlFilmDef *film, const vlRenderDef *def);
void vl_two_way_destroy(vlTwoWayRun *run);
const vlTwoWay *vl_two_way_of(const vlTwoWayRun *run);
/* A worker's memory for vlTraceBatch.two_way. */
struct vlTwoWayRows *vl_two_way_rows(const vlTwoWayRun *run, uint32_t worker);

/* Sets the scratch of a worker. */
void vl_two_way_use(vlTwoWayRun *run, uint32_t worker, vlTraceScratch *scratch);

/* The number in [0, 1) from which all paths of sample `index` take their time, where they merge; else below 0: each
 * path has its own. */
float vl_two_way_time(const vlTwoWayRun *run, uint32_t index);
/* The camera's views for the n numbers u that times are sampled by; time: those times, the world's (VL_PAD(n) elements,
 * may be null). The result is the worker's memory. Null where the camera does not move or light paths do not connect to
 * it. */
const vlCameraView *vl_two_way_cameras(const vlTwoWayRun *run, uint32_t worker, uint32_t n, const float *u,
                                       float *time);
/* Traces the light paths of sample `index`. Errors: MEMORY, CANCELLED. */
vlResult vl_two_way_light(vlTwoWayRun *run, uint32_t index, vlStop *stop, vlError *error);
/* Moves the pixels' splats to their samples (of filter weight `weight`): each pixel once per pass, any thread. */
void vl_two_way_take(vlTwoWayRun *run, uint32_t n, const int32_t *px, const int32_t *py, const float *weight, float *r,
                     float *g, float *b);

/* Counts since the run began. */
typedef struct vlTwoWayCounts {
  uint64_t paths, bounce_rays, shadow_rays, not_finite;
} vlTwoWayCounts;
vlTwoWayCounts vl_two_way_counts(const vlTwoWayRun *run);

#endif
