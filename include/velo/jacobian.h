/** @file
 * velo/jacobian.h: derivatives of projection and unprojection by everything that a calibration
 * or the refinement of a pose changes. */
#ifndef VELO_JACOBIAN_H
#define VELO_JACOBIAN_H

#include "velo/camera.h"

#ifdef __cplusplus
extern "C" {
#endif

/** The columns of a Jacobian. Columns of what a camera does not have are the derivatives at 0
 * (distortion), or 0 (shape; for a lens of many elements, whose film has its own size, also fx,
 * fy, skew and distortion). */
enum {
  VL_JACOBIAN_POINT = 0, /**< 3 columns. Project: the point in world space, scene units.
                            Unproject: the film point's x and y, pixels; the third is 0 */
  VL_JACOBIAN_POSE =
      3, /**< 6: (t, r), translation in scene units and rotation vector in radians,
            of camera_from_world' = exp((t, r)^) camera_from_world, at 0 */
  VL_JACOBIAN_INTRINSICS = 9,  /**< 5: fx, fy, skew, cx, cy, pixels */
  VL_JACOBIAN_SHAPE = 14,      /**< 2: vlCamera.shape */
  VL_JACOBIAN_DISTORTION = 16, /**< 17: members of vlDistortionMap in its order: numerator (6),
                                  denominator (3), tangential (2), prism (4); then the sensor's
                                  tilt tau_x, tau_y, radians */
  VL_JACOBIAN_COLUMNS = 33     /**< their number */
};

/** The derivatives of vl_camera_project's film point at `count` points (x, y, z): for each
 * point 2 rows (x, y, pixels) of VL_JACOBIAN_COLUMNS numbers in `jacobians`. valid[i] (may be
 * null) is 1; where a point has no projection, or no finite derivative, it is 0 and the numbers
 * are 0. The derivatives of the closed form, by the chain rule. A moving camera has the pose of
 * the time that vl_camera_project finds, and all its poses change by the same (t, r); with a
 * rolling shutter the film point's row changes its time, too (implicit function theorem),
 * except outside the image, where the time is that of the edge. Any number of threads may call
 * it. ARGUMENT: a null pointer. UNSUPPORTED: a camera of one's own, an eye of omnidirectional
 * stereo. */
VL_API vlResult vl_camera_project_jacobian(const vlCamera *camera, size_t count,
                                           const double *points, double *jacobians,
                                           uint8_t *valid, vlError *error);

/** The derivatives of vl_camera_unproject's ray at `count` film points (x, y): for each point 6
 * rows (origin, unit direction; world space) of VL_JACOBIAN_COLUMNS numbers. Solved from the
 * derivatives of the projection (implicit function theorem). valid: as above; it is 0 also
 * beyond the edges of images that wrap around, where the ray's own film point is another.
 * Errors: as above. */
VL_API vlResult vl_camera_unproject_jacobian(const vlCamera *camera, size_t count,
                                             const double *pixels, double *jacobians,
                                             uint8_t *valid, vlError *error);

#ifdef __cplusplus
}
#endif
#endif
