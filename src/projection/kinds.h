/* projection/kinds.h: two functions that call any projection. `kind` is a constant where they
 * are inlined, so a batch selects its projection once. Plane points are undistorted; the lens
 * distortion is applied between them and the pixels. */
#ifndef PROJECTION_KINDS_H
#define PROJECTION_KINDS_H

#include "projection/cube.h"
#include "projection/cylindrical.h"
#include "projection/division.h"
#include "projection/double_sphere.h"
#include "projection/equal_area.h"
#include "projection/equidistant.h"
#include "projection/equirectangular.h"
#include "projection/equisolid.h"
#include "projection/eucm.h"
#include "projection/fov.h"
#include "projection/optics.h"
#include "projection/orthographic.h"
#include "projection/panini.h"
#include "projection/perspective.h"
#include "projection/sine.h"
#include "projection/stereographic.h"
#include "projection/unified.h"
#include "velo/projection.h"

/* X(kind, unproject, project, derive): the functions of each projection, by their full names.
 */
#define VL_PROJECTION_FUNCTIONS(X)                                                           \
  X(VL_PROJECTION_PERSPECTIVE, vl_unproject_perspective, vl_project_perspective,             \
    vl_derive_perspective)                                                                   \
  X(VL_PROJECTION_ORTHOGRAPHIC, vl_unproject_orthographic, vl_project_orthographic,          \
    vl_derive_orthographic)                                                                  \
  X(VL_PROJECTION_EQUIRECTANGULAR, vl_unproject_equirectangular, vl_project_equirectangular, \
    vl_derive_equirectangular)                                                               \
  X(VL_PROJECTION_EQUIDISTANT, vl_unproject_equidistant, vl_project_equidistant,             \
    vl_derive_equidistant)                                                                   \
  X(VL_PROJECTION_EQUISOLID, vl_unproject_equisolid, vl_project_equisolid,                   \
    vl_derive_equisolid)                                                                     \
  X(VL_PROJECTION_STEREOGRAPHIC, vl_unproject_stereographic, vl_project_stereographic,       \
    vl_derive_stereographic)                                                                 \
  X(VL_PROJECTION_SINE, vl_unproject_sine, vl_project_sine, vl_derive_sine)                  \
  X(VL_PROJECTION_EQUAL_AREA, vl_unproject_equal_area, vl_project_equal_area,                \
    vl_derive_equal_area)                                                                    \
  X(VL_PROJECTION_CYLINDRICAL, vl_unproject_cylindrical, vl_project_cylindrical,             \
    vl_derive_cylindrical)                                                                   \
  X(VL_PROJECTION_CUBE, vl_unproject_cube, vl_project_cube, vl_derive_cube)                  \
  X(VL_PROJECTION_PANINI, vl_unproject_panini, vl_project_panini, vl_derive_panini)          \
  X(VL_PROJECTION_FOV, vl_unproject_fov, vl_project_fov, vl_derive_fov)                      \
  X(VL_PROJECTION_DIVISION, vl_unproject_division, vl_project_division, vl_derive_division)  \
  X(VL_PROJECTION_UNIFIED, vl_unproject_unified, vl_project_unified, vl_derive_unified)      \
  X(VL_PROJECTION_EUCM, vl_unproject_eucm, vl_project_eucm, vl_derive_eucm)                  \
  X(VL_PROJECTION_DOUBLE_SPHERE, vl_unproject_double_sphere, vl_project_double_sphere,       \
    vl_derive_double_sphere)                                                                 \
  X(VL_PROJECTION_OPTICS, vl_unproject_optics, vl_project_optics, vl_derive_optics)

/* A kind that is not in this list is a compile error: a number that the enum has not. */
#define VL_HAS_FUNCTIONS(kind, unproject, project, derive) functions_of_##kind = 1,
enum { VL_PROJECTION_FUNCTIONS(VL_HAS_FUNCTIONS) };
#define VL_NEEDS_FUNCTIONS(kind, name, row) \
  _Static_assert(functions_of_##kind, "a kind has functions");
VL_PROJECTION_KINDS(VL_NEEDS_FUNCTIONS)
#undef VL_NEEDS_FUNCTIONS
#undef VL_HAS_FUNCTIONS

VL_INLINE vlDirection vl_plane_unproject(vlProjection kind, const vlCameraCompiled *c,
                                         double face, double x, double y) {
  vlDirection d = {x, y, 1.0, 1.0};
  switch (kind) {
#define VL_UNPROJECT_CASE(kind, unproject, project, derive) \
  case kind:                                                \
    d = unproject(c, face, x, y);                           \
    break;
    VL_PROJECTION_FUNCTIONS(VL_UNPROJECT_CASE)
#undef VL_UNPROJECT_CASE
    case VL_PROJECTION_OWN:
      d.valid = 0.0;
      break;
  }
  d.valid = x * x + y * y <= c->limit2 ? d.valid : 0.0;
  return d;
}

/* Projects a point in camera space to the plane. */
VL_INLINE vlPlanePoint vl_plane_project(vlProjection kind, const vlCameraCompiled *c, double x,
                                        double y, double z) {
  vlPlanePoint p = {x, y, 0.0};
  switch (kind) {
#define VL_PROJECT_CASE(kind, unproject, project, derive) \
  case kind:                                              \
    p = project(c, x, y, z);                              \
    break;
    VL_PROJECTION_FUNCTIONS(VL_PROJECT_CASE)
#undef VL_PROJECT_CASE
    case VL_PROJECTION_OWN:
      break;
  }
  p.valid = p.x * p.x + p.y * p.y <= c->limit2 ? p.valid : 0.0;
  return p;
}

/* The derivatives of vl_plane_project, inside its domain. */
VL_INLINE vlPlaneDerivatives vl_plane_derive(vlProjection kind, const vlCameraCompiled *c,
                                             double x, double y, double z) {
  vlPlaneDerivatives d = {{0.0}, {0.0}};
  switch (kind) {
#define VL_DERIVE_CASE(kind, unproject, project, derive) \
  case kind:                                             \
    d = derive(c, x, y, z);                              \
    break;
    VL_PROJECTION_FUNCTIONS(VL_DERIVE_CASE)
#undef VL_DERIVE_CASE
    case VL_PROJECTION_OWN:
      break;
  }
  return d;
}

/* The projections that cover all longitudes. They support omnidirectional stereo (eyes.h). */
#define VL_ROUND_PROJECTIONS(X)    \
  X(VL_PROJECTION_EQUIRECTANGULAR) \
  X(VL_PROJECTION_EQUAL_AREA)      \
  X(VL_PROJECTION_CYLINDRICAL)     \
  X(VL_PROJECTION_CUBE)

#endif
