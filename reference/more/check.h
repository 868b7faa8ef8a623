/* more/check.h: what this renderer has. */
#pragma once
#include <velo/velo.h>

/* Whether the renderer has all that a scene asks for; else an error with the name and the place of the first thing that
 * it does not have. */
bool check_scene(vlContext *context, vlScene *scene, const vlCamera *camera, vlError *error);
