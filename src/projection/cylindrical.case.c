/* projection/cylindrical.case.c: what tests know of the cylindrical projection. */
#include "projection/projection.case.h"

/* The whole cylinder as far up and down as the image shows. */
const ProjectionCase cylindrical_projection = {
    .shape = NO_SHAPE,
    .known = {{CASE_PI / 3, CASE_PI / 3}, {-2.5, -2.5}},
    .end = CASE_PI,
    .seen = {.7, .4, 0.7, 0.422793218738},
};
