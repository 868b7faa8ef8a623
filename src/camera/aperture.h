/* camera/aperture.h: aperture shapes: maps a pair of random numbers to a point of the aperture.
 * The density is uniform for a blade polygon, and proportional to the image for an aperture
 * image. Points lie in the square [-1, 1]^2, with x right and y down, in units of the lens
 * radius. */
#ifndef CAMERA_APERTURE_H
#define CAMERA_APERTURE_H

#include "velo/lens.h"

enum { VL_MAX_BLADES = 32 };

/* Corners of a rotated blade polygon; the first is repeated at the end. */
typedef struct vlBlades {
  uint32_t count;
  float x[VL_MAX_BLADES + 1], y[VL_MAX_BLADES + 1];
} vlBlades;
/* Makes a regular polygon that is inscribed in the unit circle. One corner points up; then the
 * polygon is rotated clockwise by `rotation` (radians). */
void vl_blades_make(uint32_t count, double rotation, vlBlades *blades);
void vl_blades_points(const vlBlades *blades, uint32_t n, const float *u, const float *v,
                      float *x, float *y);

/* Samples the aperture image by exact inversion: v selects the row, u selects the column in
 * that row, and the position within the pixel is uniform. */
void vl_aperture_points(const vlAperture *aperture, uint32_t n, const float *u, const float *v,
                        float *x, float *y);
/* Returns the image's value at a point, interpolated bilinearly; it is 0 outside the square.
 * Values are scaled so that their mean over the square is pi / 4, as for a round aperture. */
double vl_aperture_value(const vlAperture *aperture, double x, double y);
/* The square of the largest distance from the centre at which the aperture's value is above 0;
 * at most 2. */
double vl_aperture_reach2(const vlAperture *aperture);

/* Computes a digest of the aperture image's size and values. Callers compare digests to detect
 * a change. */
void vl_aperture_digest(const vlAperture *aperture, uint8_t digest[16]);

#endif
