/* camera_files/opencv.h: what OpenCV's camera files and ROS's share. */
#ifndef CAMERA_FILES_OPENCV_H
#define CAMERA_FILES_OPENCV_H

#include "camera_files/files.h"

/* [fx 0 cx; 0 fy cy; 0 0 1] of the first pixel's centre at (0, 0). */
vlResult vl_opencv_read_matrix(const vlCameraFile *file, const json_t *tree, const char *key, vlCameraDef *def);
/* The coefficients at a key, of the model that the tree names; without a name their number decides. */
vlResult vl_opencv_read_lens(const vlCameraFile *file, const json_t *tree, const char *key, vlCameraDef *def);
/* The coefficients to write, and whether the camera is a fisheye. */
vlResult vl_opencv_lens_of(const vlCameraFile *file, const vlCameraDef *def, double k[14], uint32_t *count,
                           bool *fisheye);
/* tagged: as FileStorage does. */
void vl_opencv_put_matrix(vlCameraText *text, const char *name, int rows, int columns, const double *data, bool tagged);

#endif
