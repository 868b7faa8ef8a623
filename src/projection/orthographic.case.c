/* projection/orthographic.case.c: what tests know of the orthographic projection. */
#include "projection/projection.case.h"

const ProjectionCase orthographic_projection = {
    .focal = 20,
    .shape = NO_SHAPE,
};
