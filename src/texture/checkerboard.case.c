/* texture/checkerboard.case.c: what tests know of the texture checkerboard. */
#include "texture/texture.case.h"

const TextureCase checkerboard_texture = {
    .variants =
        {
            {.parameters = "\"float uscale\" 2 \"float vscale\" 2 \"rgb tex1\" [.8 .7 .6] "
                           "\"rgb tex2\" [.1 .2 .3]",
             .low = .1,
             .high = .8,
             .known = {{.25, .25, {.8, .7, .6}},
                       {.75, .25, {.1, .2, .3}},
                       {.25, .75, {.1, .2, .3}},
                       {.75, .75, {.8, .7, .6}}}},
            {.parameters = "\"float uscale\" 1 \"float udelta\" .5 \"rgb tex1\" [.8 .8 .8] "
                           "\"rgb tex2\" [.1 .1 .1]",
             .low = .1,
             .high = .8,
             .known = {{.25, .25, {.8, .8, .8}}, {.75, .25, {.1, .1, .1}}}},
            /* the square lies at z = 0 from -1 to 1 */
            {.parameters =
                 "\"integer dimension\" 3 \"rgb tex1\" [.8 .8 .8] \"rgb tex2\" [.1 .1 .1]",
             .low = .1,
             .high = .8,
             .known = {{.75, .75, {.8, .8, .8}},
                       {.25, .75, {.1, .1, .1}},
                       {.25, .25, {.8, .8, .8}}},
             .of_space = true},
        },
    .parameters = {{.base = "\"float uscale\" 4;\"float vscale\" 3"},
                   {.parameter = "dimension",
                    .base = "\"rgb tex1\" [.9 .8 .7]",
                    .value = "\"integer dimension\" 3"},
                   {.parameter = "mapping",
                    .base = "\"rgb tex1\" [.9 .8 .7]",
                    .value = "\"string mapping\" \"planar\""}},
};
