/* import/far.h: meshes that lie far from the origin, as those in the coordinates of a survey
 * do. Single precision holds their vertices about a point near them, which the shape's
 * transform adds. */
#ifndef IMPORT_FAR_H
#define IMPORT_FAR_H

#include "math/extent.h"
#include "velo/shape.h"

/* Coordinates below this lose nothing that is seen. */
static const double VL_MIN_FAR = 1000;

/* The point about which vertices in a box are stored: whole numbers near its middle, or 0 on
 * all axes: the box is not far from the origin, compared with its size. Returns whether it is
 * far. */
bool vl_far_origin(const vlExtent *box, double origin[3]);
/* The same, of vertices. */
bool vl_far_vertices(const float *positions, size_t vertices, double origin[3]);
/* Grows a box by vertices, of which those that are not numbers do not count. */
void vl_grow_box(const float *positions, size_t vertices, vlExtent *box);
/* Moves a shape, which has no transform yet, to the point. */
void vl_far_place(const double origin[3], vlShapeDef *shape);

#endif
