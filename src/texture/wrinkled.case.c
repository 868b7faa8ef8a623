/* texture/wrinkled.case.c: what tests know of the texture wrinkled. */
#include "texture/texture.case.h"

/* pbrt (3rd edition, 10.6.4): the sum of its octaves without their signs. */
static void formula(const TextureAt *at, double rgb[3]) {
  rgb[0] = rgb[1] = rgb[2] = plain_turbulence(at->noise, at->p, at->width, 0.3, 3);
}

const TextureCase wrinkled_texture = {
    .variants =
        {
            {.parameters = "\"integer octaves\" 3 \"float roughness\" .3",
             .high = 1,
             .formula = formula,
             .of_space = true},
        },
};
