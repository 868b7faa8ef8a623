/* texture/direction_mix.case.c: what tests know of the texture direction mix. */
#include "texture/texture.case.h"

/* The square's normal is +z. */
const TextureCase direction_mix_texture = {
    .variants =
        {
            {.parameters =
                 "\"rgb tex1\" [.8 .4 .2] \"rgb tex2\" [.1 .2 .3] \"vector3 dir\" [0 0 1]",
             .low = .1,
             .high = .8,
             .even = true,
             .known = {{.3, .4, {.8, .4, .2}}}},
            {.parameters =
                 "\"rgb tex1\" [.8 .4 .2] \"rgb tex2\" [.1 .2 .3] \"vector3 dir\" [0 .8 -.6]",
             .low = .1,
             .high = .8,
             .even = true,
             .known = {{.3, .4, {.6 * .8 + .4 * .1, .6 * .4 + .4 * .2, .6 * .2 + .4 * .3}}}},
        },
};
