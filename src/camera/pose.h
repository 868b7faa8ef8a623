/* camera/pose.h: the pose, last of the four factors of a camera: camera space to world space.
 */
#ifndef CAMERA_POSE_H
#define CAMERA_POSE_H

#include "camera/eyes.h"
#include "camera/rays.h"

/* A world-space ray in double, its direction not yet normalised. */
typedef struct vlWorldRay {
  double ox, oy, oz, dx, dy, dz;
  double inv_length; /* 1 / |d| */
  double length; /* |d|; divided by d's z in camera space, it gives the distance along the ray
                    per unit of depth */
} vlWorldRay;

static inline vlWorldRay vl_camera_to_world(const vlCameraCompiled *c, vlCameraLocal r) {
  const double *m = c->rotation;
  vlWorldRay w;
  w.ox = c->position[0] + (m[0] * r.ox + m[1] * r.oy);
  w.oy = c->position[1] + (m[3] * r.ox + m[4] * r.oy);
  w.oz = c->position[2] + (m[6] * r.ox + m[7] * r.oy);
  w.dx = m[0] * r.dx + m[1] * r.dy + m[2] * r.dz;
  w.dy = m[3] * r.dx + m[4] * r.dy + m[5] * r.dz;
  w.dz = m[6] * r.dx + m[7] * r.dy + m[8] * r.dz;
  w.length = __builtin_sqrt(w.dx * w.dx + w.dy * w.dy + w.dz * w.dz);
  w.inv_length = 1.0 / w.length;
  return w;
}

/* Transforms a ray to world space, with its origin at the eye position of its direction
 * (omnidirectional stereo). */
static inline vlWorldRay vl_camera_offset_eye(const vlCameraCompiled *c, vlEyeOffset eye,
                                              vlWorldRay w) {
  const double *m = c->rotation;
  w.ox += m[0] * eye.x + m[2] * eye.z;
  w.oy += m[3] * eye.x + m[5] * eye.z;
  w.oz += m[6] * eye.x + m[8] * eye.z;
  return w;
}

/* Origin and unit direction of a ray as element i; 0 if it is not good. */
VL_INLINE void vl_store_world_ray(vlCameraPoints *out, uint32_t i, int good, vlWorldRay w) {
  out->ox[i] = good ? w.ox : 0.0;
  out->oy[i] = good ? w.oy : 0.0;
  out->oz[i] = good ? w.oz : 0.0;
  out->x[i] = good ? w.dx * w.inv_length : 0.0;
  out->y[i] = good ? w.dy * w.inv_length : 0.0;
  out->z[i] = good ? w.dz * w.inv_length : 0.0;
}

#endif
