/* render/channels.h: ground truth beside the image: which channels are wanted, their pass, and the file that says
 * what the ids stand for. */
#ifndef APP_RENDER_CHANNELS_H
#define APP_RENDER_CHANNELS_H

#include "render/job.h"

enum { CHANNEL_LAYERS = 4 };

typedef struct Channels {
  uint32_t bits; /* of vlChannel; 0: none */
  vlChannelMode mode;
  uint32_t ranks;
  bool boxes;
  const char *other_paths[2]; /* camera files of flow: forward, backward; null: the shutter's ends */
  vlCamera others[2];
  vlImage *layers[CHANNEL_LAYERS]; /* what came of it: numbers, ids, spectrum, gbuffer; null: nothing of the kind */
  bool spectrum;                   /* the film has one */
  bool gbuffer;                    /* pbrt's, where no others are wanted */
  vlIdBox *box_list[2];            /* of objects and instances, by id - 1; null without boxes */
} Channels;

extern const Choice channel_mode_choices[];

/* What the command line wants. -1, or the exit code when all has been said. */
int channels_choose(Channels *c, const Arguments *arguments);
/* What the film brings with it: a spectrum, a gbuffer. */
void channels_take(Channels *c, Job *job);
/* The other cameras of flow, once the image's own is known. -1 or the exit code. */
int channels_load(Channels *c, vlContext *context, const Job *job);
/* Is there anything that only .exr files hold? */
bool channels_any(const Channels *c);
/* The pass, after the image. STATUS_OK or the exit code: 128 + signal when a signal that comes meanwhile ends it. */
int channels_render(Channels *c, vlContext *context, const vlWorld *world, const Job *job, const vlFilm *film);
/* Names and types of ids (vl_render_channels' second image) as files have them; MEMORY. */
vlResult channels_make_visible(vlContext *context, vlImage **ids);
/* What the layers' header says, into the image's. */
vlResult channels_describe(const Channels *c, vlImage *image);
/* Writes PATH.ids.json: type, name, material, place in its file and, if wanted, boxes of each id in the image.
 * `right` (may be null): the other view of the same file, whose ids are listed, too. STATUS_OK or the exit code. */
int channels_write_ids(const Channels *c, const Channels *right, const vlWorld *world, const char *path);
void channels_free(Channels *c);

#endif
