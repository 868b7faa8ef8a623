/* render/denoised.h: --denoise: writes a denoised copy of the image to a file of its own; and
 * the first image of a model, which is denoised itself. */
#ifndef APP_RENDER_DENOISED_H
#define APP_RENDER_DENOISED_H

#include "render/job.h"
#include "render/outputs.h"
#include "render/steady.h"
#include "velo/denoise.h"
#include "velo/render.h"

typedef struct Denoised {
  Outputs outputs;   /* count 0: nothing is denoised */
  bool replaces;     /* `outputs` are those of the image: they hold the denoised one alone */
  char comment[128]; /* of these files */
  float exposure;    /* that of the image, where each of both would be metered */
  bool written;
  Steady *steady; /* of several frames; null: this is one image */
  vlDenoiseDef def;
} Denoised;

/* Reads the options. `image`: the outputs of the image itself, whose view and exposure are
 * used. Returns -1, or the exit code after reporting the error. */
int denoised_choose(Denoised *d, const Arguments *arguments, const Outputs *image);
/* The outputs of the image itself hold the denoised one: the first image of a model. */
void denoised_replace(Denoised *d, const Outputs *image);
/* Whether a denoised copy is written to a file of its own. */
bool denoised_is_copy(const Denoised *d);
/* Checks before the render that the denoiser works: if it is Open Image Denoise, denoises an
 * image of one pixel. Returns -1, or the exit code after reporting the error. */
int denoised_check(const Denoised *d, vlContext *context);
/* Memory in bytes for an image of so many pixels. */
uint64_t denoised_memory(uint64_t pixels);
/* Estimated seconds of denoised_write for an image of so many pixels with `spp` samples, from
 * those that one sample per pixel and the writing of an image took, on so many threads. */
double denoised_seconds(uint64_t pixels, uint32_t spp, double sample, double writing,
                        uint32_t threads);
/* Makes the copy share the exposure of the image, which is known after its options are read:
 * call before the image is written. */
void denoised_share_exposure(Denoised *d, Outputs *image);
/* Renders the features and denoises the film's image. *clean, owned by the caller: the result,
 * with the image's header; null for a frame that is only kept for those after it, and after an
 * error. Returns STATUS_OK, or the exit code after reporting the error. */
int denoised_make(Denoised *d, const Job *job, const vlFilm *film, vlImage **clean);
/* denoised_make, and writes the result; d->written tells
 * whether it is there. Returns STATUS_OK, or the exit code after reporting the error. */
int denoised_write(Denoised *d, const Job *job, const vlFilm *film, OutputStage stage);

/* Makes one image with the channels of n float images, which have the same size. names: of all
 * its channels; null: those of the parts. */
vlResult denoised_join(vlContext *context, const vlImage *const parts[], int n,
                       const char *const *names, vlImage **joined);

#endif
