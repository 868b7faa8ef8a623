/* projection/cube.case.c: what tests know of the cube projection. */
#include "projection/projection.case.h"

const ProjectionCase cube_projection = {
    .shape = {0, VL_UNSET},
    .has_other = true,
    .other = {1, VL_UNSET},
    .solid_angle = 4 * CASE_PI,
    .seen = {.7, .4, 4.92114419023, 0.776392454396},
};
