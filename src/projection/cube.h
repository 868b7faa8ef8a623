/* projection/cube.h: the six faces of a cube in one image, projection and inverse: right, left,
 * up, down, front, back (the order +x -x +y -y +z -z of cube maps with y up). Each face is a
 * perspective view of 90 degrees, one unit of the plane wide. Right, left, front and back are
 * upright; up's lower edge and down's upper edge adjoin front. The plane's origin is its top
 * left corner. Two layouts:
 *
 *     0: a row, 6 x 1                        1: a cross, 4 x 3
 *        right left up down front back               up
 *                                              left front right back
 *                                                   down
 *
 * A face's view continues beyond its edge, so that filters do not mix neighbouring faces: the
 * face is chosen by the pixel and passed separately, as the number of the plane's cell: column
 * + 8 row.
 */
#ifndef PROJECTION_CUBE_H
#define PROJECTION_CUBE_H

#include "camera/plane.h"
#include "camera/rays.h"

/* Returns the number of the cell that contains a plane point. A point far outside the layout
 * gets a cell that belongs to no face. */
static inline double vl_cube_cell(double x, double y) {
  double column = __builtin_floor(x);
  return (column >= 0.0 && column < 7.0 ? column : 7.0) + 8.0 * __builtin_floor(y);
}

/* The face that a cell of the cross shows, in the row's order; -1: none. */
static inline double vl_cube_face_of_cross(double column, double row) {
  double middle = column < 0.5 ? 1.0 : column < 1.5 ? 4.0 : column < 2.5 ? 0.0 : 5.0;
  middle = column <= 3.0 ? middle : -1.0;
  double upper = column == 1.0 ? 2.0 : -1.0;
  double lower = column == 1.0 ? 3.0 : -1.0;
  double other = row == 0.0 ? upper : row == 2.0 ? lower : -1.0;
  return row == 1.0 ? middle : other;
}

VL_INLINE vlDirection vl_unproject_cube(VL_UNPROJECT_INPUT) {
  double cross = c->shape[0], over = c->over_y;
  double row = __builtin_floor(0.125 * cell), column = cell - 8.0 * row;
  double face = cross > 0.0 ? vl_cube_face_of_cross(column, row) : column;
  double top = cross > 0.0 ? row : 0.0;
  /* the place on the face, -1 to 1: to the right and downwards */
  double a = 2.0 * (x - column) - 1.0, b = 2.0 * (y - top) - 1.0;
  int right = face < 0.5, left = face == 1.0, up = face == 2.0;
  int down = face == 3.0, back = face > 4.5;
  double dx = right ? 1.0 : left ? -1.0 : back ? -a : a;
  double dy = up ? -1.0 : down ? 1.0 : b;
  double dz = right ? -a : left ? a : up ? b : 1.0;
  dz = down ? -b : back ? -1.0 : dz;
  double inside = b >= -1.0 - 2.0 * over && b <= 1.0 + 2.0 * over ? 1.0 : 0.0;
  return (vlDirection){dx, dy, dz, face >= 0.0 && face <= 5.0 ? inside : 0.0};
}

VL_INLINE vlPlanePoint vl_project_cube(VL_PROJECT_INPUT) {
  double cross = c->shape[0];
  double ax = __builtin_fabs(x), ay = __builtin_fabs(y), az = __builtin_fabs(z);
  int side = ax >= ay && ax > az, pole = !side && ay > az;
  double major = side ? ax : pole ? ay : az, k = 1.0 / vl_not_tiny(major);
  double of_sides = x > 0.0 ? 0.0 : 1.0, of_poles = y < 0.0 ? 2.0 : 3.0;
  double face = side ? of_sides : pole ? of_poles : z > 0.0 ? 4.0 : 5.0;
  double on_side = x > 0.0 ? -z : z, ahead = z > 0.0 ? x : -x;
  double a = side ? on_side : pole ? x : ahead;
  double b = pole ? (y < 0.0 ? z : -z) : y;
  double column = side ? (x > 0.0 ? 2.0 : 0.0) : pole || z > 0.0 ? 1.0 : 3.0;
  double row = pole ? (y < 0.0 ? 0.0 : 2.0) : 1.0;
  column = cross > 0.0 ? column : face;
  row = cross > 0.0 ? row : 0.0;
  return (vlPlanePoint){column + 0.5 * (a * k + 1.0), row + 0.5 * (b * k + 1.0),
                        major > 0.0 ? 1.0 : 0.0};
}

/* On its face a point is (a, b) / (2 major), each a coordinate but for its sign. */
VL_INLINE vlPlaneDerivatives vl_derive_cube(VL_PROJECT_INPUT) {
  double ax = __builtin_fabs(x), ay = __builtin_fabs(y), az = __builtin_fabs(z);
  int side = ax >= ay && ax > az, pole = !side && ay > az;
  double sx = x > 0.0 ? 1.0 : -1.0, sy = y < 0.0 ? -1.0 : 1.0, sz = z > 0.0 ? 1.0 : -1.0;
  const double major[3] = {side ? sx : 0.0, pole ? sy : 0.0, side || pole ? 0.0 : sz};
  const double a[3] = {side ? 0.0 : pole ? 1.0 : sz, 0.0, side ? -sx : 0.0};
  const double b[3] = {0.0, pole ? 0.0 : 1.0, pole ? -sy : 0.0};
  double k = 1.0 / (major[0] * x + major[1] * y + major[2] * z);
  double u = (a[0] * x + a[2] * z) * k, v = (b[1] * y + b[2] * z) * k;
  vlPlaneDerivatives d = {{0.0}, {0.0}};
  for (int i = 0; i < 3; i++) {
    d.x[i] = 0.5 * k * (a[i] - u * major[i]);
    d.y[i] = 0.5 * k * (b[i] - v * major[i]);
  }
  return d;
}

#endif
