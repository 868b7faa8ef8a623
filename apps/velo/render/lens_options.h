/* render/lens_options.h: the lens on the command line of `velo render`: focus, opening, exposure by the camera's
 * numbers. */
#ifndef APP_RENDER_LENS_OPTIONS_H
#define APP_RENDER_LENS_OPTIONS_H

#include "render/job.h"

/* Indices into Arguments.values, behind those of job.h. */
enum {
  RENDER_FOCUS_PIXEL = 56,
  RENDER_FOCUS_DISTANCE,
  RENDER_LENS_RADIUS,
  RENDER_F_NUMBER,
  RENDER_ISO,
  RENDER_SECONDS
};

/* Overrides the camera of defs; a lens of many elements is focused anew and belongs to the scene. -1: go on; else the
 * exit code. */
int lens_override(vlScene *scene, vlSceneDefs *defs, const Arguments *arguments);
/* Pixels are those of the image that is rendered: told to the camera when it has its size. -1: go on. */
int lens_focus_on(vlCamera *camera, const Arguments *arguments);
/* Focuses a camera on its pixel, once there is a world to look at. -1: go on. */
int lens_autofocus(Job *job, vlScene *scene, const vlWorld *world);

#endif
