/* camera/time.h: time, the first of the four factors of a camera: when a sample's light arrives
 * (shutter, shutter curve, rolling readout), and the camera's pose then. Part of the compiled
 * camera.
 *
 *     random number -> curve -> fraction of the exposure -> seconds, later for rows that are
 *       read later -> pose */
#ifndef CAMERA_TIME_H
#define CAMERA_TIME_H

#include "math/motion.h"
#include "velo/camera.h"

typedef struct vlCameraTime {
  bool timed; /* time is not simply open + u (close - open) */
  bool moves; /* rays are made in camera space; `motion` transforms them to the world */
  /* seconds by which a pixel's exposure begins after its neighbour's */
  double per_column, per_row;
  double first_column, first_row; /* the pixel that is read first */
  double columns, rows;           /* the image's size */
  double pose_open, pose_rate; /* fraction of the motion at time t: (t - pose_open) * pose_rate,
                                  clamped to [0, 1] */
  vlMotion motion;             /* motion of world_from_camera */
  uint32_t points; /* number of points of the shutter's curve; 0: fully open throughout */
  /* The curve's points: at is the fraction of the exposure time, value the opening, share the
   * fraction of the light that arrives before at. */
  double at[VL_SHUTTER_POINTS], value[VL_SHUTTER_POINTS], share[VL_SHUTTER_POINTS];
  double area; /* area under the curve */
} vlCameraTime;

/* Returns the fraction of the exposure time after which the fraction u of the light has
 * arrived. This is the inverse of the curve's integral, which is a parabola between two
 * points. */
static inline double vl_shutter_share(const vlCameraTime *t, double u) {
  if (t->points == 0)
    return u;
  uint32_t k = 0;
  for (uint32_t i = 1; i + 1 < t->points; i++)
    k = t->share[i] <= u ? i : k;
  double width = t->at[k + 1] - t->at[k], a = t->value[k], slope = t->value[k + 1] - a;
  double light = width > 0.0 ? (u - t->share[k]) * t->area / width : 0.0;
  double square = a * a + 2.0 * slope * light,
         root = __builtin_sqrt(square > 0.0 ? square : 0.0);
  double x = light > 0.0 ? 2.0 * light / (a + root) : 0.0;
  return t->at[k] + (x < 1.0 ? x : 1.0) * width;
}

/* Fills *t from a camera, except for the shutter's open and close times. */
void vl_camera_compile_time(const vlCamera *camera, vlCameraTime *t);

#endif
