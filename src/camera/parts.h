/* camera/parts.h: the parts of vl_camera_make: intrinsics (pixel to direction in camera space),
 * pose (camera space to world), lens, time. Internal to the camera folder. */
#ifndef CAMERA_PARTS_H
#define CAMERA_PARTS_H

#include "base/unset.h"
#include "camera/rays.h"
#include "velo/camera.h"

/* Sets the distortion's coefficients and tilt. Checks their ranges and counts. */
vlResult vl_camera_distortion(const vlCameraDef *def, vlDistortionMap *map, vlError *error);
/* Sets limit, distortion.radius and steps, and outside. Called last: it needs all other
 * parts. */
vlResult vl_camera_domain(const vlCameraDef *def, vlCamera *camera, const char **warning,
                          vlError *error);
/* Sets distortion.steps and outside, which also depend on the image's size. */
void vl_camera_measure(vlCamera *camera);
/* The batches for the best instruction set of this processor. */
const vlCameraKernels *vl_camera_best_kernels(void);
/* Whether the rays of the image's centre and corners have finite origins in single precision
 * and directions that can be normalised. True for a camera of one's own, whose rays are checked
 * one by one while it renders. */
bool vl_camera_rays_are_finite(const vlCamera *camera);
/* Computes the radius in the plane, before distortion, of a direction at `angle` (radians) from
 * the axis, measured horizontally or vertically. Returns false if the direction is outside the
 * projection's domain. */
bool vl_camera_plane_radius(const vlCamera *camera, double angle, bool vertical,
                            double *radius);
/* Sets fx, fy, skew, cx, cy from all alternative parameters of a def. If two disagree, the
 * error names both. */
vlResult vl_camera_intrinsics(const vlCameraDef *def, vlCamera *camera, vlError *error);
/* Sets world_from_camera and camera_from_world. */
vlResult vl_camera_pose(const vlCameraDef *def, vlCamera *camera, const char **warning,
                        vlError *error);
/* Sets the time parameters: shutter curve, readout, second pose. Must be called after
 * vl_camera_pose. */
vlResult vl_camera_time_part(const vlCameraDef *def, vlCamera *camera, const char **warning,
                             vlError *error);
/* Checks a matrix and sets the pose from it. */
vlResult vl_camera_pose_matrix(const double world_from_camera[16], vlCamera *camera,
                               vlError *error);
/* Sets lens, lens_radius, focus_distance and exposure_time if def.lens gives them. Must be
 * called after the intrinsics and the pose are set. */
vlResult vl_camera_lens(const vlCameraDef *def, vlCamera *camera, vlError *error);
/* Returns whether near, far and focus surfaces are planes of constant z. Otherwise they are
 * spheres around the eye. */
bool vl_camera_sees_ahead(vlProjection kind);
/* Checks the name of code of one's own (velo/own.h) and that it has a function; what: "camera",
 * "sampler", "tracer". In own.c. */
vlResult vl_own_check(const char *what, const char *name, bool has_function, vlError *error);
/* Computes the focus distance at which a world-space point is in focus. Returns false if the
 * point lies behind the camera. */
bool vl_camera_focus_at(const vlCamera *camera, const double point[3], double *distance);

#endif
