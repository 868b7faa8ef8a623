/* render/video.h: videos (.mp4, .gif) of --animate, --turntable or --trajectory. The frames are
 * rendered to .png files first, either those that the command names or NAME.part_%04d.png;
 * then ffmpeg makes each video of them (ffmpeg.h). Frames of the latter kind are removed once
 * all videos are complete; after an error they are there, and --skip-existing goes on. */
#ifndef APP_RENDER_VIDEO_H
#define APP_RENDER_VIDEO_H

#include "cli/options.h"
#include "render/outputs.h"
#include "render/pattern.h"
#include "render/progress.h"

typedef struct Videos {
  const char *paths[MAX_OUTPUTS];
  int count;
  char frames[4096];    /* pattern of the frames' names: %d */
  bool own_frames;      /* frames are removed at the end */
  double fps;           /* frames per second */
  const char *programs; /* the folders in which ffmpeg is looked for */
  FrameProgress shown;
  FrameRange range; /* of the frames */
  uint32_t number;  /* of the one that is rendered */
  bool ranged;      /* these are known: the frames were begun */
} Videos;

/* Whether a name of -o is that of a video. */
bool videos_wanted(const Arguments *arguments);
/* Takes the videos out of the command line: *frames is the one that renders the frames. Finds
 * ffmpeg. Returns -1, or the exit code after reporting the error. */
int videos_plan(Videos *videos, const Arguments *arguments, Arguments *frames);
/* The frames of this render. */
void videos_range(Videos *videos, const FrameRange *range);
/* Makes the videos. status: exit code of the render of the frames. Returns the exit code. */
int videos_finish(Videos *videos, const Arguments *arguments, int status);

#endif
