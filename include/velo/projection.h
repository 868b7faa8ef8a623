/** @file
 * velo/projection.h: the list of the projections of cameras. */
#ifndef VELO_PROJECTION_H
#define VELO_PROJECTION_H

#include "velo/camera.h"

/** X(NAME, name) for each projection but the first two, and where it maps a direction on the
 * projection plane: docs/cameras.md has the equations. The plane's unit is the focal length
 * (fx, fy pixels); in projections of angles it is one radian. */
#define VL_OTHER_PROJECTION_KINDS(X)                                                        \
  X(EQUIDISTANT, equidistant)     /* fisheyes: r = theta */                                 \
  X(EQUISOLID, equisolid)         /* 2 sin(theta / 2) */                                    \
  X(STEREOGRAPHIC, stereographic) /* 2 tan(theta / 2) */                                    \
  X(SINE, sine)                   /* the "orthographic" fisheye: sin(theta) */              \
  X(EQUIRECTANGULAR,                                                                        \
    equirectangular) /* longitude, latitude; limits are the screen window, in radians */    \
  X(EQUAL_AREA, equal_area)   /* octahedral: the sphere in a square -1 to 1 */              \
  X(CYLINDRICAL, cylindrical) /* longitude, tangent of the latitude */                      \
  X(CUBE, cube) /* six faces; shape: 0 (default) in a row, 1 in a cross: docs/cameras.md */ \
  X(PANINI, panini)               /* shape: d >= 0 */                                       \
  X(FOV, fov)                     /* shape: w, radians */                                   \
  X(DIVISION, division)           /* shape: lambda */                                       \
  X(UNIFIED, unified)             /* shape: xi >= 0 (Mei) */                                \
  X(EUCM, eucm)                   /* shape: alpha in [0, 1], beta > 0 */                    \
  X(DOUBLE_SPHERE, double_sphere) /* shape: xi in (-1, 1), alpha in [0, 1] */               \
  X(OPTICS, optics)               /* a lens of many elements: lens.optics */
/** X(NAME, name) for each projection. Their names in pbrt files are in velo/schema.h. */
#define VL_PROJECTION_KINDS(X)  \
  X(PERSPECTIVE, perspective)   \
  X(ORTHOGRAPHIC, orthographic) \
  VL_OTHER_PROJECTION_KINDS(X)

/** Values of vlProjection, in the order of the list. */
enum {
  VL_PROJECTION_LAST_FLAT = VL_PROJECTION_ORTHOGRAPHIC,
#define VL_KIND(NAME, name) VL_PROJECTION_##NAME,
  VL_OTHER_PROJECTION_KINDS(VL_KIND)
#undef VL_KIND
      VL_PROJECTION_OWN /**< functions of the caller's: vlCameraDef.own. Files cannot have it */
};

#endif
