/* projection/perspective.case.c: what tests know of the perspective projection. */
#include "projection/projection.case.h"

const ProjectionCase perspective_projection = {
    .fov = 90,
    .shape = NO_SHAPE,
    .known = {{CASE_PI / 6, 0.57735026918962576}, {-CASE_PI / 6, -0.57735026918962576}},
    .end = CASE_PI / 2,
};
