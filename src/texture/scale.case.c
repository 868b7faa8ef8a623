/* texture/scale.case.c: what tests know of the texture scale. */
#include "texture/texture.case.h"

const TextureCase scale_texture = {
    .variants =
        {
            {.parameters = "\"rgb tex\" [.8 .4 .2] \"float scale\" .5",
             .low = .1,
             .high = .4,
             .even = true,
             .known = {{.3, .4, {.4, .2, .1}}}},
            {.parameters = "\"rgb tex\" [.8 .8 .8] \"texture scale\" \"halves\"",
             .low = .08,
             .high = .64,
             .known = {{.25, .4, {.08, .08, .08}}, {.75, .4, {.64, .64, .64}}}},
        },
};
