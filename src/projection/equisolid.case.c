/* projection/equisolid.case.c: what tests know of the equisolid projection. */
#include "projection/projection.case.h"

const ProjectionCase equisolid_projection = {
    .fov = 180,
    .shape = NO_SHAPE,
    .solid_angle = 2 * CASE_PI,
    .known = {{CASE_PI / 3, 1}, {-CASE_PI / 3, -1}},
    .end = CASE_PI,
};
