/* camera/camera.h: declarations shared by the camera commands. */
#ifndef APP_CAMERA_CAMERA_H
#define APP_CAMERA_CAMERA_H

#include "cli/options.h"
#include "velo/velo.h"

extern const Choice dialect_choices[];

/* Whether the file is a scene by its name (or would be read as one for its camera). */
bool camera_is_scene(const char *path);
/* Reads a camera file of any dialect, or the camera of a pbrt scene. When a file has several frames and none was
 * chosen, a note names the one taken. Returns -1, or the exit code after reporting the error. */
int camera_load(vlContext *context, const char *path, int dialect, const char *frame, vlCameraRecord *record);
/* The same, and makes the camera; warnings are reported. */
int camera_load_made(vlContext *context, const char *path, const Arguments *arguments, int frame_option,
                     vlCameraRecord *record, vlCamera *camera);

#endif
