/* projection/unified.case.c: what tests know of the unified projection. */
#include "projection/projection.case.h"

/* xi = .8: sin / (cos + xi); the view ends where that is 0 */
const ProjectionCase unified_projection = {
    .focal = 20,
    .shape = {0.8, VL_UNSET},
    .has_other = true,
    .other = {1.1, VL_UNSET},
    .known = {{CASE_PI / 3, HALF_SQRT3 / 1.3}, {-CASE_PI / 2, -1.25}},
    .end = 2.498092,
};
