/* camera/local.h: a ray in camera space. Every projection returns one; the lens and the pose
 * then transform it. Camera space: x right, y down, z forward. */
#ifndef CAMERA_LOCAL_H
#define CAMERA_LOCAL_H

/* Origin (ox, oy, 0), direction (dx, dy, dz) of any length; dz > 0 for perspective and
 * orthographic cameras. */
typedef struct vlCameraLocal {
  double ox, oy;
  double dx, dy, dz;
} vlCameraLocal;

#endif
