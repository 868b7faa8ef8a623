/* render/turn.h: --turn: a camera that goes around the scene. */
#ifndef APP_RENDER_TURN_H
#define APP_RENDER_TURN_H

#include "velo/camera.h"

/* Turns a camera about the axis `up` through the middle of the scene's bounds. automatic: the
 * camera was made for the scene; then it keeps a distance at which every angle shows all of the
 * scene. */
void turn_camera(vlCameraDef *camera, const double low[3], const double high[3], bool automatic,
                 const double up[3], double degrees);

#endif
