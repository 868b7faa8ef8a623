/* render/two_way.h: the passes of the two-way tracers (trace/two_way/two_way.h). The light
 * paths of a pass are traced before its camera paths. Their splats are summed exactly, so that
 * neither threads nor order change the result, and are added to the film with the one sample
 * that each pixel has in the pass. */
#ifndef RENDER_TWO_WAY_H
#define RENDER_TWO_WAY_H

#include "camera/rays.h"
#include "film/film.h"
#include "render/film_rays.h"
#include "render/stop.h"
#include "render/tails.h"
#include "trace/two_way/two_way.h"

typedef struct vlTwoWayRun vlTwoWayRun;

enum { VL_MAX_LIGHT_PATHS = 1 << 24 };

/* Whether the tracer traces light paths, too. */
bool vl_two_way_tracer(uint32_t tracer); /* vlTracer */

/* trace: the def of the camera paths; afterwards the caller sets its member two_way to
 * vl_two_way_of(run). rays: determines the times of camera samples; must outlive the run.
 * Error: MEMORY. */
vlResult vl_two_way_create(const vlWorld *world, const vlCamera *camera, vlFilm *film,
                           const vlRenderDef *def, const vlTraceDef *trace,
                           const vlFilmRays *rays, vlTwoWayRun **run, vlError *error);
/* Estimated memory in bytes. */
uint64_t vl_two_way_memory(const vlWorld *world, const vlFilmDef *film, const vlRenderDef *def);
void vl_two_way_destroy(vlTwoWayRun *run);
const vlTwoWay *vl_two_way_of(const vlTwoWayRun *run);
/* A worker's memory for vlTraceBatch.two_way. */
struct vlTwoWayRows *vl_two_way_rows(const vlTwoWayRun *run, uint32_t worker);

/* Light paths measure the error of camera paths instead of adding radiance (tails.h); camera
 * paths are not traced. tails: null, or valid until the run is destroyed. pixel:
 * vlTwoWay.pixel. Only for VL_TRACER_LIGHT_PATH. */
void vl_two_way_measure(vlTwoWayRun *run, const vlTails *tails, float pixel);

/* Seeds the wavelengths and times that all paths of a pass share. They depend on the sampler's
 * seed otherwise. */
void vl_two_way_share(vlTwoWayRun *run, uint32_t seed);
/* Makes a worker use this scratch memory. */
void vl_two_way_use(vlTwoWayRun *run, uint32_t worker, vlTraceScratch *scratch);

/* Sets what determines the times of the camera paths of sample `index`: if the tracer merges
 * paths, all have the same time; if it connects inner vertices and the world moves, each has
 * the time of its group. */
void vl_two_way_times(const vlTwoWayRun *run, uint32_t index, vlFilmRays *rays);
/* The camera's views at the n times that are sampled by the numbers u. `time` (VL_PAD(n)
 * elements, may be null) receives these times in world time, 0 to 1. The result is memory of
 * the worker. It is null if the camera does not move or light paths do not connect to it. */
const vlCameraView *vl_two_way_cameras(const vlTwoWayRun *run, uint32_t worker, uint32_t n,
                                       const float *u, float *time);
/* Traces the light paths of sample `index`. Errors: MEMORY, CANCELLED. */
vlResult vl_two_way_light(vlTwoWayRun *run, uint32_t index, vlStop *stop, vlError *error);
/* Drops the splats that no sample has taken, after a pass that was not over all pixels. */
void vl_two_way_drop_splats(vlTwoWayRun *run);
/* Moves the splats of n pixels to their samples, whose filter weights are `weight`. To be
 * called once per pixel and pass, on any thread. */
void vl_two_way_take(vlTwoWayRun *run, uint32_t n, const int32_t *px, const int32_t *py,
                     const float *weight, float *r, float *g, float *b);

/* Counts since the run began. */
typedef struct vlTwoWayCounts {
  uint64_t paths, bounce_rays, shadow_rays, not_finite;
} vlTwoWayCounts;
vlTwoWayCounts vl_two_way_counts(const vlTwoWayRun *run);

#endif
