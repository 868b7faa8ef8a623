/* camera/projection.h: all projections behind two functions. `kind` is a constant where these are inlined, so that a
 * batch chooses once. The plane points are ideal: distortion lies between them and the pixels. */
#ifndef CAMERA_PROJECTION_H
#define CAMERA_PROJECTION_H

#include "camera/calibrated.h"
#include "camera/cube.h"
#include "camera/cylindrical.h"
#include "camera/equal_area.h"
#include "camera/equirectangular.h"
#include "camera/fisheye.h"
#include "camera/panini.h"
#include "camera/rays.h"

/* face: the cell of VL_PROJECTION_CUBE; unread for all others. */
static inline __attribute__((always_inline)) vlDirection vl_plane_unproject(vlProjection kind,
                                                                            const vlCameraCompiled *c, double face,
                                                                            double x, double y) {
  const double *a = c->shape;
  vlDirection d = {x, y, 1.0, 1.0};
  switch (kind) {
    case VL_PROJECTION_PERSPECTIVE:
    case VL_PROJECTION_ORTHOGRAPHIC: break;
    case VL_PROJECTION_EQUIDISTANT: d = vl_equidistant_unproject(x, y); break;
    case VL_PROJECTION_EQUISOLID: d = vl_equisolid_unproject(x, y); break;
    case VL_PROJECTION_STEREOGRAPHIC: d = vl_stereographic_unproject(x, y); break;
    case VL_PROJECTION_SINE: d = vl_sine_unproject(x, y); break;
    case VL_PROJECTION_EQUIRECTANGULAR: d = vl_equirectangular_unproject(c->over_x, c->over_y, x, y); break;
    case VL_PROJECTION_EQUAL_AREA: d = vl_equal_area_unproject(c->over_x, x, y); break;
    case VL_PROJECTION_CYLINDRICAL: d = vl_cylindrical_unproject(c->over_x, x, y); break;
    case VL_PROJECTION_CUBE: d = vl_cube_unproject(a[0], c->over_y, face, x, y); break;
    case VL_PROJECTION_PANINI: d = vl_panini_unproject(a[0], x, y); break;
    case VL_PROJECTION_FOV: d = vl_fov_unproject(a[0], a[1], x, y); break;
    case VL_PROJECTION_DIVISION: d = vl_division_unproject(a[0], x, y); break;
    case VL_PROJECTION_UNIFIED: d = vl_unified_unproject(a[0], x, y); break;
    case VL_PROJECTION_EUCM: d = vl_eucm_unproject(a[0], a[1], x, y); break;
    case VL_PROJECTION_DOUBLE_SPHERE: d = vl_double_sphere_unproject(a[0], a[1], x, y); break;
    case VL_PROJECTION_OPTICS: d.valid = 0.0; break; /* optics have their own functions (optics.h) */
  }
  d.valid = x * x + y * y <= c->limit2 ? d.valid : 0.0;
  return d;
}

/* A point in camera space to the plane. */
static inline __attribute__((always_inline)) vlPlanePoint vl_plane_project(vlProjection kind, const vlCameraCompiled *c,
                                                                           double x, double y, double z) {
  const double *a = c->shape;
  vlPlanePoint p = {x, y, z >= 0.0 ? 1.0 : 0.0};
  switch (kind) {
    case VL_PROJECTION_PERSPECTIVE: p = (vlPlanePoint){x / z, y / z, z > 0.0 ? 1.0 : 0.0}; break;
    case VL_PROJECTION_ORTHOGRAPHIC: break;
    case VL_PROJECTION_EQUIDISTANT: p = vl_equidistant_project(x, y, z); break;
    case VL_PROJECTION_EQUISOLID: p = vl_equisolid_project(x, y, z); break;
    case VL_PROJECTION_STEREOGRAPHIC: p = vl_stereographic_project(x, y, z); break;
    case VL_PROJECTION_SINE: p = vl_sine_project(x, y, z); break;
    case VL_PROJECTION_EQUIRECTANGULAR: p = vl_equirectangular_project(x, y, z); break;
    case VL_PROJECTION_EQUAL_AREA: p = vl_equal_area_project(x, y, z); break;
    case VL_PROJECTION_CYLINDRICAL: p = vl_cylindrical_project(x, y, z); break;
    case VL_PROJECTION_CUBE: p = vl_cube_project(a[0], x, y, z); break;
    case VL_PROJECTION_PANINI: p = vl_panini_project(a[0], x, y, z); break;
    case VL_PROJECTION_FOV: p = vl_fov_project(a[0], a[1], x, y, z); break;
    case VL_PROJECTION_DIVISION: p = vl_division_project(a[0], x, y, z); break;
    case VL_PROJECTION_UNIFIED: p = vl_unified_project(a[0], x, y, z); break;
    case VL_PROJECTION_EUCM: p = vl_eucm_project(a[0], a[1], x, y, z); break;
    case VL_PROJECTION_DOUBLE_SPHERE: p = vl_double_sphere_project(a[0], a[1], x, y, z); break;
    case VL_PROJECTION_OPTICS: p.valid = 0.0; break;
  }
  p.valid = p.x * p.x + p.y * p.y <= c->limit2 ? p.valid : 0.0;
  return p;
}

/* CALL(kind) with the compiled projection as a constant. */
#define VL_EACH_PROJECTION(projection, CALL)                                        \
  switch (projection) {                                                             \
    case VL_PROJECTION_PERSPECTIVE: CALL(VL_PROJECTION_PERSPECTIVE); break;         \
    case VL_PROJECTION_ORTHOGRAPHIC: CALL(VL_PROJECTION_ORTHOGRAPHIC); break;       \
    case VL_PROJECTION_EQUIDISTANT: CALL(VL_PROJECTION_EQUIDISTANT); break;         \
    case VL_PROJECTION_EQUISOLID: CALL(VL_PROJECTION_EQUISOLID); break;             \
    case VL_PROJECTION_STEREOGRAPHIC: CALL(VL_PROJECTION_STEREOGRAPHIC); break;     \
    case VL_PROJECTION_SINE: CALL(VL_PROJECTION_SINE); break;                       \
    case VL_PROJECTION_EQUIRECTANGULAR: CALL(VL_PROJECTION_EQUIRECTANGULAR); break; \
    case VL_PROJECTION_EQUAL_AREA: CALL(VL_PROJECTION_EQUAL_AREA); break;           \
    case VL_PROJECTION_CYLINDRICAL: CALL(VL_PROJECTION_CYLINDRICAL); break;         \
    case VL_PROJECTION_CUBE: CALL(VL_PROJECTION_CUBE); break;                       \
    case VL_PROJECTION_PANINI: CALL(VL_PROJECTION_PANINI); break;                   \
    case VL_PROJECTION_FOV: CALL(VL_PROJECTION_FOV); break;                         \
    case VL_PROJECTION_DIVISION: CALL(VL_PROJECTION_DIVISION); break;               \
    case VL_PROJECTION_UNIFIED: CALL(VL_PROJECTION_UNIFIED); break;                 \
    case VL_PROJECTION_EUCM: CALL(VL_PROJECTION_EUCM); break;                       \
    case VL_PROJECTION_DOUBLE_SPHERE: CALL(VL_PROJECTION_DOUBLE_SPHERE); break;     \
    case VL_PROJECTION_OPTICS: CALL(VL_PROJECTION_OPTICS); break;                   \
  }

/* The projections of the whole circle of longitudes, which support omnidirectional stereo (eyes.h). */
#define VL_EACH_ROUND_PROJECTION(projection, CALL)                          \
  switch (projection) {                                                     \
    case VL_PROJECTION_EQUAL_AREA: CALL(VL_PROJECTION_EQUAL_AREA); break;   \
    case VL_PROJECTION_CYLINDRICAL: CALL(VL_PROJECTION_CYLINDRICAL); break; \
    case VL_PROJECTION_CUBE: CALL(VL_PROJECTION_CUBE); break;               \
    default: CALL(VL_PROJECTION_EQUIRECTANGULAR); break;                    \
  }

#endif
