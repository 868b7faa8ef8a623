/* render/job.h: one render: the scene file's settings, overridden by the command line. */
#ifndef APP_RENDER_JOB_H
#define APP_RENDER_JOB_H

#include "cli/options.h"
#include "velo/channels.h"
#include "velo/render.h"

/* Options of `velo render`, indices into Arguments.values. */
enum {
  RENDER_OUTPUT,
  RENDER_THREADS,
  RENDER_SPP,
  RENDER_NOISE,
  RENDER_TIME,
  RENDER_RESOLUTION,
  RENDER_CROP,
  RENDER_CROPWINDOW,
  RENDER_SEED,
  RENDER_SEQUENCE,
  RENDER_CAMERA,
  RENDER_TRACER,
  RENDER_SAMPLER,
  RENDER_FILTER,
  RENDER_FILTER_SAMPLES,
  RENDER_LIGHT_SAMPLER,
  RENDER_REGULARIZE,
  RENDER_MERGE_RADIUS,
  RENDER_LIGHT_PATHS,
  RENDER_MAX_DEPTH,
  RENDER_COLOR,
  RENDER_SENSOR,
  RENDER_VIEW,
  RENDER_EXPOSURE,
  RENDER_SPECTRUM,
  RENDER_HALF,
  RENDER_DRY_RUN,
  RENDER_PERMISSIVE,
  RENDER_STRICT,
  RENDER_STRICT_OPTIONS,
  RENDER_SEARCH,
  RENDER_IMITATE_PBRT,
  RENDER_QUIET,
  RENDER_LOG_JSON,
  RENDER_VERBOSE,
  RENDER_ISA,
  RENDER_BITS,
  RENDER_ACCELERATOR,
  RENDER_CHANNELS,
  RENDER_CHANNELS_MODE,
  RENDER_CHANNELS_TIME,
  RENDER_CRYPTO_RANKS,
  RENDER_FLOW_CAMERA,
  RENDER_BOXES,
  RENDER_FLOW_CAMERA_BEFORE,
  RENDER_TRAJECTORY,
  RENDER_FRAMES,
  RENDER_FRAME,
  RENDER_RIG,
  RENDER_STEREO,
  RENDER_INTEROCULAR,
  RENDER_CONVERGENCE,
  RENDER_EYE,
  RENDER_AT,
  RENDER_ANIMATION,
  RENDER_ANIMATE,
  RENDER_FPS,
  RENDER_TURNTABLE,
  RENDER_TURN,
  RENDER_VARIANT,
  RENDER_SCENE_UNIT,
  RENDER_ENVIRONMENT,
  RENDER_ENVIRONMENT_ROTATION,
  RENDER_ENVIRONMENT_STRENGTH,
  RENDER_GROUND,
  RENDER_NO_GROUND,
  RENDER_GROUND_MIDDLE,
  RENDER_GROUND_RADIUS,
  RENDER_FRAMING,
  RENDER_WALLS,
  RENDER_UP,
  RENDER_TRANSPARENT,
  RENDER_SHUTTER,
  RENDER_SCENE,
  RENDER_MAX_MEMORY,
  RENDER_MAX_TEXTURE,
  RENDER_SANDBOX,
  RENDER_AGAIN,
  RENDER_NO_RECEIPT,
  RENDER_SIZE,
  RENDER_DENOISE,
  RENDER_DENOISER,
  RENDER_DENOISER_LIBRARY,
  RENDER_FILM,
  RENDER_OVERWRITE,
  RENDER_CHECKPOINT,
  RENDER_CONTINUE,
  RENDER_SAMPLES,
  RENDER_SHARD,
  RENDER_SHARD_BY,
  RENDER_TILES,
  RENDER_SKIP_EXISTING,
  RENDER_SERVE,
  RENDER_PLAIN,
  RENDER_LENS /* the first of lens_options.h */
};

extern const Choice light_sampler_choices[], sensor_choices[], regularize_choices[],
    filter_samples_choices[], color_choices[], view_choices[], isa_choices[], bits_choices[],
    accelerator_choices[], shard_choices[], stereo_choices[], eye_choices[], framing_choices[],
    walls_choices[], up_choices[];

extern Option render_options[];
extern const Section render_sections[];

/* The value of --tracer auto. */
enum { TRACER_AUTO = 255 };

/* What is chosen by a race before the render (race.h): the tracer, or the number of light paths
 * of the bidirectional one. */
typedef enum RaceKind { RACE_NONE, RACE_TRACERS, RACE_LIGHT_PATHS } RaceKind;

/* The camera, image size and crop of a receipt. */
typedef struct ReceiptCamera {
  bool given;
  vlCameraDef def;
  uint32_t size[2], crop[4];
} ReceiptCamera;

typedef struct Job {
  vlContext *context;
  const vlWorld *world; /* null until it is built */
  const char *path;     /* path of the scene file */
  /* the scene's defs with overrides; a copy for each camera of a rig. defs->camera keeps the
   * size of its description */
  vlSceneDefs *defs;
  vlError camera_location; /* location of the camera in its file; only file, line and column are
                              used */
  vlCamera camera;         /* at the film's size */
  const ReceiptCamera *receipt_camera; /* replaces --camera FILE; null: none */
  const struct ReceiptPlan *receipt;   /* receipts of the images; null: none */
  bool records_files;                  /* for receipts */
  RaceKind race;                       /* before the render */
  bool raced; /* receipts name the tracer and the number of light paths */
  double channels_share, channels_seconds; /* time of the ground truth as a fraction of the
                                              shutter interval, unless seconds are set;
                                              both unset: of each row */
} Job;

/* Overrides the scene's defs and makes the camera. Returns -1, or the exit code after reporting
 * the error. */
int job_make(Job *job, vlContext *context, vlScene *scene, const char *path,
             const Arguments *arguments);

/* Returns whether the planned number of samples determines the length of the sampler's
 * sequence. */
bool job_sequence_is_planned(const Job *job, const Arguments *arguments);

/* The time of the ground truth and of the camera in the header, in seconds. VL_UNSET: when each
 * row is exposed; the header's camera then has the middle of the image's exposure. */
double job_channels_time(const Job *job);

/* A vlStopFn of passes over an image. user: an int, signals_count() at the start; one more
 * stops the pass. */
bool job_stop_asked(void *user);
/* The def of a pass over the job's image, without channels: its pixels, space, exposure and
 * time. film: whose samples the pass is about; null: none. signals: see job_stop_asked; it must
 * live as long as the def. */
vlChannelsDef job_channels_def(const Job *job, const vlFilm *film, int *signals);

/* Replaces the job's camera by one of a file. *defs becomes the job's defs and must outlive
 * it. */
int job_take_camera(Job *job, vlSceneDefs *defs, const vlCameraDef *def, const char *path,
                    const Arguments *arguments);

/* Makes a film for the job's image. Returns -1, or the exit code after reporting the error. */
int job_make_film(const Job *job, vlFilm **film);
/* The exit code at the end of a pass over the job's image; reports the error. */
int job_end_pass(const Job *job, vlResult result, const vlError *error);

/* Prints what would be rendered to stdout (or as a JSON line). denoised: the outputs hold the
 * denoised image alone. */
void job_describe(const Job *job, const vlScene *scene, bool denoised,
                  const char *const *outputs, int output_count);

#endif
