/* view/camera_edit.h: edits of a camera by its fields, in any of its equivalent spellings, and
 * all spellings of a camera. The last edited spelling is the one that the def keeps. */
#ifndef APP_VIEW_CAMERA_EDIT_H
#define APP_VIEW_CAMERA_EDIT_H

#include "cli/json.h"
#include "velo/camera.h"
#include "view/camera_pose.h"
#include "view/message.h"

/* Applies the fields of a message. Errors: ARGUMENT: a field or value is refused; the error has
 * the message of vl_camera_make, or names the field. *result is unchanged then. warning: as
 * vl_camera_make's. */
vlResult camera_edit(const ViewCamera *now, const ViewMessage *message, ViewCamera *result,
                     const char **warning, vlError *error);
/* Replaces the focus of a camera by a distance. Errors as camera_edit. */
vlResult camera_set_focus(const ViewCamera *now, double distance, ViewCamera *result,
                          vlError *error);
/* Opens and closes the shutter at other times, in seconds. The poses of a moving camera keep
 * their times, and the image its brightness. Errors as camera_edit. */
vlResult camera_set_shutter(const ViewCamera *now, double open, double close,
                            ViewCamera *result, vlError *error);
/* The camera of a def whose image has the size of `made`. It keeps the def's spelling of the
 * focal length where it can. lookat: see CameraUnits. Errors as camera_edit. */
vlResult camera_take(const vlCameraDef *def, const vlCamera *made, double lookat,
                     ViewCamera *camera, vlError *error);

/* The f-number of the lens; NaN: it has no opening. */
double camera_f_number(const ViewCamera *camera);
/* Writes all spellings as members of the open JSON object. */
void camera_spellings(Json *json, const ViewCamera *camera);
#endif
