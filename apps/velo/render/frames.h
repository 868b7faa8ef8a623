/* render/frames.h: several images of one world: the frames of a trajectory, the cameras of a rig, two eyes. Loaded
 * once; the films of each size and the workers' memory stay; files are written beside the next frame's rendering. */
#ifndef APP_RENDER_FRAMES_H
#define APP_RENDER_FRAMES_H

#include "render/channels.h"
#include "render/job.h"
#include "render/outputs.h"

/* One camera without its place: at the origin of a frame. */
typedef struct FrameCamera {
  char name[256];
  vlSceneDefs defs; /* job.defs points here where the camera is not the scene's own */
  Job job;
  vlCamera eyes[2]; /* where they stand from the frame */
  double mount[16]; /* of a rig: frame from camera */
  vlFilm *film;     /* the same for cameras of one size and crop; owned by the first of them */
  bool owns_film;
} FrameCamera;

typedef struct Frames {
  vlTrajectory *trajectory, *rig; /* null: none */
  FrameCamera *cameras;
  uint32_t camera_count;
  uint32_t first, last, step; /* poses, by their numbers */
  int views;                  /* 1 or 2 */
  vlEye eyes[2];
  const char *view_names[2];
} Frames;

/* One image to come. */
typedef struct Frame {
  uint32_t number;
  vlTrajectoryFrame pose; /* name, time, line */
  FrameCamera *camera;
} Frame;

/* Whether there is more than one ordinary image to render: --trajectory, or stereo once the scene is known (null
 * before). */
bool frames_wanted(const Arguments *arguments, const Job *job);
/* Options that go together and the names' patterns. -1 or the exit code. */
int frames_check(const Arguments *arguments, Outputs *outputs);
/* Reads trajectory and rig, makes all cameras. -1 or the exit code, all has been said. */
int frames_load(Frames *frames, vlContext *context, const Job *job, const Arguments *arguments);
/* Names and folders of all files, before the work begins: no two frames may have one name. -1 or the exit code. */
int frames_check_names(const Frames *frames, const Outputs *outputs);
/* How many images, and the i-th of them (both eyes are one). */
uint32_t frames_count(const Frames *frames);
Frame frames_at(const Frames *frames, uint32_t index);
/* Where an image goes; view: 0 or 1, for %v. false: too long */
bool frames_path(const Frames *frames, const Frame *frame, const char *pattern, int view, char *path, size_t size);
/* The camera of one view, placed. */
vlResult frames_camera(const Frames *frames, const Frame *frame, int view, vlCamera *camera, vlError *error);
void frames_free(Frames *frames);

/* Renders and writes them all; the exit code. */
int frames_render(Frames *frames, vlContext *context, const vlWorld *world, const Outputs *outputs,
                  const Channels *channels);

#endif
