/* render/steady.h: the frames of turntables, trajectories and animations are denoised with the
 * help of the frames before them, along the exact flow of their surfaces, so that what is left
 * of the noise does not flicker. The result of a frame depends on a fixed number of frames
 * before it, each denoised by itself: so it is the same for any division of the frames among
 * processes. */
#ifndef APP_RENDER_STEADY_H
#define APP_RENDER_STEADY_H

#include "render/job.h"
#include "velo/channels.h"
#include "velo/denoise.h"

enum { STEADY_BEFORE = 5 }; /* number of earlier frames that a frame uses */

/* A frame, denoised by itself. Its images belong to it. */
typedef struct SteadyFrame {
  bool used;
  uint32_t number;
  vlCamera camera;
  vlImage *clean;    /* with its errors */
  vlImage *features; /* the denoiser's */
  vlImage *ids;      /* id.object, id.instance */
} SteadyFrame;

/* Makes a world that shows the moments of an earlier frame and of the job's. *between is the
 * caller's; in it the earlier frame's moment is at time 0, the job's at *span, in seconds. */
typedef vlResult SteadyBetween(void *user, uint32_t before, uint32_t now, const Job *job,
                               vlWorld **between, double *span, vlError *error);

typedef struct Steady {
  SteadyFrame frames[STEADY_BEFORE + 1]; /* in any order */
  uint32_t number;                       /* of the frame that is rendered */
  uint32_t before[STEADY_BEFORE], count; /* numbers of those that it uses */
  bool only_kept;                        /* it is kept for later frames; nothing is written */
  SteadyBetween *between;                /* null: all frames have the same world */
  void *between_user;
} Steady;

/* Memory in bytes for frames of so many pixels. */
uint64_t steady_memory(uint64_t pixels);
/* Renders frame s->before[k], which is only kept. Returns the exit code. */
typedef int SteadyRender(void *user, uint32_t k);
/* Renders those frames that the frame `number` uses (s->before) and that are not kept. Returns
 * the exit code. */
int steady_prepare(Steady *s, uint32_t number, SteadyRender *render, void *user);
/* Keeps the frame s->number, and forgets one that is not used any more. image: of the samples,
 * with the denoiser's features. Takes ownership of `clean`, also after an error. */
vlResult steady_keep(Steady *s, const Job *job, const vlImage *image, vlImage *clean,
                     int *signals, vlError *error);
/* Makes the image of the frame s->number of itself and of those that it uses, which are kept.
 */
vlResult steady_blend(const Steady *s, const Job *job, int *signals, vlImage **result,
                      vlError *error);
void steady_free(Steady *s);

#endif
