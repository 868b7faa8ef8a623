/** @file
 * velo/vanishing.h: vanishing points and horizon of a camera, and a camera from its vanishing points. */
#ifndef VELO_VANISHING_H
#define VELO_VANISHING_H

#include "velo/camera.h"

#ifdef __cplusplus
extern "C" {
#endif

/** Whether a vanishing point exists. */
typedef enum vlVanishing {
  VL_VANISHING_NONE,    /**< none: lines seen end on by an orthographic camera, or outside of the projection's domain */
  VL_VANISHING_FINITE,  /**< at `pixel` */
  VL_VANISHING_INFINITE /**< the lines stay parallel in the image */
} vlVanishing;

/** The point where the images of all lines of one direction meet. */
typedef struct vlVanishingPoint {
  vlVanishing kind;    /**< which fields below are set */
  bool behind;         /**< the point belongs to -d, the end of the lines in front of the camera */
  double pixel[2];     /**< FINITE; may lie outside the image */
  double direction[2]; /**< INFINITE: unit vector along the lines, x right, y down */
} vlVanishingPoint;

/** The vanishing point of a direction d in world space: project(R d). Perspective: d and -d share the point, which is
 * the ideal one moved by the lens's distortion; beyond 1e9 focal lengths it is INFINITE. Projections that see more than
 * a half space: the point of d itself. Orthographic: INFINITE, or NONE along the view direction. Returns false for a
 * null argument, or a direction that is zero or not finite. */
VL_API bool vl_camera_vanishing_point(const vlCamera *camera, const double direction[3], vlVanishingPoint *point);

/** The principal vanishing points and the horizon of a camera. */
typedef struct vlVanishingPoints {
  vlVanishingPoint axes[3]; /**< of the world's x, y and z axes; of -x, -y, -z where that end is seen */
  /** One-, two- or three-point perspective: how many of them are finite. 0: not a perspective camera. */
  uint32_t finite;
  /** Whether the horizon is a straight line at a finite place. Not with distortion, for other projections, or when the
   * camera looks along up. */
  bool has_horizon;
  /** The horizon, where all planes perpendicular to `up` vanish: h[0] x + h[1] y + h[2] = 0 in pixels, (h[0], h[1]) of
   * unit length, the sum positive on the side of the sky. */
  double horizon[3];
} vlVanishingPoints;

/** The principal vanishing points, and the horizon for the direction `up` in world space. Returns false as
 * vl_camera_vanishing_point. */
VL_API bool vl_camera_vanishing_points(const vlCamera *camera, const double up[3], vlVanishingPoints *points);

/** Vanishing points from which a camera is to be found: one with square pixels, without skew and distortion. */
typedef struct vlVanishingDef {
  uint32_t cookie;
  uint32_t width, height; /**< of the image, pixels */
  uint32_t count;         /**< number of points: 2 with a known principal point; 3 determine that, too */
  double points[3][2];    /**< pixels, finite */
  /** The world axis of each point: 0 x, 1 y, 2 z, all different; and whether its positive end is the one in front of
   * the camera. For a third axis that follows, since the world is right-handed. Default: x, z, y; away true. */
  uint32_t axes[3];
  bool away[3];  /**< see axes */
  double cx, cy; /**< principal point, pixels; unset: the image's centre (2 points), found (3 points); if given with
                  * 3 points they must agree */
} vlVanishingDef;

/** The default def for an image of this size, in pixels. */
VL_API vlVanishingDef vl_default_vanishing_def(uint32_t width, uint32_t height);

/** Finds the camera: *camera becomes a default def with fx, fy, cx, cy and a rotation matrix, at the origin. ARGUMENT:
 * points that no camera has (directions that cannot be perpendicular, collinear or equal points), an axis given twice,
 * numbers that are not finite. */
VL_API vlResult vl_camera_from_vanishing_points(const vlVanishingDef *def, vlCameraDef *camera, vlError *error);

#ifdef __cplusplus
}
#endif
#endif
