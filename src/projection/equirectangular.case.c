/* projection/equirectangular.case.c: what tests know of the equirectangular projection. */
#include "projection/projection.case.h"

const ProjectionCase equirectangular_projection = {
    .shape = NO_SHAPE,
    .solid_angle = 4 * CASE_PI,
    .known = {{CASE_PI / 3, CASE_PI / 3}, {-2.5, -2.5}},
    .end = CASE_PI,
    .seen = {.7, .4, 0.7, 0.4},
};
