/* texture/fbm.case.c: what tests know of the texture fbm. */
#include "texture/texture.case.h"

/* pbrt (3rd edition, 10.6.3): the sum of its octaves. */
static void formula(const TextureAt *at, double rgb[3]) {
  rgb[0] = rgb[1] = rgb[2] = plain_fractal(at->noise, at->p, at->width, 0.4, 3);
}

/* The noise is 0 at points of the lattice: here at uv = (.5, .5), which is the origin. */
const TextureCase fbm_texture = {
    .variants =
        {
            {.parameters = "\"integer octaves\" 3 \"float roughness\" .4",
             .high = 1,
             .known = {{.5, .5, {0, 0, 0}}},
             .formula = formula,
             .of_space = true},
        },
};
