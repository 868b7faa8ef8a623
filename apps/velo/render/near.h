/* render/near.h: models that lie far from the origin, as those in the coordinates of a survey
 * do. Single precision loses their detail there, so they are moved for an image that velo's
 * own camera takes. */
#ifndef APP_RENDER_NEAR_H
#define APP_RENDER_NEAR_H

#include "cli/options.h"
#include "render/scene_opening.h"

/* Whether the command writes images alone: files of display values, without data that have
 * positions in the scene. */
bool near_is_allowed(const Arguments *arguments);
/* Moves a completed scene and its camera, where an added camera frames something far from the
 * origin, and reports it. Where it may not (opening->images_only), it reports what is lost.
 * path: of the scene. Returns -1, or the exit code after reporting the error. */
int near_move(vlScene *scene, const char *path, SceneOpening *opening);

#endif
