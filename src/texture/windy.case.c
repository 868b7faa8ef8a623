/* texture/windy.case.c: what tests know of the texture windy. */
#include "texture/texture.case.h"

const TextureCase windy_texture = {
    .variants =
        {
            {.parameters = "",
             .low = 0,
             .high = 1,
             .known = {{.5, .5, {0, 0, 0}}},
             .known_count = 1,
             .of_space = true},
        },
};
