/* projection/panini.case.c: what tests know of the panini projection. */
#include "projection/projection.case.h"

/* d = .5: (d + 1) sin / (d + cos); the view ends where d + cos = 0 */
const ProjectionCase panini_projection = {
    .fov = 120,
    .shape = {0.5, VL_UNSET},
    .has_other = true,
    .other = {1.5, VL_UNSET},
    .known = {{CASE_PI / 3, 1.5 * HALF_SQRT3}, {-CASE_PI / 6, -0.75 / (0.5 + HALF_SQRT3)}},
    .end = 2 * CASE_PI / 3,
    .seen = {.7, .4, 0.763989800918, 0.501398383516},
};
