/* view/engine_parts.h: what the files of the engine share. Only engine*.c include it. */
#ifndef APP_VIEW_ENGINE_PARTS_H
#define APP_VIEW_ENGINE_PARTS_H

#include <pthread.h>

#include "render/progress.h"
#include "velo/sensor_raw.h"
#include "view/camera_edit.h"
#include "view/engine.h"
#include "view/state.h"

/* Why there may be no luminance. */
#define LUMINANCE_NEEDS "it needs the sensor cie1931 and no white balance"
enum { MAX_TASKS = 32, HISTORY = 256 };
/* Values of Wanted.channel that are not plain ground truth: the standard error and the
 * luminance need the film, flow needs a camera, the illuminance is a render of its own. CAMERA
 * is no ground truth: what a sensor makes of the film (engine_sensor.c). */
enum {
  CHANNEL_ERROR = 15,
  CHANNEL_FLOW = 16,
  CHANNEL_LUMINANCE = 22,
  CHANNEL_ILLUMINANCE = 23,
  CHANNEL_CAMERA = 64
};

/* What makes the samples of a film, as in vlRenderDef. */
typedef struct ViewTracer {
  uint32_t tracer; /* a vlTracer */
  uint32_t light_paths;
} ViewTracer;

/* What the pages ask for. A new generation makes the image begin anew. */
typedef struct Wanted {
  ViewCamera camera;
  uint32_t change;     /* the page's number of its last change */
  uint32_t generation; /* counts changes of what the image shows */
  uint32_t spp;        /* samples per pixel at which the image is done */
  bool paused;
  bool denoise;     /* the preview is denoised */
  uint32_t crop[4]; /* pixels */
  uint32_t channel; /* 1 + index of a ground truth channel; 0: the image */
  vlCamera mark;    /* to which flow leads */
  ViewSensor sensor;
  uint32_t sensor_edits; /* counts changes of the sensor */
} Wanted;

/* ---- the camera -------------------------------------------------------------------------- */

/* Cameras before the present one, for undo and redo. */
typedef struct History {
  ViewCamera cameras[HISTORY];
  uint32_t count, at; /* cameras[at] is the present one */
  uint32_t gesture;   /* edits of one gesture are one step */
} History;
/* The camera that pages want; takes the lock. */
ViewCamera engine_camera(Engine *engine);
/* Shows another camera, which becomes the present one of the history; the caller holds the
 * lock. change: the page's number of this change; gesture: edits of one gesture are one step;
 * 0: none. */
void engine_take_camera(Engine *engine, const ViewCamera *camera, uint32_t change,
                        uint32_t gesture);

/* ---- what waits to be answered ----------------------------------------------------------- */

/* Messages that wait to be answered. */
typedef struct TaskList {
  ViewMessage messages[MAX_TASKS];
  uint32_t count;
} TaskList;

/* ---- the paths of pixels (engine_paths.c) ------------------------------------------------ */

/* The pixels whose paths are to be traced: at most one of each page. */
typedef struct Traces {
  TaskList pixels;
  uint32_t client; /* the page whose paths are being traced; 0: none */
  vlCancel *stop;  /* stops the tracing; as Interrupt.cancel */
} Traces;

/* ---- copied commands (engine_save.c, engine_verify.c) ------------------------------------ */

typedef struct Verify {
  struct Copied *copied; /* what a page has copied last; null: none, or it is being verified */
  struct Copied *next;   /* what the thread is to verify, until it takes it */
  ViewMessage asked;     /* the message that asks for a verification */
  bool runs, end;        /* one is wanted or goes on; it shall end */
} Verify;

/* ---- loading (engine_watch.c, engine_reload.c) ------------------------------------------- */

/* The scene after a change of its files, or another of the lecture's. */
typedef struct Reload {
  uint32_t loads;   /* how often the scene was loaded again, or failed to */
  Model *model;     /* it is to be shown; null: none */
  const char *path; /* of another scene; null: the same */
  uint32_t change;  /* the page's number of its choice */
  FileList files;   /* of which the scene was made; the watcher's own */
} Reload;

/* The lecture's scene that a page has chosen and that is not loaded yet. */
typedef struct SceneChoice {
  const char *scene; /* null: none */
  uint32_t change;   /* the page's number of its choice */
} SceneChoice;

/* The time of the animation that a page asks for: in seconds, when the shutter opens, how long
 * it stays open. */
typedef struct AskedTime {
  double at, shutter;
  bool given, due; /* a page asked for one; the model is to be loaded for it */
  uint32_t change; /* the page's number of this change */
} AskedTime;
/* The thread that watches the files. */
void *engine_watch(void *engine);
/* Loads a scene, and sends the errors and warnings of that to the pages. The parameters are
 * those of model_load. Null: it cannot be loaded. */
Model *engine_load(Engine *engine, const char *path, const ModelTime *time,
                   const vlWorld *previous, FileList *files);
/* Gives the render thread a model to go on with, in place of one that it has not taken. path:
 * of another scene; null: the same, which has changed. The engine then owns the model. */
void engine_offer(Engine *engine, Model *model, const char *path, uint32_t change);
/* Loads the scene that a page has chosen. False: none is chosen. */
bool engine_load_choice(Engine *engine);
/* Goes on with the scene that was loaded again, if there is one. Returns whether there was. */
bool engine_swap_model(Engine *engine);
/* Begins anew with the camera and the settings of the model. Returns -1 or the exit code after
 * reporting an error. */
int engine_take_model(Engine *engine);
/* The timeline: of the animation that is chosen; else of what moves by itself, where the
 * camera's shutter chooses the time. The caller holds the lock. */
ViewTime engine_time(const Engine *engine);

/* ---- samples (engine_run.c) -------------------------------------------------------------- */

/* What stops the render thread. */
typedef struct Interrupt {
  vlCancel *cancel; /* requested and withdrawn under the lock */
  double since;     /* time of the first request that the thread has not obeyed; 0: none */
  double longest; /* the longest time from such a request to the end of the work, since the last
                     status */
  bool first_runs; /* the first image after a change is being made: changes let it end. The
                      render thread alone sets it */
} Interrupt;

/* The render of the film. */
typedef struct Samples {
  bool failed;          /* it cannot be rendered */
  double seconds;       /* that it has rendered */
  uint64_t paths;       /* that it has */
  double pixel_seconds; /* time of one sample of one pixel; 0: not known */
} Samples;
/* The thread that renders. */
void *engine_render(void *engine);
/* The def of a render of so many samples from the first one on, which a change stops; without
 * limits of time and noise. */
vlRenderDef engine_render_def(const Engine *engine, uint32_t spp);
/* Stops what the render thread does, unless that is the first image after a change; the caller
 * holds the lock. */
void engine_interrupt(Engine *engine);
/* The number of pixels of the present image. */
double engine_pixels(const Engine *engine);
/* The samples per pixel of its film; 0: there is no film, or it has none. */
uint32_t engine_spp(const Engine *engine);
/* A film for the present image; null after reporting why not. */
vlFilm *engine_make_film(Engine *engine);
/* Sets the tracer and the number of light paths of a render. */
void engine_set_tracer(vlRenderDef *render, ViewTracer tracer);
/* The tracer of the image that is shown; takes the lock. */
ViewTracer engine_shown(Engine *engine);
/* Seconds of processor time of the calling thread; of the whole program. */
double engine_thread_seconds(void);
double engine_program_seconds(void);
/* Takes and gives back the engine's lock. */
void engine_lock(Engine *engine);
void engine_unlock(Engine *engine);

/* ---- the race of --tracer auto (engine_race.c) ------------------------------------------- */

typedef struct Race {
  ViewTracer best;      /* of new films */
  uint32_t planned_for; /* samples per pixel for which a race was planned last; UINT32_MAX: the
                           choice is made */
  bool runs, decided;   /* it goes on; `best` is its result */
  vlFilm *successor; /* the image by the tracer that won; it replaces the film when it has less
                        noise. Null: none */
  uint32_t enough;   /* samples per pixel at which it does */
} Race;
/* Forgets the last scene's result. */
void engine_race_forget(Engine *engine);
/* Whether the race is due, if `spp` samples per pixel are wanted. */
bool engine_race_due(const Engine *engine, uint32_t spp);
/* Runs it, tells its result, and begins the successor if another tracer won. False:
 * interrupted. */
bool engine_race(Engine *engine);
/* Shows the successor in place of the film if it has enough samples. Returns whether it did. */
bool engine_succeed(Engine *engine);
void engine_drop_successor(Engine *engine);

/* ---- frames (engine_frames.c) ------------------------------------------------------------ */

/* What was sent. */
typedef struct FrameTimes {
  uint32_t serial;        /* of the last one */
  double published;       /* time of the last one of this image */
  double publish_seconds; /* time to make one */
  double seconds;         /* processor time of the render thread for all */
} FrameTimes;

typedef struct FrameKind {
  FrameFormat format; /* and channels: as frame_make's */
  uint32_t channels;
  uint32_t scale; /* pixels of the image per pixel of the frame */
  uint32_t spp;
  bool denoised;
  bool moved;     /* an earlier image that was moved with the camera */
  bool developed; /* by the mode "camera": linear sRGB, whatever the film's space is */
} FrameKind;
/* Sends a frame of `image`. */
void engine_publish(Engine *engine, const vlImage *image, const FrameKind *kind);
/* Whether what is shown is made of the film's samples: the image, luminance, standard errors.
 */
bool engine_is_of_film(uint32_t channel);
/* Sends the film, or a coarse one, whose rows from the top have samples. The others are those
 * of the last coarser one of this image. A coarse one that is whole is kept for this. */
void engine_publish_film(Engine *engine, const vlFilm *film, uint32_t scale, uint32_t rows);

/* A film with its camera, of the whole image or of a coarse one. */
typedef struct PartOfFilm {
  Engine *engine;
  const vlFilm *film;
  const vlCamera *camera;
  uint32_t scale;
  uint32_t crop[4];
  bool denoise;   /* what is shown of it is denoised */
  uint32_t rows;  /* from the top, those that are denoised */
  vlImage *clean; /* R G B A; the rows that are not denoised are those of the coarser image */
} PartOfFilm;
/* Where that takes long, has its parts sent while it grows. part: valid until the render ends.
 */
void engine_render_in_parts(PartOfFilm *part, vlRenderDef *render, double pixel_seconds);
void engine_free_part(PartOfFilm *part);

/* ---- coarse images and ground truth (engine_coarse.c) ------------------------------------ */

typedef struct Coarse {
  uint32_t next;      /* scale of the next image that is not the film's; 0: none is next */
  uint32_t light_spp; /* samples per pixel of the next image of the illuminance */
  vlImage *last;      /* the last one of this camera, R G B A; null: none */
  uint32_t last_scale;
  bool last_denoised;
  double pixel_seconds;   /* time of one pixel; 0: not known */
  double channel_seconds; /* the same of ground truth */
} Coarse;
/* What the first image after a change is: sets `coarse`. */
void engine_coarse_begin(Engine *engine);
/* Renders and sends the next coarse image or image of ground truth. False: interrupted. */
bool engine_coarse_next(Engine *engine);
/* Sends the standard error of the film, if it has one. False: interrupted. */
bool engine_render_error(Engine *engine);
/* Notes the time of one sample in a mean of the last ones. */
void engine_note_speed(double *sample_seconds, uint64_t samples, double seconds);
/* Takes a coarse image, which becomes null. */
void engine_keep_coarser(Engine *engine, vlImage **image, uint32_t scale, bool denoised);
void engine_forget_coarser(Engine *engine);
/* Fills the rows of an image R G B A from `rows` on with the coarser one, which must be there.
 */
void engine_fill_rows(const Engine *engine, vlImage *image, uint32_t scale, uint32_t rows);

/* ---- the denoised preview (engine_denoise.c) --------------------------------------------- */

/* The denoised preview (engine_denoise.c). */
typedef struct DenoisedPreview {
  uint32_t spp;         /* samples of the film that it shows; 0: none of them */
  vlImage *features;    /* of the film's pixels; null: none */
  bool failed;          /* it cannot be made */
  uint32_t feature_spp; /* samples of the film when they were made */
  double pixel_seconds; /* processor time for one pixel; 0: not known */
  double seconds;       /* processor time for this image */
  double before;        /* processor time of the program when this image began */
} DenoisedPreview;
/* Whether an image of so many pixels may be denoised now. */
bool engine_can_denoise(const Engine *engine, double pixels);
/* Whether a film with so many samples per pixel is to be denoised now. */
bool engine_denoise_due(const Engine *engine, uint32_t spp);
/* Denoises the rows of the part up to `rows`, and sends them with what is above and below.
 * False: interrupted, or it failed: the samples are to be sent. */
bool engine_denoise(PartOfFilm *part, uint32_t rows);
/* The image begins anew. */
void engine_forget_denoised(Engine *engine);

/* ---- the last clean image (engine_warp.c) ------------------------------------------------ */

/* The last clean image, which moves with the camera (engine_warp.c). */
typedef struct WarpSource {
  vlImage *image;      /* R G B A; null: none */
  vlImage *distances;  /* of what its pixels' centres see; null: not rendered yet */
  vlCamera camera;     /* of both images */
  uint32_t scale;      /* a pixel of theirs covers scale x scale pixels of the whole image */
  uint32_t generation; /* Wanted.generation of the image */
  uint32_t shown;      /* and of the image that it was moved to last */
} WarpSource;
/* Keeps an image that is sent, if it is a clean one of the whole film. */
void engine_warp_keep(Engine *engine, const vlImage *image, const FrameKind *kind);
/* Renders what is needed to move the image that is kept. */
void engine_warp_prepare(Engine *engine);
/* Whether a coarse image of this scale is worse than the moved one may be. */
bool engine_warp_suits(const Engine *engine, uint32_t scale);
/* Sends the moved image, filled from the coarser one. False: the cameras see different things,
 * or there is no memory. */
bool engine_warp_publish(Engine *engine);
/* Whether the moved image is shown and better than the film's few samples. */
bool engine_warp_stays(const Engine *engine);
/* The scene is another one. */
void engine_warp_forget(Engine *engine);

/* ---- the mode "camera" (engine_sensor.h) ------------------------------------------------- */

/* The last exposure of the mode "camera" (engine_sensor.c). */
typedef struct Shot {
  char preset[48];  /* of the sensor */
  vlSensor *sensor; /* null: none */
  vlImage *light;   /* spectrum of the film, perhaps with its colours and their errors; null */
  const vlFilm *film;              /* it is that of this film, */
  uint32_t generation, scale, spp; /* at this time */
  uint32_t buckets;                /* channels of the spectrum */
  double luminance;                /* mean of the film, cd/m^2; NaN: it has none */
  vlImage *errors; /* colours and their errors, of error_spp samples of that film; null */
  uint32_t error_spp;
  double *means; /* photoelectrons of its pixels, if is_collected */
  bool is_collected;
  bool keeps_light;       /* the next exposure may do with the light that is there */
  double electrons;       /* mean of the means */
  vlExposureDef exposure; /* of the means and of the numbers */
  vlSensorOutput out;     /* counts; no arrays */
  vlRaw *raw;             /* the numbers; null: none */
} Shot;

/* ---- what pages are told (engine_status.c) ----------------------------------------------- */

typedef struct Status {
  double sent;        /* time of the last status */
  double estimated;   /* time of the last estimate of the error */
  double noise;       /* the estimate: standard error of the display values; NaN: not known */
  uint32_t noise_spp; /* samples of the film then */
} Status;

/* Texts for pages that come; null: none. */
typedef struct LastTexts {
  char *status;   /* the last state of the render */
  char *exposure; /* the last exposure of the mode "camera" */
  char *left_out; /* that samples of the image were not finite */
} LastTexts;
/* Posts a message of this type with these members (json_put) to a page, or to all (0). */
void engine_post(Engine *engine, uint32_t client, const char *type, const char *members, ...)
    PRINTF(4, 5);
/* Posts the state to a page, or to all (0); the caller holds the lock. */
void engine_post_state(Engine *engine, uint32_t client);
/* The server's calls. */
void engine_greet(void *user, uint32_t client);
void engine_message(void *user, bool steers, const ViewMessage *message);
void engine_clients(void *user, uint32_t count);

/* ---- the engine -------------------------------------------------------------------------- */

typedef enum ThreadKind {
  THREAD_RENDER,
  THREAD_ANSWER,
  THREAD_TRACE,
  THREAD_VERIFY,
  THREAD_WATCH,
  THREAD_COUNT
} ThreadKind;

typedef struct Thread {
  pthread_t thread;
  bool runs;
} Thread;

struct Engine {
  EngineDef def;
  Server *server;
  Thread threads[THREAD_COUNT];
  pthread_mutex_t lock;
  pthread_cond_t wake;
  pthread_rwlock_t model_lock; /* held by those who use the model outside the render thread */
  vlCancel *end;               /* stops everything */
  /* under the lock */
  bool quit;
  uint32_t clients;
  Interrupt interrupt;
  Wanted wanted;
  ViewCamera scene_camera; /* as the scene and the command line give it */
  History history;
  LastTexts last;
  Reload reload;
  SceneChoice choice;
  AskedTime time;
  TaskList tasks, questions; /* for the render thread, for the answerer */
  Traces traces;
  ViewTracer shown; /* of `film`; without one, of the next film */
  Verify verify;
  /* the render thread's own; the model is replaced under the lock */
  Model model;
  Wanted now; /* what is being rendered */
  vlFilm *film;
  Samples samples;
  Race race;
  Coarse coarse;
  FrameTimes frames;
  DenoisedPreview preview;
  WarpSource warp;
  ViewSensors sensors; /* constant */
  Shot shot;
  Status status;
};

#endif
