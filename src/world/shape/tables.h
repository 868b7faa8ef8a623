/* world/shape/tables.h: the table of functions of each kind of shape (kinds.h says what they
 * do). */
#ifndef WORLD_SHAPE_TABLES_H
#define WORLD_SHAPE_TABLES_H

#include "velo/shape.h"
#include "world/shape/kinds.h"

/* Declares the table of every kind. A missing table is a link error. */
#define VL_SHAPE_DECLARE(K, k) extern const vlShapeFunctions vl_shape_functions_##k;
VL_SHAPE_KINDS(VL_SHAPE_DECLARE)
#undef VL_SHAPE_DECLARE

#endif
