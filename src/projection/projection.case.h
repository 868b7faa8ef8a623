/* projection/projection.case.h: what the tests of projections must know of a kind beyond its
 * row: a field of view, the solid angle of the image, and known radii. */
#ifndef PROJECTION_PROJECTION_CASE_H
#define PROJECTION_PROJECTION_CASE_H

#include <stdbool.h>

#include "velo/projection.h"

/* A direction at angle theta to the axis, towards +x, is this many focal lengths from the
 * centre. */
typedef struct ProjectionKnown {
  double theta, r;
} ProjectionKnown;

/* A direction at a longitude, towards +x, and a latitude, towards +y (down), radians, is seen
 * at this point of the plane. */
typedef struct ProjectionSeen {
  double longitude, latitude;
  double x, y; /* focal lengths from the principal point */
} ProjectionSeen;

typedef struct ProjectionCase {
  double fov;         /* degrees over the smaller side; 0: by fx */
  double focal;       /* fx = fy, pixels; 0: by fov or by the projection itself */
  double shape[2];    /* the projection's numbers; VL_UNSET: it has none, or the default */
  bool has_other;     /* `other`: another shape, of the other branches of the model */
  double other[2];    /* unused without has_other */
  bool optics;        /* the camera gets a lens of many elements */
  double solid_angle; /* of the whole image, steradians; 0: not known */
  ProjectionKnown known[2];
  ProjectionSeen seen; /* of projections that are not symmetric about the axis: required */
  double end; /* by fx: the angle to the axis, towards +x, up to which directions have film
                 points, radians; 0: not known */
} ProjectionCase;

#define NO_SHAPE \
  { VL_UNSET, VL_UNSET }
#define HALF_SQRT3 0.86602540378443865
#define CASE_PI 3.14159265358979323846

/* Declares the case of each kind, which is in the file of the kind: projection/NAME.case.c. */
#define PROJECTION_CASE(kind, name, row) extern const ProjectionCase name##_projection;
VL_PROJECTION_KINDS(PROJECTION_CASE)
#undef PROJECTION_CASE

#endif
