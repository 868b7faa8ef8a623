/* camera/projection.h: two functions that call any projection. `kind` is a constant where they
 * are inlined, so a batch selects its projection once. Plane points are undistorted; the lens
 * distortion is applied between them and the pixels. */
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

/* Defines the functions vl_unproject_NAME and vl_project_NAME of a kind. Both expressions can
 * use the compiled camera c and its shape numbers a. `unproject` also uses a point of the plane
 * (x, y) and, for VL_PROJECTION_CUBE, the cell `face`; `project` uses a point (x, y, z) in
 * camera space.
 */
#define VL_CAMERA_INLINE static inline __attribute__((always_inline))
#define VL_PROJECTION_FUNCTIONS(name, unproject, project)                                  \
  VL_CAMERA_INLINE vlDirection vl_unproject_##name(const vlCameraCompiled *c, double face, \
                                                   double x, double y) {                   \
    const double *a = c->shape;                                                            \
    (void)a, (void)face;                                                                   \
    return unproject;                                                                      \
  }                                                                                        \
  VL_CAMERA_INLINE vlPlanePoint vl_project_##name(const vlCameraCompiled *c, double x,     \
                                                  double y, double z) {                    \
    const double *a = c->shape;                                                            \
    (void)a, (void)z;                                                                      \
    return project;                                                                        \
  }
VL_PROJECTION_FUNCTIONS(perspective, ((vlDirection){x, y, 1.0, 1.0}),
                        ((vlPlanePoint){x / z, y / z, z > 0.0 ? 1.0 : 0.0}))
VL_PROJECTION_FUNCTIONS(orthographic, ((vlDirection){x, y, 1.0, 1.0}),
                        ((vlPlanePoint){x, y, z >= 0.0 ? 1.0 : 0.0}))
VL_PROJECTION_FUNCTIONS(equidistant, vl_equidistant_unproject(x, y),
                        vl_equidistant_project(x, y, z))
VL_PROJECTION_FUNCTIONS(equisolid, vl_equisolid_unproject(x, y), vl_equisolid_project(x, y, z))
VL_PROJECTION_FUNCTIONS(stereographic, vl_stereographic_unproject(x, y),
                        vl_stereographic_project(x, y, z))
VL_PROJECTION_FUNCTIONS(sine, vl_sine_unproject(x, y), vl_sine_project(x, y, z))
VL_PROJECTION_FUNCTIONS(equirectangular,
                        vl_equirectangular_unproject(c->over_x, c->over_y, x, y),
                        vl_equirectangular_project(x, y, z))
VL_PROJECTION_FUNCTIONS(equal_area, vl_equal_area_unproject(c->over_x, x, y),
                        vl_equal_area_project(x, y, z))
VL_PROJECTION_FUNCTIONS(cylindrical, vl_cylindrical_unproject(c->over_x, x, y),
                        vl_cylindrical_project(x, y, z))
VL_PROJECTION_FUNCTIONS(cube, vl_cube_unproject(a[0], c->over_y, face, x, y),
                        vl_cube_project(a[0], x, y, z))
VL_PROJECTION_FUNCTIONS(panini, vl_panini_unproject(a[0], x, y),
                        vl_panini_project(a[0], x, y, z))
VL_PROJECTION_FUNCTIONS(fov, vl_fov_unproject(a[0], a[1], x, y),
                        vl_fov_project(a[0], a[1], x, y, z))
VL_PROJECTION_FUNCTIONS(division, vl_division_unproject(a[0], x, y),
                        vl_division_project(a[0], x, y, z))
VL_PROJECTION_FUNCTIONS(unified, vl_unified_unproject(a[0], x, y),
                        vl_unified_project(a[0], x, y, z))
VL_PROJECTION_FUNCTIONS(eucm, vl_eucm_unproject(a[0], a[1], x, y),
                        vl_eucm_project(a[0], a[1], x, y, z))
VL_PROJECTION_FUNCTIONS(double_sphere, vl_double_sphere_unproject(a[0], a[1], x, y),
                        vl_double_sphere_project(a[0], a[1], x, y, z))
/* These only fill the table: rays of a lens of many elements are traced by optics.hot.c, and
 * those of a camera of one's own by own.c. */
VL_PROJECTION_FUNCTIONS(optics, ((vlDirection){x, y, 1.0, 0.0}), ((vlPlanePoint){x, y, 0.0}))

VL_CAMERA_INLINE vlDirection vl_plane_unproject(vlProjection kind, const vlCameraCompiled *c,
                                                double face, double x, double y) {
  vlDirection d = {x, y, 1.0, 1.0};
  switch (kind) {
#define VL_UNPROJECT_CASE(NAME, name)       \
  case VL_PROJECTION_##NAME:                \
    d = vl_unproject_##name(c, face, x, y); \
    break;
    VL_PROJECTION_KINDS(VL_UNPROJECT_CASE)
#undef VL_UNPROJECT_CASE
    case VL_PROJECTION_OWN:
      d.valid = 0.0;
      break;
  }
  d.valid = x * x + y * y <= c->limit2 ? d.valid : 0.0;
  return d;
}

/* Projects a point in camera space to the plane. */
VL_CAMERA_INLINE vlPlanePoint vl_plane_project(vlProjection kind, const vlCameraCompiled *c,
                                               double x, double y, double z) {
  vlPlanePoint p = {x, y, 0.0};
  switch (kind) {
#define VL_PROJECT_CASE(NAME, name)    \
  case VL_PROJECTION_##NAME:           \
    p = vl_project_##name(c, x, y, z); \
    break;
    VL_PROJECTION_KINDS(VL_PROJECT_CASE)
#undef VL_PROJECT_CASE
    case VL_PROJECTION_OWN:
      break;
  }
  p.valid = p.x * p.x + p.y * p.y <= c->limit2 ? p.valid : 0.0;
  return p;
}

/* The projections that cover all longitudes. They support omnidirectional stereo (eyes.h). */
#define VL_ROUND_PROJECTIONS(X)       \
  X(EQUIRECTANGULAR, equirectangular) \
  X(EQUAL_AREA, equal_area)           \
  X(CYLINDRICAL, cylindrical)         \
  X(CUBE, cube)

#endif
