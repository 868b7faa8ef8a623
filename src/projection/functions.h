/* projection/functions.h: for the files of the projections: a projection as two functions. */
#ifndef PROJECTION_FUNCTIONS_H
#define PROJECTION_FUNCTIONS_H

#include "camera/plane.h"
#include "camera/rays.h"
#include "velo/projection.h"

#define VL_CAMERA_INLINE static inline __attribute__((always_inline))
/* The arguments of vl_unproject_NAME: the compiled camera, whose member `shape` holds the
 * numbers of the projection; for VL_PROJECTION_CUBE the cell `face`; a point of the plane. */
#define VL_UNPROJECT_INPUT const vlCameraCompiled *c, double face, double x, double y
/* The arguments of vl_project_NAME: the compiled camera, a point in camera space. */
#define VL_PROJECT_INPUT const vlCameraCompiled *c, double x, double y, double z

#endif
