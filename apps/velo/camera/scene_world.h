/* camera/scene_world.h: a scene's world and camera, made as `velo render` makes them. */
#ifndef APP_CAMERA_SCENE_WORLD_H
#define APP_CAMERA_SCENE_WORLD_H

#include "render/job.h"
#include "render/scene_options.h"
#include "velo/world.h"

typedef struct SceneWorld {
  vlContext *context;
  vlScene *scene;
  vlWorld *world;
  Job job;
  SceneOpening opening;
} SceneWorld;

/* Loads the scene of the first operand and builds its world. Options that have no effect on
 * the scene are reported (render/needs.h). Returns -1, or the exit code after a report. */
int scene_world_build(SceneWorld *s, vlContext *context, const Arguments *arguments);
/* The same, and finds the focus; options that have no effect on the tracer are reported, too.
 */
int scene_world_open(SceneWorld *s, vlContext *context, const Arguments *arguments);
/* Frees all but the context, also what a failed scene_world_open has left. */
void scene_world_close(SceneWorld *s);

#endif
