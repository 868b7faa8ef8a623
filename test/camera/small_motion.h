/* camera/small_motion.h: a small motion of a camera, for differences of its pose. */
#ifndef TEST_CAMERA_SMALL_MOTION_H
#define TEST_CAMERA_SMALL_MOTION_H

#include <math.h>
#include <string.h>

/* exp((t, r)^) for one number of (t, r), a translation or a rotation about an axis, and its
 * inverse. */
static inline void small_motion(int which, double h, double e[16], double back[16]) {
  const double identity[16] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
  int a = (which + 1) % 3, b = (which + 2) % 3;
  memcpy(e, identity, sizeof identity);
  if (which < 3) {
    e[4 * which + 3] = h;
  } else {
    e[5 * a] = e[5 * b] = cos(h);
    e[4 * a + b] = -sin(h);
    e[4 * b + a] = sin(h);
  }
  memcpy(back, e, sizeof identity);
  for (int i = 0; i < 3; i++)
    for (int j = 0; j < 4; j++)
      back[4 * i + j] = j < 3 ? e[4 * j + i] : -e[4 * i + 3];
}

#endif
