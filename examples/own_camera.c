/* own_camera: a camera of one's own: a fisheye that sees half of all directions in the largest circle of the image
 * (docs/own-code.md). The scene's camera keeps its place and its size.
 *
 *   own_camera SCENE IMAGE
 *   build/release/bin/example_own_camera examples/corner.pbrt examples/own_camera.jpg
 */
#include <math.h>

#include "example.h"

static void rays_of(void *user, const vlOwnFilmPoints *points, const vlOwnRays *rays) {
  const double *widest = user; /* angle from the axis at the edge of the circle */
  double half = 0.5 * fmin(points->width, points->height);
  for (uint32_t i = 0; i < points->count; i++) {
    double x = (points->x[i] - 0.5 * points->width) / half, y = (points->y[i] - 0.5 * points->height) / half;
    double r = hypot(x, y), angle = r * *widest;
    if (r > 1) continue; /* no ray: black and transparent */
    rays->dx[i] = r > 0 ? sin(angle) * x / r : 0;
    rays->dy[i] = r > 0 ? sin(angle) * y / r : 0;
    rays->dz[i] = cos(angle);
  }
}

int main(int count, char **arguments) {
  static double right_angle = 1.5707963267948966;
  static const vlOwnCamera fisheye = {.name = "my fisheye", .rays = rays_of, .user = &right_angle};
  Example e = example_open(count, arguments, NULL);
  e.defs->camera.own = &fisheye;
  example_render(&e);
  example_write(&e, arguments[2]);
  return example_close(&e);
}
