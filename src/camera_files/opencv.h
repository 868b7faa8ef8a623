/* camera_files/opencv.h: functions shared by OpenCV's and ROS's camera files. */
#ifndef CAMERA_FILES_OPENCV_H
#define CAMERA_FILES_OPENCV_H

#include "camera_files/files.h"

/* Reads the matrix [fx 0 cx; 0 fy cy; 0 0 1], for which the centre of the first pixel is (0,
 * 0). */
vlResult vl_opencv_read_matrix(const vlCameraFile *file, const json_t *tree, const char *key,
                               vlCameraDef *def);
/* Reads the coefficients at a key. The tree names their model; without a name, the number of
 * coefficients decides. */
vlResult vl_opencv_read_lens(const vlCameraFile *file, const json_t *tree, const char *key,
                             vlCameraDef *def);
/* ROS's binning and region of interest, with which matrix and size are not those of the image.
 * Refuses them. def: with the size. */
vlResult vl_opencv_refuse_part(const vlCameraFile *file, const json_t *tree,
                               const vlCameraDef *def);
/* Whether the name is that of a field of these files; whether it is that of a lens. */
bool vl_opencv_is_field(const char *name);
bool vl_opencv_is_lens(const char *name);
/* NumPy's archives of a calibration's matrix and coefficients (npz.c). */
bool vl_npz_is(const char *text, size_t size);
vlCameraReadText vl_npz_read;

#endif
