/* camera/local.h: a ray in camera space, what every projection makes and the lens and the pose take. Camera space:
 * x right, y down, z forward. */
#ifndef CAMERA_LOCAL_H
#define CAMERA_LOCAL_H

/* Starts at (ox, oy, 0), goes along (dx, dy, dz), any length; dz > 0 for perspective and orthographic cameras. */
typedef struct vlCameraLocal {
  double ox, oy;
  double dx, dy, dz;
} vlCameraLocal;

#endif
