/** @file
 * velo/choose.h: the choice of a tracer by a short race. docs/tracers.md explains it. */
#ifndef VELO_CHOOSE_H
#define VELO_CHOOSE_H

#include "velo/render.h"

#ifdef __cplusplus
extern "C" {
#endif

/** Largest number of trials of a race. */
#define VL_MAX_TRIALS 4

/** One competitor of a race: a tracer with a number of light paths. */
typedef struct vlTracerTrial {
  uint32_t tracer;      /**< VL_TRACER_VOLPATH, VL_TRACER_BIDIRECTIONAL or VL_TRACER_MERGING */
  uint32_t light_paths; /**< for vlRenderDef.light_paths */
  double error; /**< relative squared error of an image with the samples of the race, from the
                   difference of two seeds, without the worst 0.1 % of pixels; with `tail`,
                   where that is more */
  double tail;  /**< relative squared error by samples that are too rare and bright for the race
                   to see them all, as light paths find it, less two standard errors; 0 for
                   tracers that have light paths */
  double missing; /**< relative squared error of the light that merging finds and this tracer
                     does not; 0 without merging in the race, and for merging itself */
  double cost;    /**< rays of the race, each times its mean time relative to a ray of
                     VL_TRACER_VOLPATH */
  double work;    /**< error times cost, over that of the first trial, VL_TRACER_VOLPATH */
} vlTracerTrial;

/** The result of a race. */
typedef struct vlTracerChoice {
  uint32_t tracer;      /**< the best tracer, for vlRenderDef.tracer */
  uint32_t light_paths; /**< for vlRenderDef.light_paths */
  uint32_t count; /**< number of trials; 0: there was no race. The tracer is then VL_TRACER_PATH
                     where the def's tracer looks past something of the world, else
                     VL_TRACER_VOLPATH */
  vlTracerTrial trials[VL_MAX_TRIALS]; /**< VL_TRACER_VOLPATH first */
} vlTracerChoice;

/** Chooses the tracer with the least error for the same time. The competitors are
 * VL_TRACER_VOLPATH, VL_TRACER_BIDIRECTIONAL with as many light paths as pixels and with a
 * quarter of them, and, if `merging`, VL_TRACER_MERGING. Each renders two coarse images of the
 * whole film (its crop is ignored) with fixed seeds. The errors are the differences of the two;
 * the costs are counted in rays. So the choice has the same result for any number of threads,
 * on every machine, and for every crop, seed and range of samples of the same image.
 *
 * film, def: as for vl_render; def->spp is the number of samples of the whole image. The race
 * costs about 4 % of the work of spp samples by VL_TRACER_VOLPATH, at most as much as 2^19
 * paths. There is no race for images so small that this does not suffice, for films with
 * spectra, and where VL_TRACER_VOLPATH replaces the tracers with light paths. Nor is there one
 * where def->tracer looks past media or subsurface materials of the world
 * (VL_TRACER_TRAIT_NO_MEDIA): the competitors do not, so that their images would show another
 * scene. def->progress is called during the race, and may stop it. Errors: as vl_render. */
VL_API vlResult vl_choose_tracer(const vlWorld *world, const vlCamera *camera,
                                 const vlFilmDef *film, const vlRenderDef *def, bool merging,
                                 vlTracerChoice *choice, vlError *error);

#ifdef __cplusplus
}
#endif

#endif
