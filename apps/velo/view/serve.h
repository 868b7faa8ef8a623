/* view/serve.h: `velo render --serve`: the page of `velo view` without the steering. */
#ifndef APP_VIEW_SERVE_H
#define APP_VIEW_SERVE_H

#include "render/job.h"

typedef struct Serve Serve;

/* Starts the server and prints the address. view, exposure: of the first view. Returns -1 with
 * *serve, or the exit code after reporting the error. */
int serve_start(const Job *job, vlView view, float exposure, Serve **serve);
/* Shows the film to the pages, if there are any and the last time is long enough ago; after a
 * pass of the render. */
void serve_film(Serve *serve, const vlFilm *film, const vlProgress *progress);
/* Null is allowed. */
void serve_stop(Serve *serve);

#endif
