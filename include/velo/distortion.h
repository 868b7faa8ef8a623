/** @file
 * velo/distortion.h: models of lens distortion: their kinds. */
#ifndef VELO_DISTORTION_H
#define VELO_DISTORTION_H

#include "velo/camera.h"

#ifdef __cplusplus
extern "C" {
#endif

/** X(kind, name) for each distortion, with the order of its coefficients. They act on the plane
 * of the projection. */
#define VL_DISTORTION_KINDS(X)                                                               \
  X(VL_DISTORTION_NONE, none) /* ideal */                                                    \
  X(VL_DISTORTION_OPENCV,                                                                    \
    opencv) /* k1 k2 p1 p2 [k3 [k4 k5 k6 [s1 s2 s3 s4 [tau_x tau_y]]]]: 4, 5, 8, 12 or 14 */ \
  X(VL_DISTORTION_RADIAL,                                                                    \
    radial) /* k1 [k2 [k3 [k4]]]; with EQUIDISTANT: OpenCV's and COLMAP's fisheye */         \
  X(VL_DISTORTION_THIN_PRISM, thin_prism) /* COLMAP's k1 k2 p1 p2 k3 k4 sx1 sy1 */           \
  X(VL_DISTORTION_RAD_TAN_THIN_PRISM,                                                        \
    rad_tan_thin_prism) /* Project Aria's k0 to k5, p0 p1, s0 to s3; with EQUIDISTANT:       \
                           Fisheye624, COLMAP's RAD_TAN_THIN_PRISM_FISHEYE */
/** The kinds of distortion: VL_DISTORTION_NONE and so on, from VL_DISTORTION_KINDS. */
typedef enum vlDistortionKind {
#define VL_KIND(kind, name) kind,
  VL_DISTORTION_KINDS(VL_KIND)
#undef VL_KIND
      VL_DISTORTION_KIND_COUNT /**< their number */
} vlDistortionKind;

#ifdef __cplusplus
}
#endif
#endif
