/* more/cameras.c: the cameras of more/. */
#include "more.h"
#include "refuse.h"

bool check_more_camera(const vlCamera *c, vlSource source, vlError *error) {
  (void)c;
  return refuse(error, source, "this camera");
}

bool more_camera_ray(const vlCamera *c, double x, double y, sampler *s, ray *r) {
  (void)c;
  (void)x;
  (void)y;
  (void)s;
  (void)r;
  return false;
}
