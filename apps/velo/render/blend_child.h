/* render/blend_child.h: Blender as a child process that has opened a file and renders its
 * frames on demand: how it is found, started and spoken with. */
#ifndef APP_RENDER_BLEND_CHILD_H
#define APP_RENDER_BLEND_CHILD_H

#include "cli/options.h"
#include "render/child.h"
#include "render/outputs.h"
#include "render/progress.h"

typedef struct Blender {
  Child child;
  bool runs;  /* the child is there */
  int events; /* the pipe of its lines, see headless.py; -1: closed */
  char held[4096];
  size_t held_count; /* of bytes that were read and not looked at */
  const char *scene; /* path of the file */
  char program[4096], version[64];
  long first, last;        /* frames of the scene */
  long width, height, spp; /* of the last image */
  int failed;              /* exit code of the error that it has told and that was reported;
                              0: none */
  FrameProgress *shown;    /* of the frame that is rendered; null: none */
  uint32_t number;         /* of that frame */
} Blender;

/* Starts Blender, which opens the file and takes the options of the command. Returns -1, or the
 * exit code after reporting the error; blender_close is needed after both. */
int blender_open(Blender *blender, const char *scene, const Arguments *arguments);
/* Renders a frame (null: the file's own) to the files `paths`, in the formats that the suffixes
 * of the outputs say. Returns -1, or the exit code after reporting the error. */
int blender_frame(Blender *blender, const uint32_t *frame, const char *const *paths, int count);
void blender_close(Blender *blender);

#endif
