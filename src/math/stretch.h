/* math/stretch.h: how a linear map changes solid angles around the origin: not at all, or by a
 * factor that depends on the direction where it is skewed or scales axes differently. */
#ifndef MATH_STRETCH_H
#define MATH_STRETCH_H

#include "math/transform.h"

typedef struct vlStretch {
  vlMat4 map;
  bool is_skewed; /* not a rotation, mirroring and scaling by one number, to rounding */
} vlStretch;

vlStretch vl_stretch(const double map[16]);
/* Solid angle after the map per solid angle before it, around a direction (unit, before the
 * map). 1 without skew. */
double vl_stretch_at(const vlStretch *stretch, const double direction[3]);

#endif
