/* program/command.h: the command line.
 *
 *   velo-reference SCENE -o IMAGE.exr [--spp N] [--seed N] [--resolution WxH] [--max-depth N] [--tracer NAME]
 *      [--color spectral|rgb] [--filter box]
 *
 * The image has the channels R G B A and error.R error.G error.B, the standard errors of the pixels' means. */
#pragma once
#include <stdbool.h>
#include <velo/velo.h>

typedef struct options {
  const char *scene, *output;
  long samples, seed, width, height;
  long max_depth;     /* -1: the scene's */
  const char *tracer; /* null: the scene's */
  bool rgb, box;
} options;

/* False, after a line about the usage, for a wrong command line. */
bool read_options(int count, char **arguments, options *o);
/* Puts the options in the place of what the scene's file says, and the scene's depth into the options. */
void apply_options(options *o, vlSceneDefs *defs, vlCamera *camera);
/* render.c: renders the scene of the options into their file. */
bool render_file(vlContext *context, options *o, vlScene *scene, vlError *error);
