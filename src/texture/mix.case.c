/* texture/mix.case.c: what tests know of the texture mix. */
#include "texture/texture.case.h"

const TextureCase mix_texture = {
    .variants =
        {
            {.parameters =
                 "\"rgb tex1\" [.8 .4 .2] \"rgb tex2\" [.1 .2 .3] \"float amount\" .25",
             .low = .1,
             .high = .8,
             .even = true,
             .known =
                 {{.3, .4, {.75 * .8 + .25 * .1, .75 * .4 + .25 * .2, .75 * .2 + .25 * .3}}}},
            {.parameters =
                 "\"rgb tex1\" [.5 .5 .5] \"rgb tex2\" [1 1 1] \"texture amount\" \"halves\"",
             .low = .5,
             .high = 1,
             .known = {{.25, .4, {.55, .55, .55}}, {.75, .4, {.9, .9, .9}}}},
        },
};
