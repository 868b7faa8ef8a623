/* render/two_way.h: the passes of the tracers that follow light both ways (trace/two_way/two_way.h): before the eye's
 * paths of a pass come as many from the lights. What they leave on the film is summed exactly, so that neither threads
 * nor order show, and goes to the film with the one sample that each pixel has in the pass. */
#ifndef RENDER_TWO_WAY_H
#define RENDER_TWO_WAY_H

#include "camera/rays.h"
#include "film/film.h"
#include "render/film_rays.h"
#include "render/stop.h"
#include "trace/two_way/two_way.h"

typedef struct vlTwoWayRun vlTwoWayRun;

enum { VL_MOST_LIGHT_PATHS = 1 << 24 };

/* Whether a tracer goes both ways. */
bool vl_two_way_tracer(vlTracer tracer);

/* trace: what the eye's paths take; its two_way is the caller's to set, to vl_two_way_of. rays: how the eye's samples
 * have their times; it stays. MEMORY. */
vlResult vl_two_way_create(const vlWorld *world, const vlCamera *camera, vlFilm *film, const vlRenderDef *def,
                           const vlTraceDef *trace, const vlFilmRays *rays, vlTwoWayRun **run, vlError *error);
/* Bytes that it will take, about. */
uint64_t vl_two_way_memory(const vlWorld *world, const vlFilmDef *film, const vlRenderDef *def);
void vl_two_way_destroy(vlTwoWayRun *run);
const vlTwoWay *vl_two_way_of(const vlTwoWayRun *run);
/* Memory of a worker, for vlTraceBatch. */
struct vlTwoWayRows *vl_two_way_rows(const vlTwoWayRun *run, uint32_t worker);

/* The scratch that a worker is to use. */
void vl_two_way_use(vlTwoWayRun *run, uint32_t worker, vlTraceScratch *scratch);

/* The number that all paths of sample `index` have their times by, where they are to meet; else below 0. */
float vl_two_way_time(const vlTwoWayRun *run, uint32_t index);
/* The camera at the times that the n numbers u stand for, and those times, the world's (VL_PAD(n); may be null): the
 * worker's own memory. Null where the camera does not move or light does not see it. */
const vlCameraView *vl_two_way_cameras(const vlTwoWayRun *run, uint32_t worker, uint32_t n, const float *u,
                                       float *time);
/* The light's paths of sample `index`. MEMORY, CANCELLED. */
vlResult vl_two_way_light(vlTwoWayRun *run, uint32_t index, vlStop *stop, vlError *error);
/* Moves what the pixels got to their samples (of filter weight `weight`): each pixel once a pass, any thread. */
void vl_two_way_take(vlTwoWayRun *run, uint32_t n, const int32_t *px, const int32_t *py, const float *weight, float *r,
                     float *g, float *b);

/* So far. */
typedef struct vlTwoWayCounts {
  uint64_t paths, bounce_rays, shadow_rays, not_finite;
} vlTwoWayCounts;
vlTwoWayCounts vl_two_way_counts(const vlTwoWayRun *run);

#endif
