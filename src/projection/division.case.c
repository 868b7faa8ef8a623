/* projection/division.case.c: what tests know of the division projection. */
#include "projection/projection.case.h"

/* lambda = -.2: tan = r / (1 - .2 r^2), at r = 1 tan = 1.25 */
const ProjectionCase division_projection = {
    .focal = 20,
    .shape = {-0.2, VL_UNSET},
    .has_other = true,
    .other = {0.1, VL_UNSET},
    .known = {{0.89605538457134396, 1}, {-0.89605538457134396, -1}},
    .end = CASE_PI,
};
