/* render/gbuffer.h: what pbrt's film "gbuffer" holds beside the image, under pbrt's names. */
#ifndef APP_RENDER_GBUFFER_H
#define APP_RENDER_GBUFFER_H

#include "render/job.h"

/* New image, after the render into film (with vlFilmDef.errors). In the space that the scene's gbuffer says.
 * STATUS_OK or the exit code. */
int gbuffer_render(vlContext *context, const vlWorld *world, const Job *job, const vlFilm *film, vlImage **image);

#endif
