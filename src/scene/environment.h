/* scene/environment.h: environment lights: built-in ones and images. */
#ifndef SCENE_ENVIRONMENT_H
#define SCENE_ENVIRONMENT_H

#include "scene/scene.h"

/* Adds an environment light; its kind is neither AUTO nor NONE. False: the scene holds the
 * error. */
bool vl_scene_add_environment(vlScene *scene, const vlCompleteDef *def, vlEnvironmentKind kind);
/* Gives the directions right, up and front of the scene as unit vectors. False: up or front is
 * zero, or they are parallel. */
bool vl_scene_axes(const vlCompleteDef *def, double right[3], double up[3], double front[3]);

#endif
