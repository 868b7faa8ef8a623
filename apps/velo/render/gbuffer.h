/* render/gbuffer.h: the channels of pbrt's film "gbuffer", under pbrt's names. */
#ifndef APP_RENDER_GBUFFER_H
#define APP_RENDER_GBUFFER_H

#include "render/job.h"
#include "velo/render.h"

/* Makes the image after the render into `film`, whose def had `errors` set. Positions and
 * normals are in the coordinate system that the scene's gbuffer film names. Returns STATUS_OK
 * or the exit code. */
int gbuffer_render(const Job *job, const vlFilm *film, vlImage **image);

#endif
