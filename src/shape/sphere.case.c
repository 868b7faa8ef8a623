/* shape/sphere.case.c: what tests know of spheres. */
#include "shape/shape.case.h"

const ShapeCase sphere_shape = {
    .variants =
        {
            {.parameters = "\"float radius\" .8",
             .area = 4 * HALF_TURN * .64,
             .reach = 0.81,
             .known = {{{0, 2, .4}, {0, -1, 0}, 2 - 0.69282032, .25, 1 - 1.0 / 3}}},
            {.parameters =
                 "\"float radius\" .8 \"float zmin\" -.4 \"float zmax\" .4 \"float phimax\" 180",
             .area = HALF_TURN * .8 * .8,
             .reach = 0.81,
             .known = {{{0, 2, 0}, {0, -1, 0}, 1.2, .5, .5},
                       {{0, 0, 2}, {0, 0, -1}, INFINITY, NAN, NAN}}},
        },
};
