/* camera/own_rays.h: a camera of one's own (velo/own.h) for other rooms: film points to rays of
 * the world, points in camera space to film points. */
#ifndef CAMERA_OWN_RAYS_H
#define CAMERA_OWN_RAYS_H

#include "camera/rays.h"

typedef struct vlOwnRay {
  double o[3], d[3]; /* world space; d is of unit length */
  double stretch;    /* length in the world of one unit along the ray in camera space */
  double weight;     /* vlOwnRays.weight */
  bool good; /* false: the film point has no ray, or the ray is not finite; the rest is not set
              */
} vlOwnRay;

/* The rays of n film points (pixels of the compiled camera) through the centre of the lens, at
 * the start of the exposure. n is at most VL_OWN_BATCH. */
void vl_own_world_rays(const vlCameraCompiled *c, uint32_t n, const double *x, const double *y,
                       vlOwnRay *rays);
/* The film points (pixels of the compiled camera) of n points in camera space; NaN where there
 * is none. n is at most VL_OWN_BATCH. */
void vl_own_pixels(const vlCameraCompiled *c, uint32_t n, const double *x, const double *y,
                   const double *z, double *film_x, double *film_y);

#endif
