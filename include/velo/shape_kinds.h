/** @file
 * velo/shape_kinds.h: shapes: their kinds. */
#ifndef VELO_SHAPE_KINDS_H
#define VELO_SHAPE_KINDS_H

#include "velo/shape.h"

#ifdef __cplusplus
extern "C" {
#endif

/** X(kind, name) for each kind of shape. velo/schema.h describes the kinds and their
 * parameters. Curves are cubic Bezier segments with a width, for hair, fur and grass. */
#define VL_SHAPE_KINDS(X)          \
  X(VL_SHAPE_TRIANGLES, triangles) \
  X(VL_SHAPE_BILINEAR, bilinear)   \
  X(VL_SHAPE_SPHERE, sphere)       \
  X(VL_SHAPE_DISK, disk)           \
  X(VL_SHAPE_CYLINDER, cylinder)   \
  X(VL_SHAPE_CURVES, curves)
/** The kinds of shapes: VL_SHAPE_TRIANGLES and so on, from VL_SHAPE_KINDS. */
typedef enum vlShapeKind {
#define VL_KIND(kind, name) kind,
  VL_SHAPE_KINDS(VL_KIND)
#undef VL_KIND
} vlShapeKind;
/** The default def of a kind. */
VL_API vlShapeDef vl_default_shape_def(vlShapeKind kind);

#ifdef __cplusplus
}
#endif
#endif
