/** @file
 * velo/focus.h: autofocus: the focus distance for what a camera sees in a world. */
#ifndef VELO_FOCUS_H
#define VELO_FOCUS_H

#include "velo/camera.h"
#include "velo/world.h"

#ifdef __cplusplus
extern "C" {
#endif

/** Finds the focus distance for the surface at image point (x, y), in pixels, at the middle of
 * the exposure. *distance is in scene units, as vlCameraDef.focus_distance, and accounts for
 * the tilt of the camera's plane in focus. Only surfaces between the near and far planes count.
 * For a lens of many elements: the distance from the film, as vl_optics_refocus takes it.
 * Errors: ARGUMENT (a point outside the image, or where no surface is seen), MEMORY. Must not
 * be called from inside a parallel loop. */
VL_API vlResult vl_autofocus(const vlWorld *world, const vlCamera *camera, double x, double y,
                             double *distance, vlError *error);

/** Focuses a camera made with focus_pixel on what that pixel sees; other cameras stay
 * unchanged. Errors as vl_autofocus. */
VL_API vlResult vl_camera_autofocus(const vlWorld *world, vlCamera *camera, vlError *error);

#ifdef __cplusplus
}
#endif
#endif
