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
