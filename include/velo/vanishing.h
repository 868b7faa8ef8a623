/** @file
 * velo/vanishing.h: vanishing points and horizon of a camera, and a camera from its vanishing
 * points (Caprile and Torre, "Using Vanishing Points for Camera Calibration", 1990). Pixels are
 * those of the whole image; the first one's centre is at (0.5, 0.5), y is down. The functions
 * change nothing but their results: any thread may call them. */
#ifndef VELO_VANISHING_H
#define VELO_VANISHING_H

#include "velo/camera.h"

#ifdef __cplusplus
extern "C" {
#endif

/** Whether a vanishing point exists. */
typedef enum vlVanishing {
  VL_VANISHING_NONE,   /**< no point: an orthographic camera looks along the lines, or the point
                          is outside the projection's domain */
  VL_VANISHING_FINITE, /**< at `pixel` */
  VL_VANISHING_INFINITE /**< the lines stay parallel in the image */
} vlVanishing;

/** The point where the images of all lines of one direction meet. */
typedef struct vlVanishingPoint {
  vlVanishing kind;    /**< which fields below are set */
  bool behind;         /**< the direction d points behind the camera; the point is that of -d */
  double pixel[2];     /**< FINITE; may lie outside the image */
  double direction[2]; /**< INFINITE: unit vector along the lines, x right, y down */
} vlVanishingPoint;

/** The vanishing point of a direction d in world space: project(R d), R the rotation from world
 * to camera. Perspective: d and -d have the same point; it includes the lens's distortion, and
 * is INFINITE beyond 1e9 focal lengths. Projections that see more than a half space: the point
 * is that of d only. Orthographic: INFINITE, or NONE along the view direction. Returns false
 * for a null argument, or a direction that is zero or not finite. */
VL_API bool vl_camera_vanishing_point(const vlCamera *camera, const double direction[3],
                                      vlVanishingPoint *point);

/** The principal vanishing points and the horizon of a camera. */
typedef struct vlVanishingPoints {
  vlVanishingPoint axes[3]; /**< vanishing points of the world's x, y and z axes (of -x, -y, -z
                               if that end is seen) */
  /** The number of finite points: 1, 2 or 3 for one-, two- or three-point perspective; 0 if the
   * camera is not perspective. */
  uint32_t finite;
  /** Whether the horizon is a straight line at a finite place. It is not with distortion, for
   * projections other than perspective, or if the camera looks along `up`. */
  bool has_horizon;
  /** The horizon is the vanishing line of all planes perpendicular to `up`: h[0] x + h[1] y +
   * h[2] = 0 in pixels. (h[0], h[1]) has unit length, and the left side is positive above the
   * horizon. */
  double horizon[3];
} vlVanishingPoints;

/** The principal vanishing points, and the horizon for the direction `up` in world space.
 * Returns false in the cases of vl_camera_vanishing_point. */
VL_API bool vl_camera_vanishing_points(const vlCamera *camera, const double up[3],
                                       vlVanishingPoints *points);

/** The vanishing points from which a camera is found. The camera has square pixels and neither
 * skew nor distortion. */
typedef struct vlVanishingDef {
  uint32_t cookie;
  uint32_t width, height; /**< size of the image, pixels */
  uint32_t count; /**< number of points: 2 if the principal point is known; 3 also determine the
                     principal point */
  double points[3][2]; /**< pixels, finite */
  /** the world axis of each point: 0 x, 1 y, 2 z, all different; default x, z, y */
  uint32_t axes[3];
  bool away[3];  /**< whether the positive end of the axis is in front of the camera; not read
                    for a third axis, where it follows from the right-handed world; default
                    true */
  double cx, cy; /**< principal point, pixels; unset: the image's centre (2 points), or computed
                    (3 points). With 3 points given values must agree with the computed ones */
} vlVanishingDef;

/** The default def for an image of this size, in pixels. */
VL_API vlVanishingDef vl_default_vanishing_def(uint32_t width, uint32_t height);

/** Finds the camera: *camera becomes a default def with fx, fy, cx, cy and a rotation matrix,
 * at the origin. ARGUMENT: points that no camera has (directions that cannot be perpendicular,
 * collinear or equal points), an axis that is given twice, or numbers that are not finite. */
VL_API vlResult vl_camera_from_vanishing_points(const vlVanishingDef *def, vlCameraDef *camera,
                                                vlError *error);

#ifdef __cplusplus
}
#endif
#endif
