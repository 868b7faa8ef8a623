/* camera/poses.h: the cameras of a trajectory or rig as a string of cameras: what `velo camera
 * draw` and `velo view` draw of them. */
#ifndef APP_CAMERA_POSES_H
#define APP_CAMERA_POSES_H

#include "velo/camera.h"

/* The largest number of cameras that are drawn; of longer trajectories every n-th pose is. */
enum { MAX_CAMERAS = 200 };

/* Reads the file. Poses without a camera have `base`. *cameras is for the caller to free; on
 * errors, too. */
vlResult poses_load(vlContext *context, const char *path, const vlCamera *base,
                    vlCamera **cameras, uint32_t *count, vlError *error);
/* Distance at which their view planes are drawn; 0 if all stand at the same point. */
double poses_plane(const vlCamera *cameras, uint32_t count);

#endif
