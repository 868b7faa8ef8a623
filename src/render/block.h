/* render/block.h: one run of vl_render, and how its workers render it: in blocks of tiles.
 *
 *   tile x samples -> film positions (filter) -> camera rays -> trace -> RGB -> film sums
 *
 * A batch is a tile of 16 x 16 pixels times up to 4 samples, or up to 4 tiles. Pixels are in
 * Morton order, so that 16 neighbours make a packet. A sample depends on (seed, pixel, index)
 * alone, and the film's sums are exact: the grouping into batches does not change the image. */
#ifndef RENDER_BLOCK_H
#define RENDER_BLOCK_H

#include <stdatomic.h>

#include "film/film.h"
#include "render/adaptive.h"
#include "render/film_rays.h"
#include "render/reconstruct.h"
#include "render/stop.h"
#include "render/two_way.h"
#include "trace/trace.h"
#include "velo/render.h"
#include "velo/setting.h"

enum { VL_RENDER_TILE = 16, VL_RENDER_ROWS = VL_FILM_ROWS + 16 };
/* Some of the rows after those of vlFilmRayRows: 4 wavelengths, 4 densities, 4 of radiance;
 * red, green, blue. */
enum {
  VL_ROW_LAMBDA = VL_FILM_ROWS,
  VL_ROW_INV_PDF = VL_ROW_LAMBDA + 4,
  VL_ROW_RADIANCE = VL_ROW_INV_PDF + 4,
  VL_ROW_RED = VL_ROW_RADIANCE + 5
};

/* A size rounded up to whole cache lines, bytes. */
static inline size_t vl_whole_lines(size_t size) {
  return (size + 63) & ~(size_t)63;
}

typedef struct vlRenderWorker {
  vlTraceScratch *scratch;
  float *rows; /* VL_RENDER_ROWS arrays of VL_ROW_SIZE */
  /* written by the worker; the progress report reads them */
  _Atomic uint64_t paths, bounce_rays, shadow_rays;
  vlSharedGrid *grids; /* VL_SHARED_SAMPLES of them; null: pixels share no samples */
  uint64_t merge_work; /* as vlTraceBatch.merge_work */
  uint64_t not_finite;
  int32_t bad_x, bad_y;
  /* records the paths; the film then gets no samples. Null: none */
  struct vlPathRecorder *recorder;
} vlRenderWorker;

typedef struct vlRenderRun {
  const vlWorld *world;
  vlFilm *film;
  const vlRenderDef *def;
  vlFilmRays film_rays;
  float exposure_time;
  vlTraceDef trace;
  const vlTraceKernels *trace_kernels;
  vlTwoWayRun *two_way; /* null: a tracer without light paths */
  bool rgb_mode;
  bool raced; /* one of the race (choose.c), which has only tracers that lack nothing of the
                 scene */
  vlResult prepared; /* of vl_render_prepare: OK or MEMORY */
  bool shares;       /* pixels share samples */
  vlReconstruction reconstruction;
  uint32_t crop[4];
  uint32_t tiles_x, tiles_y, tile_x0, tile_y0;
  uint32_t span_x, span_y; /* tiles of a block, the unit of work of a worker */
  uint32_t first_sample, pass_samples;
  vlAdaptive adaptive;
  vlRenderWorker *workers;
  _Atomic uint64_t own_bad; /* numbers of the caller's own sampler that were replaced */
  atomic_uint blocks_done;
  vlStop stop;
  vlLoopDef loop;
  double start;
  vlFilmSequence sequence;
  /* Work in samples per pixel, the mean over all pixels: before this call, before the running
   * pass, of the running pass, and at the end of this call (expected). */
  double work_before, work_done, work_pass, work_total;
} vlRenderRun;

/* Chooses the size of a block. In a pass with few samples a block has several tiles, so that
 * batches are full, but not so many that a worker is idle. */
void vl_render_choose_blocks(vlRenderRun *r);
uint32_t vl_render_block_count(const vlRenderRun *r);
/* A render that only measures (choose.c, illuminance.c). */
typedef struct vlPilot {
  float spread;       /* vlFilmRays.spread; texture footprints are smaller by the same factor */
  uint32_t pass_seed; /* of the wavelengths and times that all paths of a pass share */
  /* not null: VL_TRACER_LIGHT_PATH, and the film gets what vl_tails_measure finds */
  const vlTails *tails;
  bool irradiance; /* vlTraceDef.irradiance; the camera's factors on radiance do not count */
  uint64_t merge_work; /* result: as vlTraceBatch.merge_work */
} vlPilot;
/* As vl_render. pilot may be null. In render.c. */
vlResult vl_render_pilot(const vlWorld *world, const vlCamera *camera, vlFilm *film,
                         const vlRenderDef *def, vlPilot *pilot, vlRenderStats *stats,
                         vlError *error);
/* Makes a run from world, film, def and sequence: rays, sampler, tracer, crop. In render.c. */
void vl_render_prepare(vlRenderRun *r, const vlCamera *camera);
/* Checks the def's cookie, and that its tracer, sampler and other choices are known. what: the
 * beginning of the message. In render.c. */
vlResult vl_render_def_check(const vlRenderDef *def, const char *what, vlError *error);
/* Checks the arguments of a render. In render.c. */
vlResult vl_render_check(const vlWorld *world, const vlCamera *camera, vlFilm *film,
                         const vlRenderDef *def, vlError *error);
/* Traces and exposes the n samples that the worker's rows list, and adds them to the film. */
void vl_render_batch(const vlRenderRun *r, vlRenderWorker *w, uint32_t n);
/* A task of vl_parallel_for; user is the run. */
void vl_render_block(void *user, uint32_t block, uint32_t worker);

#endif
