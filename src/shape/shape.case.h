/* shape/shape.case.h: what the tests of shapes must know of a kind beyond its row: areas and
 * known hits (test/conformance/shapes.h), and cases of its parameters. */
#ifndef SHAPE_SHAPE_CASE_H
#define SHAPE_SHAPE_CASE_H

#include <math.h>
#include <stdbool.h>
#include <stdint.h>

#include "schema/parameter.case.h"
#include "velo/shape_kinds.h"

#define HALF_TURN 3.14159265358979323846

typedef struct ShapeKnown {
  double origin[3], direction[3]; /* a ray */
  double t;                       /* infinity: it hits nothing */
  double u, v;                    /* texture coordinates there; NaN: not known */
  double cosine; /* of the angle between the normal and the way back; 0: not known */
} ShapeKnown;

typedef struct ShapeVariant {
  const char *parameters; /* null ends the list */
  double area;
  double reach;        /* the shape is in the ball of this radius around the origin; 0: 1.12 */
  bool faces_rays;     /* the surface turns to each ray: no normals of its own */
  ShapeKnown known[3]; /* a direction of 0 ends the list */
} ShapeVariant;

enum { SHAPE_VARIANTS = 5 };
typedef struct ShapeCase {
  ShapeVariant variants[SHAPE_VARIANTS];
  ParameterCase parameters[PARAMETER_CASES];
} ShapeCase;

/* Values that meshes use: their corners, other corners, normals, texture coordinates. */
#define SQUARE "\"point3 P\" [-1 -1 0 1 -1 0 -1 1 0 1 1 .2]"
#define LIFTED "\"point3 P\" [-1 -1 0 1 -1 0 -1 1 0 .7 .6 .3]"
#define TURNED "\"normal N\" [.6 0 1 0 .6 1 -.6 0 1 0 0 1]"
#define UVS "\"point2 uv\" [0 0 .3 0 0 .7 .4 .9]"

/* Declares the case of each kind, which is in the file of the kind: shape/NAME.case.c. */
#define SHAPE_CASE(kind, name) extern const ShapeCase name##_shape;
VL_SHAPE_KINDS(SHAPE_CASE)
#undef SHAPE_CASE

#endif
