/* camera/aperture.h: aperture shapes: maps a pair of random numbers to a point of the aperture, with uniform density
 * (or in proportion to its image). Points lie in the square [-1, 1]^2, x right, y down, in units of the lens radius. */
#ifndef CAMERA_APERTURE_H
#define CAMERA_APERTURE_H

#include "velo/lens.h"

enum { VL_MOST_BLADES = 32 };

/* Corners of a rotated blade polygon; the first is repeated at the end. */
typedef struct vlBlades {
  uint32_t count;
  float x[VL_MOST_BLADES + 1], y[VL_MOST_BLADES + 1];
} vlBlades;
/* A regular polygon inscribed in the unit circle: a corner points up, then it is rotated clockwise by `rotation`
 * (radians). */
void vl_blades_make(uint32_t count, double rotation, vlBlades *blades);
void vl_blades_points(const vlBlades *blades, uint32_t n, const float *u, const float *v, float *x, float *y);

/* Exact inversion: the row by its sums, then the column within the row, then a uniform position within the cell. */
void vl_aperture_points(const vlAperture *aperture, uint32_t n, const float *u, const float *v, float *x, float *y);
/* The image at a point, bilinear, 0 outside. Scaled so that its mean over the square is pi / 4, as for a round
 * aperture. */
double vl_aperture_value(const vlAperture *aperture, double x, double y);
/* The square of the largest distance from the centre at which the aperture's value is above 0; at most 2. */
double vl_aperture_reach2(const vlAperture *aperture);

/* A digest of its size and values, to tell whether it changed. */
void vl_aperture_digest(const vlAperture *aperture, uint8_t digest[16]);

#endif
