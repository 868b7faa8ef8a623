/* render/channels.h: ground truth channels of an image: the choice of channels, their render
 * pass, and the file that describes the ids. */
#ifndef APP_RENDER_CHANNELS_H
#define APP_RENDER_CHANNELS_H

#include "render/job.h"
#include "velo/boxes.h"

enum {
  CHANNEL_LAYERS = 4,
  CHANNELS_CRYPTO =
      VL_CHANNEL_CRYPTO_OBJECT | VL_CHANNEL_CRYPTO_MATERIAL | VL_CHANNEL_CRYPTO_INSTANCE
};

typedef struct Channels {
  uint32_t bits; /* bit mask of vlChannel; 0: none */
  vlChannelMode mode;
  uint32_t ranks;
  bool boxes;
  const char *other_paths[2]; /* camera files for flow: forward, backward; null: the ends of the
                                 shutter interval */
  vlCamera others[2];
  vlImage *layers[CHANNEL_LAYERS]; /* results: numbers, ids, spectrum, gbuffer; null: none */
  bool spectrum;                   /* the film holds a spectrum */
  bool gbuffer;                    /* pbrt's gbuffer, when no other channels are wanted */
  vlIdBox *box_list[2]; /* boxes of objects and of instances, by id - 1; null without boxes */
} Channels;

extern const Choice channel_mode_choices[];

/* Reads the options of the command line. Returns -1, or the exit code after reporting the
 * error. */
int channels_choose(Channels *c, const Arguments *arguments);
/* Adds the channels that the scene's film requires: a spectrum or a gbuffer. */
void channels_take(Channels *c, Job *job);
/* Reads the cameras to which flow leads. Must be called after the image's camera is made.
 * Returns -1 or the exit code. */
int channels_load(Channels *c, vlContext *context, const Job *job);
/* Returns whether there are channels that only .exr files can hold. */
bool channels_any(const Channels *c);
/* Returns the number of 4-byte values per pixel. buckets: number of buckets of the film's
 * spectrum. */
uint64_t channels_values(const Channels *c, uint32_t buckets);
/* Estimated seconds of rendering and writing the channels of an image with `spp` samples per
 * pixel, from those that one sample per pixel and the writing of the image alone took. */
double channels_seconds(const Channels *c, uint32_t buckets, uint32_t spp, double sample,
                        double writing);
/* Renders the channels, after the image. Returns STATUS_OK or the exit code; 128 + signal when
 * another signal interrupts it. */
int channels_render(Channels *c, const Job *job, const vlFilm *film);
/* Converts names and types of the ids (vl_render_channels' second image) to their form in
 * files. VL_ERROR_MEMORY or VL_OK. */
vlResult channels_make_visible(vlImage **ids);
/* Sets the header attributes of the mode and of the layers. They are the last but for the
 * receipt, so that `velo film develop` writes the same file. */
vlResult channels_describe(const Channels *c, vlImage *image);
/* Sets the header attribute of the mode, if there are channels. */
vlResult channels_describe_mode(const Channels *c, vlImage *image);
/* Writes PATH.ids.json: type, name, material, location in its file and, if wanted, the box of
 * each id in the image. `right` (may be null): the other view of the same file, whose ids are
 * included. Nothing for the standard output. Returns STATUS_OK or the exit code. */
int channels_write_ids(const Channels *c, const Channels *right, const Job *job,
                       const char *path);
void channels_free(Channels *c);

#endif
