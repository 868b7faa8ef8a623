/* shape/disk.case.c: what tests know of disks. */
#include "shape/shape.case.h"

const ShapeCase disk_shape = {
    .variants =
        {
            {.parameters = "\"float radius\" .8 \"float innerradius\" .4 \"float height\" .1",
             .area = HALF_TURN * (.64 - .16),
             .reach = 0.82,
             .known = {{{0, .6, 1}, {0, 0, -1}, .9, .25, .5},
                       {{.1, .2, 1}, {0, 0, -1}, INFINITY, NAN, NAN}}},
            {.parameters = "\"float radius\" .8 \"float phimax\" 90",
             .area = HALF_TURN * .16,
             .reach = 0.81},
        },
};
