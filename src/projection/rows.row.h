/* projection/rows.row.h: the rows of all projections, each in the file of its kind,
 * projection/NAME.row.c. */
#ifndef PROJECTION_ROWS_ROW_H
#define PROJECTION_ROWS_ROW_H

#include "projection/projection.row.h"
#include "velo/projection.h"

#define VL_PROJECTION_ROW(kind, name, row) extern const vlProjectionRow row;
VL_PROJECTION_KINDS(VL_PROJECTION_ROW)
#undef VL_PROJECTION_ROW

#endif
