/* projection/eucm.case.c: what tests know of the eucm projection. */
#include "projection/projection.case.h"

/* alpha = .6, beta = 1.1: sin / (alpha sqrt(beta sin^2 + cos^2) + (1 - alpha) cos). The view
 * ends where z = -w sqrt(beta r^2 + z^2), w = (1 - alpha) / alpha. */
const ProjectionCase eucm_projection = {
    .focal = 20,
    .shape = {0.6, 1.1},
    .has_other = true,
    .other = {0.4, 0.8},
    .known = {{CASE_PI / 3, 1.053439392292}, {-CASE_PI / 2, -1.589104315409}},
    .end = 2.324258,
};
