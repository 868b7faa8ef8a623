/* more/cameras.c: the cameras of more/. */
#include "more.h"

bool is_more_camera(const vlCamera *c) {
  (void)c;
  return false;
}

bool more_camera_ray(const vlCamera *c, double x, double y, sampler *s, ray *r) {
  (void)c;
  (void)x;
  (void)y;
  (void)s;
  (void)r;
  return false;
}
