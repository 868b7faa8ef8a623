/* camera/poses.c: see poses.h. */
#include "camera/poses.h"
#include "cli/macros.h"
#include "velo/trajectory.h"

#include <math.h>
#include <stdlib.h>

vlResult poses_load(vlContext *context, const char *path, const vlCamera *base,
                    vlCamera **cameras, uint32_t *count, vlError *error) {
  vlTrajectory *trajectory = NULL;
  *cameras = NULL;
  *count = 0;
  TRY_RESULT(vl_trajectory_load(context, path, NULL, &trajectory, error));
  uint32_t frames = vl_trajectory_frames(trajectory),
           every = (frames + MAX_CAMERAS - 1) / MAX_CAMERAS;
  *cameras = calloc((frames + every - 1) / every, sizeof **cameras);
  vlResult result = *cameras ? VL_OK : VL_ERROR_MEMORY;
  for (uint32_t i = 0; result == VL_OK && i < frames; i += every) {
    vlTrajectoryFrame frame;
    vlCamera camera = *base;
    result = vl_trajectory_frame(trajectory, i, &frame);
    if (result == VL_OK && frame.camera != VL_NO_CAMERA)
      result = vl_camera_make(&vl_trajectory_camera(trajectory, (uint32_t)frame.camera)->camera,
                              &camera, NULL, error);
    if (result == VL_OK)
      result = vl_camera_move(&camera, frame.world_from_camera, &(*cameras)[(*count)++], error);
  }
  vl_trajectory_destroy(trajectory);
  return result;
}

double poses_plane(const vlCamera *cameras, uint32_t count) {
  double low[3] = {INFINITY, INFINITY, INFINITY}, high[3] = {-INFINITY, -INFINITY, -INFINITY},
         size = 0;
  for (uint32_t i = 0; i < count; i++)
    for (int k = 0; k < 3; k++) {
      low[k] = fmin(low[k], cameras[i].world_from_camera[4 * k + 3]);
      high[k] = fmax(high[k], cameras[i].world_from_camera[4 * k + 3]);
    }
  for (int k = 0; k < 3 && count; k++)
    size = hypot(size, high[k] - low[k]);
  return 0.07 * size; /* they look like cameras along a way, and do not cover each other */
}
