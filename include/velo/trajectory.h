/** @file
 * velo/trajectory.h: files of many poses and several cameras: trajectories, rigs, calibration views. docs/rigs.md says
 * what is read: COLMAP's models, transforms.json, Kalibr's camchains, OpenCV's calibrations with their views, CSV and
 * the plain lists of poses of TUM and KITTI; any other camera file is one frame. */
#ifndef VELO_TRAJECTORY_H
#define VELO_TRAJECTORY_H

#include "velo/camera_file.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef struct vlTrajectory vlTrajectory;

enum { VL_NO_CAMERA = -1 };

typedef struct vlTrajectoryFrame {
  const char *name; /**< of the image, as the file writes it; may be empty; lives as long as the trajectory */
  int32_t camera;   /**< for vl_trajectory_camera; VL_NO_CAMERA: the file gives a pose and no camera */
  uint32_t line;    /**< in the file, from 1; 0: not known */
  double world_from_camera[16]; /**< a rotation to 1e-3 and a place, checked; velo's axes */
  double time;                  /**< seconds; VL_UNSET: the file has none */
} vlTrajectoryFrame;

/** All frames of a file, in its order; def's `frame` is not read. Errors as of vl_camera_read; a pose that is not
 * finite or no rotation is SCENE, with the line where the file is text. */
VL_API vlResult vl_trajectory_load(vlContext *context, const char *path, const vlCameraFileDef *def,
                                   vlTrajectory **trajectory, vlError *error);
VL_API void vl_trajectory_destroy(vlTrajectory *trajectory);
/** At least 1. */
VL_API uint32_t vl_trajectory_frames(const vlTrajectory *trajectory);
VL_API vlResult vl_trajectory_frame(const vlTrajectory *trajectory, uint32_t index, vlTrajectoryFrame *frame);
/** Cameras that differ in more than their pose; 0 where the file holds poses only. The def's pose is that of the
 * camera's first frame. Null when there is no such camera. */
VL_API uint32_t vl_trajectory_cameras(const vlTrajectory *trajectory);
VL_API const vlCameraRecord *vl_trajectory_camera(const vlTrajectory *trajectory, uint32_t index);

#ifdef __cplusplus
}
#endif
#endif
