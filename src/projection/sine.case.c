/* projection/sine.case.c: what tests know of the sine projection. */
#include "projection/projection.case.h"

const ProjectionCase sine_projection = {
    .fov = 180,
    .shape = NO_SHAPE,
    .known = {{CASE_PI / 3, HALF_SQRT3}, {-CASE_PI / 6, -.5}},
    .end = CASE_PI / 2,
};
