/* camera/moments.h: the time at which a moving camera sees something. A rolling shutter's time
 * depends on the film point, and the film point on the pose at that time; both are solved for
 * together.
 *
 * The time of a film point is the middle of the exposure of the row (or column) there, linear
 * between the rows' centres. Beyond the image's edges it is that at the edge. */
#ifndef CAMERA_MOMENTS_H
#define CAMERA_MOMENTS_H

#include "camera/rays.h"

/* Whether all film points have the same time. */
static inline bool vl_camera_has_one_time(const vlCameraCompiled *c) {
  return c->when.per_row == 0.0 && c->when.per_column == 0.0;
}

/* The time (s) of a film point, pixels. */
double vl_camera_film_time(const vlCameraCompiled *c, double x, double y);

/* Holds the camera where it is at a time: it no longer moves. */
void vl_camera_hold(vlCameraCompiled *c, double seconds);

/* The film point, pixels, at which the camera sees a point of the world at a time; false: it
 * does not. */
bool vl_camera_film_at(const vlCameraCompiled *c, double seconds, const double point[3],
                       double film[2]);

/* The film point, pixels, at which something is seen at a time; false: it is not seen. */
typedef bool vlSeenFn(void *user, double seconds, double film[2]);

/* Finds the time at which something is seen at a film point of that time, and the point. If
 * several rows of the image see it, the one that is read first; rows that are less than 1/16 of
 * the readout apart may be taken for each other. If no row of the image sees it: as the first
 * row's camera sees it beyond the image's edge there, else as the last row's does. Returns
 * false if these do not see it beyond their edges either. */
bool vl_camera_find_time(const vlCameraCompiled *c, vlSeenFn *seen, void *user, double *seconds,
                         double film[2]);

/* vl_camera_find_time for a point at rest in the world: then the camera is held at the time. */
bool vl_camera_hold_at_point(vlCameraCompiled *c, const double point[3]);

#endif
