/* render/needs.h: options that have an effect only with something else: a glTF file, a film, a
 * certain tracer. */
#ifndef APP_RENDER_NEEDS_H
#define APP_RENDER_NEEDS_H

#include "render/run.h"

/* The option of all commands that check. */
#define STRICT_OPTIONS_OPTION                                                                      \
  {                                                                                                \
    RENDER_STRICT_OPTIONS,                                                                         \
        .help =                                                                                    \
            "an option that has no effect is an error, exit code 2, before anything is rendered; " \
            "without this, a note"                                                                 \
  }

/* A command with some of the options of `velo render`, and what it has made of them. */
typedef struct Needs {
  const Option *options;      /* of the command */
  const OptionValue *values;  /* of the whole command */
  const Arguments *arguments; /* of this frame */
  const vlScene *scene;
  const SceneOpening *opening;
  const Job *job;
  const Render *render; /* its outputs; null: another command, which shows or needs what options
                           set for outputs */
  bool edited;          /* the camera will change */
} Needs;

/* Both report each given option that has no effect: as a note, with --strict-options as an
 * error. The first is called when scene, camera and outputs are known, the second when world
 * and tracer are. They return -1, or the exit code after an error. */
int needs_check_scene(const Needs *needs);
int needs_check_tracer(const Needs *needs, const vlWorld *world);

/* The same of `velo render`. Frames of an animation are reported once. */
int needs_check_render_scene(Render *render, const Arguments *arguments);
int needs_check_render_tracer(Render *render, const Arguments *arguments);

#endif
