/** @file
 * velo/trajectory.h: reads files of many poses and several cameras: trajectories, rigs,
 * calibration views. docs/rigs.md lists the formats: COLMAP's models, transforms.json, Kalibr's
 * camchains, OpenCV's calibrations with their views, CSV and the plain lists of poses of TUM
 * and KITTI; any other camera file is one frame. */
#ifndef VELO_TRAJECTORY_H
#define VELO_TRAJECTORY_H

#include "velo/camera_file.h"

#ifdef __cplusplus
extern "C" {
#endif

/** The frames and cameras of a file. Constant once loaded. */
typedef struct vlTrajectory vlTrajectory;

/** Value of vlTrajectoryFrame.camera for a pose without a camera. */
enum { VL_NO_CAMERA = -1 };

/** One pose of a trajectory. */
typedef struct vlTrajectoryFrame {
  const char *name; /**< name of the image, as the file writes it; may be empty; lives as long
                       as the trajectory */
  /** index for vl_trajectory_camera; VL_NO_CAMERA: the file gives a pose only */
  int32_t camera;
  uint32_t line;                /**< line in the file, from 1; 0: not known */
  double world_from_camera[16]; /**< a rotation (checked to 1e-3) and a translation; velo's
                                   axes, scene units */
  double time;                  /**< seconds; VL_UNSET: the file gives none */
} vlTrajectoryFrame;

/** Reads all frames of a file, in its order; def may be null, its `frame` is ignored. Errors as
 * vl_camera_read; SCENE also for a pose that is not finite or not a rotation, with the line
 * where the file is text. */
VL_API vlResult vl_trajectory_load(vlContext *context, const char *path,
                                   const vlCameraFileDef *def, vlTrajectory **trajectory,
                                   vlError *error);
/** Null is allowed. */
VL_API void vl_trajectory_destroy(vlTrajectory *trajectory);
/** The number of frames, at least 1. */
VL_API uint32_t vl_trajectory_frames(const vlTrajectory *trajectory);
/** Frame `index`, from 0. ARGUMENT when there is no such frame. */
VL_API vlResult vl_trajectory_frame(const vlTrajectory *trajectory, uint32_t index,
                                    vlTrajectoryFrame *frame);
/** The number of different cameras; cameras that differ only in their pose count as one. 0: the
 * file holds only poses. */
VL_API uint32_t vl_trajectory_cameras(const vlTrajectory *trajectory);
/** Camera `index`, from 0; its pose is that of its first frame. Lives as long as the
 * trajectory; null past the end. */
VL_API const vlCameraRecord *vl_trajectory_camera(const vlTrajectory *trajectory,
                                                  uint32_t index);

#ifdef __cplusplus
}
#endif
#endif
