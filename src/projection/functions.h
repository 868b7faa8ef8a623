/* projection/functions.h: for the files of the projections: a projection as two functions. */
#ifndef PROJECTION_FUNCTIONS_H
#define PROJECTION_FUNCTIONS_H

#include "camera/plane.h"
#include "camera/rays.h"
#include "velo/projection.h"

/* Defines the functions vl_unproject_name and vl_project_name of the kind VL_PROJECTION_NAME.
 * Both expressions can use the compiled camera c and its shape numbers a. `unproject` also uses
 * a point of the plane (x, y) and, for VL_PROJECTION_CUBE, the cell `face`; `project` uses a
 * point (x, y, z) in camera space.
 */
#define VL_CAMERA_INLINE static inline __attribute__((always_inline))
#define VL_PROJECTION_FUNCTIONS(NAME, name, unproject, project)                            \
  _Static_assert(VL_PROJECTION_##NAME >= 0, "a kind of VL_PROJECTION_KINDS");              \
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

#endif
