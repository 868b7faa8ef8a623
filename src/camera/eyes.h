/* camera/eyes.h: omnidirectional stereo, projection and inverse. Each direction has its own eye
 * position on a circle about the camera's vertical axis (y). It is the eye position of a head
 * that turns to look in that direction (Peleg, Ben-Ezra and Pritch, "Omnistereo: panoramic
 * stereo imaging", 2001; Google, "Rendering Omni-directional Stereo Content", 2015). With the
 * longitude a from z (ahead) to x (right), the eye is at r (cos a, 0, -sin a); the left eye has
 * r < 0.
 *
 * The inverse has a closed form. Seen from above, the ray is tangent to the circle. Its length
 * to a point at distance p from the axis is therefore t = sqrt(p^2 - r^2), and the ray's
 * longitude is the point's longitude minus atan(r / t). */
#ifndef CAMERA_EYES_H
#define CAMERA_EYES_H

#include "camera/plane.h"

typedef struct vlEyeOffset {
  double x, z; /* y = 0 */
} vlEyeOffset;

/* Returns the eye position for a direction of any length. For straight up or down it is the
 * circle's centre. */
static inline vlEyeOffset vl_eye_offset(double r, double dx, double dz) {
  double k = r / vl_not_tiny(vl_length_2d(dx, dz));
  return (vlEyeOffset){dz * k, -dx * k};
}

/* Returns the direction to a point from the eye position that sees it. It is valid only for
 * points outside the vertical cylinder through the circle. */
static inline vlDirection vl_eye_direction(double r, double x, double y, double z) {
  double p2 = x * x + z * z, t2 = p2 - r * r, t = vl_root(t2), k = t / vl_not_tiny(p2);
  return (vlDirection){(x * t - z * r) * k, y, (z * t + x * r) * k, t2 > 0.0 ? 1.0 : 0.0};
}

#endif
