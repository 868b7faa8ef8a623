/* camera/kinds.h: properties of each projection, one row per kind. Its functions are in projection.h. */
#ifndef CAMERA_KINDS_H
#define CAMERA_KINDS_H

#include "velo/camera.h"

enum {
  VL_PROJECTION_AHEAD = 1,      /* cannot look back: planes of constant z cut and focus, not spheres around the eye */
  VL_PROJECTION_FISHEYE = 2,    /* 180 degrees across the smaller side where nothing is given */
  VL_PROJECTION_CIRCLE = 4,     /* may have an image circle, max_angle */
  VL_PROJECTION_CALIBRATED = 8, /* models a real lens: the share of the image that sees nothing is reported */
  VL_PROJECTION_RADIAL = 16,    /* symmetric about the axis: a diagonal fov has a meaning */
  VL_PROJECTION_STRETCHED = 32, /* fills any image, whatever its sides */
  VL_PROJECTION_NO_FOV = 64,
  VL_PROJECTION_NO_DISTORTION = 128
};

/* One of vlCameraDef.shape. */
typedef struct vlShapeNumber {
  const char *name;
  double least, most; /* both allowed: beyond them the equations have no meaning, or no precision */
  double standard;    /* unset: must be given */
} vlShapeNumber;

typedef struct vlProjectionRow {
  const char *name; /* for people */
  const char *key;  /* in velo's JSON; null: files of that kind cannot have it */
  uint32_t traits;
  uint32_t count; /* of numbers */
  vlShapeNumber numbers[2];
  double limit; /* radius of the plane beyond which it ends; 0: none */
  /* The angle of the pixel at the centre by that of a pixel at focal length; shape as compiled. Null: 1. */
  double (*spread)(const double shape[2]);
  /* fx, fy in pixels where nothing is given. Null: 90 degrees across the smaller side, of fisheyes 180. */
  void (*standard_focal)(const vlCameraDef *def, const vlCamera *camera, double focal[2]);
} vlProjectionRow;

/* Defines the row of a kind, which must be in the list. */
#define VL_PROJECTION_ROW(NAME, variable, ...)                                \
  _Static_assert(VL_PROJECTION_##NAME >= 0, "a kind of VL_PROJECTION_KINDS"); \
  const vlProjectionRow vl_projection_##variable = {__VA_ARGS__}

/* Each kind's row: those of kinds.c, or of a file of its own. */
#define VL_PROJECTION_DECLARE(NAME, name) extern const vlProjectionRow vl_projection_##name;
VL_PROJECTION_KINDS(VL_PROJECTION_DECLARE)
#undef VL_PROJECTION_DECLARE

/* Null: there is no such kind. */
const vlProjectionRow *vl_projection_row(vlProjection kind);

#endif
