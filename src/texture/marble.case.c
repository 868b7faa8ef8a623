/* texture/marble.case.c: what tests know of the texture marble. */
#include "texture/texture.case.h"

const TextureCase marble_texture = {
    .variants =
        {
            {.parameters = "\"float scale\" 3 \"float variation\" .4",
             .low = 0,
             .high = 1,
             .of_space = true},
        },
};
