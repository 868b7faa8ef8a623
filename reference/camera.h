/* camera.h: the lecture's camera: from a point of the image to a ray. */
#ifndef REFERENCE_CAMERA_H
#define REFERENCE_CAMERA_H

#include "world.h"

/* Whether this renderer knows the camera; else an error. */
bool check_camera(const vlCamera *c, vlSource source, vlError *error);
/* The ray through the point (x, y) of the image, in pixels from its top left corner. False: the point is outside of the
 * camera's image circle. */
bool camera_ray(const vlCamera *c, double x, double y, sampler *s, ray *r);

#endif
