/* camera/aperture.h: the shape of a lens's opening: from a pair of random numbers to a point of it, evenly (or as dense
 * as its image is bright). Points lie in the square -1 to 1, x right, y down, before the lens's radius. */
#ifndef CAMERA_APERTURE_H
#define CAMERA_APERTURE_H

#include "velo/lens.h"

enum { VL_MOST_BLADES = 32 };

/* A blade polygon's corners, the first again at the end, turned already. */
typedef struct vlBlades {
  uint32_t count;
  float x[VL_MOST_BLADES + 1], y[VL_MOST_BLADES + 1];
} vlBlades;
/* Inscribed in the unit circle; a corner is up, then turned by `rotation`, clockwise. */
void vl_blades_make(uint32_t count, double rotation, vlBlades *blades);
void vl_blades_points(const vlBlades *blades, uint32_t n, const float *u, const float *v, float *x, float *y);

/* By inversion, exactly: rows by their sums, then columns inside the row, then evenly inside the cell. */
void vl_aperture_points(const vlAperture *aperture, uint32_t n, const float *u, const float *v, float *x, float *y);
/* The image at a point, bilinear, 0 outside, so scaled that its mean over the square is pi / 4: a round opening's. */
double vl_aperture_value(const vlAperture *aperture, double x, double y);
/* The square of the largest distance from the middle at which it is above 0; 2 at most. */
double vl_aperture_reach2(const vlAperture *aperture);

#endif
