/* projection/equal_area.case.c: what tests know of the equal area projection. */
#include "projection/projection.case.h"

const ProjectionCase equal_area_projection = {
    .shape = NO_SHAPE,
    .solid_angle = 4 * CASE_PI,
    .known = {{CASE_PI / 3, 0.70710678118654752}, {CASE_PI / 2 - 1e-12, 1}},
    .end = CASE_PI,
    .seen = {.7, .4, 0.342629130104, 0.201000978265},
};
