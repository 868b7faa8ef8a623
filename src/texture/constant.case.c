/* texture/constant.case.c: what tests know of the texture constant. */
#include "texture/texture.case.h"

const TextureCase constant_texture = {
    .variants =
        {
            {.parameters = "\"rgb value\" [.7 .4 .2]",
             .low = .2,
             .high = .7,
             .even = true,
             .known = {{.3, .4, {.7, .4, .2}}}},
        },
};
