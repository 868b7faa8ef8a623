/* camera/points.h: maps a pixel to a direction, and a point to a pixel, without lens and pose.
 * The public functions call these for one point at a time. The batches (points.hot.c) run the
 * same operations in stages, so both give the same bits. */
#ifndef CAMERA_POINTS_H
#define CAMERA_POINTS_H

#include "distortion/distortion.h"
#include "projection/kinds.h"

/* Maps pixels from the principal point to the plane. */
static inline vlPlanePoint vl_pixel_to_plane(const vlCameraCompiled *c, double x, double y) {
  return (vlPlanePoint){(x - c->skew_ratio * y) * c->inv_fx, y * c->inv_fy, 1.0};
}
static inline vlPlanePoint vl_plane_to_pixel(const vlCameraCompiled *c, vlPlanePoint p) {
  double x = c->fx * p.x + c->skew * p.y + c->cx, y = c->fy * p.y + c->cy;
  int valid = p.valid > 0.0 && x - x == 0.0 && y - y == 0.0; /* x - x is NaN if x is infinite */
  return (vlPlanePoint){valid ? x : 0.0, valid ? y : 0.0, valid ? 1.0 : 0.0};
}

/* Normalises a projection's direction, except for perspective cameras, which keep z = 1. An
 * invalid direction becomes straight ahead, so that no later stage sees a zero or a NaN. */
static inline vlDirection vl_direction_finish(const int inclined, vlDirection d, double valid) {
  int good = d.valid > 0.0 && valid > 0.0;
  double k = inclined ? 1.0 : 1.0 / vl_not_tiny(vl_length_3d(d.x, d.y, d.z));
  return (vlDirection){good ? d.x * k : 0.0, good ? d.y * k : 0.0, good ? d.z * k : 1.0,
                       good ? 1.0 : 0.0};
}

/* x, y: pixels from the principal point. */
vlDirection vl_camera_direction(const vlCameraCompiled *c, double x, double y);
/* Maps a point in camera space to the film. */
vlPlanePoint vl_camera_film_point(const vlCameraCompiled *c, double x, double y, double z);

#endif
