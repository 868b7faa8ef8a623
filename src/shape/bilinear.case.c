/* shape/bilinear.case.c: what tests know of meshes of bilinear patches. */
#include "shape/shape.case.h"

const ShapeCase bilinear_shape = {
    .variants =
        {
            {.parameters = "\"point3 P\" [-.5 -.5 0 .5 -.5 0 -.5 .5 0 .5 .5 0]",
             .area = 1,
             .known = {{{-.3, .1, 1}, {0, 0, -1}, 1, .2, .6},
                       {{.6, .6, 1}, {0, 0, -1}, INFINITY, NAN, NAN}}},
            /* z = x y over the square: the area is the integral of sqrt(1 + x^2 + y^2) */
            {.parameters = "\"point3 P\" [-.5 -.5 .25 .5 -.5 -.25 -.5 .5 -.25 .5 .5 .25]",
             .area = 1.0790366,
             .known = {{{.25, .5, 1}, {0, 0, -1}, .875, .75, 1}}},
            /* z = 2.4 x y, which many lines meet twice */
            {
                .parameters = "\"point3 P\" [-.5 -.5 .6 .5 -.5 -.6 -.5 .5 -.6 .5 .5 .6] "
                              "\"point2 uv\" [0 .1 .7 0 .2 .9 .9 .8]",
                .area = 1.3832461,
            },
            /* with normals of its own, which turn in different ways along u and along v */
            {
                .parameters = "\"point3 P\" [-.5 -.5 .25 .5 -.5 -.25 -.5 .5 -.25 .5 .5 .25] "
                              "\"normal N\" [.3 .1 1 -.2 .4 1 .1 -.3 1 0 .2 1]",
                .area = 1.0790366,
            },
        },
    .parameters =
        {
            {.base = SQUARE},
            {.parameter = "P", .value = LIFTED},
            {.parameter = "indices", .value = "\"integer indices\" [0 2 1 3 0 1 3 2]"},
            {.parameter = "N", .value = TURNED},
            {.parameter = "uv", .value = UVS},
        },
};
