/* distortion/opencv.row.c: the names of OpenCV's distortion, and how many coefficients it has.
 */
#include "distortion/distortion.row.h"

const vlDistortionRow vl_distortion_row_opencv = {
    .name = "opencv",
    .key = "opencv",
    .title = "OpenCV",
    .counts = 1u << 4 | 1u << 5 | 1u << 8 | 1u << 12 | 1u << 14,
    .how_many = "4, 5, 8, 12 or 14",
};
