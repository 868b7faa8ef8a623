/* camera/paths.h: the paths of one pixel, with what its centre sees: traced, ordered, written
 * as text or JSON. Shared by `velo camera paths` and `velo view`. */
#ifndef APP_CAMERA_PATHS_H
#define APP_CAMERA_PATHS_H

#include "cli/json.h"
#include "velo/paths.h"

/* Which paths. */
typedef struct PathsRequest {
  const vlWorld *world;
  const vlCamera *camera;
  const vlFilmDef *film;     /* its crop is not used */
  const vlRenderDef *render; /* its cancel and priority hold for all of it */
  uint32_t pixel[2], first, count;
  bool by_sample; /* order: by sample, else the largest share of the pixel first */
} PathsRequest;

/* What was traced. */
typedef struct TracedPaths {
  vlPixelPaths *paths;
  vlImage *channels, *ids; /* ground truth at the pixel's centre */
  uint32_t *order;         /* indices of the paths */
} TracedPaths;

/* Traces. The caller frees *traced in any case. */
vlResult paths_trace(const PathsRequest *request, TracedPaths *traced, vlError *error);
void paths_free(TracedPaths *traced);

/* What is written. */
typedef struct PathsReport {
  const char *file;
  const vlWorld *world;
  const TracedPaths *traced;
  uint32_t shown; /* number of paths that are written, the first ones of the order */
} PathsReport;

/* The luminance of a path's share of the pixel, without the division by the sum of weights. */
double paths_share(const vlPath *path);
void paths_print_text(const PathsReport *report);
/* Writes the members of a JSON object. */
void paths_put_json(Json *json, const PathsReport *report);

#endif
