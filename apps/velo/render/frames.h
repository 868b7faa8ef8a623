/* render/frames.h: several images of one world: frames of a trajectory, cameras of a rig, two
 * eyes. The world is loaded once; films and the workers' memory are reused; files are written
 * while the next frame renders. */
#ifndef APP_RENDER_FRAMES_H
#define APP_RENDER_FRAMES_H

#include "render/channels.h"
#include "render/denoised.h"
#include "render/film_keeper.h"
#include "render/job.h"
#include "render/outputs.h"
#include "render/pattern.h"
#include "velo/trajectory.h"

/* A camera relative to a frame, before the frame's pose is applied. */
typedef struct FrameCamera {
  char name[256];
  vlSceneDefs defs; /* job.defs points here for cameras other than the scene's */
  Job job;
  vlCamera eyes[2]; /* poses relative to the frame */
  vlCamera middle;  /* between the eyes; without stereo the camera itself */
  double mount[16]; /* frame_from_camera in a rig */
  vlFilm *film; /* shared by cameras of the same size and crop; owned by the first of them */
  bool owns_film;
} FrameCamera;

typedef struct Frames {
  vlTrajectory *trajectory, *rig; /* null: none */
  FrameCamera *cameras;
  uint32_t camera_count;
  FrameRange range;   /* of pose numbers */
  bool skip_existing; /* skip frames whose files all exist */
  int views;          /* 1 or 2 */
  vlEye eyes[2];
  const char *view_names[2];
  const FilmPlan *films; /* film settings for two eyes; null: no film files */
  Steady steady;         /* frames that later ones are denoised with */
} Frames;

/* One image to be rendered. */
typedef struct Frame {
  uint32_t number;
  vlTrajectoryFrame pose; /* name, time, line */
  FrameCamera *camera;
} Frame;

/* Returns whether several images are rendered, because of --trajectory or stereo. job is null
 * before the scene is loaded; then stereo is unknown. */
bool frames_wanted(const Arguments *arguments, const Job *job);
/* Checks that the options are compatible, and the name patterns. Returns -1 or the exit
 * code. */
int frames_check(const Arguments *arguments, Outputs *outputs);
/* Reads trajectory and rig and makes all cameras. Returns -1, or the exit code after reporting
 * the error. */
int frames_load(Frames *frames, const Job *job, const Arguments *arguments);
/* Checks names and directories of all files before rendering; two frames must not have the same
 * name. Returns -1 or the exit code. */
int frames_check_names(const Frames *frames, const Outputs *outputs);
/* Return the number of images, and image i. Both eyes count as one image. */
uint32_t frames_count(const Frames *frames);
Frame frames_at(const Frames *frames, uint32_t index);
/* The first image of all poses and cameras, whatever part of them is rendered. */
Frame frames_first(const Frames *frames);
/* The frames before this one, at most STEADY_BEFORE, which it is denoised with: the nearest
 * poses of the trajectory whose images have the same film, whatever part of them is rendered.
 * Returns their number. */
uint32_t frames_before(const Frames *frames, const Frame *frame, Frame before[STEADY_BEFORE]);
/* The path of an image. view: 0 or 1, for %v. False: too long. */
bool frames_path(const Frames *frames, const Frame *frame, const char *pattern, int view,
                 char *path, size_t size);
/* Whether one file of the pattern holds both eyes. */
bool frames_join(const Frames *frames, const char *pattern);
/* Number of files of the pattern that a frame has: one, or one per eye. */
int frames_files(const Frames *frames, const char *pattern);
/* Returns whether all these files of the frame exist. Files are written atomically, so their
 * content is not checked. */
bool frames_exist(const Frames *frames, const Frame *frame, const Outputs *outputs);
/* The camera of one view in the frame's pose. */
vlResult frames_camera(const Frames *frames, const Frame *frame, int view, vlCamera *camera,
                       vlError *error);
/* The camera between the eyes in the frame's pose. */
vlResult frames_middle(const Frames *frames, const Frame *frame, vlCamera *camera,
                       vlError *error);
void frames_free(Frames *frames);

/* Renders and writes all frames, and their denoised copies if denoised->outputs are not empty.
 * Returns the exit code. */
int frames_render(Frames *frames, vlContext *context, const vlWorld *world,
                  const Outputs *outputs, const Channels *channels, Denoised *denoised);

#endif
