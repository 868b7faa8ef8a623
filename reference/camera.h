/* camera.h: the lecture's camera: from a point of the image to a ray. */
#pragma once
#include "world.h"

/* The ray through the point (x, y) of the image, in pixels from its top left corner. False: the point is outside of the
 * camera's image circle. */
bool camera_ray(const vlCamera *c, double x, double y, sampler *s, ray *r);
