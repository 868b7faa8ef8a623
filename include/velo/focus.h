/** @file
 * velo/focus.h: autofocus. A camera does not know the world, so the world is asked here. */
#ifndef VELO_FOCUS_H
#define VELO_FOCUS_H

#include "velo/camera.h"
#include "velo/render.h"

#ifdef __cplusplus
extern "C" {
#endif

/** The focus distance that brings what the middle of the image's point (x, y) sees into focus: as vlCameraDef's
 * focus_distance takes it, for the camera's own tilt. Between near and far plane. A lens of many elements: the distance
 * from the film, as vl_optics_refocus takes it. ARGUMENT: a point outside the image, one that sees nothing; MEMORY.
 * Not from inside a parallel body. */
VL_API vlResult vl_autofocus(const vlWorld *world, const vlCamera *camera, double x, double y, double *distance,
                             vlError *error);

/** Focuses a camera that was made with focus_pixel on what that pixel sees; others stay as they are. */
VL_API vlResult vl_camera_autofocus(const vlWorld *world, vlCamera *camera, vlError *error);

#ifdef __cplusplus
}
#endif
#endif
