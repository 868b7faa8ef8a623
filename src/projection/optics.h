/* projection/optics.h: a lens of many elements has no projection: camera/optics.hot.c traces
 * its rays. These functions only fill the tables. */
#ifndef PROJECTION_OPTICS_H
#define PROJECTION_OPTICS_H

#include "camera/plane.h"
#include "camera/rays.h"

VL_INLINE vlDirection vl_unproject_optics(VL_UNPROJECT_INPUT) {
  return (vlDirection){x, y, 1.0, 0.0};
}
VL_INLINE vlPlanePoint vl_project_optics(VL_PROJECT_INPUT) {
  return (vlPlanePoint){x, y, 0.0};
}

VL_INLINE vlPlaneDerivatives vl_derive_optics(VL_PROJECT_INPUT) {
  return (vlPlaneDerivatives){{0.0}, {0.0}};
}

#endif
