/* projection/stereographic.case.c: what tests know of the stereographic projection. */
#include "projection/projection.case.h"

const ProjectionCase stereographic_projection = {
    .fov = 180,
    .shape = NO_SHAPE,
    .solid_angle = 2 * CASE_PI,
    .known = {{CASE_PI / 3, 1.1547005383792515}, {-CASE_PI / 3, -1.1547005383792515}},
    .end = CASE_PI,
};
