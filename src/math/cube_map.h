/* math/cube_map.h: directions and the faces of a cube map, in the order and with the axes of
 * OpenGL: +x -x +y -y +z -z. */
#ifndef VL_MATH_CUBE_MAP_H
#define VL_MATH_CUBE_MAP_H

#include <stdint.h>

#include "math/vec.h"

/* The direction of a point (s, t) in [-1, 1] of a face; not normalized. */
static inline vlVec3 vl_cube_map_direction(uint32_t face, float s, float t) {
  const vlVec3 d[6] = {{1, -t, -s}, {-1, -t, s}, {s, 1, t},
                       {s, -1, -t}, {s, -t, 1},  {-s, -t, -1}};
  return d[face];
}

/* The face that direction d meets, and the point (*s, *t) of it. */
static inline uint32_t vl_cube_map_face(vlVec3 d, float *s, float *t) {
  float x = vl_abs(d.x), y = vl_abs(d.y), z = vl_abs(d.z), m;
  uint32_t face;
  if (x >= y && x >= z) {
    face = d.x < 0;
    m = x;
    *s = face ? d.z : -d.z;
    *t = -d.y;
  } else if (y >= z) {
    face = 2 + (d.y < 0);
    m = y;
    *s = d.x;
    *t = face == 2 ? d.z : -d.z;
  } else {
    face = 4 + (d.z < 0);
    m = z;
    *s = face == 4 ? d.x : -d.x;
    *t = -d.y;
  }
  *s /= m;
  *t /= m;
  return face;
}

#endif
