/* view/camera_pose.h: a camera as described and as compiled, and its pose as the lecture spells
 * it: eye, lookat, up, roll. */
#ifndef APP_VIEW_CAMERA_POSE_H
#define APP_VIEW_CAMERA_POSE_H

#include "velo/camera.h"

/* What the spellings refer to that the def does not use. */
typedef struct CameraUnits {
  double zoom, pixel_size; /* of the lecture's spelling */
  double sensor_mm;        /* width of the sensor */
  double lookat;           /* distance of lookat from the eye, where the def has a matrix */
} CameraUnits;

/* A camera as described and as compiled, for an image of the same size. */
typedef struct ViewCamera {
  vlCameraDef def;
  vlCamera made;
  CameraUnits units;
} ViewCamera;

typedef struct CameraPose {
  double eye[3], lookat[3], up[3], roll; /* scene units; radians */
} CameraPose;

/* The pose of a camera. */
CameraPose camera_pose(const ViewCamera *camera);
/* Gives the def this pose. A pose that mirrors or scales keeps doing so: it stays a matrix. */
void camera_place(const ViewCamera *now, const CameraPose *pose, vlCameraDef *def);

/* From the eye to the point that it looks at. */
double camera_arm(const CameraPose *pose);

#endif
