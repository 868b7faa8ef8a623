/* render/near.h: models that lie far from the origin, as those in the coordinates of a survey
 * do. Single precision loses their detail there, so they are moved for an image that velo's
 * own camera takes. */
#ifndef APP_RENDER_NEAR_H
#define APP_RENDER_NEAR_H

#include "cli/options.h"
#include "velo/scene_base.h"

/* Whether the command writes images alone: files of display values, without data that have
 * positions in the scene. */
bool near_is_allowed(const Arguments *arguments);
/* A model that an added camera shows. */
typedef struct Near {
  const char *path;       /* of its file */
  bool images_only;       /* near_is_allowed */
  bool silent;            /* a move is not reported */
  double low[3], high[3]; /* what the camera frames; it moves along */
  double moved[3];        /* output: what was subtracted from all positions */
} Near;

/* Moves a completed scene and its camera, where the camera frames something far from the
 * origin, and reports it. Where it may not, it reports what is lost. Returns -1, or the exit
 * code after reporting the error. */
int near_move(vlScene *scene, Near *near);

#endif
