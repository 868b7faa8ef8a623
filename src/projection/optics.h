/* projection/optics.h: a lens of many elements has no projection: camera/optics.hot.c traces
 * its rays. These functions only fill the tables. */
#ifndef PROJECTION_OPTICS_H
#define PROJECTION_OPTICS_H

#include "projection/functions.h"

VL_PROJECTION_FUNCTIONS(OPTICS, optics, ((vlDirection){x, y, 1.0, 0.0}),
                        ((vlPlanePoint){x, y, 0.0}))

#endif
