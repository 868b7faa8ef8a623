/* camera/camera.h: what the camera commands share. */
#ifndef APP_CAMERA_CAMERA_H
#define APP_CAMERA_CAMERA_H

#include "cli/options.h"
#include "velo/velo.h"

extern const Choice dialect_choices[];

/* Whether a name is a scene's (or its camera would be read as one). */
bool camera_is_scene(const char *path);
/* A camera file of any dialect, or a pbrt scene's camera. Says which frame is taken where there are several and none
 * was asked for. -1, or the exit code when all has been said. */
int camera_load(vlContext *context, const char *path, int dialect, const char *frame, vlCameraRecord *record);
/* The same, made; warnings are said. */
int camera_load_made(vlContext *context, const char *path, const Arguments *arguments, int frame_option,
                     vlCameraRecord *record, vlCamera *camera);

#endif
