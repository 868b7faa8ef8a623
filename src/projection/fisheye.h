/* projection/fisheye.h: what the fisheyes share. */
#ifndef PROJECTION_FISHEYE_H
#define PROJECTION_FISHEYE_H

/* 1 + cos(theta) for a unit direction, without cancellation near straight back. */
static inline double vl_one_plus_cosine(double x, double y, double z) {
  double back = (x * x + y * y) / (1.0 + __builtin_fabs(z));
  return z < 0.0 ? back : 1.0 + z;
}

#endif
