/* projection/equidistant.case.c: what tests know of the equidistant projection. */
#include "projection/projection.case.h"

const ProjectionCase equidistant_projection = {
    .fov = 180,
    .shape = NO_SHAPE,
    .solid_angle = 2 * CASE_PI,
    .known = {{CASE_PI / 3, CASE_PI / 3}, {-1.5, -1.5}},
    .end = CASE_PI,
};
