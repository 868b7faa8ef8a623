/* render/ffmpeg.h: makes a video of .png files by the program ffmpeg, a child process that is
 * started without a shell and reads the files' bytes from a pipe. */
#ifndef APP_RENDER_FFMPEG_H
#define APP_RENDER_FFMPEG_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

typedef enum VideoKind { VIDEO_MP4, VIDEO_GIF } VideoKind;

/* What becomes a video. */
typedef struct VideoSource {
  const char *program; /* path of ffmpeg */
  double fps;          /* frames per second */
  uint32_t count;
  /* The path of frame i, from 0, of a .png file. False: it is too long. */
  bool (*frame)(void *user, uint32_t i, char *path, size_t size);
  void *user;
  const char *name; /* of the video, for the status line */
} VideoSource;

/* Writes the video to the file `to`, which exists. Returns true, or false and what is wrong,
 * one line; that line is empty after a signal (signals.h). *width, *height: of the frames. */
bool ffmpeg_make(const VideoSource *source, VideoKind kind, const char *to, uint32_t *width,
                 uint32_t *height, char *wrong, size_t size);

#endif
