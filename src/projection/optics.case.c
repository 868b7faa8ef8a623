/* projection/optics.case.c: what tests know of the optics projection. */
#include "projection/projection.case.h"

const ProjectionCase optics_projection = {
    .optics = true,
    .shape = NO_SHAPE,
};
