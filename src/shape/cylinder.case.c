/* shape/cylinder.case.c: what tests know of cylinders. */
#include "shape/shape.case.h"

const ShapeCase cylinder_shape = {
    .variants =
        {
            {.parameters = "\"float radius\" .5 \"float zmin\" -.4 \"float zmax\" .6",
             .area = HALF_TURN,
             .known = {{{0, 2, 0}, {0, -1, 0}, 1.5, .25, .4},
                       {{0, 2, .7}, {0, -1, 0}, INFINITY, NAN, NAN}}},
            {.parameters = "\"float radius\" .5 \"float phimax\" 120",
             .area = HALF_TURN / 3 * 2},
        },
};
