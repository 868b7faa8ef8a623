/* camera/local.h: a ray in camera space, what every projection makes and the lens and the pose take. Camera space:
 * x right, y down, z forward. */
#ifndef CAMERA_LOCAL_H
#define CAMERA_LOCAL_H

/* Starts at (ox, oy, 0), goes along (dx, dy, dz), dz > 0, any length. */
typedef struct vlCameraLocal {
  double ox, oy;
  double dx, dy, dz;
} vlCameraLocal;

/* A point of the film, in pixels from the window's top left corner. */
typedef struct vlFilmPoint {
  double x, y;
} vlFilmPoint;

typedef struct vlCameraPoint {
  double x, y, z;
} vlCameraPoint;

#endif
