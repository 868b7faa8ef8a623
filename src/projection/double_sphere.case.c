/* projection/double_sphere.case.c: what tests know of the double sphere projection. */
#include "projection/projection.case.h"

/* xi = -.2, alpha = .6: at 90 degrees sin / (alpha sqrt(1 + xi^2) + (1 - alpha) xi).
 * The second sphere ends at psi, cos(psi) = (alpha - 1) / alpha; the view at psi +
 * asin(xi sin(psi)). */
const ProjectionCase double_sphere_projection = {
    .focal = 20,
    .shape = {-0.2, 0.6},
    .has_other = true,
    .other = {0.3, 0.4},
    .known = {{CASE_PI / 2, 1.880115058780}, {-CASE_PI / 2, -1.880115058780}},
    .end = 2.150895,
};
