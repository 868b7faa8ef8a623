/* projection/projection.row.h: for the files that hold rows of projections. MODEL stands for
 * the parameters that all have. */
#ifndef PROJECTION_PROJECTION_ROW_H
#define PROJECTION_PROJECTION_ROW_H

#include "projection/properties.row.h"
#include "schema/camera_parameters.h"

/* The image shows -1 to 1 along its smaller side: for a perspective camera 90 degrees. */
void vl_projection_half_side(const vlCameraDef *def, const vlCamera *camera, double focal[2]);

#define FISHEYE VL_PROJECTION_FISHEYE | VL_PROJECTION_CIRCLE | VL_PROJECTION_RADIAL
#define CALIBRATED VL_PROJECTION_CALIBRATED | VL_PROJECTION_CIRCLE | VL_PROJECTION_RADIAL
/* A parameter of the projection: a number of vlCameraDef.shape. */
#define SHAPE(name, index, line, ...) OPTIONAL(name, shape[index], line, __VA_ARGS__)

#endif
