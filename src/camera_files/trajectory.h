/* camera_files/trajectory.h: what the readers of many frames fill. */
#ifndef CAMERA_FILES_TRAJECTORY_H
#define CAMERA_FILES_TRAJECTORY_H

#include "camera_files/files.h"
#include "velo/trajectory.h"

typedef struct vlStoredFrame {
  double pose[12]; /* world from camera, three rows */
  double time;
  size_t name; /* where it starts among the names */
  int32_t camera;
  uint32_t line;
} vlStoredFrame;

struct vlTrajectory {
  vlContext *context;
  VL_ARRAY(vlStoredFrame) frames;
  VL_ARRAY(vlCameraRecord) cameras;
  VL_ARRAY(char) names;
};

/* A place in the file for messages: its name where it is not the file that was asked for, the line, which frame. */
typedef struct vlFramePlace {
  const char *path;
  uint32_t line, frame;
  const char *name;
} vlFramePlace;

vlResult vl_frame_wrong(const vlCameraFile *file, const vlFramePlace *place, const char *format, ...)
    __attribute__((format(printf, 3, 4)));
/* *index of a camera like this but for its pose and name: the last one, or a new one. */
vlResult vl_trajectory_add_camera(vlTrajectory *t, const vlCameraFile *file, const vlCameraRecord *record,
                                  int32_t *index);
/* Checks the pose. */
vlResult vl_trajectory_add(vlTrajectory *t, const vlCameraFile *file, const vlFramePlace *place, int32_t camera,
                           const double world_from_camera[16], double time);

/* One frame of transforms.json (nerf.c). */
vlResult vl_camera_read_nerf_frame(const vlCameraFile *file, const json_t *frame, const json_t *tree,
                                   vlCameraRecord *record);

vlResult vl_trajectory_read_csv(vlTrajectory *t, const vlCameraFile *file, char *text, size_t size);
vlResult vl_trajectory_read_colmap(vlTrajectory *t, const vlCameraFile *file);
vlResult vl_trajectory_read_nerf(vlTrajectory *t, const vlCameraFile *file, const json_t *tree, const char *text);
vlResult vl_trajectory_read_kalibr(vlTrajectory *t, const vlCameraFile *file, const json_t *tree);
vlResult vl_trajectory_read_opencv(vlTrajectory *t, const vlCameraFile *file, const json_t *tree, const char *text);

#endif
