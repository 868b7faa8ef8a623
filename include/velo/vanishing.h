/** @file
 * velo/vanishing.h: vanishing points and horizon of a camera, and the camera back from its vanishing points. */
#ifndef VELO_VANISHING_H
#define VELO_VANISHING_H

#include "velo/camera.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef enum vlVanishing {
  VL_VANISHING_NONE,    /**< seen end on by parallel projectors, or outside of what the projection sees */
  VL_VANISHING_FINITE,  /**< at pixel */
  VL_VANISHING_INFINITE /**< the lines stay parallel in the image */
} vlVanishing;

/** Where the images of all lines of one direction meet. */
typedef struct vlVanishingPoint {
  vlVanishing kind;
  bool behind;         /**< the point is that of the lines' other end, which is the one before the camera */
  double pixel[2];     /**< FINITE; may lie outside the image */
  double direction[2]; /**< INFINITE: unit vector along the lines, x right, y down */
} vlVanishingPoint;

/** A direction d of the world vanishes at project(R d). Perspective: d and -d share the point, which is the ideal one
 * moved by the lens's distortion; it is taken as INFINITE beyond 1e9 focal lengths. Projections that see more than a
 * half space: of the direction's own end. Orthographic: INFINITE, or NONE along the view direction. false: a null
 * argument, or a direction that is zero or not finite. */
VL_API bool vl_camera_vanishing_point(const vlCamera *camera, const double direction[3], vlVanishingPoint *point);

typedef struct vlVanishingPoints {
  vlVanishingPoint
      axes[3]; /**< the principal vanishing points: of the world's x, y, z; of -x ... where that end is seen */
  /** One-, two- or three-point perspective: how many of them are finite. 0: not a perspective camera. */
  uint32_t finite;
  /** Where all planes at right angles to `up` vanish: horizon[0] x + horizon[1] y + horizon[2] = 0, the first two of
   * unit length, the sum above zero on the sky's side. false: a curve (distortion, other projections), or infinite,
   * since the camera looks along up. */
  bool has_horizon;
  double horizon[3];
} vlVanishingPoints;

VL_API bool vl_camera_vanishing_points(const vlCamera *camera, const double up[3], vlVanishingPoints *points);

/** The inverse. Square pixels, no skew, no distortion; finite points. */
typedef struct vlVanishingDef {
  uint32_t cookie;
  uint32_t width, height; /**< of the image */
  uint32_t count;         /**< points: 2 with a known principal point, 3 give that too */
  double points[3][2];
  /** Which axis of the world each belongs to: 0 x, 1 y, 2 z, all different. away: its positive end is the one before
   * the camera; that of a third axis follows, since the world is right-handed. Default: x, z, y; away. */
  uint32_t axes[3];
  bool away[3];
  double cx, cy; /**< pixels; unset: two points: the image's centre; three: found. Given with three they must agree */
} vlVanishingDef;

VL_API vlVanishingDef vl_default_vanishing_def(uint32_t width, uint32_t height);

/** *camera: a default def with fx, fy, cx, cy and a matrix that turns, at the origin. ARGUMENT: points that no camera
 * has (not at right angles from anywhere, on one line, the same), axes given twice, numbers that are not finite. */
VL_API vlResult vl_camera_from_vanishing_points(const vlVanishingDef *def, vlCameraDef *camera, vlError *error);

#ifdef __cplusplus
}
#endif
#endif
