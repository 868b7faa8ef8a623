/* render/lens_options.h: lens options of `velo render`: focus, aperture, exposure from camera
 * settings. */
#ifndef APP_RENDER_LENS_OPTIONS_H
#define APP_RENDER_LENS_OPTIONS_H

#include "render/job.h"

/* Indices into Arguments.values, behind those of job.h. */
enum {
  RENDER_FOCUS_PIXEL = RENDER_LENS,
  RENDER_FOCUS_DISTANCE,
  RENDER_LENS_RADIUS,
  RENDER_F_NUMBER,
  RENDER_ISO,
  RENDER_SECONDS,
  RENDER_OPTIONS
};
_Static_assert((int)RENDER_OPTIONS <= (int)MAX_OPTIONS,
               "Arguments.values has no room for an option");

/* Overrides the camera of defs. A lens of many elements is made anew with the new focus and
 * belongs to the scene. Returns -1 or the exit code. */
int lens_override(vlScene *scene, vlSceneDefs *defs, const Arguments *arguments);
/* Sets the pixel to focus on, once the camera has the size of the rendered image. Returns -1 or
 * the exit code. */
int lens_focus_on(vlCamera *camera, const Arguments *arguments);
/* Focuses a camera on its pixel, once the world exists. Returns -1 or the exit code. */
int lens_autofocus(Job *job, vlScene *scene, const vlWorld *world);

#endif
