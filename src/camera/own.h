/* camera/own.h: the rays and film points of a camera of one's own (velo/own.h): calls of its
 * functions. */
#ifndef CAMERA_OWN_H
#define CAMERA_OWN_H

#include "camera/own_rays.h"
#include "camera/parts.h"
#include "camera/pose.h"

/* Inputs and outputs of vlOwnRaysFn. */
typedef struct vlOwnRows {
  double x[VL_OWN_BATCH], y[VL_OWN_BATCH]; /* film points in the camera's own pixels */
  double lens_u[VL_OWN_BATCH], lens_v[VL_OWN_BATCH], time[VL_OWN_BATCH];
  double ox[VL_OWN_BATCH], oy[VL_OWN_BATCH], oz[VL_OWN_BATCH];
  double dx[VL_OWN_BATCH], dy[VL_OWN_BATCH], dz[VL_OWN_BATCH], weight[VL_OWN_BATCH];
} vlOwnRows;

/* Makes the rays of n film points. Elements from n to VL_PAD(n) have the ray (0 0 0), (0 0
 * 0). */
void vl_own_rays(const vlCameraCompiled *c, uint32_t n, vlOwnRows *rows);
/* The chief rays of n film points (pixels of the compiled camera), at the start of the
 * exposure. */
void vl_own_chief_rays(const vlCameraCompiled *c, uint32_t n, const double *x, const double *y,
                       vlOwnRows *rows);

/* A ray of camera space in the world. */
static inline vlWorldRay vl_own_to_world(const vlCameraCompiled *c, double ox, double oy,
                                         double oz, double dx, double dy, double dz) {
  const double *m = c->rotation;
  vlWorldRay w = vl_camera_to_world(c, (vlCameraLocal){ox, oy, dx, dy, dz});
  w.ox += m[2] * oz;
  w.oy += m[5] * oz;
  w.oz += m[8] * oz;
  return w;
}
/* Lane i of rows in the world. False: the film point has no ray, or the ray is not finite. */
bool vl_own_ray_at(const vlCameraCompiled *c, const vlOwnRows *rows, uint32_t i,
                   vlWorldRay *ray);

/* The def without what describes a projection or a lens: these a camera of one's own
 * replaces. */
vlCameraDef vl_camera_own_def(const vlCameraDef *def);
/* Checks def->own and fills the members of the camera that begin with own_. */
vlResult vl_camera_own(const vlCameraDef *def, vlCamera *camera, vlError *error);
/* The share of the image that has no rays. */
double vl_own_outside(const vlCamera *camera);

#endif
