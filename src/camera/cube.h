/* camera/cube.h: the six faces of a cube in one row, both directions: right, left, up, down, front, back (the order +x
 * -x +y -y +z -z of cube maps with y up). The plane is 6 wide and 1 high from its top left corner. Each face is a
 * perspective view of 90 degrees: right, left, front and back upright; up's lower edge and down's upper edge meet
 * front. A face's own view goes on beyond its edge, so that filters do not mix neighbours in the row: the face is the
 * pixel's, and given apart. */
#ifndef CAMERA_CUBE_H
#define CAMERA_CUBE_H

#include "camera/plane.h"

static inline vlDirection vl_cube_unproject(double over, double face, double x, double y) {
  double a = 2.0 * (x - face) - 1.0, b = 2.0 * y - 1.0;
  double dx = face < 0.5 ? 1.0 : face < 1.5 ? -1.0 : face < 4.5 ? a : -a;
  double dy = face < 1.5 ? b : face < 2.5 ? -1.0 : face < 3.5 ? 1.0 : b;
  double dz = face < 0.5 ? -a : face < 1.5 ? a : face < 2.5 ? b : face < 3.5 ? -b : face < 4.5 ? 1.0 : -1.0;
  return (vlDirection){dx, dy, dz, face >= 0.0 && face <= 5.0 && y >= -over && y <= 1.0 + over ? 1.0 : 0.0};
}
static inline vlPlanePoint vl_cube_project(double x, double y, double z) {
  double ax = __builtin_fabs(x), ay = __builtin_fabs(y), az = __builtin_fabs(z);
  int side = ax >= ay && ax > az, pole = !side && ay > az;
  double major = side ? ax : pole ? ay : az, k = 1.0 / vl_not_tiny(major);
  double face = side ? (x > 0.0 ? 0.0 : 1.0) : pole ? (y < 0.0 ? 2.0 : 3.0) : z > 0.0 ? 4.0 : 5.0;
  double a = side ? (x > 0.0 ? -z : z) : pole ? x : z > 0.0 ? x : -x;
  double b = pole ? (y < 0.0 ? z : -z) : y;
  return (vlPlanePoint){face + 0.5 * (a * k + 1.0), 0.5 * (b * k + 1.0), major > 0.0 ? 1.0 : 0.0};
}

#endif
