/** @file
 * velo/projection.h: the list of the projections of cameras. */
#ifndef VELO_PROJECTION_H
#define VELO_PROJECTION_H

#include "velo/camera.h"

/** X(kind, name, row) for each projection but the first two, and where it maps a direction on
 * the projection plane: docs/cameras.md has the equations. The plane's unit is the focal length
 * (fx, fy pixels); in projections of angles it is one radian. */
#define VL_OTHER_PROJECTION_KINDS(X)                                                           \
  X(VL_PROJECTION_EQUIDISTANT, equidistant,                                                    \
    vl_projection_row_equidistant)                                   /* fisheyes: r = theta */ \
  X(VL_PROJECTION_EQUISOLID, equisolid, vl_projection_row_equisolid) /* 2 sin(theta / 2) */    \
  X(VL_PROJECTION_STEREOGRAPHIC, stereographic,                                                \
    vl_projection_row_stereographic) /* 2 tan(theta / 2) */                                    \
  X(VL_PROJECTION_SINE, sine,                                                                  \
    vl_projection_row_sine) /* the "orthographic" fisheye: sin(theta) */                       \
  X(VL_PROJECTION_EQUIRECTANGULAR, equirectangular,                                            \
    vl_projection_row_equirectangular) /* longitude, latitude; limits are the screen window,   \
                                          in radians */                                        \
  X(VL_PROJECTION_EQUAL_AREA, equal_area,                                                      \
    vl_projection_row_equal_area) /* octahedral: the sphere in a square -1 to 1 */             \
  X(VL_PROJECTION_CYLINDRICAL, cylindrical,                                                    \
    vl_projection_row_cylindrical)                    /* longitude, tangent of the latitude */ \
  X(VL_PROJECTION_CUBE, cube, vl_projection_row_cube) /* six faces; shape: 0 (default) in a    \
                                                         row, 1 in a cross: docs/cameras.md */ \
  X(VL_PROJECTION_PANINI, panini, vl_projection_row_panini)       /* shape: d >= 0 */          \
  X(VL_PROJECTION_FOV, fov, vl_projection_row_fov)                /* shape: w, radians */      \
  X(VL_PROJECTION_DIVISION, division, vl_projection_row_division) /* shape: lambda */          \
  X(VL_PROJECTION_UNIFIED, unified, vl_projection_row_unified)    /* shape: xi >= 0 (Mei) */   \
  X(VL_PROJECTION_EUCM, eucm, vl_projection_row_eucm) /* shape: alpha in [0, 1], beta > 0 */   \
  X(VL_PROJECTION_DOUBLE_SPHERE, double_sphere,                                                \
    vl_projection_row_double_sphere) /* shape: xi in (-1, 1), alpha in [0, 1] */               \
  X(VL_PROJECTION_OPTICS, optics,                                                              \
    vl_projection_row_optics) /* a lens of many elements: lens.optics */
/** X(kind, name, row) for each projection. Their names in pbrt files are in velo/schema.h. */
#define VL_PROJECTION_KINDS(X)                                                \
  X(VL_PROJECTION_PERSPECTIVE, perspective, vl_projection_row_perspective)    \
  X(VL_PROJECTION_ORTHOGRAPHIC, orthographic, vl_projection_row_orthographic) \
  VL_OTHER_PROJECTION_KINDS(X)

/** Values of vlProjection, in the order of the list. */
enum {
  VL_PROJECTION_LAST_FLAT = VL_PROJECTION_ORTHOGRAPHIC,
#define VL_KIND(kind, name, row) kind,
  VL_OTHER_PROJECTION_KINDS(VL_KIND)
#undef VL_KIND
      VL_PROJECTION_OWN /**< functions of the caller's: vlCameraDef.own. Files cannot have it */
};

#endif
