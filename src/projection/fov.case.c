/* projection/fov.case.c: what tests know of the fov projection. */
#include "projection/projection.case.h"

/* w = .9: atan(2 tan(theta) tan(w / 2)) / w */
const ProjectionCase fov_projection = {
    .focal = 20,
    .shape = {0.9, VL_UNSET},
    .has_other = true,
    .other = {0.4, VL_UNSET},
    .known = {{CASE_PI / 4, 0.853514284171}, {-CASE_PI / 4, -0.853514284171}},
    .end = CASE_PI / 2,
};
