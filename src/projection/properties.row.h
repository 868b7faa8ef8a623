/* projection/properties.row.h: what a projection's row says of it to other code; the rows are
 * in the files of the kinds, projection/NAME.row.c. */
#ifndef PROJECTION_PROPERTIES_ROW_H
#define PROJECTION_PROPERTIES_ROW_H

#include "velo/camera.h"
#include "velo/schema.h"

enum {
  VL_PROJECTION_AHEAD = 1, /* sees only z > 0: near, far and focus surfaces are planes of
                              constant z, not spheres around the eye */
  VL_PROJECTION_FISHEYE =
      2, /* the default field of view is 180 degrees along the image's smaller side */
  VL_PROJECTION_CIRCLE = 4, /* the parameters image circle and max_angle are allowed */
  VL_PROJECTION_CALIBRATED =
      8, /* models a real lens: the share of pixels outside its domain is reported */
  VL_PROJECTION_RADIAL = 16, /* symmetric about the axis: a diagonal field of view is allowed */
  VL_PROJECTION_STRETCHED = 32, /* fills an image of any aspect ratio */
  VL_PROJECTION_NO_FOV = 64,
  VL_PROJECTION_NO_DISTORTION = 128
};

/* The range, default and names of one number of vlCameraDef.shape. */
typedef struct vlShapeNumber {
  const char *name;
  double min, max; /* inclusive range; outside it the equations are undefined or imprecise */
  double standard; /* default value; VL_UNSET if the number is required */
} vlShapeNumber;

typedef struct vlProjectionRow {
  /* name and parameters in scene files; without a name another camera has it */
  vlKindRow in_files;
  const char *name; /* name in messages */
  const char *key;  /* key in velo's JSON; null if a file cannot contain the number */
  uint32_t traits;
  uint32_t count; /* number of shape numbers */
  vlShapeNumber numbers[2];
  double limit; /* radius at which the plane ends; 0: no limit */
  /* Returns the angle of the central pixel divided by the angle of a pixel at the focal length.
   * shape: the compiled values. Null: the ratio is 1. */
  double (*spread)(const double shape[2]);
  /* Sets the default fx, fy in pixels. Null: the default field of view along the smaller side,
   * 90 degrees (180 for fisheyes). */
  void (*standard_focal)(const vlCameraDef *def, const vlCamera *camera, double focal[2]);
} vlProjectionRow;

/* Returns the row of a kind, or null for an unknown kind. */
const vlProjectionRow *vl_projection_row(vlProjection kind);

#endif
