/* camera/paths.h: output of `velo camera paths`. */
#ifndef APP_CAMERA_PATHS_H
#define APP_CAMERA_PATHS_H

#include "velo/velo.h"

/* What is printed. */
typedef struct PathsReport {
  const char *file;
  const vlWorld *world;
  const vlPixelPaths *paths;
  const uint32_t *order;         /* indices of the paths that are printed */
  uint32_t shown;                /* their number */
  const vlImage *channels, *ids; /* ground truth at the pixel's centre */
} PathsReport;

/* The luminance of a path's share of the pixel, without the division by the sum of weights. */
double paths_share(const vlPath *path);
void paths_print_text(const PathsReport *report);
void paths_print_json(const PathsReport *report);

#endif
