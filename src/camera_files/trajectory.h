/* camera_files/trajectory.h: types and functions that the trajectory readers share. */
#ifndef CAMERA_FILES_TRAJECTORY_H
#define CAMERA_FILES_TRAJECTORY_H

#include "camera_files/files.h"
#include "velo/trajectory.h"

typedef struct vlStoredFrame {
  double pose[12]; /* world from camera, three rows */
  double time;
  size_t name; /* offset of the frame's name in the list of names */
  int32_t camera;
  uint32_t line;
} vlStoredFrame;

struct vlTrajectory {
  vlContext *context;
  VL_ARRAY(vlStoredFrame) frames;
  VL_ARRAY(vlCameraRecord) cameras;
  VL_ARRAY(char) names;
};

/* A frame's location for messages: the file (if it is not the opened one), the line and the
 * frame. */
typedef struct vlFrameLocation {
  const char *path;
  uint32_t line, frame;
  const char *name;
} vlFrameLocation;

vlResult vl_frame_wrong(const vlCameraFile *file, const vlFrameLocation *location,
                        const char *format, ...) VL_PRINTF(3, 4);
/* A record to be read from a file of the dialect. */
void vl_trajectory_begin(vlCameraDialect dialect, vlCameraRecord *record);
/* Finds a camera that is equal to this one except for pose and name, or adds this one. *index
 * is its index. */
vlResult vl_trajectory_add_camera(vlTrajectory *t, const vlCameraFile *file,
                                  const vlCameraRecord *record, int32_t *index);
/* Checks a frame's pose and adds the frame. */
vlResult vl_trajectory_add(vlTrajectory *t, const vlCameraFile *file,
                           const vlFrameLocation *location, int32_t camera,
                           const double world_from_camera[16], double time);

/* Reads one frame of transforms.json (nerf.c). */
vlResult vl_camera_read_nerf_frame(const vlCameraFile *file, const json_t *frame,
                                   const json_t *tree, vlCameraRecord *record);

vlResult vl_trajectory_read_csv(vlTrajectory *t, const vlCameraFile *file, char *text,
                                size_t size);
vlResult vl_trajectory_read_colmap(vlTrajectory *t, const vlCameraFile *file);
/* Returns whether a path ends in the name of a file of a COLMAP model. Defined in colmap.c. */
bool vl_colmap_is_name(const char *path);
vlResult vl_trajectory_read_nerf(vlTrajectory *t, const vlCameraFile *file, const json_t *tree,
                                 const char *text);
vlResult vl_trajectory_read_kalibr(vlTrajectory *t, const vlCameraFile *file,
                                   const json_t *tree);
vlResult vl_trajectory_read_opencv(vlTrajectory *t, const vlCameraFile *file,
                                   const json_t *tree, const char *text);

#endif
