/* texture/fbm.case.c: what tests know of the texture fbm. */
#include "texture/texture.case.h"

/* The noise is 0 at points of the lattice: here at uv = (.5, .5), which is the origin. */
const TextureCase fbm_texture = {
    .variants =
        {
            {.parameters = "\"integer octaves\" 3",
             .low = 0,
             .high = 1,
             .known = {{.5, .5, {0, 0, 0}}},
             .known_count = 1,
             .of_space = true},
        },
};
