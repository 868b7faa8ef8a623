/* camera/parts.h: the two halves that vl_camera_make joins: intrinsics (which pixel looks where, in camera space) and
 * pose (where camera space lies in the world). Internal to the room. */
#ifndef CAMERA_PARTS_H
#define CAMERA_PARTS_H

#include "velo/camera.h"

/* A value of a def that is not given (VL_UNSET). */
static inline bool vl_is_unset(double value) {
  return value != value;
}

/* Fills shape and the distortion's coefficients and tilt; checks their ranges and counts. */
vlResult vl_camera_model(const vlCameraDef *def, vlCamera *camera, vlError *error);
/* Fills limit, distortion.radius and steps, and outside. Last: it needs all the rest. */
vlResult vl_camera_domain(const vlCameraDef *def, vlCamera *camera, const char **warning, vlError *error);
/* Fills distortion.steps and outside, which hang on the image's size too. */
void vl_camera_measure(vlCamera *camera);
/* How far from the plane's centre a direction at an angle from the axis lands, before distortion; across or down.
 * false: the projection does not see it. */
bool vl_camera_plane_radius(const vlCamera *camera, double angle, bool vertical, double *radius);
/* Fills fx, fy, skew, cx, cy from all the ways a def may say them; disagreeing ways are an error that names both. */
vlResult vl_camera_intrinsics(const vlCameraDef *def, vlCamera *camera, vlError *error);
/* Fills world_from_camera and camera_from_world. */
vlResult vl_camera_pose(const vlCameraDef *def, vlCamera *camera, const char **warning, vlError *error);
/* Fills what belongs to time: curve, readout, the second pose. After vl_camera_pose. */
vlResult vl_camera_time_part(const vlCameraDef *def, vlCamera *camera, const char **warning, vlError *error);
/* The pose from a matrix, which is checked. */
vlResult vl_camera_pose_matrix(const double world_from_camera[16], vlCamera *camera, vlError *error);
/* Fills lens, lens_radius, focus_distance and exposure_time where def.lens says them; after intrinsics and pose. */
vlResult vl_camera_lens(const vlCameraDef *def, vlCamera *camera, vlError *error);
/* Planes of constant z cut and focus, not spheres around the eye. */
bool vl_camera_sees_ahead(vlProjection kind);
/* The focus distance that brings a point of the world into focus; false: it lies behind. */
bool vl_camera_focus_at(const vlCamera *camera, const double point[3], double *distance);

#endif
