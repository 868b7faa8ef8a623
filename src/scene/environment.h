/* scene/environment.h: light from all around: built-in rooms and images. */
#ifndef SCENE_ENVIRONMENT_H
#define SCENE_ENVIRONMENT_H

#include "scene/scene.h"

/* Adds the light; kind is not AUTO or NONE. False: the scene has the error. */
bool vl_scene_add_environment(vlScene *scene, const vlCompleteDef *def, vlEnvironmentKind kind);
/* The world's axes: right, up, front, each of unit length. False: up and front are zero or parallel. */
bool vl_scene_axes(const vlCompleteDef *def, double right[3], double up[3], double front[3]);

#endif
