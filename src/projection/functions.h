/* projection/functions.h: for the files of the projections: a projection as two functions. */
#ifndef PROJECTION_FUNCTIONS_H
#define PROJECTION_FUNCTIONS_H

#include "camera/plane.h"
#include "camera/rays.h"
#include "velo/projection.h"

/* A projection need not use all of its arguments. These are those of vl_unproject_NAME: the
 * compiled camera, whose member `shape` holds the numbers of the projection; for
 * VL_PROJECTION_CUBE the `cell`; a point of the plane. */
#define VL_UNPROJECT_INPUT                                                        \
  VL_UNUSED const vlCameraCompiled *c, VL_UNUSED double cell, VL_UNUSED double x, \
      VL_UNUSED double y
/* The arguments of vl_project_NAME: the compiled camera, a point in camera space. */
#define VL_PROJECT_INPUT                                                       \
  VL_UNUSED const vlCameraCompiled *c, VL_UNUSED double x, VL_UNUSED double y, \
      VL_UNUSED double z

/* Derivatives of a plane point: by x, y, z of the point in camera space, then by the two
 * numbers of vlCamera.shape. */
typedef struct vlPlaneDerivatives {
  double x[5], y[5];
} vlPlaneDerivatives;

/* The derivatives of (x k, y k); by: those of k. */
static inline vlPlaneDerivatives vl_derive_factor(double x, double y, double k,
                                                  const double by[5]) {
  vlPlaneDerivatives d;
  for (int i = 0; i < 5; i++) {
    d.x[i] = x * by[i];
    d.y[i] = y * by[i];
  }
  d.x[0] += k;
  d.y[1] += k;
  return d;
}
/* The derivatives of (x, y) / divisor; by: those of the divisor. */
static inline vlPlaneDerivatives vl_derive_quotient(double x, double y, double divisor,
                                                    const double by[5]) {
  double k = 1.0 / divisor, of_k[5];
  for (int i = 0; i < 5; i++)
    of_k[i] = -by[i] * k * k;
  return vl_derive_factor(x, y, k, of_k);
}

#endif
