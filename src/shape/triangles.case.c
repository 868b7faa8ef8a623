/* shape/triangles.case.c: what tests know of meshes of triangles. */
#include "shape/shape.case.h"

const ShapeCase triangles_shape = {
    .variants =
        {
            {.parameters = "\"point3 P\" [0 0 0 1 0 0 0 1 0] \"point2 uv\" [0 0 1 0 0 1] "
                           "\"integer indices\" [0 1 2]",
             .area = 0.5,
             .reach = 1.01,
             .known = {{{.2, .3, 1}, {0, 0, -1}, 1, .2, .3},
                       {{.6, .6, 1}, {0, 0, -1}, INFINITY, NAN, NAN}}},
            {.parameters = "\"point3 P\" [-.5 -.5 0 .5 -.5 0 .5 .5 .4 -.5 .5 .4] "
                           "\"integer indices\" [0 1 2 0 2 3]",
             .area = 1.0770330,
             .known = {{{.1, 0, 1}, {0, 0, -1}, .8, NAN, NAN}}},
        },
    .parameters =
        {
            {.base = SQUARE ";\"integer indices\" [0 1 2 1 3 2]"},
            {.parameter = "displacement",
             .directive = "plymesh",
             .base = "\"string filename\" \"a.ply\";\"float edgelength\" .3",
             .value = "\"texture displacement\" \"bumps\""},
            {.parameter = "edgelength",
             .directive = "plymesh",
             .base = "\"string filename\" \"a.ply\";\"texture displacement\" \"bumps\"",
             .value = "\"float edgelength\" .3"},
            {.parameter = "P", .value = LIFTED},
            {.parameter = "indices", .value = "\"integer indices\" [0 1 2 0 1 3]"},
            {.parameter = "N", .value = TURNED},
            {.parameter = "S", .value = "\"vector3 S\" [1 1 0 1 1 0 1 1 0 1 1 0]"},
            {.parameter = "uv", .value = UVS},
        },
};
