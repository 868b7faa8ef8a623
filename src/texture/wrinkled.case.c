/* texture/wrinkled.case.c: what tests know of the texture wrinkled. */
#include "texture/texture.case.h"

const TextureCase wrinkled_texture = {
    .variants =
        {
            {.parameters = "\"integer octaves\" 3 \"float roughness\" .3",
             .low = 0,
             .high = 1,
             .of_space = true},
        },
};
