/* render/run.h: the state of `velo render`, and its last step: the render of one image and its
 * files. */
#ifndef APP_RENDER_RUN_H
#define APP_RENDER_RUN_H

#include "cli/json.h"
#include "render/again.h"
#include "render/channels.h"
#include "render/continue.h"
#include "render/denoised.h"
#include "render/film_keeper.h"
#include "render/frames.h"
#include "render/job.h"
#include "render/memory.h"
#include "render/outputs.h"
#include "render/progress.h"
#include "render/scene_options.h"
#include "render/video.h"
#include "view/serve.h"

typedef struct Render {
  vlContext *context;
  vlScene *scene;
  vlWorld *world;
  vlFilm *film;
  Job job;
  Outputs outputs;
  char default_output[600];
  Progress progress;
  uint32_t begun_spp;   /* samples per pixel of a film that is continued */
  uint32_t written_spp; /* samples per pixel of the last progress image */
  bool part_named;      /* the paths of the NAME.part.EXT files were reported */
  /* Times, in seconds. */
  double last_write;   /* when a progress image was last written */
  double write_cost;   /* how long that took */
  double first_pass;   /* how long the first pass, of one sample, took; 0: not done */
  double start;        /* when the command began */
  double render_start; /* when the first pass began */
  double time_limit;   /* --time; 0: none */
  Channels channels;   /* of the ground truth */
  Frames frames;       /* of a trajectory, a rig or two eyes */
  MemoryPlan memory;
  Denoised denoised;
  bool many; /* whether `frames` is used */
  SceneOpening opening;
  Again again;
  Continue resumed;
  FilmKeeper keeper;
  FilmPlan film_plan;
  ReceiptPlan receipt;
  Serve *serve;                 /* the page of --serve; null: none */
  struct AnimateShared *shared; /* of all frames of an animation; null: this is one image */
  Videos *videos;               /* that the frames become; null: they stay images */
} Render;

/* Whether an output holds ground truth. */
bool run_has_layers(const Render *render);
/* The number of pixels that are rendered. */
uint64_t run_pixels(const Render *render);
/* Writes the numbers of paths, rays and samples that were left out into the open object. */
void json_render_stats(Json *json, const vlRenderStats *stats);
/* Warns of samples that were not finite or negative, if there were any. */
void report_not_finite(const vlRenderStats *stats);
/* The line of that warning, for some. */
void not_finite_text(const vlRenderStats *stats, char *text, size_t size);
/* Renders the image, writes its files and reports the result. Returns the exit code. */
int run_image(Render *render);

#endif
