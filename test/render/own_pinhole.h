/* render/own_pinhole.h: a camera of one's own that is velo's perspective camera of the small
 * world (api/small_world.h). */
#ifndef TEST_RENDER_OWN_PINHOLE_H
#define TEST_RENDER_OWN_PINHOLE_H

#include "velo/own.h"

typedef struct Pinhole {
  double focal;
} Pinhole;

static void pinhole_rays(void *user, const vlOwnFilmPoints *points, const vlOwnRays *rays) {
  Pinhole *p = user;
  for (uint32_t i = 0; i < points->count; i++) {
    rays->dx[i] = points->x[i] - 0.5 * points->width;
    rays->dy[i] = points->y[i] - 0.5 * points->height;
    rays->dz[i] = p->focal;
  }
}

static void pinhole_pixels(void *user, const vlOwnSpacePoints *points) {
  const Pinhole *p = user;
  for (uint32_t i = 0; i < points->count; i++) {
    if (!(points->z[i] > 0))
      continue;
    points->film_x[i] = p->focal * points->x[i] / points->z[i] + 0.5 * points->width;
    points->film_y[i] = p->focal * points->y[i] / points->z[i] + 0.5 * points->height;
  }
}

static Pinhole of_small = {.focal = 40};
static const vlOwnCamera pinhole = {
    .name = "pinhole", .rays = pinhole_rays, .pixels = pinhole_pixels, .user = &of_small};

#endif
