/* render/scene_options.h: options of `velo render` about the scene: the camera, time and
 * variant of a glTF file, and the camera or light that is added if the file has none. */
#ifndef APP_RENDER_SCENE_OPTIONS_H
#define APP_RENDER_SCENE_OPTIONS_H

#include "cli/options.h"
#include "render/scene_opening.h"
#include "velo/render.h"

/* Values of --walls. */
enum { WALLS_HIDE, WALLS_KEEP, WALLS_BOTH_SIDES };

/* The def of a render's context: that of context_def, with the instruction set and limits of
 * the options. */
vlContextDef scene_context_def(const Arguments *arguments);
/* Makes a scene of a file. Errors: those of vl_scene_create and vl_scene_load; *scene may be
 * there then, too. */
vlResult scene_read(vlContext *context, const char *path, const vlLoadDef *load,
                    vlScene **scene, vlError *error);
/* Loads the scene, completes it and turns its camera. Returns -1, or the exit code after
 * reporting the error. */
int scene_open(vlContext *context, const char *path, const Arguments *arguments,
               vlScene **scene, SceneOpening *opening);
/* Frees what is left of the opening once the world is built, or after an error. */
void scene_opening_close(SceneOpening *opening);
/* Turns the camera as it was opened as --turn asks. *defs: the scene's. */
void scene_turn(const SceneOpening *opening, const Arguments *arguments, vlSceneDefs *defs);
/* Reads --at T or --at T0:T1 where it is given. Returns -1 or the exit code. */
int scene_read_times(const OptionValue *at, vlLoadDef *load);
/* Sets the directions up and front for an axis (0: x) that points up. */
void scene_choose_up(int axis, vlCompleteDef *def);
/* Whether it is a glTF file, by its name. */
bool scene_is_gltf(const char *path);
/* Returns whether --camera names a camera of the scene. This requires that the scene is glTF
 * and that no file has that name. */
bool scene_camera_is_own(const char *path, const Arguments *arguments);

#endif
