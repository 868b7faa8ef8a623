/* camera/camera.h: declarations shared by the camera commands. */
#ifndef APP_CAMERA_CAMERA_H
#define APP_CAMERA_CAMERA_H

#include "cli/options.h"
#include "velo/camera_file.h"

/* The dialects of camera files: the list of an OPTION_KIND. */
extern const Choice dialects[];
/* Rows of options that several commands have. */
#define CAMERA_FILE_OPTION(id)                                                              \
  {                                                                                         \
    (id), "camera", "camera file in any dialect of `velo camera convert`, or a scene file", \
        OPTION_TEXT, "FILE"                                                                 \
  }
#define CAMERA_FRAME_OPTION(id)                                                        \
  {                                                                                    \
    (id), "frame", "camera to use, by name or number from 0, if the file has several", \
        OPTION_TEXT, "NAME"                                                            \
  }
#define CAMERA_SIZE_OPTION(id)                                                           \
  {                                                                                      \
    (id), "size", "image size for a file that does not give one", OPTION_SIZE, "WxH", 1, \
        1 << 24                                                                          \
  }

/* Returns whether the file's name is that of a scene, whose camera is then read. */
bool camera_is_scene(const char *path);
/* Reads a camera file of any dialect, or the camera of a pbrt scene. If a file has several
 * frames and none was chosen, a note names the frame that is used. size: the image size given
 * by --size; it is used for files without a size, and a file with another size is an error.
 * fallback: a size (--resolution) for files without a size, from which a file's own size may
 * differ. Both may be null or not given. Returns -1, or the exit code after reporting the
 * error. */
int camera_load(vlContext *context, const char *path, int dialect, const char *frame,
                const OptionValue *size, const OptionValue *fallback, vlCameraRecord *record);
/* Reports the fields that velo does not understand, if there are any: the first names, and how
 * many more there are. record: may be null. */
void camera_note_unread(const char *path, const vlCameraRecord *record);
/* Like camera_load, and also makes the camera. Reports warnings. */
int camera_load_made(vlContext *context, const char *path, const Arguments *arguments,
                     int frame_option, int size_option, vlCameraRecord *record,
                     vlCamera *camera);
/* The angle between the rays of two points of the film, radians; NaN: one has none. */
double camera_angle(const vlCamera *c, double x0, double y0, double x1, double y1);
/* The solid angle that the image sees, steradians; 0 for orthographic cameras. Its relative
 * error is about 1e-5, and up to 1e-3 where the view ends within the image. A moving camera has
 * the pose of the middle of its exposure. */
double camera_image_angle(const vlCamera *camera);

#endif
