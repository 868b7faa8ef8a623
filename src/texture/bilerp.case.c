/* texture/bilerp.case.c: what tests know of the texture bilerp. */
#include "texture/texture.case.h"

const TextureCase bilerp_texture = {
    .variants =
        {
            {.parameters =
                 "\"rgb v00\" [.1 .1 .1] \"rgb v01\" [.3 .3 .3] \"rgb v10\" [.5 .5 .5] "
                 "\"rgb v11\" [.9 .9 .9]",
             .low = .1,
             .high = .9,
             .known = {{.001, .001, {.1, .1, .1}},
                       {.001, .999, {.3, .3, .3}},
                       {.999, .001, {.5, .5, .5}},
                       {.5, .5, {.45, .45, .45}}}},
        },
};
